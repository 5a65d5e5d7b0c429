"""Recorder of a run: stored states, contact statistics, the energy balance, the bounds."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.exudyn_local.integrals import Integrals, lags
from mdlgen.backends.exudyn_local.shipped import begin, end_hinges, ledger, overstretched, passed, set_limits
from mdlgen.backends.exudyn_local.state import (
    DRIVING,
    ELASTIC,
    HELD,
    KINETIC,
    LOST,
    POTENTIAL,
    SEEN,
    TOTALS,
    Coordinates,
    workspace,
)
from mdlgen.backends.exudyn_local.system import MM, MS, PER_MM, System
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.pair import before_an_end
from mdlgen.mechanics.point import DEPTH, OUT, PRESSING
from mdlgen.mechanics.turning import ABOUT_A, ABOUT_B, ALONG, LIMIT, TURNING
from mdlgen.model import curves
from mdlgen.model.meshes import carried
from mdlgen.model.overlaps.unheld import Unheld
from mdlgen.model.passing import begun_stays, energy_as_they_come
from mdlgen.model.rotations import euler_parameters, without_jumps
from mdlgen.model.tables import Model
from mdlgen.reactions.machine import SOON
from mdlgen.results import audit
from mdlgen.results.result import ContactStatistics, Energy, Result

if TYPE_CHECKING:
    from mdlgen.backends.exudyn_local.reacting import Reacting

# Two rollers with a sheet between them clear each other by a few micrometres and may graze.
GRAZE = 0.05


Mask = NDArray[np.bool_]


class Recorder:
    """Called after every step of the solver; turns SI into the Model's units when the result is made."""

    def __init__(self, model: Model, system: System, progress: Callable | None, until: float = math.inf):
        self._until = until  # when `run.limit` is over, of time.perf_counter [s]
        self.model, self.system, self.progress = model, system, progress
        # the same arrays at each step, so that their types are checked only once
        self._tables = system.tables
        self._state, self._before = np.zeros((2, 2, max(1, system.free)))  # coordinates and velocities
        self._q, self._v = self._state
        self._last_q, self._last_v = self._before
        self.steps = 0
        self.time = 0.0  # [s]
        self.reason: str | None = None
        self.left: np.ndarray | None = None  # places of all bodies where one has left its bounds [mm]
        self._due = np.zeros(0)  # times at which a state is stored [s]
        self._work = workspace(system)
        self._pairs = np.zeros((len(system.pairs), SEEN))
        self._totals = np.zeros(TOTALS)
        system.pairs["beside"] = 0  # a run before this one may have left its own
        for name in ("plastic", "begun", "lost"):
            system.hinges[name] = 0.0
        self._integrals = Integrals(model, system)
        self._touched = np.zeros(len(system.pairs), bool)
        rows = len(model.contacts)
        self._max_depth, self._max_force = np.zeros(rows), np.zeros(rows)
        self._sum_depth, self._sum_force = np.zeros(rows), np.zeros(rows)
        self._in_contact, self._last = np.zeros(rows), np.zeros(rows)
        self._acting = np.zeros(rows, bool)
        self._force = np.zeros(rows)  # of the state last observed; a failed static run observes none [N]
        names = ("t", "x", "e", "u", "w", "f", "turning", "p", "b")
        self._stored: dict[str, list] = {name: [] for name in names}
        self._first: list[float] | None = None  # energies at the start [J]
        self._lost = self._driven = 0.0
        self._through = self._most = 0.0
        self.gained = self.vanished = 0.0  # how far the balance was off, most above and most below [J]
        self._low, self._high = model.pairs.low * MM, model.pairs.high * MM
        self._last_stored = -1
        self._deepest = np.empty(len(system.pairs))
        self.unheld = Unheld(model)
        self._reacting: Reacting | None = None
        self.parted = self._parts = False
        self.finished = False  # a rule ended the run, at a stored time
        self.stays = begun_stays(model)
        self._gone = np.zeros(0, bool)  # sheets that are not there, and their boxes; none: all are
        self._boxes = np.zeros(0, np.int64)
        self._places = np.append(model.bodies.position * MM, np.zeros((1, 3)), axis=0)  # where those are left
        self._turns = np.append(model.bodies.rotation.reshape(-1, 9), np.zeros((1, 9)), axis=0)
        self._entered = self._went = 0.0  # energy that came in, and left [J]
        # function: true if a part of the run ends before the next step (here never); and true if it did
        self.ahead: Callable[[], bool] = bool
        self.stopped = False

    def rebase(self, system: System, gone: Mask, boxes: Mask, at: Coordinates | None) -> None:
        """From now on the System has no sheets `gone` (sheets,), of the boxes (bodies + 1,). `at`: the state,
        whose energy is added to the balance; None: the run begins."""
        fresh = boxes.copy()
        fresh[self._boxes] = False
        x, r, _, _ = self._work.motion
        if at is not None:  # a sheet that has left keeps its last place
            self._places[fresh], self._turns[fresh] = x[fresh], r[fresh]
        came = np.setdiff1d(self._boxes, np.flatnonzero(boxes))
        system.given_up[:] = self.system.given_up
        self.system, self._tables, self._work = system, system.tables, workspace(system)
        self._gone, self._boxes = gone, np.flatnonzero(boxes)
        self._state, self._before = np.zeros((2, 2, max(1, system.free)))
        self._q, self._v = self._state
        self._last_q, self._last_v = self._before
        self._low, self._high = self.model.pairs.low * MM, self.model.pairs.high * MM
        self._low[self._boxes], self._high[self._boxes] = -np.inf, np.inf
        if at is None:
            return
        self._q[:], self._v[:] = at.q, at.v
        self._before[:] = self._state
        before = self._totals[:3].copy()
        self._pairs[:] = 0.0
        here = Coordinates(self._q, self._v, at.t)
        begin(system.bodies, system.pairs, system.shapes, here, self._work.motion)
        set_limits(system.bodies, system.pairs, self._deepest)
        ledger(self._tables, here, self._work, self._pairs, self._totals)
        gained, own = self._totals[:3] - before, MM * energy_as_they_come(self.model, came)
        self._entered, self._went = self._entered + own, self._went + own - float(gained.sum())
        assert self._first is not None, "the start was observed"
        self._first = [first + more for first, more in zip(self._first, gained.tolist(), strict=True)]

    def wait(self, t: float, count: int, h: float) -> None:
        """Advances the time by a number of steps of h, where no body moves."""
        end = t + count * h
        for time in [*self._due[(self._due > t) & (self._due < end)].tolist(), end]:
            self.steps += 1
            self._observe(time)
            done = len(self._stored["t"]) - 1
            if done < len(self._due) and time >= self._due[done]:
                self._store(time)

    def plan(self, h: float) -> None:
        """Sets the stored times: the print times, at the first step that reaches them, and the end."""
        run = self.model.run
        outputs = max(1, round(run.duration / run.print_step))
        # 1e-6 of a step early, so that rounding never delays an output by a whole step
        self._due = np.arange(1, outputs + 1) * (run.duration / outputs) * MS - 1e-6 * h

    def after_step(self, mbs, t: float) -> bool:
        """Exudyn's post-step function; False ends the run."""
        if t <= self.time:  # Exudyn also calls at the start
            return True
        data, free = mbs.systemData, self.system.free
        self._q[:free] = data.GetODE2Coordinates(copy=False)
        self._v[:free] = data.GetODE2Coordinates_t(copy=False)
        self.steps += 1
        step = t - self.time
        if np.count_nonzero(np.isfinite(self._state)) < self._state.size:
            self.reason = f"the state went non-finite at {t / MS:.6g} ms (step {step / MS:.3g} ms)"
            return False
        self._integrals.hold(self.system, self._q, self._v, t)
        self._observe(t)
        done = len(self._stored["t"]) - 1
        if done < len(self._due) and t >= self._due[done]:
            self._store(t)
        if self.reason is None:
            self._watch(t, step)
        if self.reason is None:
            self._between(t, step)
        if self.reason is None and clock.perf_counter() > self._until:
            limit = 1e-3 * (self.model.run.limit or 0.0)
            self.reason = f"run.limit of {limit:g} s of wall time was over at {t / MS:.6g} ms"
            self._store(t)
        if self.progress is not None and self.steps % 20 == 0:
            self.progress(t / MS, self.model.run.duration, self.steps, self.touching)
        if self._reacting is not None and self.reason is None:
            happened = self._reacting.look(t)
            self.parted = self._parts and (happened or self._reacting.until(t) < t + step * (1.0 - SOON))
            self.finished = self._reacting.machine.ended and self._last_stored == self.steps
        if self.reason is None and self.ahead():
            self.stopped = True
        return self.reason is None and not (self.parted or self.finished or self.stopped)

    def watch(self, reacting: Reacting, parts: bool) -> None:
        """Sets the machine that reacts after each step; `parts`: the solver ends at its events."""
        self._reacting, self._parts, self.parted = reacting, parts, False

    def book(self, times: float, slide: int) -> None:
        """Adds the work of a change of a spring's force: that change [N] times the place of the spring."""
        work = times * float(self._q[slide])
        self._driven += work
        self._through += abs(work)

    def renew(self, t: float) -> None:
        """Recomputes energies and powers at a time at which drives or springs have changed."""
        at = Coordinates(self._q, self._v, t)
        ledger(self._tables, at, self._work, np.zeros_like(self._pairs), self._totals)

    @property
    def motion(self) -> Motion:
        """Motion of all bodies at the end of the last step, in SI units."""
        return self._work.motion

    @property
    def touching(self) -> int:
        """Pairs that touch at the state last observed."""
        return int((self._pairs[:, PRESSING] > 0).sum())

    @property
    def begun(self) -> Coordinates:
        """State at the end of the last step."""
        return Coordinates(self._last_q, self._last_v, self.time)

    def store(self, q: np.ndarray, v: np.ndarray, t: float) -> None:
        """Observe and store one state outside the stepping (the start, or a static result)."""
        self._q[:], self._v[:] = q, v
        self._observe(t)
        self._store(t)
        self._watch(t, 0.0)
        self._before[:] = self._state

    def _observe(self, t: float) -> None:
        before = self._totals.tolist()
        self._pairs[:] = 0.0
        at = Coordinates(self._q, self._v, t)
        if self.system.hinges.size:
            self._lost += end_hinges(self._tables, at, self._work.motion, self._first is None)
        ledger(self._tables, at, self._work, self._pairs, self._totals)
        now = self._totals.tolist()
        step, self.time = t - self.time, t
        self._lost += 0.5 * step * (before[LOST] + now[LOST])
        if self._first is not None:
            self._lost -= now[HELD] - before[HELD]  # the springs of patches have taken that
        self._driven += 0.5 * step * (before[DRIVING] + now[DRIVING])
        self._through += 0.5 * step * (abs(before[DRIVING]) + abs(now[DRIVING]))
        self._most = max(self._most, now[KINETIC] + now[ELASTIC])
        if self._first is None:
            self._first = now[:3]
        off = self._off(now)
        self.gained, self.vanished = max(self.gained, off), min(self.vanished, off)
        self._contacts(step, t)
        set_limits(self.system.bodies, self.system.pairs, self._deepest)  # as pairs stood in the step
        begin(self.system.bodies, self.system.pairs, self.system.shapes, at, self._work.motion)

    def _contacts(self, step: float, t: float) -> None:
        if not self._pairs.size:
            return
        rows = len(self._max_depth)
        if not self._acting.any() and not self._pairs.any():  # a body that flies: nothing of this changes
            self._force = np.zeros(rows)
            return
        row = self.model.pairs.contact
        force = np.asarray(np.bincount(row, weights=self._pairs[:, PRESSING], minlength=rows), dtype=float)
        depth = np.zeros(rows)
        np.maximum.at(depth, row, self._pairs[:, DEPTH])
        # a graze below a twentieth of the greatest force is not counted as the nip still acting
        acting = force > GRAZE * np.maximum(self._max_force, force)
        self._touched |= self._pairs[:, PRESSING] > 0.0
        self._max_depth = np.maximum(self._max_depth, depth)
        self._max_force = np.maximum(self._max_force, force)
        self._sum_depth += step * depth
        self._sum_force += step * force
        self._in_contact += step * (force > 0.0)
        self._last = np.where(self._acting & ~acting, t, self._last)
        self._acting = acting
        self._force = force

    def _store(self, t: float) -> None:
        if self._last_stored == self.steps:
            return
        self._last_stored = self.steps
        x, r, u, w = self._work.motion
        if self._boxes.size:
            x, r = x.copy(), r.copy()
            x[self._boxes], r[self._boxes] = self._places[self._boxes], self._turns[self._boxes]
        carried(self.model, x, r, u, w)
        self._stored["t"].append(t)
        self._stored["x"].append(x[:-1].copy())
        self._stored["e"].append(euler_parameters(r[:-1].reshape(-1, 3, 3)))
        self._stored["u"].append(u[:-1].copy())
        self._stored["w"].append(w[:-1].copy())
        self._stored["f"].append(self._force.copy())
        turning = np.zeros((len(self._force), TURNING))  # [N m, N]
        np.add.at(turning, self.model.pairs.contact, self._pairs[:, OUT:])
        self._stored["turning"].append(turning)
        self._stored["p"].append(self.system.hinges["plastic"].copy())
        self._stored["b"].append(lags(self.model, self.system, self._q, t))
        there = None if self.stays is None else ~self._gone
        self.reason = self.reason or self.unheld.found(x[:-1] / MM, r[:-1], t / MS, there)

    def _watch(self, t: float, step: float) -> None:
        """Sets the reason of a failure where a joint is beyond its curve, a body left its bounds or went deep
        into a plate."""
        x = self._work.motion.x[:-1]
        if self.system.points.size:
            joint, strain = overstretched(self.system.points, self.system.bushings, *self._work.motion[:2])
            if joint >= 0:
                row = int(self.system.bushings["row"][joint])
                time = None if self.model.run.analysis == "static" else t / MS
                self.reason = curves.overstretched(self.model, row, float(strain), time)
        deep = self._pairs[:, DEPTH] > self._deepest
        if np.count_nonzero(deep):
            self._too_deep(int(np.flatnonzero(deep)[0]), t, step)
        beyond = (x < self._low) | (x > self._high)
        if np.count_nonzero(beyond):
            out = np.flatnonzero(beyond.any(axis=1))
            self.left = x / MM
            at = ", ".join(f"{value:.4g}" for value in x[out[0]] * PER_MM)
            name, (bounds, advice) = self.model.called(int(out[0])), self.model.bounds_of(int(out[0]))
            self.reason = f"{name} left {bounds} at {t / MS:.6g} ms (it is at {at} mm); {advice}"

    def _between(self, t: float, step: float) -> None:
        """Sets the reason where a pair has passed since the last step."""
        tables = self.system
        states = (self._last_q, self._last_v, self._q, self._v)
        pair = passed(tables.bodies, tables.pairs, tables.shapes, *states, t - step, step)
        if pair >= 0:
            self._too_deep(pair, t, step)
        self._before[:] = self._state

    def _too_deep(self, pair: int, t: float, step: float) -> None:
        one, two = (int(side[pair]) for side in (self.model.pairs.a, self.model.pairs.b))
        rate = self._work.motion.u
        way = step / MM * float(np.linalg.norm(rate[one] - rate[two]))
        deep = self.model.too_deep(one, two, before_an_end(self.system.pairs[pair]))
        self.reason = f"{deep} at {t / MS:.6g} ms; {self.model.held_by(one, way)}"

    def result(self, solver: str, reason: str | None) -> Result:
        """The Result in mm, N, g, ms."""
        held = self._stored
        count, rows = len(self.model.bodies.name), len(self.model.contacts)
        times = len(held["t"])

        def array(name: str, *shape: int) -> np.ndarray:
            return np.array(held[name], dtype=float).reshape(times, *shape)

        contact_time = np.where(self._in_contact > 0, self._in_contact, 1.0)
        static = self.steps == 0
        turning = array("turning", rows, TURNING)
        return Result(
            model=self.model,
            solver=solver,
            status=reason or "ok",
            time=array("t") / MS,
            position=array("x", count, 3) / MM,
            rotation=without_jumps(array("e", count, 4)),
            velocity=array("u", count, 3) * MS / MM,
            spin=array("w", count, 3) * MS,
            contact_force=array("f", rows),
            contact_torque=turning[..., [ABOUT_A, ABOUT_B]] / MM,
            contact_friction=turning[..., [ALONG, LIMIT]],
            behind=array("b", len(held["b"][0])) if times and len(held["b"][0]) else None,
            plastic=array("p", len(self.system.hinges)) if self.system.hinges.size else None,
            statistics=ContactStatistics(
                max_depth=self._max_depth / MM,
                mean_depth=(self._max_depth if static else self._sum_depth / contact_time) / MM,
                max_force=self._max_force,
                mean_force=self._force if static else self._sum_force / contact_time,
                last_force_at=np.where(self._acting, np.nan, self._last / MS),
            ),
            touched=int(self._touched.sum()),
            energy=self._balance(),
            stays=self.stays,
        )

    def _off(self, energies: list[float]) -> float:
        """Energy error since the start: energy without a source [J]."""
        assert self._first is not None, "something was observed"
        kinetic, elastic, potential = energies[:3]
        first = self._first[KINETIC] + self._first[ELASTIC] + self._first[POTENTIAL]
        return kinetic + elastic + potential - first + self._lost - self._driven

    def _balance(self) -> Energy:
        if self._first is None:
            return Energy()
        to_nmm = 1.0 / MM
        passed = (
            self._lost,
            self._through,
            self._most,
            float(self._totals[POTENTIAL] - self._first[POTENTIAL]),
        )
        lost, through, most, moved = (to_nmm * energy for energy in passed)
        scale = audit.scale(self.model, lost, through, most, moved)
        return Energy(
            kinetic=self._totals[KINETIC] * to_nmm,
            elastic=self._totals[ELASTIC] * to_nmm,
            dissipated=self._lost * to_nmm,
            driven=self._driven * to_nmm,
            balance_error=self._off(self._totals.tolist()) * to_nmm / scale if self.steps else 0.0,
            scale=scale,
            plastic=float(self.system.hinges["lost"].sum()) * to_nmm if self.system.hinges.size else None,
            entered=None if self.stays is None else self._entered * to_nmm,
            left=None if self.stays is None else self._went * to_nmm,
        )
