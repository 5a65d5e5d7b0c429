"""A run compared with others at other steps: its estimate, or why its error is not known."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from mdlgen.backends.lattice.integrate.ends import limit_of
from mdlgen.backends.lattice.integrate.limit import Deadline
from mdlgen.backends.lattice.kernels.tuning import COMPARED
from mdlgen.model.tables import Model
from mdlgen.results import audit
from mdlgen.results.estimates import NOT_KNOWN, by_finer, estimated, open_yet, unlike
from mdlgen.results.result import Result
from mdlgen.results.stored import finite

# Reasons why the error of a run at a given step is unknown: the other run failed, or differs too much.
UNKNOWN = f"{NOT_KNOWN}: a run at twice the step"
FINER = f"{NOT_KNOWN}: a run at finer steps"


def thinned(model: Model) -> Model:
    """The Model with a subset of its stored times that needs at most COMPARED states, about."""
    outputs = max(1, round(model.run.duration / model.run.print_step))
    least = math.ceil(outputs * len(model.bodies.name) / COMPARED)
    each = next(k for k in range(least, outputs + 1) if outputs % k == 0) if least <= outputs else 1
    if each == 1 or each > 4 * least:
        return model
    return replace(model, run=replace(model.run, print_step=each * model.run.print_step))


def compared_with_coarser(
    result: Result, before: list[Result], again: Callable[[int], Result] | None
) -> Result:
    """The result with its estimate, from the runs `before` at twice its step, four times its step, ...

    `again(times)` runs at a multiple of its step; None: no other run is made. It is called for twice the step
    where `before` is empty. It is called once more, for four times the step, where two runs do not show
    whether the tolerance is met, or differ by a large part: three show how errors fall. Where the run at
    twice the step fails, or differs by a large part that does not fall, the result states that its error is
    unknown.
    """
    found = [run for run in before if ended(run)]
    for run in found:
        run.coarser = ()
    if not before and again is not None:
        found = [again(2)]
        if not found[0].ok:
            return replace(estimated(result, []), error_unknown=f"{UNKNOWN} fails: {reason(found[0])}")
    if not found or not ended(found[0]):
        return estimated(result, [])
    result = estimated(result, found[:2])
    if result.error_unknown:
        return result
    what = None if before or result.error_estimate is not None else unlike(result, found[0])
    if again is not None and (open_yet(result) or what) and result.model.run.duration / result.step >= 16:
        third = again(4)
        result = estimated(result, [found[0], third]) if ended(third) else result
    if what and result.error_estimate is None:
        return replace(result, error_unknown=f"{UNKNOWN} differs from it in {what}")
    return result


def compared_with_finer(result: Result, finer: Result) -> Result:
    """The result with its estimate from a run at finer steps."""
    if not ended(finer):
        return replace(estimated(result, []), error_unknown=f"{FINER} fails: {reason(finer)}")
    result = by_finer(result, finer)
    if result.error_estimate is not None or result.error_unknown:
        return result
    what = unlike(result, finer)
    return replace(result, error_unknown=f"{FINER} differs from it in {what}") if what else result


def in_time(result: Result, deadline: Deadline) -> Result:
    """The result of a complete run; it states where `run.limit` left no time for a comparison."""
    late = result.model.run.limit is not None and not deadline.allows(0.5 * result.wall_s)
    if result.error_estimate is not None or result.error_unknown or not late:
        return result
    why = f"{limit_of(result.model)} left no time for another run"
    return replace(result, error_unknown=f"{NOT_KNOWN}: {why}")


def ended(run: Result) -> bool:
    """True if a run reached its end; one whose energies do not balance still shows how errors fall."""
    whole = all(finite(a) for a in (run.position, run.velocity, run.spin))
    return whole and bool(run.time[-1] >= run.model.run.duration * (1.0 - 1e-9))


def reason(run: Result) -> str:
    """Reason why a run failed, without advice on the step: the run it is compared with has another step."""
    return run.status.partition(f"; {audit.ADVICE}")[0]
