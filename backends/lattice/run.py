"""Runs a Model with fixed steps, halved where they do not converge. Repeats the run at half the step until
the difference is within the tolerance."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from dataclasses import replace
from queue import SimpleQueue
from threading import Event, Thread

from mdlgen.backends.lattice import watches
from mdlgen.backends.lattice.arrays import System, build
from mdlgen.backends.lattice.compared import (
    UNKNOWN,
    compared_with_coarser,
    compared_with_finer,
    ended,
    in_time,
    thinned,
)
from mdlgen.backends.lattice.integrate.beside import Beside, Stopped, own
from mdlgen.backends.lattice.integrate.ends import cut, limit_of, off_balance, unbalanced
from mdlgen.backends.lattice.integrate.limit import Deadline
from mdlgen.backends.lattice.integrate.passes import Progress, Watch, accuracy, division, first_step, one_pass
from mdlgen.backends.lattice.integrate.work import arrays, flexible, warm
from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.backends.lattice.kernels.tuning import (
    ASKED,
    FEWEST_COMPARED,
    MAY_MAKE,
    MAY_MISS,
    MOST_REFINED,
    MOST_REFINED_RIGID,
    PATIENCE,
    SAME_END,
    SHORT,
    TWICE,
)
from mdlgen.backends.lattice.scope import check
from mdlgen.backends.lattice.statics.rest import rest
from mdlgen.backends.lattice.symmetry.find import find
from mdlgen.backends.lattice.symmetry.mirror import halve
from mdlgen.backends.lattice.watches import Watches
from mdlgen.model.tables import Model
from mdlgen.model.wider import wider
from mdlgen.results import audit, chaos
from mdlgen.results.estimates import NOT_KNOWN, SAME_STEPS, estimated, marked, within
from mdlgen.results.result import OK, Result
from mdlgen.runs.checkpoint import Checkpointer

Report = tuple[float, float, int, int]  # arguments of progress


# Rules that save work; each can be disabled for a run.
FOLDING, FACTORS, SYMMETRY, SLEEP = "folding", "factors", "symmetry", "sleep"


@PROGRAM.releases
def solve(
    model: Model,
    progress: Progress | None = None,
    step: float | None = None,
    without: tuple[str, ...] = (),
    keep: Checkpointer | None = None,
    threads: int = 1,
) -> Result:
    """Run a Model; `progress(time, end, steps, touching)` is called during the run (times in ms).

    The Model's own step is used as it is, and the error is estimated by a run at twice the step. With the
    argument `step` [ms] nothing is compared. Without either the step follows from the tolerance: the run is
    repeated at half the step until the estimated errors are within it (see `results.estimates`). Where they
    never are, the finest complete run is the result, marked as inaccurate. A failed run returns a Result with
    its reason; RefusedError is raised for features that the solver cannot represent.

    `without` names rules that are disabled: FOLDING of equal bushings, reuse of FACTORS over steps, SYMMETRY
    of both sides, SLEEP of sheets at rest. `keep` stores states; a run resumes from those that it has,
    bitwise identical. `threads` is the number of passes that may run in parallel, also bitwise identical:
    with two, progress is that of the finer pass.
    """
    check(model)
    started = clock.perf_counter()
    system = build(model, fold=FOLDING not in without)
    compiled = clock.perf_counter()
    if model.run.analysis == "static":
        result = rest(model, system, arrays(model, system))
        while (wide := wider(model, result.position[-1])) is not None and wide is not model:
            model, system = wide, build(wide, fold=FOLDING not in without)
            result = rest(model, system, arrays(model, system))
        # a static run compiles or loads its functions on demand: that time is all except its wall time
        result.build_s = compiled - started
        result.compile_s = clock.perf_counter() - compiled - result.wall_s
        return result
    warm(model, system)
    compile_s = clock.perf_counter() - compiled
    mirror = None if SYMMETRY in without or model.reactions else find(model, system)
    if mirror is not None:
        system = halve(system, mirror)
    build_s = clock.perf_counter() - started - compile_s
    wanted = step or model.run.step
    begun = clock.perf_counter()
    deadline = Deadline.of(model)
    watch = Watches(progress, keep, SLEEP not in without).until(deadline)
    # numba's code holds Python's global lock
    together = threads > 1 and PROGRAM.loaded
    if keep is not None and not (together and threads == 2):
        keep.free.set()
    if wanted is None:
        result = Search(model, system, watch).result(together)
    else:
        anew = FACTORS in without
        number = 0 if step is None else watches.CHECK
        result = _given(model, system, wanted, watch, number, anew, step is None, together)
    result.estimate_s = clock.perf_counter() - begun - result.wall_s
    result.build_s, result.compile_s = build_s, compile_s
    return result


def _given(
    model: Model,
    system: System,
    wanted: float,
    watch: Watches,
    number: int,
    anew: bool,
    compared: bool,
    together: bool,
) -> Result:
    """A run at a given step, stored by its `number`; `compared` with one at twice that step. The other run
    has half the step where twice the step would be too few steps, or is rounded to the same step."""
    made = MAY_MAKE * accuracy(model) / 1e-3
    h = division(model, wanted).step
    fewer, begun = thinned(model), clock.perf_counter()

    def again(times: float, on: System, seen: Watch) -> Result:
        return alone(one_pass(fewer, on, times * h, seen, made=times * times * made))

    def alone(result: Result) -> Result:
        if not together:
            PROGRAM.release()  # frees the arrays of this pass before the next one allocates its own
        return result

    def first() -> Result:
        return alone(one_pass(model, system, wanted, watch(number), made=made, anew=anew))

    def judged(result: Result, coarse: Callable[[], Result]) -> Result:
        """The result with its estimate from a run at twice the step, or from a finer one."""
        if not result.ok:
            return result
        late, took = watch.deadline, clock.perf_counter() - begun
        if few or not late.allows(0.5 * took):
            result = estimated(result, [])
        else:
            result = compared_with_coarser(
                result, [], lambda n: coarse() if n == 2 else again(n, system, watch(n // 2))
            )
        if (few or result.error_unknown.endswith(SAME_STEPS)) and late.allows(2.0 * took):
            finer = 0.5 * model.run.duration / result.steps
            result = compared_with_finer(result, again(finer / h, system, watch(watches.FINER)))
        return marked(in_time(result, late))

    few = model.run.duration / wanted < FEWEST_COMPARED
    if not compared:
        return first()
    if not together or few:
        return judged(first(), lambda: again(2, system, watch(1)))
    seen, beside = watch(1), own(system)
    with Beside(lambda stop: again(2, beside, seen.beside(stop)), seen.leave) as coarse:
        return judged(first(), coarse.result)


class Search:
    """Halves the step until estimates are within the tolerance.

    Where they never are, the finest complete run is the result, with its estimate. The reason for which a run
    ends early may be the physics of the scene or the step. It is reported where the next finer run ends at
    the same time and its energies balance.
    """

    def __init__(self, model: Model, system: System, watch: Watches):
        self._model, self._system, self._watch = model, system, watch
        self._flexible = flexible(model)
        self._runs: list[Result] = []  # the last one first
        self._late = watch.deadline
        self._limited = model.run.limit is not None
        self._stopped = False  # true where a finer pass would take too long

    def result(self, together: bool) -> Result:
        """The last run; `together`: runs two passes in parallel, where both are needed or likely to be."""
        ready: list[Result] = []
        if not together:
            self._runs.append(self._once(first_step(self._model), 0, self._watch(0)))
        elif self._flexible:
            done, ready = self._three()
            if done:
                return self._done()
        else:
            ready.append(self._two())
        for k in range(len(self._runs), 1 + (MOST_REFINED if self._flexible else MOST_REFINED_RIGID)):
            if not ready and self._stops():
                self._stopped = True
                break
            if together and not ready:
                # strains of earlier runs, for the estimates, while compiled code runs
                Thread(target=_strains, args=(self._runs[:2],), daemon=True).start()
            run = ready.pop() if ready else self._once(0.5 * self._runs[0].step, k, self._watch(k))
            if self._ends(run, k) or (k == ASKED and self._parts(k)):
                return self._done()
        return self._best()

    def _once(
        self, h: float, halved: int, seen: Watch, on: System | None = None, of: Model | None = None
    ) -> Result:
        fine = accuracy(self._model) / 1e-3 * 0.25**halved
        miss = 0.0 if self._flexible else MAY_MISS * fine
        # bound on the steps relative to the first pass: that of the finest one; not needed with a time limit
        most = math.inf if self._limited else 2.0 ** (MOST_REFINED if self._flexible else MOST_REFINED_RIGID)
        on = self._system if on is None else on
        if not self._limited and any(run.ok for run in self._runs):
            # there is a result: a pass that is slower than was foreseen ends in time, too
            left = PATIENCE - sum(run.wall_s for run in self._runs)
            seen = seen._replace(deadline=Deadline(clock.perf_counter() + max(left, 0.0)))
        return one_pass(of or self._model, on, h, seen, miss, MAY_MAKE * fine, times=most)

    def _ends(self, run: Result, k: int, shown: bool = True) -> bool:
        """True if the search ends with the run at the first step halved `k` times, which becomes the last
        one. `shown`: a coarser run, where one is made, reports its progress, too."""
        before, model = self._runs[:2], self._model
        if run.ok and before[0].ok:
            h = run.step
            run = compared_with_coarser(run, before, lambda n: self._coarser(n, h, k, shown))
        same = abs(run.time[-1] - before[0].time[-1]) <= SAME_END * model.run.duration
        self._runs.insert(0, run)
        if run.ok and before[0].ok:
            # the energy error of nips is in their law: a finer step has the same
            return within(run)
        return not ended(run) and same and not cut(run) and unbalanced(run) is None

    def _two(self) -> Result:
        """Runs the second pass in parallel with the first one: rigid blocks seldom need a third."""
        h = first_step(self._model)
        seen, beside = self._watch(0), own(self._system)
        with Beside(lambda stop: self._once(h, 0, seen.beside(stop), beside), seen.leave) as coarse:
            second = self._once(0.5 * division(self._model, h).step, 1, self._watch(1))
            self._runs.append(coarse.result())
            return second

    def _three(self) -> tuple[bool, list[Result]]:
        """Runs the first pass in parallel with the second one; if the first took long, then the third, too.
        Returns True if the search ends with the second pass, and the third pass if it was begun. Progress is
        then that of the third."""
        model, h = self._model, first_step(self._model)
        coarse, second, third = (self._watch(number) for number in (0, 1, 2))
        beside, first, reports = own(self._system), Event(), SimpleQueue[Report | None]()
        finer = division(model, 0.5 * division(model, h).step).step

        def others(stop: Event) -> Result | None:
            try:
                self._runs.append(self._once(h, 0, coarse.beside(stop), beside))
            finally:
                first.set()
            took = self._runs[0].wall_s
            if took < SHORT or not self._allows((TWICE + TWICE * TWICE) * took):
                return None  # the work after the run needs this processor more
            followed = third.beside(stop)._replace(progress=lambda *report: reports.put(report))
            return self._once(0.5 * finer, 2, followed, beside)

        def report(*_: float) -> None:
            for _waiting in range(reports.qsize()):
                found = reports.get()
                if found is None:
                    reports.put(None)  # the end marker, for which the other loop waits
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
            ends = self._ends(run, 1, shown=False)
            if not ends:
                coarse.leave()  # this processor is free
                _strains(self._runs)
                for found in iter(reports.get, None):
                    if third.progress is not None:
                        third.progress(*found)
                run = side.result()
                return False, [] if run is None else [run]
        side.raises(Stopped)
        return True, []

    def _coarser(self, times: int, h: float, halved: int, shown: bool = True) -> Result:
        """A run for comparison at 2 or 4 times the step h, which is the first one halved `halved` times."""
        seen = self._watch(watches.DOUBLED if times == 2 else watches.QUADRUPLED)
        return self._once(times * h, halved - times // 2, seen if shown else seen._replace(progress=None))

    def _allows(self, seconds: float) -> bool:
        """True if this much more wall time is left. All passes count, also those before a run was resumed."""
        if self._limited:
            return self._late.allows(seconds)
        return sum(run.wall_s for run in self._runs) + seconds <= PATIENCE

    def _stops(self) -> bool:
        """True if a run at half the step would take too long; without a complete run: `run.limit` is over."""
        runs = self._runs
        if self._limited and not any(run.ok for run in runs):
            return self._late.over
        # a pass that ended early does not show how long the whole run takes
        k = next((k for k, run in enumerate(runs) if ended(run)), 0)
        longer = TWICE
        if len(runs) > k + 1 and ended(runs[k]) and ended(runs[k + 1]) and runs[k + 1].wall_s > 0.0:
            longer = max(TWICE, runs[k].wall_s / runs[k + 1].wall_s)
        return not self._allows(longer * TWICE**k * runs[k].wall_s)

    def _done(self) -> Result:
        """The last run, with which the search ended."""
        return marked(self._runs[0])

    def _best(self) -> Result:
        """The finest complete run, where the search ended without one within the tolerance. Without any
        complete one, the last run, or the one that came furthest where time was over."""
        runs, late = self._runs, f"{PATIENCE:g} s of wall time (set run.limit to allow more)"
        late = limit_of(self._model) if self._limited else late
        complete = [k for k, run in enumerate(runs) if run.ok]
        if not complete and (unkept := self._unkept()) is not None:
            return unkept
        if not complete:
            return max(runs, key=lambda run: float(run.time[-1])) if self._stopped else runs[0]
        k = complete[0]
        best, before = runs[k], [run for run in runs[k + 1 :] if ended(run)]
        if before:
            best = compared_with_coarser(best, before, None)
        elif len(runs) == 1 and self._late.allows(0.5 * best.wall_s):
            h = best.step
            best = compared_with_coarser(best, [], lambda n: self._coarser(n, h, 0))
        else:
            best = estimated(best, [])
        tried = f"no step below {best.step:.3g} ms was tried"
        why = f"{late} left no time for a finer step" if self._stopped or cut(runs[0]) else tried
        unknown = best.error_unknown
        if k > 0 and not cut(runs[0]):
            unknown = f"{NOT_KNOWN}: a run at half the step ended early: {runs[0].status}"
        elif not before and best.error_estimate is None and not unknown:
            other = f"{UNKNOWN} failed: {runs[k + 1].status}" if len(runs) > k + 1 else ""
            unknown = other or f"{NOT_KNOWN}: {late} left no time for another run"
        best = replace(best, error_unknown=unknown)
        return marked(self._chaos(replace(best, search_ended=why), before, len(runs) - 1 - k))

    def _unkept(self) -> Result | None:
        """The finest run that came to its end, but did not keep its energy, at no step that was tried: it is
        shown as long as that is a small part, and says how much it is."""
        found = [run for run in self._runs if ended(run)]
        if not found or not audit.shown(found[0].energy):
            return None
        best = estimated(replace(found[0], status=OK), found[1:3])
        return marked(replace(best, error_unknown=f"{NOT_KNOWN}: at the finest step {off_balance(found[0])}"))

    def _parts(self, k: int) -> bool:
        """True if the motion is chaotic, so that no finer step helps: a run from a slightly moved start
        differs from the last run, halved `k` times, by as much as a run at half the step. Marks the last run
        then."""
        runs = self._runs[:4]
        name = runs[0].error_estimate_of
        if not all(run.ok for run in runs) or name is None or chaos.falls(runs, name):
            return False
        if not self._allows(runs[0].wall_s):
            return False
        found = chaos.chaos(runs[0], runs[1], self._moved(runs[0].step, k, watches.MOVED_EARLY))
        if found is None or chaos.ALIKE * found.apart < found.step_apart:
            return False
        why = f"no step below {runs[0].step:.3g} ms was tried"
        self._runs[0] = replace(runs[0], search_ended=why, chaotic=found)
        return True

    def _moved(self, step: float, halved: int, number: int) -> Result:
        """A run at this step from a slightly moved start."""
        model = chaos.moved(self._model)
        return self._once(step, halved, self._watch(number), build(model, fold=True), model)

    def _chaos(self, best: Result, before: list[Result], halved: int) -> Result:
        """The result with its measure of chaos, from a run with a slightly moved start."""
        name = best.error_estimate_of
        if not before or name is None or chaos.falls([best, *before[:3]], name):
            return best
        if not self._allows(best.wall_s):
            return best
        other = self._moved(best.step, halved, watches.MOVED)
        return replace(best, chaotic=chaos.chaos(best, before[0], other))


def _strains(runs: list[Result]) -> None:
    """Computes the strains of runs, which estimates need; the runs cache them."""
    for run in runs:
        _ = run.strains
