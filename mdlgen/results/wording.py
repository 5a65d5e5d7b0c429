"""Numbers for readers: few figures, and 0 for round-off."""

from __future__ import annotations

from collections.abc import Sequence

ROUND_OFF = 1e-9  # a number below it has no figures to speak of, nor a component of others' size


def number(value: float, figures: int) -> str:
    """A number in so many figures."""
    return f"{value:.{figures}g}" if abs(value) >= ROUND_OFF else "0"


def numbers(values: Sequence[float | None], figures: int, unknown: str) -> list[str]:
    """Components of a vector, of which one that is round-off of the others is 0; `unknown` is for None."""
    small = ROUND_OFF * max((abs(v) for v in values if v is not None), default=0.0)
    return [unknown if v is None else "0" if abs(v) < small else number(v, figures) for v in values]


def percent(part: float) -> str:
    """A part of something, in percent."""
    return f"{100.0 * part:.2g} %"
