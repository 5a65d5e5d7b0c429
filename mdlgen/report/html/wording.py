"""Numbers as pages write them."""

from __future__ import annotations

from typing import Any

ROUND_OFF = 1e-9  # a number below it has no figures to speak of


def shown(value: Any) -> str:
    """A number as a reader wants it: five figures, 0 for round-off; a dash for what is not known.

    In a vector a component that is round-off of the others is 0.
    """
    if value is None:
        return "–"
    if isinstance(value, (bool, str)):
        return str(value)
    if isinstance(value, (list, tuple)):
        numbers = [v for v in value if isinstance(v, (int, float))]
        small = ROUND_OFF * max((abs(v) for v in numbers), default=0.0)
        return "(" + ", ".join("0" if v in numbers and abs(v) < small else shown(v) for v in value) + ")"
    return f"{value:.5g}" if abs(value) > ROUND_OFF else "0"


def percent(value: float | None) -> str:
    """A ratio in percent, of which a small one says how small it is."""
    if value is None:
        return "– %"
    value *= 100.0
    return f"{value:.3g} %" if abs(value) > ROUND_OFF else f"{value:.1g} %"
