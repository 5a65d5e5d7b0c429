"""One pass of a run: all of its time at one step."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from threading import Event
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.integrate.beside import Stopped
from mdlgen.backends.lattice.integrate.ends import (
    CRAWLED,
    LIMITED,
    OVERLAPPED,
    PASSED,
    RUNAWAY,
    TAKEN,
    Ended,
    reason_of,
    unbalanced,
    unheld,
)
from mdlgen.backends.lattice.integrate.limit import Calls, Cut, Deadline
from mdlgen.backends.lattice.integrate.looks import Looks
from mdlgen.backends.lattice.integrate.pass_state import PassState, Stage
from mdlgen.backends.lattice.integrate.passing import Passing
from mdlgen.backends.lattice.integrate.reacting import Reacting
from mdlgen.backends.lattice.integrate.record import Recorder, Snapshot
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.backends.lattice.integrate.slow import Slow
from mdlgen.backends.lattice.integrate.there import Whole
from mdlgen.backends.lattice.integrate.widen import begins_again
from mdlgen.backends.lattice.integrate.work import arrays, beginning, begun_places, control, flexible
from mdlgen.backends.lattice.kernels import entries
from mdlgen.backends.lattice.kernels.integrate import integrate
from mdlgen.backends.lattice.kernels.state import (
    ANEW,
    FACTORS,
    FASTEST,
    GIVEN_UP,
    ITERATIONS,
    SOLVES,
    STEPS,
    TOUCHING,
    WORST,
)
from mdlgen.backends.lattice.kernels.state import MADE as MADE_OF
from mdlgen.backends.lattice.kernels.state import MISS as MISS_OF
from mdlgen.backends.lattice.kernels.tuning import (
    FIRST_STEP,
    LOOSEST,
    MOST_AT_ONCE,
    MOST_STEPS,
    ROUND_OFF,
    ROUND_OFF_RIGID,
)
from mdlgen.errors import SpecError
from mdlgen.model.overlaps.unheld import Unheld
from mdlgen.model.starts import fastest_start
from mdlgen.model.tables import Model
from mdlgen.results.result import Result
from mdlgen.results.stored import finite
from mdlgen.runs.checkpoint import Checkpointer

Progress = Callable[[float, float, int, int], None]
# Names of Result.counts.
COUNTED = {"factors": FACTORS, "solves": SOLVES, "given_up": GIVEN_UP}


class Watch(NamedTuple):
    """Observers of a pass: the callback for its progress; its checkpointer and number; for a parallel pass,
    the event that stops it, and whether it is `hidden`, as one of two is. `sleeps`: sheets at rest may
    sleep."""

    progress: Progress | None = None
    keep: Checkpointer | None = None
    number: int = 0
    stop: Event | None = None
    hidden: bool = False
    sleeps: bool = True
    deadline: Deadline = Deadline()

    def beside(self, stop: Event) -> Watch:
        """The Watch of a pass in parallel with another one, which is the one that reports."""
        return self._replace(progress=None, stop=stop, hidden=True)

    def leave(self) -> None:
        """Reports that a parallel pass has ended, so that a processor is free."""
        if self.keep is not None:
            self.keep.free.set()


UNSEEN = Watch()


class Division(NamedTuple):
    """Division of a run: number of stored times after the start, of steps between two of them, step [ms]."""

    outputs: int
    each: int
    step: float


def division(model: Model, wanted: float) -> Division:
    """Divides a run into steps of at most `wanted` [ms] that end at the outputs. Where `wanted` is longer
    than the time between outputs, some are omitted. Raises SpecError for too many steps."""
    run = model.run
    outputs = max(1, round(run.duration / run.print_step))
    each = max(1, math.ceil(run.duration / outputs / wanted - 1e-9))
    dt = run.duration / outputs / each
    if wanted > run.duration / outputs:  # steps longer than the time between outputs
        each, outputs = 1, max(1, math.ceil(run.duration / wanted - 1e-9))
        dt = run.duration / outputs
    if run.duration / dt > MOST_STEPS:
        raise SpecError(
            f"this run would take {run.duration / dt:.3g} steps of {dt:.3g} ms; allowed are {MOST_STEPS:g}: "
            "give a shorter run.duration, or a larger run.tolerance or run.step",
            ("run",),
        )
    return Division(outputs, each, dt)


def first_step(model: Model) -> float:
    """Step with which a search begins [ms]."""
    run = model.run
    return min(FIRST_STEP * math.sqrt(run.tolerance / 1e-3), run.duration / 20)


def accuracy(model: Model) -> float:
    """Tolerance to which a step is solved. A larger `run.tolerance` is for motions that differ from run to
    run at any accuracy, so the step does not follow it."""
    return min(model.run.tolerance, LOOSEST)


def speed(model: Model) -> float:
    """Initial scale of velocities [mm/ms]: that of drives, initial velocities and spins; at least a hundredth
    of a sheet's length in the run, and a tenth where nothing else is known."""
    drives = [abs(r.speed) * r.radius for r in model.rollers if r.speed is not None]
    starts = [float(np.linalg.norm(s.velocity)) for s in model.sheets]
    own = [max(s.size) / 10 / model.run.duration for s in model.sheets]
    radius = {r.name: r.radius for r in model.rollers}
    orders = [order for rule in model.reactions.rules for order in rule.orders if order.kind == "speed"]
    drives += [abs(order.value) * radius[order.name] for order in orders]
    known = max(*drives, *starts, fastest_start(model), 0.0)
    return max(known, max(own, default=0.0) * (0.1 if known > 0.0 else 1.0))


