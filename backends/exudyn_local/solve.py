"""Runs a Model in Exudyn and checks what came out.

Exudyn's own success flag is not trusted: the end time must be reached, the state finite, Newton converged
(an exception otherwise), the energy kept, and the boxes within the bounds from which the contacts were
chosen.
"""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from mdlgen.backends.exudyn_local.assemble import Assembly, assemble
from mdlgen.backends.exudyn_local.films import entries_of
from mdlgen.backends.exudyn_local.place import owners
from mdlgen.backends.exudyn_local.recorder import Recorder
from mdlgen.backends.exudyn_local.scope import check
from mdlgen.backends.exudyn_local.shipped import (
    PROGRAM,
    air_slopes,
    begin_air,
    forces,
    jacobian,
    lay_air,
    ledger,
    passed,
)
from mdlgen.backends.exudyn_local.stability import falling
from mdlgen.backends.exudyn_local.state import SEEN, TOTALS, Coordinates, Work, workspace
from mdlgen.backends.exudyn_local.step import choose_steps, cost, given_steps
from mdlgen.backends.exudyn_local.system import MM, MS, Pattern, System, build
from mdlgen.model.tables import Model
from mdlgen.results import audit
from mdlgen.results.estimates import estimated, open_yet
from mdlgen.results.result import Result

# Spectral radius of the generalised-alpha rule: 1 would keep the noise of contact changes, 0 damps most.
SPECTRAL_RADIUS = 0.6
# Newton's tolerance: the default 1e-10 lies below the round-off of stiff bushings (k eps |x|).
NEWTON_TOLERANCE = 1e-8
# Steps in which the load of a static run grows; more where the balance that they lead to does not stand.
LOAD_STEPS = (20, 200)
UNSTABLE = "the balance is unstable"
# A run and the one at twice its step, from which its error is estimated, are made where the finer one costs
# less than the first [s, see step.cost]; the step is halved for the tolerance where that costs less than the
# second.
ESTIMATED, REFINED = 6.0, 30.0
MOST_REFINED = 5
# Relative to the load of one step; what counts is our own check of the residual at the end.
STATIC_TOLERANCE = 1e-8
# A step may shrink to this part of the wanted one before the run fails.
SMALLEST_STEP = 1e-3

Progress = Callable[[float, float, int, int], None]


