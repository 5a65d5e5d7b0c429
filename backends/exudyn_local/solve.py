"""Runs a Model in Exudyn and checks what came out.

Exudyn's own success flag is not trusted: the end time must be reached, the state finite, Newton converged
(an exception otherwise), and the boxes within the bounds from which the contacts were chosen.
"""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from backends.exudyn_local import kernels
from backends.exudyn_local.recorder import Recorder
from backends.exudyn_local.step import choose_steps
from backends.exudyn_local.system import MM, MS, Pattern, System, build
from mdlgen.model.external import refuse_externals
from mdlgen.model.sheet_pairs import refuse_searched
from mdlgen.model.tables import Model
from mdlgen.results.result import Result

# Spectral radius of the generalised-alpha rule: 1 would keep the noise of contact changes, 0 damps most.
SPECTRAL_RADIUS = 0.6
# Newton's tolerance: the default 1e-10 lies below the round-off of stiff bushings (k eps |x|).
NEWTON_TOLERANCE = 1e-8
STATIC_LOAD_STEPS = 20
# Energy made by the integration, relative to what passed through, above which a run fails.
ENERGY_GAIN = 0.02
# Relative to the load of one step; what counts is our own check of the residual at the end.
STATIC_TOLERANCE = 1e-8
# A step may shrink to this part of the wanted one before the run fails.
SMALLEST_STEP = 1e-3

Progress = Callable[[float, float, int, int], None]


@dataclass
class Assembly:
    """Exudyn's system, with the arrays that its user functions work on."""

    mbs: Any  # of Exudyn's compiled module, whose stubs are not complete
    container: Any
    system: System
    pattern: Pattern
    q: np.ndarray
    v: np.ndarray


def solve(model: Model, progress: Progress | None = None, step: float | None = None) -> Result:
    """Run a Model; `progress(time, end, steps, touching)` is told where it stands (times in ms).

    `step` [ms] overrides the Model's. A failed run returns a Result with its reason; RefusedError is
    raised for what the backend cannot represent.
    """
    refuse_externals(model, "Exudyn")
    refuse_searched(model, "Exudyn")
    started = clock.perf_counter()
    system, pattern = build(model)
    exu = _exudyn()
    compiled = clock.perf_counter()
    work = kernels.workspace(system)
    _compile(system, pattern, work)
    compile_s = clock.perf_counter() - compiled
    recorder = Recorder(model, system, progress)
    assembly = _assemble(exu, model, system, pattern, work)
    build_s = clock.perf_counter() - started - compile_s
    static = model.run.analysis == "static"
    count, h = (1, 0.0) if static else choose_steps(model, step)
    if not static:
        recorder.plan(h)
        assembly.mbs.SetPostStepUserFunction(recorder.after_step)
        recorder.store(assembly.q, assembly.v, 0.0)
    begun = clock.perf_counter()
    reason = _run(exu, assembly, model, count, h, recorder.touching > 0)
    wall = clock.perf_counter() - begun
    data = assembly.mbs.systemData
    q, v = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
    if static:
        v[:] = 0.0  # Exudyn leaves the initial velocities there
    if static and reason is None:
        recorder.store(q, v, 0.0)
    reason = recorder.reason or reason
    if reason is None and not (np.isfinite(q).all() and np.isfinite(v).all()):
        reason = "the state went non-finite"
    # the reached time is kept by our own step function, not by the solver's flag
    if reason is None and not static and recorder.time < model.run.duration * MS * (1 - 1e-9):
        reason = f"stopped at {recorder.time / MS:.6g} ms, before the end at {model.run.duration:g} ms"
    if reason is None and static:
        reason = _unbalanced(system, q, work)
    result = recorder.result("exudyn", reason)
    if result.ok and result.energy.balance_error > ENERGY_GAIN:
        # the integrator's own damping may lose energy; nothing may make it
        result = result.failed(
            f"{100 * result.energy.balance_error:.3g} % of the energy came from nowhere; "
            "take a smaller run.step"
        )
    result.wall_s, result.build_s, result.compile_s = wall, build_s, compile_s
    result.step, result.steps = h / MS, recorder.steps
    result.versions = {"exudyn": exu.config.Version() if hasattr(exu.config, "Version") else exu.__version__}
    return result


def _exudyn():
    # Exudyn looks for this attribute, unknown to sys: it skips range checks in the compiled module
    sys.exudynFast = True  # type: ignore[attr-defined]
    import exudyn as exu

    exu.special.userInterface.SuppressAll(True)
    return exu


def _compile(system: System, pattern: Pattern, work: kernels.Work) -> None:
    """Compile (or load from the cache) every kernel before the clock of the run starts."""
    x, r, u, w, _, f = work
    free = system.free
    q, v = np.zeros(max(1, free)), np.zeros(max(1, free))
    data = np.zeros(len(pattern.indices))
    owner = kernels.owners(system.bodies, free)
    kernels.forces(*system.tables, q, v, 0.0, 1.0, *work)
    kernels.jacobian(*system.tables, system.elements, q, v, 0.0, 1.0, 1.0, 1.0, False, owner, *work, data)
    kernels.ledger(
        *system.tables, q, v, 0.0, x, r, u, w, f, np.zeros((len(system.pairs), kernels.OUT)), np.zeros(5)
    )


