"""A System as bodies of Exudyn, with one object for all forces and their jacobian."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from mdlgen.backends.exudyn_local.films import LAG, entries_of
from mdlgen.backends.exudyn_local.patches import masses
from mdlgen.backends.exudyn_local.place import owners
from mdlgen.backends.exudyn_local.recorder import Recorder
from mdlgen.backends.exudyn_local.shipped import air_slopes, begin_air, forces, jacobian, lay_air
from mdlgen.backends.exudyn_local.state import Coordinates, Work
from mdlgen.backends.exudyn_local.system import EULER, MM, MS, Pattern, System
from mdlgen.mechanics.arm import AXIAL, INERTIA
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.model.starts import begun_rates
from mdlgen.model.tables import Model


@dataclass
class Assembly:
    """Exudyn's system, with the arrays that its user functions work on."""

    mbs: Any  # of Exudyn's compiled module, whose stubs are not complete
    container: Any
    system: System
    pattern: Pattern
    q: np.ndarray
    v: np.ndarray


class Begun(NamedTuple):
    """Coordinates with which a part of a run begins, their rates and accelerations, (free,)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray


def assemble(
    exu,
    model: Model,
    system: System,
    pattern: Pattern,
    work: Work,
    recorder: Recorder,
    begun: Begun | None = None,
    bring: Callable[[float], None] | None = None,
) -> Assembly:
    """Assembly of a Model and its System; the recorder has the state at the end of the last step. `begun`:
    the initial state, None: that of the Model. `bring` is called with the part of the load in each step of a
    static run."""
    from exudyn.itemInterface import (
        Mass1D,
        Node1D,
        NodeRigidBodyEP,
        ObjectGenericODE2,
        ObjectRigidBody,
        VObjectGenericODE2,
    )
    from scipy.sparse import csr_matrix

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    bodies = model.bodies
    nodes = []
    free = system.free
    q, v = np.zeros(max(1, free)), np.zeros(max(1, free))
    # a roller with a clutch or a limiter begins with its shaft
    starts = {
        int(system.bodies["spin"][r.body]): float(r.prescribed(0.0)) / MS
        for r in model.rollers
        if r.begins_turning
    }
    for rate in begun_rates(model):
        starts[int(system.bodies[rate.of][rate.body])] = rate.rate / MS * (1.0 if rate.turns else MM)
    for body in range(len(bodies.name)):
        row = system.bodies[body]
        n = row["first"]
        if n >= 0:
            reference = row["reference"]
            rate = bodies.spin[body] / MS
            e = reference[EULER:]
            v[n : n + EULER] = bodies.velocity[body] * MM / MS
            v[n + EULER : n + 7] = 0.5 * np.array(
                [
                    -e[1] * rate[0] - e[2] * rate[1] - e[3] * rate[2],
                    e[0] * rate[0] + e[3] * rate[1] - e[2] * rate[2],
                    -e[3] * rate[0] + e[0] * rate[1] + e[1] * rate[2],
                    e[2] * rate[0] - e[1] * rate[1] + e[0] * rate[2],
                ]
            )
            node = mbs.AddNode(
                NodeRigidBodyEP(referenceCoordinates=list(reference), initialVelocities=list(v[n : n + 7]))
            )
            inertia = [*row["inertia"], 0.0, 0.0, 0.0]
            mbs.AddObject(ObjectRigidBody(mass=row["mass"], inertia=inertia, nodeNumber=node))
            nodes.append(node)
            continue
        for coordinate, mass in ((row["slide"], row["press"][INERTIA]), (row["spin"], row["press"][AXIAL])):
            if coordinate >= 0 and row["coupled"] != FOLLOWER:  # else it has the node of its leader
                rate = starts.get(coordinate, 0.0)
                v[coordinate] = rate
                node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], initialVelocities=[rate]))
                mbs.AddObject(Mass1D(mass=mass, nodeNumber=node))
                nodes.append(node)
    for mass in masses(system.stick).tolist():
        node = mbs.AddNode(Node1D(referenceCoordinates=[0.0]))
        mbs.AddObject(Mass1D(mass=mass, nodeNumber=node))
        nodes.append(node)
    cells = system.film.cells.size
    if cells:
        begin_air(system.tables, Coordinates(q, v, 0.0), work.motion)
        for pressure, area in zip(v[free - cells :].tolist(), system.film.areas.tolist(), strict=True):
            node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], initialVelocities=[pressure]))
            mbs.AddObject(Mass1D(mass=LAG * area, nodeNumber=node))
            nodes.append(node)
    entries, values = entries_of(system.film)
    f = work.forces
    tables = system.tables
    owner = owners(system)
    data = np.zeros(len(pattern.indices))
    state = mbs.systemData
    static = model.run.analysis == "static"
    rest = np.zeros_like(q)
    here, rates = (
        np.zeros_like(q),
        np.zeros_like(q),
    )  # the same arrays at each call, so that their types are checked only once

    laid = [0.0]  # time for which the gaps of the air were set

    def lay(t: float) -> None:
        """Sets the gaps of a step that ends at t, before its first iteration."""
        if cells and t != laid[0]:
            begun = recorder.begun
            guess = Coordinates(begun.q + (t - begun.t) * begun.v, begun.v, t)
            lay_air(tables, guess, t - begun.t, work.motion)
            laid[0] = t

    def force(mbs, t, itemNumber, q, q_t):
        lay(t)
        here[:] = state.GetODE2Coordinates(copy=False)
        if not static:
            rates[:] = state.GetODE2Coordinates_t(copy=False)
        if bring is not None:
            bring(t)
        forces(tables, Coordinates(here, rates, t), t if static else 1.0, work)
        return f

    def tangent(mbs, t, itemNumber, q, q_t, fODE2, fODE2_t):
        lay(t)
        if bring is not None:
            bring(t)
        at = Coordinates(np.array(q), rest.copy() if static else np.array(q_t), t)
        by = (fODE2, 0.0 if static else fODE2_t)
        jacobian(tables, system.elements, at, t if static else 1.0, by, static, owner, work, data)
        if not np.isfinite(data).all():
            # a factor of it would end the whole process; a singular one is a step that did not converge
            data[:] = 0.0
        matrix = csr_matrix((data, pattern.indices, pattern.indptr), shape=(free, free))
        if cells:
            many = air_slopes(tables, at, by[1], work.motion, entries, values)
            matrix += csr_matrix((values[:many], entries[:, :many]), shape=(free, free))
        return exu.MatrixContainer(matrix)

    if nodes:
        mbs.AddObject(
            ObjectGenericODE2(
                nodeNumbers=nodes,
                forceUserFunction=force,
                jacobianUserFunction=tangent,
                visualization=VObjectGenericODE2(show=False),
            )
        )
    mbs.Assemble()
    if begun is not None and free:
        q[:], v[:] = begun.q, begun.v
        first = exu.ConfigurationType.Initial
        for place, values in (
            (state.SetODE2Coordinates, begun.q),
            (state.SetODE2Coordinates_t, begun.v),
            (state.SetODE2Coordinates_tt, begun.a),
        ):
            place(values, first)
    return Assembly(mbs, container, system, pattern, q, v)
