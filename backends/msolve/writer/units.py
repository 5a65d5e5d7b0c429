"""Converts from the Model's units (mm, N, g, ms, rad) to those of the script (mm, N, kg, s, rad)."""

from __future__ import annotations

from typing import Any

from mdlgen.model.tables import Floats

Row = list[float]


def same(value: float) -> float:
    """Lengths, forces, angles, stiffness: a plain float, without a negative zero."""
    return float(value) + 0.0


def per_thousand(value: float) -> float:
    """g in kg, ms in s, N ms/mm in N s/mm, to 15 digits: 0.72 g is 0.00072 kg."""
    return float(f"{float(value) / 1000:.15g}") + 0.0


def thousandfold(value: float) -> float:
    """mm/ms in mm/s, rad/ms in rad/s."""
    return float(f"{float(value) * 1000:.15g}") + 0.0


def acceleration(value: float) -> float:
    """mm/ms^2 in mm/s^2."""
    return float(f"{float(value) * 1e6:.15g}") + 0.0


def row(values: Floats | list[float], convert: Any = same) -> Row:
    """Numbers one by one."""
    return [convert(v) for v in values]


def axes(rotation: Floats) -> list[Row]:
    """Axes of columns, (3, 3), as x, y and z."""
    return [row(rotation[:, k]) for k in range(3)]
