"""Builds the workspace of a run for its start."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.bristles import begin
from mdlgen.backends.lattice.hinges import begin as begin_hinges
from mdlgen.backends.lattice.integrate.awake import Parts
from mdlgen.backends.lattice.integrate.films import films
from mdlgen.backends.lattice.integrate.islands import groups, islands
from mdlgen.backends.lattice.integrate.record import Recorder
from mdlgen.backends.lattice.integrate.there import There, Whole, parts_of
from mdlgen.backends.lattice.kernels.state import (
    COUNTERS,
    GUESSES,
    ROW,
    Asleep,
    Bounds,
    Control,
    History,
    Islands,
    Kept,
    Matrix,
    Midpoint,
    State,
    Workspace,
)
from mdlgen.mechanics.frame import Motion
from mdlgen.model.passing import at_start, passing
from mdlgen.model.starts import begun_rates
from mdlgen.model.tables import Floats, Ints, Model


class Begun(NamedTuple):
    """The part of a System that is in the machine as a run begins."""

    system: System
    chosen: Ints  # numbers of its pairs among those of the whole System, without searched pairs.
    there: There  # its bodies.


def start(model: Model, begun: Begun) -> tuple[State, Midpoint, Matrix]:
    """State at the start, and the arrays of a step."""
    from mdlgen.backends.lattice.kernels import forces
    from mdlgen.backends.lattice.kernels.integrate import room

    system, there = begun.system, begun.there
    state, mid, matrix = room.empty(system, forces.WIDE)
    x, r = begun_places(model)
    state.x[:], state.r[:] = there.rows(x), there.rows(r)
    mid.motion.x[:], mid.motion.r[:] = state.x, state.r
    state.v[:], state.l[:], state.u[:], _, _ = starts(model, there.whole(system.nodes))
    for roller in model.rollers:
        if roller.begins_turning:  # with its shaft
            at = system.bodies["spin"][there.number(roller.body)]
            if at < 0:
                continue  # eliminated by symmetry, see symmetry.mirror
            state.vb[at] = state.ub[at] = roller.prescribed(0.0)
        if roller.motor and roller.axle is not None:
            at = system.bodies["spin"][there.number(roller.body)]
            state.s[at] = roller.axle.begins_behind(float(roller.prescribed(0.0)))
    for rate in begun_rates(model):
        at = system.bodies[rate.of][there.number(rate.body)]
        if at >= 0:  # else eliminated by symmetry
            state.vb[at] = state.ub[at] = rate.rate
    return state, mid, matrix


def begun_places(model: Model) -> tuple[Floats, Floats]:
    """Places x (bodies + 1, 3) [mm] and rotations r (bodies + 1, 9) of bodies as a run begins; the last row
    is the ground."""
    bodies = model.bodies
    return (
        np.append(bodies.position, np.zeros((1, 3)), axis=0),
        np.append(bodies.rotation.reshape(-1, 9), np.eye(3).reshape(1, 9), axis=0),
    )


def starts(model: Model, nodes: Ints) -> tuple[Floats, ...]:
    """Initial values of the boxes `nodes` (n,): velocities [mm/ms] and angular momenta [N mm ms], (n, 3)
    each; velocities with angular velocities [rad/ms], (n, 6), once for each of the last three steps."""
    bodies = model.bodies
    turn, spin, v = bodies.rotation[nodes], bodies.spin[nodes], bodies.velocity[nodes]
    own = np.einsum("nji,nj->ni", turn, spin)
    momentum = np.einsum("nij,nj->ni", turn, bodies.inertia[nodes] * own)
    u = np.concatenate([v, spin], axis=1)
    return v, momentum, u, u, u


def beginning(model: Model, system: System) -> Begun:
    """The part of a System that is present as a run begins: all of it where no sheet comes in later."""
    there = np.array(at_start(model))
    if there.all():
        return Begun(system, np.arange(system.search.first), There())
    return Begun(*parts_of(system, Parts(model, system), np.zeros_like(there), ~there))


def arrays(model: Model, whole: System, begun: Begun | None = None) -> Workspace:
    """Workspace of a run at its start. `begun`: the part of the System that is present then, None: all of
    it."""
    from mdlgen.backends.lattice.kernels import entries

    begun = begun or Begun(whole, np.arange(whole.search.first), There())
    system, there = begun.system, begun.there
    state, mid, matrix = start(model, begun)
    system.pairs["beside"][: system.search.first] = 0
    begin(system.bristles)
    begin_hinges(system.yields.hinges)
    contacts = len(model.contacts)
    kept = Kept(np.zeros((contacts, ROW)), np.zeros(system.marks, bool))
    sheets = len(model.sheets)
    meet = sheets if len(whole.search.regions) or passing(model) else 0
    asleep = Asleep(
        speeds=np.zeros(meet),
        bodies=np.zeros(0, np.int64),
        missed=np.zeros((0, 6)),
        may=np.zeros(1),
        rows=np.zeros(contacts, bool),
    )
    found = islands(model, whole)
    found = found._replace(part=there.rows(found.part))
    work = workspace(model, (system, there), (state, mid, matrix), kept, found, asleep)
    motion = Motion(state.x, state.r, mid.motion.u, mid.motion.w)
    entries.remember(system.bodies, system.pairs, system.tables.shapes, motion)
    return work


def workspace(
    model: Model,
    parts: tuple[System, There],
    step: tuple[State, Midpoint, Matrix],
    kept: Kept,
    islands: Islands,
    asleep: Asleep,
) -> Workspace:
    """Workspace of a run that begins from a state. Searches the pairs of boxes of two sheets in that state.
    `parts`: the part of a System that is solved, and its bodies."""
    from mdlgen.backends.lattice.kernels import entries, forces
    from mdlgen.backends.lattice.kernels.contact import condensed
    from mdlgen.backends.lattice.kernels.integrate import damped, momentum, room

    (system, there), (state, mid, matrix) = parts, step
    entries.look(system.pairs, system.search, state.x)
    film = films(model, system)
    return Workspace(
        tables=system.tables,
        state=state,
        mid=mid,
        matrix=matrix,
        condensed=condensed.empty(system, forces.WIDE),
        free=momentum.empty(system),
        kept=kept,
        bounds=bounds_of(model, there),
        search=system.search,
        damped=damped.empty(system),
        frozen=room.frozen(system, len(film.cells)),
        film=film,
        islands=islands,
        asleep=asleep,
    )


def bounds_of(model: Model, there: There) -> Bounds:
    """Bounds on the places of the present bodies of a Model, in arrays of their own (see limit.Cut)."""
    return Bounds(_own(there.rows(model.pairs.low)), _own(there.rows(model.pairs.high)))


def _own(array: Floats) -> Floats:
    """A copy that compiled code may only read, like the arrays of the Model."""
    shown = array.copy().view()
    shown.flags.writeable = False
    return shown


def control(work: Workspace) -> Control:
    """Counts and settings of a run before its first step."""
    u, ub = work.state.u.copy(), work.state.ub.copy()
    sheets = max(len(work.free.loose), len(work.asleep.speeds))
    history = History(u, ub, u.copy(), np.zeros(3), np.zeros((sheets, GUESSES)))
    energies = np.zeros((groups(work), 4))
    return Control(np.zeros(5), np.zeros(COUNTERS), energies, history, np.zeros(7))


def warm(model: Model, system: System) -> None:
    """Compiles, or loads from the cache, before the clock of the run starts."""
    from mdlgen.backends.lattice.kernels import entries
    from mdlgen.backends.lattice.kernels.integrate import integrate

    begun = beginning(model, system)
    work = arrays(model, system, begun)
    integrate.run(work, 0.0, np.zeros(0), 1.0, control(work))
    Recorder(model, system, work, Whole(begun.there, *begun_places(model))).store(0.0)
    entries.PROGRAM.release()  # frees the arrays of its last calls


def flexible(model: Model) -> bool:
    """True if a sheet has more than one box."""
    return any(sheet.count > 1 for sheet in model.sheets)