@PROGRAM.releases
def solve(model: Model, progress: Progress | None = None, step: float | None = None) -> Result:
    """Run a Model; `progress(time, end, steps, touching)` is called as it goes (times in ms).

    `step` [ms], or the Model's own, is taken as it is. Without either the step follows from the tolerance and
    the shortest impact in the scene, and is halved until what the tolerance judges is estimated to be within
    it. Where two runs would take long there is one, and no estimate; the step is halved where it fails a
    check. A failed run returns a Result with its reason; RefusedError is raised for what the backend cannot
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
    once = partial(_once, exu, model, system, pattern, work, progress)
    build_s = clock.perf_counter() - started - compile_s
    begun, wanted = clock.perf_counter(), step or model.run.step
    if model.run.analysis == "static":
        result = once(LOAD_STEPS[0], 0.0)
        if result.status.startswith(UNSTABLE):
            result = once(LOAD_STEPS[1], 0.0)
    elif wanted is None:
        result = _refined(model, system, once, *choose_steps(model, system, work))
    else:
        count, h = given_steps(model, wanted)
        result = once(count, h)
        if result.ok and step is None and count >= 4 and cost(system, count) <= ESTIMATED:
            result = _estimated(result, [once(*given_steps(model, 2 * result.step))])
    result.estimate_s = clock.perf_counter() - begun - result.wall_s - result.build_s
    result.build_s, result.compile_s = result.build_s + build_s, compile_s
    return result


def _estimated(result: Result, coarser: Sequence[Result]) -> Result:
    """A result with its estimates from runs at twice and four times its step; a failed one as it is."""
    if not result.ok or not coarser[0].ok:
        return result
    return estimated(result, [replace(run, coarser=()) for run in coarser[:2] if run.ok])


def _refined(
    model: Model, system: System, once: Callable[[int, float], Result], count: int, h: float
) -> Result:
    """Halves the step until what the tolerance judges is estimated within it; fails where it never is."""
    if cost(system, count) > ESTIMATED:
        result = once(count, h)
        # one that came to its end, and fails a check of that, is tried at a finer step
        while not result.ok and result.time[-1] >= model.run.duration * (1 - 1e-9):
            if cost(system, 2 * count) > REFINED:
                break
            count, h = 2 * count, 0.5 * h
            result = once(count, h)
        return result
    # outputs fall on the steps of the coarser run, too
    even = max(1, round(model.run.duration / model.run.print_step)) * 2
    count = even * -(-count // even)
    h = model.run.duration * MS / count
    before = [once(count // 2, 2.0 * h)]
    result = _estimated(once(count, h), before)
    if open_yet(result) and count % 4 == 0 and count >= 16:
        result = _estimated(result, [*before, once(count // 4, 4.0 * h)])
    for _ in range(MOST_REFINED):
        near = result.error_estimate is not None and result.error_estimate <= model.run.tolerance
        early = [r.steps > 0 and r.time[-1] < model.run.duration * (1 - 1e-9) for r in (before[0], result)]
        if near or all(early) or cost(system, 2 * count) > REFINED:
            break
        count, h, before = 2 * count, 0.5 * h, [result, *before[:1]]
        result = _estimated(once(count, h), before)
    if result.ok and not (result.error_estimate is not None and result.error_estimate <= model.run.tolerance):
        off = (
            f"a run at twice the step failed ({before[0].status})"
            if not result.coarser
            else f"there is no estimate of {result.error_estimate_of}"
            if result.error_estimate is None
            else f"the estimate of {result.error_estimate_of} is {result.error_estimate:.3g}"
        )
        result = result.failed(
            f"the tolerance of {model.run.tolerance:.3g} was not reached at a step of {result.step:.3g} ms: "
            f"{off}; a larger run.tolerance or a run.step of your own ends the search"
        )
    return result


def _once(
    exu: Any,
    model: Model,
    system: System,
    pattern: Pattern,
    work: Work,
    progress: Progress | None,
    count: int,
    h: float,
) -> Result:
    """One run of `count` steps of h [s], or a static one of as many steps of the load, where h is 0."""
    started = clock.perf_counter()
    recorder = Recorder(model, system, progress)
    assembly = assemble(exu, model, system, pattern, work, recorder)
    static = model.run.analysis == "static"
    if not static:
        recorder.plan(h)
        assembly.mbs.SetPostStepUserFunction(recorder.after_step)
        recorder.store(assembly.q, assembly.v, 0.0)
    begun = clock.perf_counter()
    reason = _run(exu, assembly, model, count, h, recorder.touching > 0)
    wall = clock.perf_counter() - begun
    data = assembly.mbs.systemData
    q, v = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
    if static:
        v[:] = 0.0  # Exudyn leaves the initial velocities there
    if static and reason is None:
        recorder.store(q, v, 0.0)
    reason = recorder.reason or reason
    if reason is None and not (np.isfinite(q).all() and np.isfinite(v).all()):
        reason = "the state went non-finite"
    # the reached time is kept by our own step function, not by the solver's flag
    if reason is None and not static and recorder.time < model.run.duration * MS * (1 - 1e-9):
        reason = f"stopped at {recorder.time / MS:.6g} ms, before the end at {model.run.duration:g} ms"
    if reason is None and static:
        reason = _unbalanced(system, q, work)
    if reason is None and static and (ways := falling(system, pattern, q, work)) > 0:
        which = "one direction" if ways == 1 else f"{ways} directions"
        reason = f"{UNSTABLE}: it falls in {which}; a small load aside leads to one that stands"
    result = recorder.result("exudyn", reason)
    if result.ok and not static:
        unbalanced = _unbalanced_energy(model, result, recorder, h)
        result = result if unbalanced is None else result.failed(unbalanced)
    result.wall_s, result.build_s = wall, begun - started
    result.step, result.steps = h / MS, recorder.steps
    result.versions = {"exudyn": exu.config.Version() if hasattr(exu.config, "Version") else exu.__version__}
    return result


def _exudyn():
    # Exudyn looks for this attribute, unknown to sys: it skips range checks in the compiled module
    sys.exudynFast = True  # type: ignore[attr-defined]
    import exudyn as exu

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
    passed(system.bodies, system.pairs, system.shapes, q, v, q, v, 0.0, 0.0)


def _settings(exu, count: int, end: float, touching: bool):
    """Exudyn's settings for `count` steps to `end` [s], or of the load of a static run, where `end` is 0."""
    s = exu.SimulationSettings()
    s.solution.file.write = False
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    s.parallel.numberOfThreads = 1
    static = s.staticSolver
    static.newton.absoluteTolerance = NEWTON_TOLERANCE
    static.newton.relativeTolerance = STATIC_TOLERANCE
    static.newton.maxIterations = 40
    static.numberOfLoadSteps = count
    static.verboseMode = 0
    if end == 0.0:
        return s
    t = s.timeIntegration
    t.newton.useModifiedNewton = True
    t.newton.absoluteTolerance = t.newton.relativeTolerance = NEWTON_TOLERANCE
    t.newton.maxIterations = 12
    t.verboseMode = 0
    t.numberOfSteps = count
    t.endTime = end
    t.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
    # Accelerations at the start are wanted for accuracy; but in contact the stiff damping makes them so
    # large for a moment that Newton would start far away. Such scenes start at rest in their nips.
    t.generalizedAlpha.computeInitialAccelerations = not touching
    t.adaptiveStep = True  # a step that does not converge is repeated at half the size
    t.adaptiveStepDecrease = 0.5
    t.adaptiveStepIncrease = 2.0
    t.adaptiveStepRecoverySteps = 1
    t.minimumStepSize = end / count * SMALLEST_STEP
    return s


