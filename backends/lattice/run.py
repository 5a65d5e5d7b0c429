"""Runs a Model: fixed steps, halved where they do not converge, and the whole again at half the step until
the difference is within the tolerance."""

from __future__ import annotations

import contextlib
import math
import time as clock
from collections.abc import Callable
from functools import partial
from threading import Event, Thread
from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.arrays import System, build, partner
from mdlgen.backends.lattice.beside import Beside, Stopped, own
from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.backends.lattice.kernels.state import (
    ANEW,
    COUNTERS,
    FASTEST,
    ITERATIONS,
    ROW,
    STEPS,
    STRAIN,
    THROUGH,
    TOUCHING,
    WORST,
    Bounds,
    Control,
    History,
    Kept,
    Matrix,
    Midpoint,
    State,
    Workspace,
)
from mdlgen.backends.lattice.kernels.state import MADE as MADE_OF
from mdlgen.backends.lattice.kernels.state import MISS as MISS_OF
from mdlgen.backends.lattice.mark import Mark, Stage
from mdlgen.backends.lattice.record import Recorder, Stand
from mdlgen.backends.lattice.scope import check
from mdlgen.backends.lattice.statics.rest import rest
from mdlgen.backends.lattice.symmetry.find import find
from mdlgen.backends.lattice.symmetry.mirror import halve
from mdlgen.errors import SpecError
from mdlgen.mechanics.frame import Motion
from mdlgen.model.curves import overstretched
from mdlgen.model.tables import Floats, Model
from mdlgen.model.unheld import Unheld
from mdlgen.results import audit
from mdlgen.results.estimates import estimated, open_yet
from mdlgen.results.result import Result
from mdlgen.runs.checkpoint import Checkpointer

# Longest first step at a tolerance of 1e-3 [ms]; it goes with the root of the tolerance.
FIRST_STEP = 0.2
# How often the step may be halved to meet the tolerance, from the first step on; blocks take little time.
MOST_REFINED, MOST_REFINED_RIGID = 5, 8
# Iterations of a step of that size stop at changes of velocity of this part of tolerance times speed: in
# scenes with flexible sheets, whose boxes flutter much faster, and of rigid blocks, whose impacts are sharp.
ROUND_OFF, ROUND_OFF_RIGID = 2.0, 0.02
# Where the step of rigid blocks is chosen, velocities may miss their guess by this part of the speed at a
# tolerance of 1e-3; else the step is halved. Sheets flutter, and miss it always.
MISS = 1e-3
# Energy that contacts may make or lose in one step by its length alone, as a part of what passes through the
# run, at a tolerance of 1e-3; else the step is halved.
MADE = 5e-5
LOOSEST = 1e-2  # tolerance that a step is solved to, at most
# What a scene without contacts may gain, as a part of the tolerance; its step is halved until it does not.
FREE_GAIN = 1e-3

# Two runs that end early end at the same time where it differs by less than this part of the duration.
SAME_END = 0.01

# How a halved run ends, beside those of kernels.integrate.
PASSED, OVERLAPPED = -1, -2
# Steps of one run, and those that compiled code takes before it is asked again.
MOST_STEPS, MOST_AT_ONCE = 1e9, 1000

Progress = Callable[[float, float, int, int], None]


# Numbers by which states of passes are kept: first those of the first step, halved so many times, or of the
# step that is given, doubled so many times; then of twice the first step; of a check at a step of its own.
DOUBLED, CHECK = MOST_REFINED_RIGID + 1, MOST_REFINED_RIGID + 2

# Rules that leave out what a run does not need, each of which a run can do without.
FOLDING, FACTORS, SYMMETRY = "folding", "factors", "symmetry"


class Watch(NamedTuple):
    """Who follows a pass: what is called as it goes, what keeps it and by which number, and what stops it
    where it goes on at the same time as another one; one of the two is hidden."""

    progress: Progress | None = None
    keep: Checkpointer | None = None
    number: int = 0
    stop: Event | None = None
    hidden: bool = False

    def beside(self, stop: Event) -> Watch:
        """Of a pass that goes on beside another one, which is the one that reports."""
        return self._replace(progress=None, stop=stop, hidden=True)

    def leave(self) -> None:
        """Such a pass has ended, and leaves a processor free."""
        if self.keep is not None:
            self.keep.free.set()


