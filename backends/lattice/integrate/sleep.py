"""Sleeping sheets: islands at rest are omitted from a run until something moves them.

A sheet at rest costs as much as one that moves: each step evaluates its bushings, contacts and velocities. So
an island of sheets that touch each other sleeps after a time in which none of its places was faster than the
residual speed of iterations at rest (kernels.integrate.islands: STILL). The rest of the System treats these
sheets as fixed parts (see awake). The contact forces among them, and their energies, are held.

Moving bodies may reach them. Such contacts are evaluated as before, and their forces are impulses that the
sleeping boxes miss. Before these would give a box, alone, that speed, all sleeping sheets that touch its
sheet wake at the velocities that they had, and the step is repeated with them.

The waiting time: a sheet that is slower than V for a time W, about a reversal of its motion, is accelerated
by 2 V/W at most, and moves by V T^2/W in a run of T without sleep. With W = T/20 that is 20 V T. V is the
part STILL of the speed that iterations may leave. So the motion is a tenth of the run's tolerance times the
path of the fastest body. A sheet that woke waits twice as long.

Sheets that have not come yet, or have left, are `gone`: nothing meets them, and their energies are added as
they come and leave (see passing).

Some sheets do not sleep: those with air on them, since a film closes slowly; islands of which a joint holds a
sheet, or of which one touches a part that moves; all sheets of a scene in which sheets stick on other parts,
or loads or gravity change over time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.bristles import moved
from mdlgen.backends.lattice.integrate.awake import Parts
from mdlgen.backends.lattice.integrate.islands import groups
from mdlgen.backends.lattice.integrate.record import Recorder
from mdlgen.backends.lattice.integrate.there import There, parts_of
from mdlgen.backends.lattice.integrate.widen import besides, carried_over, marks_of, places, system_of
from mdlgen.backends.lattice.integrate.work import Begun, starts, workspace
from mdlgen.backends.lattice.kernels.state import (
    ACTS,
    DEPTH_NOW,
    ENDED,
    FASTEST,
    FORCE_NOW,
    STEPS,
    TIME,
    TURNING_NOW,
    Control,
    Workspace,
)
from mdlgen.backends.lattice.kernels.tuning import STILL, STILL_FOR, STILL_STEPS
from mdlgen.backends.lattice.search import many_searched
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.stick import STRETCH
from mdlgen.mechanics.turning import TURNING
from mdlgen.model.passing import at_start, passing
from mdlgen.model.tables import Model
from mdlgen.model.wider import wider, with_margin
from mdlgen.runs.checkpoint import Checkpointer, State

# Widths of the values that are carried over by body, from the nodes: velocity and angular momentum at the end
# of the last step, and velocities in its middle and in those of the two before.
WIDTHS = {"v": 3, "l": 3, "u": 6, "last": 6, "earlier": 6}
# Names in a checkpoint: the margin of the pairs; sheets that sleep or are gone; fields of Asleep.
MARGIN = "margin"
SHEETS, GONE = "sleep.sheets", "sleep.gone"
# Columns of contacts that are reset when a sheet leaves.
NO_MORE = np.array([FORCE_NOW, DEPTH_NOW, ACTS, *range(TURNING_NOW, TURNING_NOW + TURNING)])
OF_STEPS = ("speeds", "missed", "may")


class Sleep:
    """Sleeping sheets of a pass; the System that is awake, with its workspace and control."""

    def __init__(
        self,
        model: Model,
        system: System,
        work: Workspace,
        steering: Control,
        recorder: Recorder,
        sleeps: bool,
        begun: Begun | None = None,
    ):
        """`sleeps`: sheets may sleep; `begun`: the part of the System that is present at the beginning; None:
        all of it."""
        from mdlgen.backends.lattice.kernels.integrate import momentum

        # writes the orders of rules into new records of bodies
        self.ordered: Callable[[np.ndarray], None] = lambda bodies: None
        self.work, self.steering = work, steering
        begun = begun or Begun(system, np.arange(system.search.first), There())
        self.system, self._chosen, self.there = begun
        self.whole = recorder.whole
        self._model, self._whole, self._recorder = model, system, recorder
        self._passes = passing(model)
        sheets, bodies = len(work.asleep.speeds), len(system.bodies)
        self._may = np.zeros(sheets, bool)
        self._air = model.contacts.air_viscosity > 0.0
        sleeps = sleeps and model.run.sleep and not len(system.bristles)
        sleeps = sleeps and not len(system.yields.hinges) and not len(system.changes.laws)
        if sheets and sleeps and not self._air.any():
            loose = work.free.loose if self.system is system else momentum.empty(system).loose
            self._may[: len(loose)] = loose
        self._parts = Parts(model, system)
        self._sheets = np.zeros(sheets, bool)
        self._since, self._counted = np.zeros(sheets), np.zeros(sheets)
        self._wait = np.full(sheets, STILL_FOR * model.run.duration)
        self._touched = np.zeros(len(model.contacts))
        self._store = {name: np.zeros((bodies if sheets else 0, width)) for name, width in WIDTHS.items()}
        self._beside = np.zeros(system.search.first, system.pairs["beside"].dtype)
        self._beside[self._chosen] = self.system.pairs["beside"][: len(self._chosen)]
        self.gone = np.zeros(sheets, bool)
        self._energies = np.zeros((groups(work), 3))
        if self.system is not system:
            self.gone[:] = ~np.array(at_start(model))
            self._keep_starts()
        self._stuck = np.zeros(0, STRETCH)  # with the numbers that boxes have in the whole
        self._part = np.full(bodies, -1)  # of the islands
        self._part[system.nodes] = system.sheets
        self._part[self.there.whole(np.arange(len(self.system.bodies)))] = work.islands.part

    @property
    def asleep(self) -> NDArray[np.bool_]:
        """True for sheets that sleep, (sheets,)."""
        return self._sheets

    def look(self, t: float, tolerance: float) -> None:
        """Finds islands, and puts to sleep those that were still for long enough at the time t [ms];
        `tolerance`: that of a step."""
        if not len(self._sheets):
            return
        asleep, rows = self.work.asleep, self.work.kept.rows
        steps = self.steering.counters[STEPS]
        asleep.may[0] = STILL * tolerance * self.steering.pace[FASTEST]
        lively = asleep.speeds >= asleep.may[0]
        asleep.speeds[:] = 0.0
        self._since[lively], self._counted[lively] = t, steps
        touched = rows[:, TIME] > self._touched
        self._touched[:] = rows[:, TIME]
        touched |= self._air
        islands = self._islands(touched)
        awake = self._may & ~self._sheets
        awake &= (t - self._since < self._wait) | (steps - self._counted < STILL_STEPS)
        one, two = self._parts.sheets
        awake |= ~self._may
        awake[one[touched & (one >= 0) & self._parts.moves]] = True
        still = ~np.isin(islands, islands[awake]) & ~self._sheets & ~self.gone
        if still.any():
            self._turn(self._sheets | still, t)

    def wake(self, body: int, t: float) -> None:
        """Wakes the sheet of a box, and all sleeping sheets of its island."""
        disturbed = self._parts.sheet_of[self.there.body(body)]
        self._wait[disturbed] *= 2.0
        islands = self._islands(self.work.kept.rows[:, ACTS] != 0.0)
        woken = (islands == islands[disturbed]) & self._sheets
        self._since[woken], self._counted[woken] = t, self.steering.counters[STEPS]
        self._turn(self._sheets & ~woken, t)

    def widen(self) -> bool:
        """Chooses pairs with a wider margin, where a body has left its bounds; returns True if that helps.
        Raises UnhalvedError."""
        x, _ = self.whole.places(self.work.state)
        model = wider(self._model, x[: len(self._model.bodies.name)])
        if model is not None:
            self._widen(model)
        return model is not None

    def _widen(self, model: Model) -> None:
        """Continues with the pairs of a Model that has those of this one and more."""
        whole = system_of(model, self._whole)
        at = places(self._whole, whole)
        self._beside[self._chosen] = self.system.pairs["beside"][: len(self._chosen)]
        self._beside = besides(whole, self._beside, at, self._motion())
        marks = marks_of(self.work.kept.marks, self._model, model)
        whole = whole._replace(bristles=moved(self._whole.bristles, whole.bristles))
        whole = whole._replace(yields=self._whole.yields)
        self._model, self._whole, self._parts = model, whole, Parts(model, whole)
        self.system, self._chosen = whole, np.arange(whole.search.first)
        if self._sheets.any() or self.gone.any():
            self.system, self._chosen, _ = parts_of(whole, self._parts, self._sheets, self.gone)
        self.ordered(self.system.bodies)
        self.system.pairs["beside"][: len(self._chosen)] = self._beside[self._chosen]
        self.work = carried_over(model, self.work, self.system, self.there, marks)
        self._recorder.widen(model, whole, self.work.kept)
        self._recorder.follow(self.work, self._energies)

    def _islands(self, touching: NDArray[np.bool_]) -> NDArray[np.int64]:
        """First sheet of the island of each sheet, by contacts that are `touching` (contacts,)."""
        one, two = self._parts.sheets
        both = touching & (one >= 0) & (two >= 0)
        one, two, found = one[both], two[both], np.arange(len(self._sheets))
        while True:
            before, least = found.copy(), np.minimum(found[one], found[two])
            np.minimum.at(found, one, least)
            np.minimum.at(found, two, least)
            if (found == before).all():
                return found

    def _turn(self, sheets: NDArray[np.bool_], t: float) -> None:
        """Lets exactly the `sheets` (sheets,) sleep, from the state at the time t on."""
        from mdlgen.backends.lattice.kernels import forces
        from mdlgen.backends.lattice.kernels.integrate import room

        old, before = self.work, self.there
        nodes = before.whole(self.system.nodes)
        history = self.steering.history
        moves = (old.state.v, old.state.l, old.state.u, history.u, history.earlier)
        for name, array in zip(WIDTHS, moves, strict=True):
            self._store[name][nodes] = array
        self._beside[self._chosen] = self.system.pairs["beside"][: len(self._chosen)]
        stuck = old.mid.sticks.pairs[old.mid.sticks.pairs["count"] > 0]
        stuck["a"], stuck["b"] = before.whole(stuck["a"]), before.whole(stuck["b"])
        self._stuck = np.concatenate([self._stuck, stuck])
        energies = self._ledger(t) + self._energies

        self._sheets = sheets
        self.system, self._chosen, self.there = parts_of(self._whole, self._parts, sheets, self.gone)
        x, r = self.whole.turn(self.there, old.state)
        self.ordered(self.system.bodies)
        self.system.pairs["beside"][: len(self._chosen)] = self._beside[self._chosen]
        state, mid, matrix = room.empty(self.system, forces.WIDE)
        nodes = self.there.whole(self.system.nodes)
        v, l, u, last, earlier = (self._store[name][nodes] for name in WIDTHS)
        state = old.state._replace(x=x, r=r, v=v, l=l, u=u)
        mid.motion.x[:], mid.motion.r[:] = state.x, state.r
        bodies = self._whole.nodes[sheets[self._whole.sheets]]
        # no awake sheet touches sheets that fall asleep now; earlier sleepers keep their missed impulses
        missed = np.zeros((len(self._whole.bodies), 6))
        missed[before.whole(old.asleep.bodies)] = old.asleep.missed
        rows = self._parts.lasting(sheets)
        own = self.there.own(bodies)
        asleep = old.asleep._replace(bodies=own, missed=missed[bodies], rows=rows)
        step, islands = (state, mid, matrix), old.islands._replace(part=self.there.rows(self._part))
        parts = self.system, self.there
        self.work = workspace(self._model, parts, step, old.kept, islands, asleep)
        self._put_back()
        self.steering = self.steering._replace(history=history._replace(u=last, earlier=earlier))
        self.steering.factored[:] = 0.0

        self._energies = energies - self._ledger(t)
        self._recorder.follow(self.work, self._energies)

    def change(self, gone: NDArray[np.bool_], t: float) -> np.ndarray:
        """Removes the sheets `gone` (sheets,) from the time t [ms] on, and adds all others. Returns the
        change of energy: kinetic, elastic and potential, of one side, (groups, 3)."""
        left, came = gone & ~self.gone, self.gone & ~gone
        acts = self.work.kept.rows[:, ACTS] != 0.0
        islands = self._islands(acts)
        woken = np.isin(islands, islands[left]) & self._sheets
        if woken.any():  # sheets that lay on it wake, too
            self._since[woken], self._counted[woken] = t, self.steering.counters[STEPS]
            self._turn(self._sheets & ~woken, t)
        rows, own = self.work.kept.rows, self._parts.of(left)
        rows[own & acts, ENDED] = t
        rows[np.ix_(own, NO_MORE)] = 0.0
        self._since[came], self._counted[came] = t, self.steering.counters[STEPS]
        before, asleep = self._ledger(t), self._energies
        self.gone = gone
        if came.any():
            self._meet(self._parts.of(came))
        self._turn(self._sheets, t)
        self._energies = asleep
        boxes = np.flatnonzero(np.append(gone, False)[self._parts.sheet_of])
        self._stuck = self._stuck[~(np.isin(self._stuck["a"], boxes) | np.isin(self._stuck["b"], boxes))]
        self._recorder.follow(self.work, self._energies)
        return self._ledger(t) - before

    def _keep_starts(self) -> None:
        """Stores the velocities with which sheets come in."""
        for name, array in zip(WIDTHS, starts(self._model, self._whole.nodes), strict=True):
            self._store[name][self._whole.nodes] = array

    def _motion(self) -> Motion:
        """Motion of all bodies."""
        return self.whole.motion(self.work.state, self.work.mid.motion)

    def _meet(self, rows: NDArray[np.bool_]) -> None:
        """Stores the sides of parts on which the boxes of contacts `rows` (contacts,) come in."""
        from mdlgen.backends.lattice.kernels import entries

        some = np.flatnonzero(rows[self._whole.pairs["row"][: self._whole.search.first]])
        pairs, motion = self._whole.pairs[some], self._motion()
        pairs["beside"] = 0
        entries.remember(self._whole.bodies, pairs, self._whole.tables.shapes, motion)
        self._beside[some] = pairs["beside"]

    def _ledger(self, t: float) -> np.ndarray:
        """Kinetic, elastic and potential energy of the awake part, of one side, (groups, 3)."""
        from mdlgen.backends.lattice.kernels.integrate import observe

        energies, rows = np.zeros_like(self._energies), np.zeros_like(self.work.kept.rows)
        observe.ledger(self.work, t, energies, rows)
        return energies

    def _put_back(self) -> None:
        """Restores the stretches of pairs whose friction sticks."""
        first, places = self.system.search.first, self.work.mid.sticks.pairs
        pairs = self.system.pairs[first:]
        count, many = len(self._whole.bodies), many_searched(self.system.search)
        known = self._stuck["a"] * count + self._stuck["b"]
        one, two = (self.there.whole(pairs[end][:many]) for end in "ab")
        keys = one * count + two
        order = np.argsort(known)
        at = np.minimum(np.searchsorted(known[order], keys), max(0, len(known) - 1))
        if not len(known) or not len(places):
            return
        found = known[order][at] == keys
        some = self._stuck[order[at[found]]]
        some["a"], some["b"] = self.there.own(some["a"]), self.there.own(some["b"])
        places[np.flatnonzero(found)] = some
        self._stuck = np.delete(self._stuck, order[at[found]])

    # -- checkpoints

    def carried(self) -> State:
        """Its state for a checkpoint, in addition to the state of the awake part."""
        margin = np.array([self._model.pairs.margin])
        if not len(self._sheets):
            return {MARGIN: margin}
        return {
            MARGIN: margin,
            SHEETS: self._sheets,
            **({GONE: self.gone, **self.whole.carried(self.work.state)} if self._passes else {}),
            "sleep.since": self._since,
            "sleep.counted": self._counted,
            "sleep.wait": self._wait,
            "sleep.touched": self._touched,
            "sleep.beside": self._beside,
            "sleep.energies": self._energies,
            **{f"sleep.{name}": getattr(self.work.asleep, name) for name in OF_STEPS},
            "sleep.stuck": self._stuck,
            **{f"sleep.{name}": array for name, array in self._store.items()},
        }

    def lie_down(self, keep: Checkpointer, number: int) -> bool:
        """Restores the margin of a checkpoint and its sleeping sheets, so that its arrays fit. False where
        the pass was begun again since, with a wider margin."""
        own = self._model.pairs.margin
        kept = keep.load(number, {MARGIN: np.zeros(1)}, (MARGIN,))
        margin = own if kept is None else float(kept[MARGIN][0])
        if margin < own:
            return False
        if margin > own:
            self._widen(with_margin(self._model, margin))
        if not len(self._sheets):
            return True
        like = {SHEETS: self._sheets} | ({GONE: self.gone} if self._passes else {})
        found = keep.load(number, like, tuple(like))
        if found is not None and (found[SHEETS].any() or self._passes):
            self.gone = found.get(GONE, self.gone)
            self._turn(found[SHEETS], 0.0)
        return True

    def restore(self, found: dict[str, Any]) -> None:
        """Restores the state that `carried` returned."""
        if not len(self._sheets):
            return
        self._stuck = found.pop("sleep.stuck")
        for name, array in self.carried().items():
            if name in found:
                array[...] = found[name]
        self._recorder.follow(self.work, self._energies)
