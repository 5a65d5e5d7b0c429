"""Runs a Model: fixed steps, halved where they do not converge, and the whole again at half the step until
the difference is within the tolerance."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from queue import SimpleQueue
from threading import Event, Thread

import numpy as np

from mdlgen.backends.lattice.arrays import System, build
from mdlgen.backends.lattice.integrate.beside import Beside, Stopped, own
from mdlgen.backends.lattice.integrate.ends import unbalanced
from mdlgen.backends.lattice.integrate.passes import FIRST_STEP, Progress, Watch, accuracy, division, one_pass
from mdlgen.backends.lattice.integrate.work import arrays, flexible, warm
from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.backends.lattice.scope import check
from mdlgen.backends.lattice.statics.rest import rest
from mdlgen.backends.lattice.symmetry.find import find
from mdlgen.backends.lattice.symmetry.mirror import halve
from mdlgen.model.tables import Model
from mdlgen.processors import processors
from mdlgen.results import audit
from mdlgen.results.estimates import estimated, open_yet, unlike
from mdlgen.results.result import Result
from mdlgen.runs.checkpoint import Checkpointer

# How often the step may be halved to meet the tolerance, from the first step on; blocks take little time.
MOST_REFINED, MOST_REFINED_RIGID = 5, 8
# Where the step of rigid blocks is chosen, velocities may miss their guess by this part of the speed at a
# tolerance of 1e-3; else the step is halved. Sheets flutter, and miss it always.
MISS = 1e-3
# Energy that contacts may make or lose in one step by its length alone, as a part of what passes through the
# run, at a tolerance of 1e-3; else the step is halved.
MADE = 5e-5
# What a scene without contacts may gain, as a part of the tolerance; its step is halved until it does not.
FREE_GAIN = 1e-3

# Two runs that end early end at the same time where it differs by less than this part of the duration.
SAME_END = 0.01

# A first pass that takes less than this [s] has a third begun where it is needed alone.
SHORT = 0.25

Report = tuple[float, float, int, int]  # what progress is called with

# Of a run at a step that is given, where one at twice that step is none, or quite another one.
UNKNOWN = "the error is not known: a run at twice the step"

# Numbers by which states of passes are kept: first those of the first step, halved so many times, or of the
# step that is given, doubled so many times; then of twice the first step; of a check at a step of its own.
DOUBLED, CHECK = MOST_REFINED_RIGID + 1, MOST_REFINED_RIGID + 2

# States, stored times by bodies, of a run that is only compared with another one: those of a pile of a
# hundred sheets would take as much memory as half of what its steps work on.
COMPARED = 1_000_000

# Rules that leave out what a run does not need, each of which a run can do without.
FOLDING, FACTORS, SYMMETRY, SLEEP = "folding", "factors", "symmetry", "sleep"


def _watch(
    progress: Progress | None, keep: Checkpointer | None, threads: int, sleeps: bool, number: int
) -> Watch:
    """Of the pass of that number."""
    if keep is not None:
        keep.begin(number)
    return Watch(progress, keep, number, threads=threads, sleeps=sleeps)


@PROGRAM.releases
def solve(
    model: Model,
    progress: Progress | None = None,
    step: float | None = None,
    without: tuple[str, ...] = (),
    keep: Checkpointer | None = None,
    threads: int | None = None,
) -> Result:
    """Run a Model; `progress(time, end, steps, touching)` is called as it goes (times in ms).

    `step` [ms], or the Model's own, is taken as it is, and estimates come of a run at twice the step.
    Without either the step follows from the tolerance: the run is repeated at half the step until what it
    judges is estimated to be within it (see `results.estimates`). A failed run returns a Result with its
    reason; RefusedError is raised for what the solver cannot represent.

    `without` names rules that are not to be used: FOLDING of equal bushings, keeping of FACTORS over steps,
    SYMMETRY of both sides, SLEEP of sheets at rest. `keep` is given states to go on from, and a run goes on
    from those that it has, to the same bits. `threads` is how many there may be at the same time, to the same
    bits as well: each pass has those that the Model asks for, and two passes go on at the same time where
    there are enough for both; progress is that of the finer one. Left out: those of one pass.
    """
    check(model)
    started = clock.perf_counter()
    system = build(model, fold=FOLDING not in without)
    compiled = clock.perf_counter()
    if model.run.analysis == "static":
        result = rest(model, system, arrays(model, system))
        # what a run at rest calls is compiled, or loaded, as it goes: all but its wall time
        result.build_s = compiled - started
        result.compile_s = clock.perf_counter() - compiled - result.wall_s
        return result
    warm(model, system)
    compile_s = clock.perf_counter() - compiled
    mirror = None if SYMMETRY in without else find(model, system)
    if mirror is not None:
        system = halve(system, mirror)
    build_s = clock.perf_counter() - started - compile_s
    wanted = step or model.run.step
    begun = clock.perf_counter()
    allowed = processors() if threads is None else threads
    each = min(model.run.threads, allowed) if PROGRAM.loaded else 1
    watch = partial(_watch, progress, keep, each, SLEEP not in without)
    # numba's code keeps the lock of Python
    together = threads is not None and threads >= 2 * each and threads > 1 and PROGRAM.loaded
    if keep is not None and not (together and threads == 2 * each):
        keep.free.set()
    if wanted is None:
        result = Search(model, system, watch).result(together)
    else:
        compared = step is None and model.run.duration / wanted >= 4
        anew = FACTORS in without
        number = 0 if step is None else CHECK
        result = _given(model, system, wanted, watch, number, anew, compared, together)
    result.estimate_s = clock.perf_counter() - begun - result.wall_s
    result.build_s, result.compile_s = build_s, compile_s
    return result


def _given(
    model: Model,
    system: System,
    wanted: float,
    watch: Callable[[int], Watch],
    number: int,
    anew: bool,
    compared: bool,
    together: bool,
) -> Result:
    """A run of that number at a step that is given, `compared` with one at twice that step."""
    made = MADE * accuracy(model) / 1e-3
    h = division(model, wanted).step
    thinned = _thinned(model)

    def again(times: int, on: System, seen: Watch) -> Result:
        return alone(one_pass(thinned, on, times * h, seen, made=times * times * made))

    def alone(result: Result) -> Result:
        if not together:
            PROGRAM.release()  # else the arrays of this pass stay beside those of what follows
        return result

    def first() -> Result:
        return alone(one_pass(model, system, wanted, watch(number), made=made, anew=anew))

    if not compared:
        return first()
    if not together:
        result = first()
        return _compared(result, [], lambda n: again(n, system, watch(n // 2))) if result.ok else result
    seen, beside = watch(1), own(system)
    with Beside(lambda stop: again(2, beside, seen.beside(stop)), seen.leave) as coarse:
        result = first()
        if not result.ok:
            return result
        return _compared(result, [], lambda n: coarse.result() if n == 2 else again(n, system, watch(2)))


def _thinned(model: Model) -> Model:
    """The Model with so many stored times that COMPARED states are enough, each of which it has anyway."""
    outputs = max(1, round(model.run.duration / model.run.print_step))
    least = math.ceil(outputs * len(model.bodies.name) / COMPARED)
    each = next(k for k in range(least, outputs + 1) if outputs % k == 0) if least <= outputs else 1
    if each == 1 or each > 4 * least:
        return model
    return replace(model, run=replace(model.run, print_step=each * model.run.print_step))


def _compared(result: Result, before: list[Result], again: Callable[[int], Result]) -> Result:
    """The result with its estimate, from the runs `before` at twice its step, four times its step, ...

    `again(times)` runs at so many times its step: at twice where there is none, and once more coarsely where
    two leave open whether the tolerance is met, or differ by a large part, since three show how errors fall.
    Where there is none, and that at twice its step fails or differs by a large part that does not fall,
    nothing shows how far off the result is, which it says.
    """
    found = [run for run in before if _ended(run)]
    for run in found:
        run.coarser = ()
    found = found if before else [again(2)]
    if not before and not found[0].ok:
        why = found[0].status.partition(f"; {audit.ADVICE}")[0]
        return replace(estimated(result, []), error_unknown=f"{UNKNOWN} fails: {why}")
    if not found or not _ended(found[0]):
        return estimated(result, [])
    result = estimated(result, found[:2])
    what = None if before or result.error_estimate is not None else unlike(result, found[0])
    if (open_yet(result) or what) and result.model.run.duration / result.step >= 16:
        third = again(4)
        result = estimated(result, [found[0], third]) if _ended(third) else result
    if what and result.error_estimate is None:
        return replace(result, error_unknown=f"{UNKNOWN} differs from it in {what}")
    return result


def _ended(run: Result) -> bool:
    """Whether a run came to its end; one whose energies do not balance still shows how errors fall."""
    finite = all(np.isfinite(a).all() for a in (run.position, run.velocity, run.spin))
    return finite and bool(run.time[-1] >= run.model.run.duration * (1.0 - 1e-9))


class Search:
    """Halves the step until estimates are within the tolerance; fails where they never are.

    A run that ends early has its reason from the physics of the scene or from its step: it is reported where
    the next finer run ends at the same time, and its energies balance.
    """

    def __init__(self, model: Model, system: System, watch: Callable[[int], Watch]):
        self._model, self._system, self._watch = model, system, watch
        self._flexible = flexible(model)
        self._runs: list[Result] = []  # the last one first

    def result(self, together: bool) -> Result:
        """The last run; `together`: two passes at the same time, where both are needed or likely to be."""
        ready: list[Result] = []
        if not together:
            self._runs.append(self._once(first_step(self._model), 0, self._watch(0)))
        elif self._flexible:
            finer = self._three()
            if finer is None:
                return self._runs[0]
            ready.append(finer)
        else:
            ready.append(self._two())
        for k in range(len(self._runs), 1 + (MOST_REFINED if self._flexible else MOST_REFINED_RIGID)):
            if (
                together and not ready
            ):  # what estimates need of the runs before, while compiled code is at work
                Thread(target=_strains, args=(self._runs[:2],), daemon=True).start()
            run = ready.pop() if ready else self._once(0.5 * self._runs[0].step, k, self._watch(k))
            if self._ends(run, k, self._watch(DOUBLED)):
                return self._runs[0]
        return self._failed()

    def _once(self, h: float, halved: int, seen: Watch, on: System | None = None) -> Result:
        fine = accuracy(self._model) / 1e-3 * 0.25**halved
        miss = 0.0 if self._flexible else MISS * fine
        return one_pass(self._model, self._system if on is None else on, h, seen, miss, MADE * fine)

    def _ends(self, run: Result, k: int, seen: Watch, on: System | None = None) -> bool:
        """Whether the search ends with the run at the first step halved `k` times, which becomes the last
        one."""
        before, model = self._runs[:2], self._model
        enough = False
        if run.ok and before[0].ok:
            h = run.step
            run = _compared(run, before, lambda n: self._once(n * h, k - n // 2, seen, on))
            near = run.error_estimate is not None and run.error_estimate <= model.run.tolerance
            free = not len(model.pairs)
            enough = near and not (free and run.energy.balance_error > FREE_GAIN * model.run.tolerance)
        same = abs(run.time[-1] - before[0].time[-1]) <= SAME_END * model.run.duration
        self._runs.insert(0, run)
        return enough or (not _ended(run) and same and unbalanced(run) is None)

    def _two(self) -> Result:
        """The second pass beside the first one: rigid blocks seldom need a third."""
        h = first_step(self._model)
        seen, beside = self._watch(0), own(self._system)
        with Beside(lambda stop: self._once(h, 0, seen.beside(stop), beside), seen.leave) as coarse:
            second = self._once(0.5 * division(self._model, h).step, 1, self._watch(1))
            self._runs.append(coarse.result())
            return second

    def _three(self) -> Result | None:
        """The first pass beside the second one; the third, where it is needed, else None. It is begun beside
        the second where the first took long, and progress is that of the third then."""
        model, h = self._model, first_step(self._model)
        coarse, second, third, doubled = (self._watch(number) for number in (0, 1, 2, DOUBLED))
        beside, first, reports = own(self._system), Event(), SimpleQueue[Report | None]()
        finer = division(model, 0.5 * division(model, h).step).step

        def others(stop: Event) -> Result | None:
            try:
                self._runs.append(self._once(h, 0, coarse.beside(stop), beside))
            finally:
                first.set()
            if self._runs[0].wall_s < SHORT:
                return None  # what comes after the run has more use for this processor
            followed = third.beside(stop)._replace(progress=lambda *report: reports.put(report))
            return self._once(0.5 * finer, 2, followed, beside)

        def report(*_: float) -> None:
            for _waiting in range(reports.qsize()):
                found = reports.get()
                if found is None:
                    reports.put(None)  # it has ended, which is waited for
                elif third.progress is not None:
                    third.progress(*found)

        def ended() -> None:
            coarse.leave()
            reports.put(None)

        with Beside(others, ended) as side:
            run = self._once(finer, 1, second._replace(progress=report))
            first.wait()
            if not self._runs:
                side.raises(Stopped)
            ends = self._ends(run, 1, doubled._replace(progress=None))
            if not ends:
                coarse.leave()  # this processor has no more to do
                _strains(self._runs)
                for found in iter(reports.get, None):
                    if third.progress is not None:
                        third.progress(*found)
                return side.result() or self._once(0.5 * finer, 2, third)
        side.raises(Stopped)
        return None

    def _failed(self) -> Result:
        result = self._runs[0]
        if not result.ok:
            return result
        why = f"{result.error_estimate_of} does not come closer as steps are halved"
        if not result.coarser:
            why = "a run at twice the step failed"
        elif result.error_estimate is not None:
            why = f"the estimate of {result.error_estimate_of} is {result.error_estimate:.3g}"
        return result.failed(
            f"the tolerance of {self._model.run.tolerance:.3g} was not reached at a step of "
            f"{result.step:.3g} ms: {why}; a larger run.tolerance or a run.step of your own ends the search"
        )


def _strains(runs: list[Result]) -> None:
    """Works out what estimates need of runs, which keep it."""
    for run in runs:
        _ = run.strains


def first_step(model: Model) -> float:
    """Step to begin with [ms]."""
    run = model.run
    return min(FIRST_STEP * math.sqrt(run.tolerance / 1e-3), run.duration / 20)
