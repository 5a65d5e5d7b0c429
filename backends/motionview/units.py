"""From the Model's units (mm, N, g, ms, rad) to those of MotionView (mm, N, kg, s; angles in degrees)."""

from __future__ import annotations

import math


def number(value: float) -> str:
    """A number as it stands in the text: the shortest that reads back as the same float."""
    return repr(float(value) + 0.0)  # + 0.0 turns -0.0 into 0.0


def _fifteen(value: float) -> float:
    """`value` to 15 digits, so that 0.72 g is 0.00072 kg, 0.1867 rad/ms 186.7 rad/s and 10 deg 10.0."""
    return float(f"{value:.15g}")


def mdl_value(value: float, unit: str) -> float:
    """`value` in the unit that MotionView has for the internal `unit`.

    Raises KeyError for a unit that no Parameter has.
    """
    return {
        "mm": lambda: value,
        "N": lambda: value,
        "1": lambda: value,
        "MPa": lambda: value,
        "N/mm": lambda: value,
        "N*mm": lambda: value,
        "N*mm/rad": lambda: value,
        "N/mm^1.5": lambda: value,
        "g": lambda: _fifteen(value / 1000),
        "g/mm^3": lambda: _fifteen(value / 1000),
        "g*mm^2": lambda: _fifteen(value / 1000),
        "N*mm*ms/rad": lambda: _fifteen(value / 1000),
        "ms": lambda: _fifteen(value / 1000),
        "1/ms": lambda: _fifteen(value * 1000),
        "mm/ms": lambda: _fifteen(value * 1000),
        "rad/ms": lambda: _fifteen(value * 1000),
        "mm/ms^2": lambda: _fifteen(value * 1e6),
        "rad": lambda: _fifteen(math.degrees(value)),
    }[unit]()


# What a label names as the unit where the label has none yet.
SHOWN = {"mm": "mm", "g": "kg", "ms": "s", "mm/ms": "mm/s", "N/mm": "N/mm"}


def with_unit(label: str, unit: str) -> str:
    """`label` with the unit that MotionView shows the value in."""
    shown = SHOWN.get(unit)
    if shown is None or label.endswith(f"({shown})"):
        return label
    return f"{label}, {shown}" if label.endswith(")") else f"{label} ({shown})"
