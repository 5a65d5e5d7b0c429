"""Compares the error of a run with its estimate, by runs at an eighth and a sixteenth of its step."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from mdlgen.bench.campaign.row import INACCURATE, OK, Finer
from mdlgen.results.estimates import complete
from mdlgen.results.quantities import differences
from mdlgen.results.result import Result

# Times its estimate from which an error counts as above it, and from which far above.
ABOVE, FAR = 1.5, 3.0
# Two finer runs agree where they differ by less than this part of the error, or of the estimate.
AGREE = 0.3


@dataclass(frozen=True)
class Compared:
    """The error of one quantity, relative to its estimate."""

    name: str
    times: float | None  # None: there is no estimate
    agree: bool = True  # true if the two finer runs agree on it


def against(result: Result, fine: Result, finest: Result | None = None) -> Iterator[Compared]:
    """Yields each quantity of a result with its error over its estimate. The error is the difference from the
    finest run. Two finer runs `agree` where their difference is below AGREE."""
    last = fine if finest is None else finest
    errors = differences(last, result)
    between = {} if finest is None else differences(finest, fine)
    for name, estimate in complete(result).items():
        if estimate.value is None or name not in errors:
            yield Compared(name, None)
            continue
        error = errors[name].reported * errors[name].scale / estimate.scale
        left = between[name].reported * between[name].scale / estimate.scale if name in between else 0.0
        yield Compared(name, error / estimate.value, left <= AGREE * max(error, estimate.value))


def finer(result: Result, again: Callable[[float], Result]) -> Finer:
    """Compares a result with `again(step)` at an eighth of its step. Where an error is above its estimate, a
    run at a sixteenth checks that the eighth is fine enough."""
    eighth = again(result.step / 8.0)
    if not ended(eighth):
        return Finer(failed=f"at an eighth of the step: {eighth.status}")
    found = list(against(result, eighth))
    apart: tuple[str, ...] = ()
    if any(_above(each) for each in found):
        sixteenth = again(result.step / 16.0)
        if ended(sixteenth):
            found = list(against(result, eighth, sixteenth))
            apart = tuple(each.name for each in found if _above(each) and not each.agree)
    return Finer(
        compared=sum(each.times is not None for each in found),
        unknown=sum(each.times is None for each in found),
        above=tuple(
            (each.name, each.times) for each in found if each.times is not None and each.times > ABOVE
        ),
        apart=apart,
    )


def ended(run: Result) -> bool:
    """Returns whether a run is complete. The error of a run at a given step may be unknown."""
    return run.status in (OK, INACCURATE)


def _above(each: Compared) -> bool:
    return each.times is not None and each.times > ABOVE
