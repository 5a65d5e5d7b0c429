"""Numbers and times in tables."""

from __future__ import annotations


def number(value: float | None) -> str:
    """Three figures; empty where there is none."""
    return "" if value is None else f"{value:.3g}"


def time(seconds: float | None) -> str:
    """Three figures in the unit that reads best."""
    if seconds is None:
        return ""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"
