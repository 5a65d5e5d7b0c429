"""Factors over time: of a load, and of gravity."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field

from mdlgen.spec.drive import MOST_CORNERS
from mdlgen.spec.fields import TimeOrZero
from mdlgen.spec.quantities import ratio
from mdlgen.spec.strict import fail

# A factor is a part of what is written next to it: a larger one is a mistake in that.
MOST_FACTOR = 1000.0


def _corner(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise fail(f"expected [time, factor] like ['5 ms', 0.5], got {value!r}"[:200])
    return tuple(value)


def _rising(corners: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    if not 2 <= len(corners) <= MOST_CORNERS:
        raise fail(f"{len(corners)} corners; allowed 2 to {MOST_CORNERS}")
    for k, ((before, _), (time, _)) in enumerate(pairwise(corners), 1):
        if not time > before:
            raise fail(
                f"the time {time:g} ms is not above the one before, {before:g} ms; a jump is a short ramp",
                within=(k,),
            )
    return corners


Factor = Annotated[float, ratio(-MOST_FACTOR, MOST_FACTOR)]
_Corner = Annotated[tuple[TimeOrZero, Factor], BeforeValidator(_corner)]
# Corners [time, factor] with rising times: linear between them, constant before the first and after the last.
Profile = Annotated[tuple[_Corner, ...], Field(strict=False), AfterValidator(_rising)]
WORDS = (
    "[time, factor] of each corner, times increasing; linear between corners, constant before the first and "
    f"after the last; 2 to {MOST_CORNERS}"
)


def begun(profile: tuple[tuple[float, float], ...] | None) -> float:
    """The factor as a run begins, which is that of the first corner."""
    return 1.0 if profile is None else profile[0][1]
