"""Numbers as pages write them."""

from __future__ import annotations

from typing import Any

from mdlgen.results.wording import ROUND_OFF, number, numbers

FIGURES = 4
UNKNOWN = "–"


def shown(value: Any) -> str:
    """A number as a reader wants it: four figures, 0 for round-off; a dash for what is not known.

    In a vector a component that is round-off of the others is 0.
    """
    if value is None:
        return UNKNOWN
    if isinstance(value, (bool, str)):
        return str(value)
    if isinstance(value, (list, tuple)):
        if all(v is None or isinstance(v, (int, float)) for v in value):
            return f"({', '.join(numbers(value, FIGURES, UNKNOWN))})"
        return f"({', '.join(map(shown, value))})"
    return number(value, FIGURES)


def percent(value: float | None) -> str:
    """A ratio in percent, of which a small one says how small it is."""
    if value is None:
        return f"{UNKNOWN} %"
    value *= 100.0
    return f"{value:.3g} %" if abs(value) > ROUND_OFF else f"{value:.1g} %"
