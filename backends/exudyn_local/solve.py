"""Runs a Model in Exudyn and checks the result.

Exudyn's own success flag is not trusted: the end time must be reached, the state finite, Newton converged
(an exception otherwise), the energy balanced, and the boxes within the bounds for which the contacts were
chosen. A run in which a body leaves these is begun again with a wider margin.
"""

from __future__ import annotations

import math
import sys
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mdlgen.backends.exudyn_local.assemble import Assembly, assemble
from mdlgen.backends.exudyn_local.balanced import allowed_residual, unbalanced, unbalanced_energy
from mdlgen.backends.exudyn_local.films import entries_of
from mdlgen.backends.exudyn_local.passing import Parts
from mdlgen.backends.exudyn_local.place import owners
from mdlgen.backends.exudyn_local.prestress import bring_on
from mdlgen.backends.exudyn_local.reacting import Reacting, in_parts
from mdlgen.backends.exudyn_local.recorder import Recorder
from mdlgen.backends.exudyn_local.scope import check
from mdlgen.backends.exudyn_local.settings import settings_of
from mdlgen.backends.exudyn_local.shipped import (
    PROGRAM,
    air_slopes,
    begin_air,
    end_hinges,
    forces,
    jacobian,
    lay_air,
    ledger,
    passed,
)
from mdlgen.backends.exudyn_local.stability import falling
from mdlgen.backends.exudyn_local.state import SEEN, TOTALS, Coordinates, Work, workspace
from mdlgen.backends.exudyn_local.step import choose_steps, cost, given_steps
from mdlgen.backends.exudyn_local.system import MS, Pattern, System, build
from mdlgen.errors import RefusedError
from mdlgen.extras import advice
from mdlgen.model.passing import passing
from mdlgen.model.tables import Model
from mdlgen.model.wider import wider
from mdlgen.results.estimates import NOT_KNOWN, by_finer, estimated, marked, open_yet
from mdlgen.results.result import Result

# Steps in which the load of a static run grows; more where the balance that they lead to does not stand.
LOAD_STEPS = (20, 200)
UNSTABLE = "the balance is unstable"
DIVERGED = "Exudyn did not converge"
# A run and the one at twice its step, from which its error is estimated, are made where the finer one costs
# less than the first [s, see step.cost]; the step is halved for the tolerance where that costs less than the
# second.
ESTIMATED, REFINED = 6.0, 30.0
MOST_REFINED = 5
# A given step is compared with twice that step where a run has at least this many steps, else with half.
FEWEST = 4

Progress = Callable[[float, float, int, int], None]


@PROGRAM.releases
def solve(model: Model, progress: Progress | None = None, step: float | None = None) -> Result:
    """Run a Model; `progress(time, end, steps, touching)` is called during the run (times in ms).

    `step` [ms], or the Model's own, is used as it is. Without either the step follows from the tolerance and
    the shortest impact in the scene, and is halved until the estimated errors are within the tolerance. Where
    two runs would take long there is one, and no estimate; the step is halved where it fails a check. A
    failed run returns a Result with its reason; RefusedError is raised for features that the backend cannot
    represent.
    """
    check(model)
    started = clock.perf_counter()
    system, pattern = build(model)
    exu = _exudyn()
    compiled = clock.perf_counter()
    work = workspace(system)
    _compile(system, pattern, work)
    compile_s = clock.perf_counter() - compiled
    build_s = clock.perf_counter() - started - compile_s
    begun, wanted = clock.perf_counter(), step or model.run.step
    until = math.inf if model.run.limit is None else begun + 1e-3 * model.run.limit
    once = _Runs(exu, model, (system, pattern, work), progress, until).once
    if model.run.analysis == "static":
        result = once(LOAD_STEPS[0], 0.0)
        if result.status.startswith(UNSTABLE):
            result = once(LOAD_STEPS[1], 0.0)
        elif result.status.startswith(DIVERGED) and model.bushings.rest.any():
            stressed = _Runs(exu, model, (system, pattern, work), progress, until, in_steps=True)
            result = stressed.once(LOAD_STEPS[0], 0.0)
    elif wanted is None:
        result = _refined(model, system, once, until, *choose_steps(model, system, work))
    else:
        count, h = given_steps(model, wanted)
        result = once(count, h)
        if step is None:
            result = _compared(model, system, once, until, result)
    result.estimate_s = clock.perf_counter() - begun - result.wall_s - result.build_s
    result.build_s, result.compile_s = result.build_s + build_s, compile_s
    return result