def _run(exu, assembly: Assembly, model: Model, count: int, h: float, touching: bool) -> str | None:
    """Runs; returns the reason of a failure, or None."""
    if assembly.system.free == 0:
        return "nothing in this scene can move"
    settings = _settings(exu, count, count * h, touching)
    mbs = assembly.mbs
    try:
        run = mbs.SolveStatic if model.run.analysis == "static" else mbs.SolveDynamic
        done = run(settings)
    except Exception as error:  # Exudyn raises its own kinds for a Newton that does not converge
        if isinstance(error, KeyboardInterrupt):
            raise
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        return f"Exudyn did not converge: {lines[0] if lines else type(error).__name__}"[:300]
    return None if done else "Exudyn stopped before the end"


def _unbalanced_energy(model: Model, result: Result, recorder: Recorder, h: float) -> str | None:
    """Why the energy does not balance, at the time at which it was furthest off either way.

    A sheet rattles faster than a step is long, which the rule damps; a rigid block loses what its impacts get
    wrong.
    """
    if any(sheet.count > 1 for sheet in model.sheets):
        # what an edge stores as it comes into a nip comes back some steps later: the end counts
        return audit.reason(model, result.energy, h / MS, audit.LOSS)
    for off in (recorder.gained, recorder.vanished):
        worst = replace(result.energy, balance_error=off / MM / result.energy.scale)
        reason = audit.reason(model, worst, h / MS, audit.LOSS_RIGID)
        if reason is not None:
            return reason
    return None


def _unbalanced(system: System, q: np.ndarray, work: Work) -> str | None:
    """Static equilibrium by our own account: the residual against the largest force in the sheet."""
    forces(system.tables, Coordinates(q, np.zeros_like(q), 1.0), 1.0, work)
    residual = work.forces.copy()
    for row in system.bodies:
        n = row["first"]
        if n >= 0:  # along the Euler parameters themselves a force does no work
            e = row["reference"][3:] + q[n + 3 : n + 7]
            residual[n + 3 : n + 7] -= e * (e @ residual[n + 3 : n + 7]) / (e @ e)
    weight = float(system.bodies["mass"].sum() * np.linalg.norm(system.gravity))
    loads = float(np.abs(system.loads["force"]).sum() + np.abs(system.loads["moment"]).sum() / 0.1)
    allowed = 1e-4 * max(weight, loads, 1e-9)
    worst = float(np.abs(residual).max())
    return None if worst <= allowed else f"static residual {worst:.3g} N above {allowed:.3g} N"