UNSEEN = Watch()


def _watch(progress: Progress | None, keep: Checkpointer | None, number: int) -> Watch:
    """Of the pass of that number."""
    if keep is not None:
        keep.begin(number)
    return Watch(progress, keep, number)


@PROGRAM.releases
def solve(
    model: Model,
    progress: Progress | None = None,
    step: float | None = None,
    without: tuple[str, ...] = (),
    keep: Checkpointer | None = None,
    threads: int = 1,
) -> Result:
    """Run a Model; `progress(time, end, steps, touching)` is called as it goes (times in ms).

    `step` [ms], or the Model's own, is taken as it is, and estimates come of a run at twice the step.
    Without either the step follows from the tolerance: the run is repeated at half the step until what it
    judges is estimated to be within it (see `results.estimates`). A failed run returns a Result with its
    reason; RefusedError is raised for what the solver cannot represent.

    `without` names rules that are not to be used: FOLDING of equal bushings, keeping of FACTORS over steps,
    SYMMETRY of both sides. `keep` is given states to go on from, and a run goes on from those that it has, to
    the same bits. With two `threads` or more, two passes go on at the same time, to the same bits as well;
    progress is that of the finer one.
    """
    check(model)
    started = clock.perf_counter()
    system = build(model, fold=FOLDING not in without)
    compiled = clock.perf_counter()
    if model.run.analysis == "static":
        result = rest(model, system, *start(model, system)[:2])
        # what a run at rest calls is compiled, or loaded, as it goes: all but its wall time
        result.build_s = compiled - started
        result.compile_s = clock.perf_counter() - compiled - result.wall_s
        return result
    _warm(model, system)
    compile_s = clock.perf_counter() - compiled
    mirror = None if SYMMETRY in without else find(model, system)
    if mirror is not None:
        system = halve(system, mirror)
    build_s = clock.perf_counter() - started - compile_s
    wanted = step or model.run.step
    begun = clock.perf_counter()
    watch = partial(_watch, progress, keep)
    together = threads > 1 and PROGRAM.loaded  # numba's code keeps the lock of Python
    if keep is not None and not (together and threads == 2):
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
    made = MADE * _accuracy(model) / 1e-3
    h = _division(model, wanted).step

    def again(times: int, on: System, seen: Watch) -> Result:
        return _once(model, on, times * h, seen, made=times * times * made)

    first = partial(_once, model, system, wanted, watch(number), made=made, anew=anew)
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


def _compared(result: Result, before: list[Result], again: Callable[[int], Result]) -> Result:
    """The result with its estimate, from the runs `before` at twice its step, four times its step, ...

    `again(times)` runs at so many times its step: at twice where there is none, and once more coarsely where
    two leave open whether the tolerance is met, since three show how errors fall.
    """
    found = [run for run in before if _ended(run)]
    for run in found:
        run.coarser = ()
    found = found if before else [again(2)]
    if not found or not _ended(found[0]) or not (found[0].ok or before):
        return estimated(result, [])
    result = estimated(result, found[:2])
    if open_yet(result) and result.model.run.duration / result.step >= 16:
        third = again(4)
        result = estimated(result, [found[0], third]) if _ended(third) else result
    return result


def _ended(run: Result) -> bool:
    """Whether a run came to its end; one whose energies do not balance still tells how errors fall."""
    finite = all(np.isfinite(a).all() for a in (run.position, run.velocity, run.spin))
    return finite and bool(run.time[-1] >= run.model.run.duration * (1.0 - 1e-9))


