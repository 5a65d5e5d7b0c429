"""Converts from the Model's units (mm, N, g, ms, rad) to those of MotionView (mm, N, kg, s; angles in
degrees)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mdlgen.units import parse_unit, same


def number(value: float) -> str:
    """A number as written in the text: the shortest that reads back as the same float."""
    return repr(float(value) + 0.0)  # + 0.0 turns -0.0 into 0.0


def _fifteen(value: float) -> float:
    """`value` to 15 digits, so that 0.72 g is 0.00072 kg, 0.1867 rad/ms 186.7 rad/s and 10 deg 10.0."""
    return float(f"{value:.15g}")


def factor(dimension: Sequence[float]) -> float:
    """Factor from internal units (mm, g, ms, rad) to those of a formula, for a value of a dimension. Formulas
    use mm, N, s, rad, and so N s^2/mm for a mass."""
    return 1e-6 ** dimension[1] * 1e-3 ** dimension[2]


def in_kg(dimension: Sequence[float]) -> bool:
    """True if an MDL file has values of this dimension in kg: masses, densities, inertias."""
    return dimension[1] == 1.0 and dimension[2] == 0.0


def in_degrees(dimension: Sequence[float]) -> bool:
    """True if an MDL file has values of this dimension in degrees."""
    return same(dimension, (0.0, 0.0, 0.0, 1.0))


def mdl_value(value: float, unit: str) -> float:
    """`value` in the unit that MotionView has for the internal `unit`."""
    dimension = parse_unit(unit).dimension
    if in_degrees(dimension):
        return _fifteen(math.degrees(value))
    scale = 1e-3 if in_kg(dimension) else factor(dimension)
    if abs(scale - 1.0) < 1e-9:
        return value
    return _fifteen(value / round(1 / scale) if scale < 1.0 else value * round(scale))


# Units that are added to labels without a unit.
SHOWN = {"mm": "mm", "g": "kg", "ms": "s", "mm/ms": "mm/s", "mm/ms^2": "mm/s2", "N/mm": "N/mm"}


def with_unit(label: str, unit: str) -> str:
    """`label` with the unit that MotionView shows the value in."""
    shown = SHOWN.get(unit)
    if shown is None or label.endswith(f"({shown})"):
        return label
    return f"{label}, {shown}" if label.endswith(")") else f"{label} ({shown})"
