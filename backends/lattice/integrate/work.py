"""Builds the workspace of a run for its start."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.bristles import begin
from mdlgen.backends.lattice.hinges import begin as begin_hinges
from mdlgen.backends.lattice.integrate.awake import Parts, awake
from mdlgen.backends.lattice.integrate.films import films
from mdlgen.backends.lattice.integrate.islands import groups, islands
from mdlgen.backends.lattice.integrate.record import Recorder
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


def start(model: Model, system: System) -> tuple[State, Midpoint, Matrix]:
    """State at the start, and the arrays of a step."""
    from mdlgen.backends.lattice.kernels import forces
    from mdlgen.backends.lattice.kernels.integrate import room

    state, mid, matrix = room.empty(system, forces.WIDE)
    bodies = model.bodies
    count = len(bodies.name)
    state.x[:count], state.r[:count] = bodies.position, bodies.rotation.reshape(-1, 9)
    state.r[count] = np.eye(3).ravel()
    mid.motion.x[:], mid.motion.r[:] = state.x, state.r
    state.v[:], state.l[:], state.u[:], _, _ = starts(model, system.nodes)
    for roller in model.rollers:
        if roller.begins_turning:  # with its shaft
            at = system.bodies["spin"][roller.body]
            if at < 0:
                continue  # left out, see mirror
            state.vb[at] = state.ub[at] = roller.prescribed(0.0)
        if roller.motor and roller.axle is not None:
            at = system.bodies["spin"][roller.body]
            state.s[at] = roller.axle.begins_behind(float(roller.prescribed(0.0)))
    for begun in begun_rates(model):
        at = system.bodies[begun.of][begun.body]
        if at >= 0:  # else it is left out
            state.vb[at] = state.ub[at] = begun.rate
    return state, mid, matrix


def starts(model: Model, nodes: Ints) -> tuple[Floats, ...]:
    """Initial values of boxes, the bodies `nodes` (n,): velocities [mm/ms], angular momenta [N mm ms], (n, 3)
    each; and velocities with angular velocities [rad/ms], (n, 6), for the two steps before."""
    bodies = model.bodies
    turn, spin, v = bodies.rotation[nodes], bodies.spin[nodes], bodies.velocity[nodes]
    own = np.einsum("nji,nj->ni", turn, spin)
    momentum = np.einsum("nij,nj->ni", turn, bodies.inertia[nodes] * own)
    u = np.concatenate([v, spin], axis=1)
    return v, momentum, u, u, u


def beginning(model: Model, system: System) -> tuple[System, Ints]:
    """The part of a System that is present as a run begins, and the numbers of its pairs, without searched
    ones: all of it where no sheet comes in later."""
    there = np.array(at_start(model))
    if there.all():
        return system, np.arange(system.search.first)
    return awake(system, Parts(model, system), np.zeros_like(there), ~there)


def arrays(model: Model, whole: System, there: System | None = None) -> Workspace:
    """Workspace of a run at its start. `there`: the part of the System that is present then, None: all of
    it."""
    from mdlgen.backends.lattice.kernels import entries

    system = whole if there is None else there
    state, mid, matrix = start(model, system)
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
    work = workspace(model, system, (state, mid, matrix), kept, islands(model, whole), asleep)
    motion = Motion(state.x, state.r, mid.motion.u, mid.motion.w)
    entries.remember(system.bodies, system.pairs, system.tables.shapes, motion)
    return work


def workspace(
    model: Model,
    system: System,
    step: tuple[State, Midpoint, Matrix],
    kept: Kept,
    islands: Islands,
    asleep: Asleep,
) -> Workspace:
    """Workspace of a run from a state, for which the pairs of boxes of two sheets are searched."""
    from mdlgen.backends.lattice.kernels import entries, forces
    from mdlgen.backends.lattice.kernels.contact import condensed
    from mdlgen.backends.lattice.kernels.integrate import damped, momentum, room

    state, mid, matrix = step
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
        bounds=bounds_of(model),
        search=system.search,
        damped=damped.empty(system),
        frozen=room.frozen(system, len(film.cells)),
        film=film,
        islands=islands,
        asleep=asleep,
    )


def bounds_of(model: Model) -> Bounds:
    """Bounds on the places of the bodies of a Model, in their own arrays (see limit.Cut)."""
    return Bounds(_own(model.pairs.low), _own(model.pairs.high))


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

    work = arrays(model, system, beginning(model, system)[0])
    integrate.run(work, 0.0, np.zeros(0), 1.0, control(work))
    Recorder(model, system, work).store(0.0)
    entries.PROGRAM.release()  # frees the arrays of its last calls


def flexible(model: Model) -> bool:
    """True if a sheet has more than one box."""
    return any(sheet.count > 1 for sheet in model.sheets)