class Search:
    """Halves the step until estimates are within the tolerance; fails where they never are.

    A run that ends early has its reason from the physics of the scene or from its step: it is reported where
    the next finer run ends at the same time, and its energies balance.
    """

    def __init__(self, model: Model, system: System, watch: Callable[[int], Watch]):
        self._model, self._system, self._watch = model, system, watch
        self._flexible = _flexible(model)
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
        fine = _accuracy(self._model) / 1e-3 * 0.25**halved
        miss = 0.0 if self._flexible else MISS * fine
        return _once(self._model, self._system if on is None else on, h, seen, miss, MADE * fine)

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
        return enough or (not _ended(run) and same and _unbalanced(run) is None)

    def _two(self) -> Result:
        """The second pass beside the first one: rigid blocks seldom need a third."""
        h = first_step(self._model)
        seen, beside = self._watch(0), own(self._system)
        with Beside(lambda stop: self._once(h, 0, seen.beside(stop), beside), seen.leave) as coarse:
            second = self._once(0.5 * _division(self._model, h).step, 1, self._watch(1))
            self._runs.append(coarse.result())
            return second

    def _three(self) -> Result | None:
        """The third pass, which most scenes with flexible sheets need, beside the first two, which take as
        long; None where the search ends with these."""
        model, h, enough = self._model, first_step(self._model), Event()
        seen, beside = [self._watch(number) for number in (0, 1, 2, DOUBLED)], own(self._system)

        def two(stop: Event) -> bool:
            hidden = [each.beside(stop) for each in seen]
            ends = True
            try:
                self._runs.append(self._once(h, 0, hidden[0], beside))
                seen[0].leave()
                second = self._once(0.5 * self._runs[0].step, 1, hidden[1], beside)
                ends = self._ends(second, 1, hidden[3], beside)
                if not ends:
                    _strains(self._runs)
                return ends
            finally:
                if ends:
                    enough.set()

        second = _division(model, 0.5 * _division(model, h).step)
        with Beside(two, seen[0].leave) as coarser:
            third = None
            with contextlib.suppress(Stopped):
                third = self._once(0.5 * second.step, 2, seen[2]._replace(stop=enough))
            return None if coarser.result() else third

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


def _accuracy(model: Model) -> float:
    """What a step is solved to: a larger tolerance is for what differs from run to run however exact."""
    return min(model.run.tolerance, LOOSEST)


def first_step(model: Model) -> float:
    """Step to begin with [ms]."""
    run = model.run
    return min(FIRST_STEP * math.sqrt(run.tolerance / 1e-3), run.duration / 20)


def _flexible(model: Model) -> bool:
    return any(sheet.count > 1 for sheet in model.sheets)


def _speed(model: Model) -> float:
    """What velocities are measured by at first [mm/ms]: drives, initial velocities, a tenth of a sheet in the
    run."""
    drives = [abs(r.speed) * r.radius for r in model.rollers if r.speed is not None]
    starts = [float(np.linalg.norm(s.velocity)) for s in model.sheets]
    own = [max(s.size) / 10 / model.run.duration for s in model.sheets]
    return max(*drives, *starts, *own, 0.0)


class Division(NamedTuple):
    """How a run is divided: stored times after the start, steps between two of them, and the step [ms]."""

    outputs: int
    each: int
    step: float


def _division(model: Model, wanted: float) -> Division:
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


