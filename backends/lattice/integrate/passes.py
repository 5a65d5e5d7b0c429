"""One pass of a run: all of its time at one step."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from functools import partial
from threading import Event
from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.integrate.beside import Stopped
from mdlgen.backends.lattice.integrate.ends import (
    CRAWLED,
    LIMITED,
    OVERLAPPED,
    PASSED,
    reason_of,
    unbalanced,
    unheld,
)
from mdlgen.backends.lattice.integrate.helpers import Helpers
from mdlgen.backends.lattice.integrate.limit import Calls, Cut, Deadline
from mdlgen.backends.lattice.integrate.looks import Looks
from mdlgen.backends.lattice.integrate.pass_state import PassState, Stage
from mdlgen.backends.lattice.integrate.record import Recorder, Snapshot
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.backends.lattice.integrate.slow import Slow
from mdlgen.backends.lattice.integrate.widen import begins_again
from mdlgen.backends.lattice.integrate.work import arrays, control, flexible
from mdlgen.backends.lattice.kernels.state import (
    ANEW,
    FASTEST,
    ITERATIONS,
    STEPS,
    TOUCHING,
    WORST,
)
from mdlgen.backends.lattice.kernels.state import MADE as MADE_OF
from mdlgen.backends.lattice.kernels.state import MISS as MISS_OF
from mdlgen.errors import SpecError
from mdlgen.model.overlaps.unheld import Unheld
from mdlgen.model.tables import Model
from mdlgen.results.result import Result
from mdlgen.runs.checkpoint import Checkpointer

# Longest first step at a tolerance of 1e-3 [ms]; it goes with the root of the tolerance.
FIRST_STEP = 0.2
# Iterations of a step of that size stop at changes of velocity of this part of tolerance times speed: in
# scenes with flexible sheets, whose boxes flutter much faster, and of rigid blocks, whose impacts are sharp.
ROUND_OFF, ROUND_OFF_RIGID = 2.0, 0.02
LOOSEST = 1e-2  # tolerance that a step is solved to, at most
# Steps of one run, and those that compiled code takes before it is asked again.
MOST_STEPS, MOST_AT_ONCE = 1e9, 1000

Progress = Callable[[float, float, int, int], None]


class Watch(NamedTuple):
    """Who follows a pass: what is called as it goes, what keeps it and by which number, and what stops it
    where it goes on at the same time as another one; one of the two is hidden. And how many threads share
    the work of its steps, whether sheets at rest may sleep, and when the time of the run is over."""

    progress: Progress | None = None
    keep: Checkpointer | None = None
    number: int = 0
    stop: Event | None = None
    hidden: bool = False
    threads: int = 1
    sleeps: bool = True
    deadline: Deadline = Deadline()

    def beside(self, stop: Event) -> Watch:
        """Of a pass that goes on beside another one, which is the one that reports."""
        return self._replace(progress=None, stop=stop, hidden=True)

    def leave(self) -> None:
        """Such a pass has ended, and leaves a processor free."""
        if self.keep is not None:
            self.keep.free.set()


UNSEEN = Watch()


class Division(NamedTuple):
    """How a run is divided: stored times after the start, steps between two of them, and the step [ms]."""

    outputs: int
    each: int
    step: float


def division(model: Model, wanted: float) -> Division:
    """Into steps of at most `wanted` [ms] that outputs fall on, or longer ones where outputs are left out.
    Raises SpecError for too many."""
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
    """What a step is solved to: a larger tolerance is for what differs from run to run however exact."""
    return min(model.run.tolerance, LOOSEST)


def speed(model: Model) -> float:
    """What velocities are measured by at first [mm/ms]: drives and initial velocities; a hundredth of a sheet
    in the run, and a tenth where nothing else is known."""
    drives = [abs(r.speed) * r.radius for r in model.rollers if r.speed is not None]
    starts = [float(np.linalg.norm(s.velocity)) for s in model.sheets]
    own = [max(s.size) / 10 / model.run.duration for s in model.sheets]
    known = max(*drives, *starts, 0.0)
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
    """One run at a step, or the next smaller one that outputs fall on; `miss`, `made`: see run.MISS and
    run.MADE, 0 for any; `anew`: a new factor for each step; `times`: it ends early where it takes more than
    so many times its number of steps, since they are divided. Raises Stopped where `watch` says so."""
    from mdlgen.backends.lattice.kernels import entries
    from mdlgen.backends.lattice.kernels.integrate import integrate

    run = model.run
    divided = division(model, wanted)
    outputs, _, dt = divided
    looks = Looks(run.duration, outputs, divided.each)
    progress, keep, number, stop, hidden, threads, sleeps, deadline = watch
    begun = clock.perf_counter()
    work = arrays(model, system)
    steering = control(work)
    counters, energies = steering.counters, steering.energies
    recorder = Recorder(model, system, work, outputs)
    overlaps = unheld(model, system)
    recorder.store(0.0)
    # the guess of a step is the better the finer it is: what is left of it must fall as fast
    part = (ROUND_OFF if flexible(model) else ROUND_OFF_RIGID) * min(1.0, (dt / FIRST_STEP) ** 2)
    tolerance = part * accuracy(model)
    steering.pace[[MISS_OF, ANEW, MADE_OF]] = miss, float(anew), made
    steering.pace[FASTEST] = speed(model)
    status, t, past = integrate.DONE, 0.0, 0.0
    sleep, stage = Sleep(model, system, work, steering, recorder, sleeps), None
    del work  # sleep has what is worked on
    if keep is not None and sleep.lie_down(keep, number):
        stage = PassState(sleep.work, sleep.steering, recorder, sleep).back(keep, number)
    if stage is not None:
        status, t, past = stage.status, stage.t, stage.wall
        search = sleep.system.search
        entries.look(sleep.system.pairs, search, search.place.copy())

    def show() -> None:
        if keep is not None and not hidden:  # the one beside shows a later part, or a finer one
            keep.part = partial(_part, recorder, recorder.snapshot(energies), dt, int(counters[STEPS]))

    calls, slow = Calls(MOST_AT_ONCE), Slow(model, sleep.steering, None if hidden else progress)

    def advance(t: float, goal: int, steps: int, fresh: bool) -> tuple[int, float]:
        """Takes so many steps up to that one; `fresh`: the first one follows a state that was stored."""
        status, left = integrate.DONE, np.full(steps, dt)
        while left.size:
            if stop is not None and stop.is_set():
                raise Stopped
            began, many, since = t, calls.many, clock.perf_counter()
            status, t = integrate.run(sleep.work, t, left[:many], tolerance, sleep.steering)
            took = clock.perf_counter() - since
            calls.took(min(many, left.size), took)
            slow.tell(t, left[0], took)
            if fresh and t > began:
                recorder.between()
                fresh = False
            if deadline.over and (status != integrate.DONE or left.size > many):
                return LIMITED, t
            if status == integrate.DONE and counters[STEPS] > times * outputs * divided.each:
                return CRAWLED, t
            if status == integrate.WOKEN:
                sleep.wake(int(counters[WORST]), t, helpers)
                status, left = integrate.DONE, looks.left(goal, t, dt)
            elif status == integrate.LEFT and sleep.widen(helpers):
                status, left = integrate.DONE, looks.left(goal, t, dt)
            elif status == integrate.DONE:
                left = left[many:]
            else:
                break
        return status, t

    if stage is not None:
        show()
    todo = range(stage.outputs if stage else 0, 0 if stage and stage.ended else outputs)
    with Helpers(sleep.work, threads) as helpers, Cut(deadline, lambda: sleep.work):
        for output in todo:
            begins, stops = output * divided.each, looks.stops(output)
            for goal, before in zip(stops, [begins, *stops], strict=False):
                status, t = advance(t, goal, goal - before, before == begins)
                stored = status == integrate.DONE and goal == stops[-1]
                if stored:
                    recorder.store((output + 1) * run.duration / outputs)
                if status == integrate.DONE and looks.due(goal):
                    t = looks.time(goal)
                    sleep.look(t, tolerance, helpers)
                    status = _seen(sleep, system, overlaps, t)
                    if status != integrate.DONE and not stored:
                        recorder.store(t)
                if status != integrate.DONE:
                    break
            if status != integrate.DONE:
                break
            show()
            if keep is not None and keep.due(number) and output + 1 < outputs:
                wall = past + clock.perf_counter() - begun
                at = Stage(status, t, output + 1, wall, False)
                keep.save(number, PassState(sleep.work, sleep.steering, recorder, sleep).arrays(at))
            if progress is not None:
                progress(t, run.duration, int(counters[STEPS]), int(counters[TOUCHING]))
            if deadline.over and output + 1 < outputs:
                status = LIMITED
                break
    within = (integrate.LEFT, integrate.DEEP, integrate.STRETCHED, LIMITED, CRAWLED)
    if todo and status in within and t > recorder.last:
        recorder.store(t)  # with which its energies balance, or do not
    wall = past + clock.perf_counter() - begun
    if keep is not None and todo and (keep.written or keep.due(number)):
        at = Stage(status, t, todo.stop, wall, True)
        keep.save(number, PassState(sleep.work, sleep.steering, recorder, sleep).arrays(at))
    reason = None
    if status != integrate.DONE:
        reason = reason_of(model, sleep.system, status, t, dt, sleep.work.state, counters)
    result = recorder.result("lattice", reason, energies)
    result.step, result.steps = dt, int(counters[STEPS])
    result.rounds, result.wall_s = int(counters[ITERATIONS]), wall
    if result.ok and not all(np.isfinite(a).all() for a in (result.position, result.velocity, result.spin)):
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


def _seen(sleep: Sleep, system: System, overlaps: Unheld, t: float) -> int:
    """DONE, or why a pass cannot go on from its state at the time t."""
    from mdlgen.backends.lattice.kernels.integrate import integrate

    state, mirror = sleep.work.state, sleep.system.mirror
    passed = mirror.passed(state.x, system.nodes) if mirror is not None else -1
    if passed >= 0:
        sleep.steering.counters[WORST] = passed
        return PASSED
    return integrate.DONE if overlaps.found(state.x, state.r, t) is None else OVERLAPPED


def _part(recorder: Recorder, snapshot: Snapshot, dt: float, steps: int) -> Result:
    """The result up to where a run stood."""
    result = recorder.result_at(snapshot, "lattice", None)
    result.step, result.steps = dt, steps
    return result