def _compared(
    model: Model, system: System, once: Callable[[int, float], Result], until: float, result: Result
) -> Result:
    """The run at a given step, with its estimate from one at twice that step, or at half of it where there
    are few steps. Where two runs would take long, or `run.limit` is near, its error is not known."""
    if not result.ok:
        return result
    count = round(model.run.duration / result.step)
    few = count < FEWEST
    seconds = cost(system, (2 if few else 1) * count)
    if seconds > ESTIMATED:
        why = f"a second run, to compare with, would take some {seconds:.0f} s; --check-step makes it"
        return marked(replace(estimated(result, []), error_unknown=f"{NOT_KNOWN}: {why}"))
    if clock.perf_counter() + (2.0 if few else 0.5) * result.wall_s > until:
        return marked(replace(estimated(result, []), error_unknown=f"{NOT_KNOWN}: {_limit(model)}"))
    other = once(*given_steps(model, (0.5 if few else 2.0) * result.step))
    if not other.ok:
        which = "half" if few else "twice"
        why = f"a run at {which} the step fails: {other.status}"
        return marked(replace(estimated(result, []), error_unknown=f"{NOT_KNOWN}: {why}"))
    return marked(by_finer(result, other) if few else _estimated(result, [other]))


def _limit(model: Model) -> str:
    return f"run.limit of {1e-3 * (model.run.limit or 0.0):g} s left no time for another run"


def _estimated(result: Result, coarser: Sequence[Result]) -> Result:
    """A result with its estimates from runs at twice and four times its step; a failed one as it is."""
    if not result.ok or not coarser[0].ok:
        return result
    return estimated(result, [replace(run, coarser=()) for run in coarser[:2] if run.ok])