def _once(
    model: Model,
    system: System,
    wanted: float,
    watch: Watch = UNSEEN,
    miss: float = 0.0,
    made: float = 0.0,
    anew: bool = False,
) -> Result:
    """One run at a step, or the next smaller one that outputs fall on; `miss`, `made`: see MISS and MADE, 0
    for any; `anew`: a new factor for each step. Raises Stopped where `watch` says so."""
    from mdlgen.backends.lattice.kernels import entries, integrate

    run = model.run
    outputs, each, dt = _division(model, wanted)
    progress, keep, number, stop, hidden = watch
    begun = clock.perf_counter()
    work = _arrays(model, system)
    state = work.state
    control = _control(work)
    counters, energies = control.counters, control.energies
    recorder = Recorder(model, system, state, work.mid, work.kept)
    unheld = _unheld(model, system)
    recorder.store(0.0)
    # the guess of a step is the better the finer it is: what is left of it must fall as fast
    part = (ROUND_OFF if _flexible(model) else ROUND_OFF_RIGID) * min(1.0, (dt / FIRST_STEP) ** 2)
    tolerance = part * _accuracy(model)
    control.pace[[MISS_OF, ANEW, FASTEST, MADE_OF]] = miss, float(anew), _speed(model), made
    status, t, past = integrate.DONE, 0.0, 0.0
    mark = Mark(work, control, recorder)
    stage = mark.back(keep, number) if keep is not None else None
    if stage is not None:
        status, t, past = stage.status, stage.t, stage.wall
        entries.look(system.pairs, system.search, system.search.place.copy())

    def show() -> None:
        if keep is not None and not hidden:  # the one beside shows a later part, or a finer one
            keep.part = partial(_part, recorder, recorder.stand(energies), dt, int(counters[STEPS]))

    if stage is not None:
        show()
    todo = range(stage.outputs if stage else 0, 0 if stage and stage.ended else outputs)
    for output in todo:
        for taken in range(0, each, MOST_AT_ONCE):
            if stop is not None and stop.is_set():
                raise Stopped
            steps = np.full(min(each - taken, MOST_AT_ONCE), dt)
            status, t = integrate.run(work, t, steps, tolerance, control)
            if taken == 0:
                recorder.between()
            if status != integrate.DONE:
                break
        if status != integrate.DONE:
            break
        t = (output + 1) * run.duration / outputs
        recorder.store(t)
        passed = system.mirror.passed(state.x, system.nodes) if system.mirror is not None else -1
        if passed >= 0:
            status = PASSED
            counters[WORST] = passed
            break
        if unheld.found(state.x, state.r, t) is not None:
            status = OVERLAPPED
            break
        show()
        if keep is not None and keep.due(number) and output + 1 < outputs:
            wall = past + clock.perf_counter() - begun
            keep.save(number, mark.arrays(Stage(status, t, output + 1, wall, False)))
        if progress is not None:
            progress(t, run.duration, int(counters[STEPS]), int(counters[TOUCHING]))
    wall = past + clock.perf_counter() - begun
    if keep is not None and todo and (keep.written or keep.due(number)):
        keep.save(number, mark.arrays(Stage(status, t, todo.stop, wall, True)))
    reason = None if status == integrate.DONE else _reason(model, system, status, t, dt, state, counters)
    if status in (integrate.LEFT, integrate.DEEP, integrate.STRETCHED):
        recorder.store(t)  # with which its energies balance, or do not
    result = recorder.result("lattice", reason, energies)
    result.step, result.steps = dt, int(counters[STEPS])
    result.rounds, result.wall_s = int(counters[ITERATIONS]), wall
    if result.ok and not all(np.isfinite(a).all() for a in (result.position, result.velocity, result.spin)):
        result = result.failed("the state went non-finite")
    unbalanced = _unbalanced(result)
    if unbalanced is None or status not in (
        integrate.DONE,
        integrate.LEFT,
        integrate.DEEP,
        integrate.STRETCHED,
    ):
        return result
    return result.failed(unbalanced if result.ok else f"{result.status}; and {unbalanced}")


def _unheld(model: Model, system: System) -> Unheld:
    """What looks for overlaps that no contact hinders, where one side is solved on that side."""
    return Unheld(model, None if system.mirror is None else ~system.mirror.gone)


def _unbalanced(run: Result) -> str | None:
    """Why a run's energies make it no result."""
    loss = audit.LOSS if _flexible(run.model) else audit.LOSS_RIGID
    return audit.reason(run.model, run.energy, run.step, loss)


def _part(recorder: Recorder, stand: Stand, dt: float, steps: int) -> Result:
    """The result up to where a run stood."""
    result = recorder.result_at(stand, "lattice", None)
    result.step, result.steps = dt, steps
    return result


def start(model: Model, system: System) -> tuple[State, Midpoint, Matrix]:
    """State at the start, and the arrays of a step."""
    from mdlgen.backends.lattice.kernels import forces, step

    state, mid, matrix = step.empty(system, forces.WIDE)
    bodies = model.bodies
    count = len(bodies.name)
    state.x[:count], state.r[:count] = bodies.position, bodies.rotation.reshape(-1, 9)
    state.r[count] = np.eye(3).ravel()
    mid.motion.x[:], mid.motion.r[:] = state.x, state.r
    nodes = system.nodes
    turn, spin = bodies.rotation[nodes], bodies.spin[nodes]
    state.v[:] = bodies.velocity[nodes]
    own = np.einsum("nji,nj->ni", turn, spin)
    state.l[:] = np.einsum("nij,nj->ni", turn, bodies.inertia[nodes] * own)
    state.u[:, :3], state.u[:, 3:] = state.v, spin
    for roller in model.rollers:
        if roller.one_way is not None and roller.speed is not None:  # it begins with its shaft
            at = system.bodies["spin"][roller.body]
            if at < 0:
                continue  # left out, see mirror
            state.vb[at] = state.ub[at] = roller.prescribed(0.0)
    return state, mid, matrix


