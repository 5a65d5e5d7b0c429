"""Runs in which sheets come in and leave: consecutive parts, each with the sheets that are present.

A part has bodies of Exudyn for these alone. Boxes of others are far away, where nothing meets them. A part
ends where a sheet comes in, or has left. The time is found as in the lattice's integrate.passing: steps end
where a sheet would be beyond its plane at its present velocity.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.exudyn_local.assemble import Assembly, Begun, assemble
from mdlgen.backends.exudyn_local.reacting import Reacting
from mdlgen.backends.exudyn_local.recorder import Recorder
from mdlgen.backends.exudyn_local.state import Coordinates, workspace
from mdlgen.backends.exudyn_local.system import EULER, MM, MS, System, build
from mdlgen.model.passing import NEAR, far
from mdlgen.model.rotations import euler_parameters
from mdlgen.model.tables import Floats, Ints, Model

# Part of a step: an event nearer than this to the end of a step counts as at that end.
SAME = 1e-6

# Function of a number of steps, their size [s], whether accelerations are known, and the time of the first
# [s]: takes the steps, and returns the reason of a failure.
Go = Callable[[Assembly, int, float, bool, float], str | None]


class _Carried(NamedTuple):
    """Coordinates, their rates and accelerations by what they are of: bodies (bodies, 7), slides and spins
    (bodies, 2), and patches."""

    boxes: Floats  # (3, bodies, 7)
    moves: Floats  # (3, bodies, 2)
    patches: Floats  # (3, coordinates of patches)


def _taken(system: System, states: Floats) -> _Carried:
    """Converts from coordinates in the order of a System, (3, free)."""
    bodies = system.bodies
    boxes, moves = np.zeros((3, len(bodies), 7)), np.zeros((3, len(bodies), 2))
    free = np.flatnonzero(bodies["first"] >= 0)
    boxes[:, free] = states[:, bodies["first"][free, None] + np.arange(7)]
    for k, name in enumerate(("slide", "spin")):
        own = np.flatnonzero(bodies[name] >= 0)
        moves[:, own, k] = states[:, bodies[name][own]]
    return _Carried(boxes, moves, states[:, int(system.stick.first[0]) : system.free])


def _given(system: System, carried: _Carried) -> Floats:
    """Converts to coordinates in the order of a System, (3, free)."""
    bodies, states = system.bodies, np.zeros((3, max(1, system.free)))
    free = np.flatnonzero(bodies["first"] >= 0)
    states[:, bodies["first"][free, None] + np.arange(7)] = carried.boxes[:, free]
    for k, name in enumerate(("slide", "spin")):
        own = np.flatnonzero(bodies[name] >= 0)
        states[:, bodies[name][own]] = carried.moves[:, own, k]
    states[:, int(system.stick.first[0]) : system.free] = carried.patches
    return states


class Parts:
    """A run in parts."""

    def __init__(self, exu: Any, model: Model, recorder: Recorder, go: Go, h: float):
        self._exu, self._model, self._recorder, self._go, self._h = exu, model, recorder, go, h
        self._enters = np.array([sheet.enters for sheet in model.sheets])
        self._gone = self._enters != 0.0
        self._reacting: Reacting | None = None
        self._enters = np.where(np.isnan(self._enters), math.inf, self._enters) * MS
        self._sheet = np.full(len(model.bodies.name), -1)
        for k, sheet in enumerate(model.sheets):
            self._sheet[sheet.first : sheet.first + sheet.count] = k

    def react(self, reacting: Reacting | None) -> None:
        """Sets the machine that reacts in this run; None: there is none."""
        self._reacting = reacting
        if reacting is not None:
            reacting.follow(self.assembly.system, ~self._gone)
            reacting.enter = self._enter

    def _enter(self, sheets: tuple[int, ...], t: float) -> None:
        """Lets the first of these sheets that has no time yet come in at a time [s]."""
        waits = self._coming()
        for sheet in sheets:
            if waits[sheet] and math.isinf(self._enters[sheet]):
                self._enters[sheet] = t
                return

    def begin(self) -> Assembly:
        """The first part."""
        self.assembly = self._begin(None, 0.0)
        return self.assembly

    def run(self) -> str | None:
        """Runs to the end; returns the reason of a failure, or None."""
        end, h = self._model.run.duration * MS, self._h
        t = 0.0
        if self._reacting is not None:
            self._reacting.look(0.0)
        while t < end - SAME * h and self._recorder.reason is None and not self._recorder.finished:
            gone, wrong = self._due(t)
            if wrong is not None:
                return wrong
            if (gone != self._gone).any():
                self._change(gone, t)
            count, step = self._next(t, end)
            went = self._stretch(count, t, step)
            if went is not None:
                return went
            t = self._recorder.time
            late = self._enters[np.abs(self._enters - t) <= SAME * h]
            t = float(late[0]) if late.size else t
        return None

    def _next(self, t: float, end: float) -> tuple[int, float]:
        """Number and size [s] of the next steps: whole ones up to the time at which a sheet comes in; or one
        shorter step up to that time, to where a sheet leaves, or to the next whole one."""
        h, slack = self._h, SAME * self._h
        to = min(end, float(self._enters[self._coming()].min(initial=math.inf)))
        if self._reacting is not None:
            to = min(to, max(self._reacting.until(t), t + slack))
        grid = h * (math.floor(t / h + SAME) + 1.0)
        first = min(grid, to)
        if first - t < h - slack or self._leaves() < h:
            return 1, min(first - t, max(self._leaves(), slack))
        return max(1, math.floor((to - t) / h + SAME)), h

    def _stretch(self, count: int, t: float, h: float) -> str | None:
        """Takes steps, or only advances the time where no body moves."""
        recorder, assembly = self._recorder, self.assembly
        if assembly.system.free == 0:
            recorder.wait(t, count, h)
            if self._reacting is not None:
                self._reacting.look(recorder.time)
            return None
        recorder.ahead = lambda: self._leaves() < self._h
        if self._reacting is not None:
            recorder.watch(self._reacting, count > 1)
        # accelerations are those at the end of the part before
        reason = self._go(assembly, count, h, t > 0.0 or recorder.touching > 0, t)
        data, first = assembly.mbs.systemData, self._exu.ConfigurationType.Initial
        for put, get in (
            (data.SetODE2Coordinates, data.GetODE2Coordinates),
            (data.SetODE2Coordinates_t, data.GetODE2Coordinates_t),
            (data.SetODE2Coordinates_tt, data.GetODE2Coordinates_tt),
        ):
            put(np.array(get()), first)
        if (recorder.stopped or recorder.parted or recorder.finished) and recorder.reason is None:
            reason = None
        recorder.stopped = False
        return recorder.reason or reason

    def _coming(self) -> NDArray[np.bool_]:
        assert self._recorder.stays is not None, "sheets come in or leave"
        return self._gone & np.isnan(self._recorder.stays[:, 0])

    def _leaves(self) -> float:
        """Time until the next sheet would leave at its present velocity [s]."""
        found, (x, r, u, _) = math.inf, self._recorder.motion
        for k in np.flatnonzero(~self._gone).tolist():
            sheet = self._model.sheets[k]
            if not sheet.out:
                continue
            boxes = slice(sheet.first, sheet.first + sheet.count)
            rate = u[boxes].mean(axis=0)
            for (axis, _, side), gap in zip(sheet.out, -far(self._model, sheet, x[:-1] / MM, r), strict=True):
                speed = side * float(rate[axis])
                if speed > 0.0 and gap > self._near(k):
                    found = min(found, MM * float(gap) / speed)
        return found

    def _near(self, k: int) -> float:
        return NEAR * self._model.run.tolerance * max(self._model.sheets[k].size) / 10.0

    def _due(self, t: float) -> tuple[NDArray[np.bool_], str | None]:
        """Sheets that are not present from the time t [s] on, and the reason why one cannot come in, or
        None."""
        gone, (x, r, _, _) = self._gone.copy(), self._recorder.motion
        for k in np.flatnonzero(~self._gone).tolist():
            sheet = self._model.sheets[k]
            gone[k] = bool(sheet.out) and bool(
                (far(self._model, sheet, x[:-1] / MM, r) >= -self._near(k)).any()
            )
        comes = self._coming() & (self._enters <= t + SAME * self._h)
        places = np.where(self._boxes(comes)[:, None], self._model.bodies.position, x[:-1] / MM)
        turns = self._model.bodies.rotation.reshape(-1, 9)
        turns = np.where(self._boxes(comes)[:, None], turns, r[:-1])
        wrong = self._recorder.unheld.taken(comes, ~gone, places, turns, t / MS)
        return gone & ~comes, wrong

    def _boxes(self, sheets: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """True for bodies of some sheets, (bodies,)."""
        return np.append(sheets, False)[self._sheet]

    def _change(self, gone: NDArray[np.bool_], t: float) -> None:
        """Continues without the sheets `gone`, and with all others."""
        assembly = self.assembly
        left, came = gone & ~self._gone, self._gone & ~gone
        data = assembly.mbs.systemData
        free = assembly.system.free
        states = np.zeros((3, max(1, free)))
        if free:
            states[:] = (
                data.GetODE2Coordinates(),
                data.GetODE2Coordinates_t(),
                data.GetODE2Coordinates_tt(),
            )
        carried = _taken(assembly.system, states)
        new = np.flatnonzero(self._boxes(came))
        carried.boxes[1:, new] = self._starts(new)
        self._gone, stays = gone, self._recorder.stays
        assert stays is not None, "sheets come in or leave"
        stays[left, 1], stays[came, 0] = t / MS, self._enters[came] / MS
        self.assembly = self._begin(carried, t, assembly.system.pairs["beside"])

    def _starts(self, boxes: Ints) -> Floats:
        """Rates and accelerations of coordinates of boxes that come in, which fly freely, (2, n, 7)."""
        table = self._model.bodies
        e, w = euler_parameters(table.rotation[boxes]), table.spin[boxes] / MS
        found = np.zeros((2, len(boxes), 7))
        found[0, :, :EULER], found[1, :, :EULER] = (
            table.velocity[boxes] * MM / MS,
            self._model.gravity * MM / MS**2,
        )
        found[0, :, EULER] = -0.5 * (e[:, 1:] * w).sum(axis=1)
        found[0, :, EULER + 1 :] = 0.5 * (e[:, :1] * w + np.cross(w, e[:, 1:]))
        found[1, :, EULER:] = -0.25 * (w * w).sum(axis=1)[:, None] * e
        return found

    def _begin(self, carried: _Carried | None, t: float, beside: Floats | None = None) -> Assembly:
        system, pattern = build(self._model, self._gone)
        system.stick.lag[0] = self._h
        work = workspace(system)
        if beside is not None:
            system.pairs["beside"] = np.where(self._gone[self._sheet_of_pairs(system)], 0, beside)
        states = None if carried is None else _given(system, carried)
        begun = None if states is None else Begun(*states)
        at = None if states is None else Coordinates(states[0], states[1], t)
        if self._reacting is not None:
            self._reacting.follow(system, ~self._gone)
        self._recorder.rebase(system, self._gone, np.append(self._boxes(self._gone), False), at)
        made = assemble(self._exu, self._model, system, pattern, work, self._recorder, begun)
        made.mbs.SetPostStepUserFunction(self._recorder.after_step)
        return made

    def _sheet_of_pairs(self, system: System) -> NDArray[np.int_]:
        return np.maximum(self._sheet[system.pairs["a"]], 0)