def _assemble(exu, model: Model, system: System, pattern: Pattern, work: kernels.Work) -> Assembly:
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
    # a roller with a clutch begins with its shaft
    starts = {
        int(system.bodies["spin"][r.body]): float(r.prescribed(0.0)) / MS
        for r in model.rollers
        if r.one_way is not None and r.speed is not None
    }
    for body in range(len(bodies.name)):
        row = system.bodies[body]
        n = row["first"]
        if n >= 0:
            reference = row["reference"]
            rate = bodies.spin[body] / MS
            e = reference[3:]
            v[n : n + 3] = bodies.velocity[body] * MM / MS
            v[n + 3 : n + 7] = 0.5 * np.array(
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
        for coordinate, mass in ((row["slide"], row["press"][3]), (row["spin"], row["press"][4])):
            if coordinate >= 0:
                rate = starts.get(coordinate, 0.0)
                v[coordinate] = rate
                node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], initialVelocities=[rate]))
                mbs.AddObject(Mass1D(mass=mass, nodeNumber=node))
                nodes.append(node)
    f = work[-1]
    tables = system.tables
    owner = kernels.owners(system.bodies, free)
    data = np.zeros(len(pattern.indices))
    state = mbs.systemData
    static = model.run.analysis == "static"
    rest = np.zeros_like(q)

    def force(mbs, t, itemNumber, q, q_t):
        kernels.forces(
            *tables,
            state.GetODE2Coordinates(copy=False),
            rest if static else state.GetODE2Coordinates_t(copy=False),
            t,
            t if static else 1.0,
            *work,
        )
        return f

    def tangent(mbs, t, itemNumber, q, q_t, fODE2, fODE2_t):
        kernels.jacobian(
            *tables,
            system.elements,
            np.array(q),
            rest.copy() if static else np.array(q_t),
            t,
            t if static else 1.0,
            fODE2,
            0.0 if static else fODE2_t,
            static,
            owner,
            *work,
            data,
        )
        return exu.MatrixContainer(csr_matrix((data, pattern.indices, pattern.indptr), shape=(free, free)))

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
    return Assembly(mbs, container, system, pattern, q, v)


def _settings(exu, count: int, end: float, touching: bool):
    """Exudyn's settings for `count` steps to `end` [s], or for a static run where `end` is 0."""
    s = exu.SimulationSettings()
    s.solution.file.write = False
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    s.parallel.numberOfThreads = 1
    static = s.staticSolver
    static.newton.absoluteTolerance = NEWTON_TOLERANCE
    static.newton.relativeTolerance = STATIC_TOLERANCE
    static.newton.maxIterations = 40
    static.numberOfLoadSteps = STATIC_LOAD_STEPS
    static.verboseMode = 0
    if end == 0.0:
        return s
    t = s.timeIntegration
    t.newton.useModifiedNewton = True
    t.newton.absoluteTolerance = t.newton.relativeTolerance = NEWTON_TOLERANCE
    t.newton.maxIterations = 12
    t.verboseMode = 0
    t.numberOfSteps = count
    t.endTime = end
    t.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
    # Accelerations at the start are wanted for accuracy; but in contact the stiff damping makes them so
    # large for a moment that Newton would start far away. Such scenes start at rest in their nips.
    t.generalizedAlpha.computeInitialAccelerations = not touching
    t.adaptiveStep = True  # a step that does not converge is repeated at half the size
    t.adaptiveStepDecrease = 0.5
    t.adaptiveStepIncrease = 2.0
    t.adaptiveStepRecoverySteps = 1
    t.minimumStepSize = end / count * SMALLEST_STEP
    return s


def _run(exu, assembly: Assembly, model: Model, count: int, h: float, touching: bool) -> str | None:
    """Runs; returns the reason of a failure, or None."""
    if assembly.system.free == 0:
        return "nothing in this scene can move"
    settings = _settings(exu, count, count * h, touching)
    mbs = assembly.mbs
    try:
        run = mbs.SolveStatic if model.run.analysis == "static" else mbs.SolveDynamic
        done = run(settings)
    except Exception as error:  # Exudyn raises its own kinds for a Newton that does not converge
        if isinstance(error, KeyboardInterrupt):
            raise
        told = [line.strip() for line in str(error).splitlines() if line.strip()]
        return f"Exudyn did not converge: {told[0] if told else type(error).__name__}"[:300]
    return None if done else "Exudyn stopped before the end"


def _unbalanced(system: System, q: np.ndarray, work: kernels.Work) -> str | None:
    """Static equilibrium by our own account: the residual against the largest force in the sheet."""
    kernels.forces(*system.tables, q, np.zeros_like(q), 1.0, 1.0, *work)
    residual = work[-1].copy()
    for row in system.bodies:
        n = row["first"]
        if n >= 0:  # along the Euler parameters themselves a force does no work
            e = row["reference"][3:] + q[n + 3 : n + 7]
            residual[n + 3 : n + 7] -= e * (e @ residual[n + 3 : n + 7]) / (e @ e)
    weight = float(system.bodies["mass"].sum() * np.linalg.norm(system.gravity))
    loads = float(np.abs(system.loads["force"]).sum() + np.abs(system.loads["moment"]).sum() / 0.1)
    allowed = 1e-4 * max(weight, loads, 1e-9)
    worst = float(np.abs(residual).max())
    return None if worst <= allowed else f"static residual {worst:.3g} N above {allowed:.3g} N"