def _reason(
    model: Model, system: System, status: int, t: float, dt: float, state: State, counters: Floats
) -> str:
    """Why a run ended before its end."""
    from mdlgen.backends.lattice.kernels import integrate

    names = model.bodies.name
    if status == integrate.STOPPED and counters[THROUGH] >= 0:
        one, two = (names[int(system.pairs[end][int(counters[THROUGH])])] for end in "ab")
        return (
            f"box {one} would pass through box {two} of another sheet at {t:.6g} ms, with steps down to "
            f"{dt / 2**integrate.DEEPEST:.3g} ms; a stiffer contact between the two would hold it"
        )
    if status == integrate.STOPPED:
        body = names[int(counters[WORST])]
        return (
            f"no convergence at {t:.6g} ms with steps down to {dt / 2**integrate.DEEPEST:.3g} ms; "
            f"box {body} moved most; larger smoothing of its contacts may help"
        )
    if status == integrate.DEEP:
        pair = int(counters[WORST])
        box, plate = int(system.pairs["a"][pair]), partner(model, system.pairs[pair])
        rates = [
            state.u[np.flatnonzero(system.nodes == int(system.pairs[end][pair])), :3].sum(0) for end in "ab"
        ]
        way = dt * float(np.linalg.norm(rates[0] - rates[1]))
        return f"{model.too_deep(box, plate)} at {t:.6g} ms; {model.held_by(box, way)}"
    if status == OVERLAPPED:
        return _unheld(model, system).found(state.x, state.r, t) or "two parts overlap"
    if status == PASSED:
        return (
            f"box {names[int(counters[WORST])]} has passed the plane of the scene's symmetry at "
            f"{t:.6g} ms, where it may meet what is on the other side; run.symmetry: false solves both sides"
        )
    if status == integrate.CROWDED:
        room = len(system.pairs) - system.search.first
        return f"more than {room} pairs of boxes of two sheets are near each other at {t:.6g} ms"
    if status == integrate.STRETCHED:
        row = int(system.joints["row"][int(counters[WORST])])
        return overstretched(model, row, float(counters[STRAIN]), t)
    body = int(counters[WORST])
    at = ", ".join(f"{value:.4g}" for value in state.x[body])
    bounds, advice = model.bounds_of(body)
    return f"{model.called(body)} left {bounds} at {t:.6g} ms (it is at {at} mm); {advice}"


def _arrays(model: Model, system: System) -> Workspace:
    """What a run works on, made for the start."""
    from mdlgen.backends.lattice.kernels import condensed, damped, entries, forces, momentum

    state, mid, matrix = start(model, system)
    entries.look(system.pairs, system.search, state.x)
    system.pairs["beside"] = 0
    entries.remember(system.bodies, system.pairs, Motion(state.x, state.r, mid.motion.u, mid.motion.w))
    return Workspace(
        tables=system.tables,
        state=state,
        mid=mid,
        matrix=matrix,
        condensed=condensed.empty(system, forces.WIDE),
        free=momentum.empty(system),
        kept=Kept(np.zeros((len(model.contacts), ROW)), np.zeros(system.marks, bool)),
        bounds=Bounds(model.pairs.low, model.pairs.high),
        search=system.search,
        damped=damped.empty(system),
    )


def _control(work: Workspace) -> Control:
    """Counts and settings of a run before its first step."""
    history = History(work.state.u.copy(), work.state.ub.copy(), np.zeros(2))
    return Control(np.zeros(3), np.zeros(COUNTERS), np.zeros(4), history, np.zeros(5))


def _warm(model: Model, system: System) -> None:
    """Compiles, or loads from the cache, before the clock of the run starts."""
    from mdlgen.backends.lattice.kernels import integrate

    work = _arrays(model, system)
    integrate.run(work, 0.0, np.zeros(0), 1.0, _control(work))
    Recorder(model, system, work.state, work.mid, work.kept).store(0.0)