def _refined(
    model: Model, system: System, once: Callable[[int, float], Result], until: float, count: int, h: float
) -> Result:
    """Halves the step until the estimated errors are within the tolerance; where they never are, the finest
    complete run is the result, with its estimate."""

    def affords(last: Result) -> bool:
        """True if there is time for a run at half the step."""
        took = 2.0 * last.wall_s
        return cost(system, 2 * last.steps) <= REFINED and clock.perf_counter() + took <= until

    if cost(system, count) > ESTIMATED:
        result = once(count, h)
        # a run that reached its end and fails a check is repeated at a finer step
        while not result.ok and result.time[-1] >= model.run.duration * (1 - 1e-9):
            if not affords(result):
                break
            count, h = 2 * count, 0.5 * h
            result = once(count, h)
        return _compared(model, system, once, until, result)
    # outputs fall on the steps of the coarser run, too
    even = max(1, round(model.run.duration / model.run.print_step)) * 2
    count = even * -(-count // even)
    h = model.run.duration * MS / count
    before = [once(count // 2, 2.0 * h)]
    result = _estimated(once(count, h), before)
    if open_yet(result) and count % 4 == 0 and count >= 16:
        result = _estimated(result, [*before, once(count // 4, 4.0 * h)])
    why = f"the step was halved {MOST_REFINED} times"
    for _ in range(MOST_REFINED):
        early = [r.steps > 0 and r.time[-1] < model.run.duration * (1 - 1e-9) for r in (before[0], result)]
        if marked(result).ok or all(early):
            break
        if not affords(result):
            why = f"a run at half the step of {result.step:.3g} ms would take long"
            break
        count, h, before = 2 * count, 0.5 * h, [result, *before[:1]]
        result = _estimated(once(count, h), before)
    return _best([result, *before], why)


def _best(runs: list[Result], why: str) -> Result:
    """The finest complete run, of `runs` with the last first, after a search for a step."""
    last = runs[0]
    k = next((k for k, run in enumerate(runs) if run.ok), 0)
    best = runs[k]
    if not best.ok or (k == 0 and marked(best).ok):
        return marked(best)
    if k > 0:
        early = f"a run at half the step ended early: {last.status}"
        best = replace(estimated(best, []), error_unknown=f"{NOT_KNOWN}: {early}")
    elif not best.coarser and not best.error_unknown:
        early = f"a run at twice the step fails: {runs[1].status}"
        best = replace(estimated(best, []), error_unknown=f"{NOT_KNOWN}: {early}")
    return marked(replace(best, search_ended=why))


class _Runs:
    """Runs of one scene; after a run that needed a wider margin, all later ones have it from their start."""

    def __init__(
        self,
        exu: Any,
        model: Model,
        built: tuple[System, Pattern, Work],
        progress: Progress | None,
        until: float,
        in_steps: bool = False,
    ):
        self._exu, self._model, self._built = exu, model, built
        self._progress, self._until = progress, until
        self._in_steps = in_steps  # the initial stress of sheets is applied with the load of a static run

    def once(self, count: int, h: float) -> Result:
        """One run of `count` steps of h [s], or a static one of as many steps of the load, where h is 0."""
        while True:
            watch = self._progress, self._until
            result, left = _once(self._exu, self._model, *self._built, *watch, count, h, self._in_steps)
            wide = None if left is None else wider(self._model, left)
            if wide is None:
                return result
            system, pattern = build(wide)
            self._model, self._built = wide, (system, pattern, workspace(system))


def _once(
    exu: Any,
    model: Model,
    system: System,
    pattern: Pattern,
    work: Work,
    progress: Progress | None,
    until: float,
    count: int,
    h: float,
    in_steps: bool = False,
) -> tuple[Result, np.ndarray | None]:
    """One run of `count` steps of h [s], or a static one of as many steps of the load, where h is 0. It ends
    at `until`, of `time.perf_counter` [s]. With it the places of all bodies (bodies, 3) [mm] where one has
    left its bounds."""
    started = clock.perf_counter()
    system.stick.lag[0] = h
    recorder = Recorder(model, system, progress, until)
    parts = None
    if passing(model):

        def go(of: Assembly, many: int, step: float, known: bool, begin: float) -> str | None:
            return _run(exu, of, model, many, step, recorder, None, known, begin)

        parts = Parts(exu, model, recorder, go, h)
    bring = bring_on(model, system) if in_steps else None
    assembly = parts.begin() if parts else assemble(exu, model, system, pattern, work, recorder, bring=bring)
    static = model.run.analysis == "static"
    if not static:
        recorder.plan(h)
        if parts is None:
            assembly.mbs.SetPostStepUserFunction(recorder.after_step)
        recorder.store(assembly.q, assembly.v, 0.0)
    reacting = Reacting(model, system, recorder, h) if model.reactions and not static else None
    begun = clock.perf_counter()
    try:
        if parts is not None:
            parts.react(reacting)
            reason = parts.run()
        else:
            reason = _run(exu, assembly, model, count, h, recorder, reacting)
    finally:
        if reacting is not None:
            reacting.undo()
    wall = clock.perf_counter() - begun
    assembly = parts.assembly if parts else assembly
    if bring is not None:
        bring(1.0)  # a run that failed ended with a part
    data = assembly.mbs.systemData
    q, v = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
    if static:
        v[:] = 0.0  # Exudyn leaves the initial velocities there
    if static and reason is None:
        recorder.store(q, v, 0.0)
    reason = recorder.reason or reason
    if reason is None and not (np.isfinite(q).all() and np.isfinite(v).all()):
        reason = "the state went non-finite"
    if recorder.finished:
        model = replace(model, run=replace(model.run, duration=recorder.time / MS))
        recorder.model = model
    # the reached time is recorded by our own step function, not by the solver's flag
    if reason is None and not static and recorder.time < model.run.duration * MS * (1 - 1e-9):
        reason = f"stopped at {recorder.time / MS:.6g} ms, before the end at {model.run.duration:g} ms"
    if reason is None and static:
        reason = unbalanced(model, system, q, work)
    if reason is None and static and (ways := falling(system, pattern, q, work)) > 0:
        which = "one direction" if ways == 1 else f"{ways} directions"
        reason = f"{UNSTABLE}: it falls in {which}; a small load aside leads to one that stands"
    result = recorder.result("exudyn", reason)
    if reacting is not None:
        result.reactions = tuple(reacting.machine.log)
    if result.ok and not static:
        wrong = unbalanced_energy(model, result, recorder, h)
        result = result if wrong is None else result.failed(wrong)
    result.wall_s, result.build_s = wall, begun - started
    result.step, result.steps = h / MS, recorder.steps
    named = exu.config.Version() if hasattr(exu.config, "Version") else exu.__version__
    result.versions = {"exudyn": named, "code": PROGRAM.code()}
    return result, recorder.left


def _exudyn():
    # Exudyn looks for this attribute, unknown to sys: it skips range checks in the compiled module
    sys.exudynFast = True  # type: ignore[attr-defined]
    try:
        import exudyn as exu
    except ModuleNotFoundError:
        raise RefusedError(f"the solver exudyn {advice('exudyn')}") from None
    exu.special.userInterface.SuppressAll(True)
    return exu


def _compile(system: System, pattern: Pattern, work: Work) -> None:
    """Compile (or load from the cache) every kernel before the clock of the run starts."""
    free, tables = system.free, system.tables
    q, v = np.zeros(max(1, free)), np.zeros(max(1, free))
    data = np.zeros(len(pattern.indices))
    at, owner = Coordinates(q, v, 0.0), owners(system)
    forces(tables, at, 1.0, work)
    jacobian(tables, system.elements, at, 1.0, (1.0, 1.0), False, owner, work, data)
    ledger(tables, at, work, np.zeros((len(system.pairs), SEEN)), np.zeros(TOTALS))
    if system.film.cells.size:
        begin_air(tables, at, work.motion)
        lay_air(tables, at, 0.0, work.motion)
        air_slopes(tables, at, 1.0, work.motion, *entries_of(system.film))
    if system.hinges.size:
        end_hinges(tables, at, work.motion, True)
    passed(system.bodies, system.pairs, system.shapes, q, v, q, v, 0.0, 0.0)


def _run(
    exu,
    assembly: Assembly,
    model: Model,
    count: int,
    h: float,
    recorder: Recorder,
    reacting: Reacting | None = None,
    known: bool = False,
    begin: float = 0.0,
) -> str | None:
    """Runs from `begin` [s]; returns the reason of a failure, or None. `known`: accelerations are, at the
    start."""
    if assembly.system.free == 0:
        return "nothing in this scene can move"
    mbs, static = assembly.mbs, model.run.analysis == "static"
    system = assembly.system
    allowed = (allowed_residual(model, system, assembly.q, workspace(system)),) if static else ()
    settings = settings_of(exu, count, begin + count * h, known or recorder.touching > 0, begin, *allowed)
    try:
        run = mbs.SolveStatic if static else mbs.SolveDynamic
        if reacting is not None:
            return (
                None
                if in_parts(run, mbs, settings, exu, reacting, recorder)
                else "Exudyn stopped before the end"
            )
        done = run(settings)
    except Exception as error:  # Exudyn raises its own kinds for a Newton that does not converge
        if isinstance(error, KeyboardInterrupt):
            raise
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        return f"{DIVERGED}: {lines[0] if lines else type(error).__name__}"[:300]
    return None if done else "Exudyn stopped before the end"