@begins_again
def one_pass(
    model: Model,
    system: System,
    wanted: float,
    watch: Watch = UNSEEN,
    miss: float = 0.0,
    made: float = 0.0,
    anew: bool = False,
    times: float = math.inf,
) -> Result:
    """One run at a step, or at the next smaller one that divides the time between outputs. `miss`, `made`:
    see MAY_MISS and MAY_MAKE, 0 for any; `anew`: a new factor for each step; `times`: it ends early where
    halvings make more than this multiple of its number of steps. Raises Stopped where `watch` stops it."""
    going = _Pass(model, system, division(model, wanted), watch, times)
    going.steer(miss, made, anew)
    going.take_up()
    going.go()
    return going.result()


class _Pass:
    """State of a pass during its run."""

    def __init__(self, model: Model, system: System, divided: Division, watch: Watch, times: float):
        if model.reactions.rules:  # they rewrite records of bodies, which the next pass needs unchanged
            system = system._replace(bodies=system.bodies.copy())
        self._model, self._system, self._divided, self._watch = model, system, divided, watch
        self._begun = clock.perf_counter()
        self._most = times * divided.outputs * divided.each  # bound on the number of steps
        self._looks = Looks(model.run.duration, divided.outputs, divided.each)
        begun = beginning(model, system)
        work = arrays(model, system, begun)
        steering = control(work)
        self._counters, self._energies, self._pace = steering.counters, steering.energies, steering.pace
        whole = Whole(begun.there, *begun_places(model))
        self._recorder = Recorder(model, system, work, whole, divided.outputs)
        self._overlaps = unheld(model, system)
        self._sleep = Sleep(model, system, work, steering, self._recorder, watch.sleeps, begun)
        self.passing = Passing(model, self._sleep, self._recorder, divided.step, self._overlaps)
        self._recorder.store(0.0)
        # the guess is more accurate at finer steps, so the limit of the iterations must fall as fast
        part = ROUND_OFF if flexible(model) else ROUND_OFF_RIGID
        self._tolerance = part * min(1.0, (divided.step / FIRST_STEP) ** 2) * accuracy(model)
        self._status, self._t, self._past = integrate.DONE, 0.0, 0.0
        self._todo = range(divided.outputs)  # numbers of the outputs that are not reached yet
        self._calls = Calls(MOST_AT_ONCE)
        self._slow = Slow(model, steering, None if watch.hidden else watch.progress)
        self._reacting = None
        if model.reactions:
            self._reacting = Reacting(model, self._sleep, self.passing, speed(model))

    def steer(self, miss: float, made: float, anew: bool) -> None:
        self._pace[[MISS_OF, ANEW, MADE_OF]] = miss, float(anew), made
        self._pace[FASTEST] = speed(self._model)

    def take_up(self) -> None:
        """Resumes this pass from its checkpoint, if there is one."""
        keep, number, sleep = self._watch.keep, self._watch.number, self._sleep
        if keep is None or not sleep.lie_down(keep, number):
            return
        stage = self._state().back(keep, number)
        if stage is None:
            return
        self._status, self._t, self._past = stage.status, stage.t, stage.wall
        search = sleep.system.search
        entries.look(sleep.system.pairs, search, search.place.copy())
        self._todo = range(stage.outputs, 0 if stage.ended else self._divided.outputs)
        self._show()

    def go(self) -> None:
        """Takes all remaining steps, or as many as possible."""
        keep, deadline = self._watch.keep, self._watch.deadline
        if self._reacting is not None and self._t == 0.0 and self._status == integrate.DONE:
            self._status = self._reacting.look(0.0, self._divided.step)
        if self._status != integrate.DONE:
            return
        with Cut(deadline, lambda: self._sleep.work):
            for output in self._todo:
                self._status = self._up_to(output)
                if self._status != integrate.DONE:
                    break
                self._show()
                if keep is not None and keep.due(self._watch.number) and output + 1 < self._divided.outputs:
                    self._keep(keep, output + 1, ended=False)
                if self._watch.progress is not None:
                    steps, touching = int(self._counters[STEPS]), int(self._counters[TOUCHING])
                    self._watch.progress(self._t, self._model.run.duration, steps, touching)
                if self._reacting is not None and self._reacting.machine.ended:
                    self._shorten()
                    break
                if deadline.over and output + 1 < self._divided.outputs:
                    self._status = LIMITED
                    break
        within = (integrate.LEFT, integrate.DEEP, integrate.STRETCHED, LIMITED, CRAWLED)
        if self._todo and self._status in within and self._t > self._recorder.last:
            self._recorder.store(self._t)  # for the energy balance up to this time

    def _up_to(self, output: int) -> int:
        """Takes the steps to the end of an output, and stores it; returns the status."""
        looks, duration = self._looks, self._model.run.duration
        begins, stops = output * self._divided.each, looks.stops(output)
        for goal, before in zip(stops, [begins, *stops], strict=False):
            status, self._t = self._advance(self._t, goal, goal - before, before == begins)
            if status != integrate.DONE:
                return status
            stored = goal == stops[-1]
            if stored:
                self._recorder.store((output + 1) * duration / self._divided.outputs)
            if looks.due(goal):
                self._t = looks.time(goal)
                self._sleep.look(self._t, self._tolerance)
                status = _seen(self._sleep, self._system, self._overlaps, self._t, self.passing.there)
                if status != integrate.DONE:
                    if not stored:
                        self._recorder.store(self._t)
                    return status
        return integrate.DONE

    def _advance(self, t: float, goal: int, steps: int, fresh: bool) -> tuple[int, float]:
        """Takes `steps` steps from t up to step `goal`; `fresh`: the first one follows a stored state."""
        sleep, stop, dt = self._sleep, self._watch.stop, self._divided.step
        left = np.full(steps, dt)
        while left.size:
            if stop is not None and stop.is_set():
                raise Stopped
            if not self.passing.turn(t):
                return TAKEN, t
            began, many, since = t, self._calls.many, clock.perf_counter()
            some = left[:many]
            if self._reacting is not None:
                some = self._reacting.steps(t, some, dt)
            taken, whole = self.passing.cut(t, some)
            whole = whole and some[0] == left[0]
            status, t = integrate.run(sleep.work, t, taken, self._tolerance, sleep.steering)
            took = clock.perf_counter() - since
            self._calls.took(len(taken), took)
            self._slow.tell(t, left[0], took)
            if fresh and t > began:
                self._recorder.between()
                fresh = False
            if self._watch.deadline.over and (status != integrate.DONE or left.size > many):
                return LIMITED, t
            if status == integrate.DONE and self._counters[STEPS] > self._most:
                return CRAWLED, t
            if status == integrate.DONE and not whole:
                t = self.passing.exact(t)
            if status == integrate.DONE and self._reacting is not None:
                status = self._reacting.look(t, dt)
            if status == integrate.DONE:
                left = left[len(taken) :] if whole else self._looks.left(goal, t, dt)
            elif status == integrate.WOKEN:
                sleep.wake(int(self._counters[WORST]), t)
                left = self._looks.left(goal, t, dt)
            elif status == integrate.LEFT and sleep.widen():
                left = self._looks.left(goal, t, dt)
            else:
                return status, t
        return integrate.DONE, t

    def _shorten(self) -> None:
        """Shortens the run to the last stored time, where a rule ended it."""
        self._model = replace(self._model, run=replace(self._model.run, duration=self._recorder.last))
        self._recorder.model = replace(self._recorder.model, run=self._model.run)

    def _show(self) -> None:
        """Offers the partial result; of two parallel passes, only the one that is not hidden."""
        keep = self._watch.keep
        if keep is not None and not self._watch.hidden:
            snapshot, steps = self._recorder.snapshot(self._energies), int(self._counters[STEPS])
            keep.part = partial(_part, self._recorder, snapshot, self._divided.step, steps)

    def _keep(self, keep: Checkpointer, outputs: int, ended: bool) -> None:
        """Stores a checkpoint."""
        at = Stage(self._status, self._t, outputs, self._wall(), ended)
        keep.save(self._watch.number, self._state().arrays(at))

    def _state(self) -> PassState:
        sleep = self._sleep
        return PassState(sleep.work, sleep.steering, self._recorder, sleep, self._reacting)

    def _wall(self) -> float:
        return self._past + clock.perf_counter() - self._begun

    def result(self) -> Result:
        """The Result of the pass, or the reason why it ended early."""
        keep, number, status = self._watch.keep, self._watch.number, self._status
        wall = self._wall()
        if keep is not None and self._todo and (keep.written or keep.due(number)):
            self._keep(keep, self._todo.stop, ended=True)
        dt, sleep, reason = self._divided.step, self._sleep, None
        if status != integrate.DONE:
            state = sleep.work.state
            ended = Ended(sleep.system, sleep.there, state, sleep.whole.places(state), self._counters)
            at = ended, status, self._t, dt, self.passing.there
            if status == RUNAWAY and self._reacting is not None:
                reason = self._reacting.runaway
            elif status == TAKEN:
                reason = self.passing.taken(self._t)
            else:
                reason = reason_of(self._model, *at)
        result = self._recorder.result("lattice", reason, self._energies)
        result.step, result.steps = dt, int(self._counters[STEPS])
        result.rounds, result.wall_s = int(self._counters[ITERATIONS]), wall
        if self._reacting is not None:
            result.reactions = tuple(self._reacting.machine.log)
        result.counts = {name: int(self._counters[column]) for name, column in COUNTED.items()}
        if result.ok and not all(finite(a) for a in (result.position, result.velocity, result.spin)):
            result = result.failed("the state went non-finite")
        wrong = unbalanced(result)
        if wrong is None or status not in (
            integrate.DONE,
            integrate.LEFT,
            integrate.DEEP,
            integrate.STRETCHED,
        ):
            return result
        return result.failed(wrong if result.ok else f"{result.status}; and {wrong}")


def _seen(sleep: Sleep, system: System, overlaps: Unheld, t: float, there: NDArray[np.bool_] | None) -> int:
    """integrate.DONE, or the status of a pass that cannot continue from its state at the time t; `there`
    (sheets,): sheets that are present, None: all."""
    mirror, (x, r) = sleep.system.mirror, sleep.whole.places(sleep.work.state)
    passed = mirror.passed(x, system.nodes) if mirror is not None else -1
    if passed >= 0:
        sleep.steering.counters[WORST] = sleep.there.number(passed)
        return PASSED
    return integrate.DONE if overlaps.found(x, r, t, there) is None else OVERLAPPED


def _part(recorder: Recorder, snapshot: Snapshot, dt: float, steps: int) -> Result:
    """The Result up to a snapshot."""
    result = recorder.result_at(snapshot, "lattice", None)
    result.step, result.steps = dt, steps
    return result
