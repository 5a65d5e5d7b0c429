"""What the rows say together: order of a step, wall time at equal error, growth with the boxes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from mdlgen.bench.row import OK, Row

# The error at which solvers are compared: 0.2 % of the travel.
EQUAL_ERROR = 2e-3
# An estimate of the error is honest between these parts of the true error, where that is not tiny.
HONEST, SMALL = (0.5, 10.0), 1e-6
Line = tuple[str, list[float], list[float]]


def lines(rows: Iterable[Row]) -> list[Line]:
    """(label, errors, wall times [s]) of each solver and grid of `transport`, finest step first."""
    groups: dict[str, list[Row]] = {}
    for row in rows:
        if row.suite == "transport" and row.status == OK and row.quantity.startswith("position"):
            groups.setdefault(f"{row.solver}, {row.boxes} boxes", []).append(row)
    found = []
    for label, group in groups.items():
        good = [row for row in group if row.error and row.wall_s]
        good.sort(key=lambda row: row.step_s or 0.0)
        if good:
            found.append((label, [row.error or 0.0 for row in good], [row.wall_s or 0.0 for row in good]))
    return found


def wall_at(error: float, errors: list[float], walls: list[float]) -> tuple[float, bool] | None:
    """Wall time [s] at an error, on the straight line through log error and log wall time; and whether it
    lies outside what was measured. None with fewer than two errors."""
    if len(set(errors)) < 2:
        return None
    power, start = np.polyfit(np.log(errors), np.log(walls), 1)
    outside = not min(errors) <= error <= max(errors)
    return math.exp(start + power * math.log(error)), outside


def slope(points: list[tuple[float, float]]) -> float:
    """Exponent p of y = c x^p through points (x, y)."""
    x, y = np.log(np.array(points)).T
    return float(np.polyfit(x, y, 1)[0])


def fits(rows: list[Row]) -> dict[str, Any]:
    """Plain data: `order` per case and solver, `wall_at_equal_error` per line, `growth` per solver, and the
    estimates of the error that are not honest."""
    equal = {}
    for label, errors, walls in lines(rows):
        found = wall_at(EQUAL_ERROR, errors, walls)
        if found is not None:
            equal[label] = {"error": EQUAL_ERROR, "wall_s": found[0], "extrapolated": found[1]}
    return {
        "order": _orders(rows),
        "wall_at_equal_error": equal,
        "growth": _growth(rows),
        "estimates_off": _off(rows),
    }


def _off(rows: list[Row]) -> list[str]:
    """Rows whose solver estimated its error below half of the true one, or above ten times it."""
    found = []
    for row in rows:
        if row.error_estimate is None or row.error is None or not row.quantity.startswith("position"):
            continue
        low, high = HONEST[0] * row.error, HONEST[1] * max(row.error, SMALL)
        if not low <= row.error_estimate <= high:
            told = f"estimated {row.error_estimate:.3g}, is {row.error:.3g}"
            found.append(f"{row.suite}, {row.solver}: {row.case}: {told}")
    return found


def _orders(rows: list[Row]) -> dict[str, float]:
    """Slope of log error over log step where a step was given, or over log rows in `elastica`."""
    groups: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        if row.status != OK or not row.error:
            continue
        if row.suite == "elastica":
            columns, _, rest = row.case.partition(" columns, ")
            count, _, bending = rest.partition(" rows, ")
            label = f"elastica, {row.solver}: {columns} columns, {bending}"
            groups.setdefault(label, []).append((1 / float(count), row.error))
        elif row.step_s and "step given" in row.case:
            label = f"{row.suite}, {row.solver}: {row.quantity.partition(',')[0]}"
            groups.setdefault(label, []).append((row.step_s, row.error))
    return {label: slope(points) for label, points in groups.items() if len({x for x, _ in points}) > 1}


def _growth(rows: list[Row]) -> dict[str, float]:
    """Exponent of the wall time per step over the boxes, per solver."""
    groups: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        if row.suite == "scaling" and row.status == OK and row.boxes and row.wall_s and row.steps:
            groups.setdefault(row.solver, []).append((row.boxes, row.wall_s / row.steps))
    return {solver: slope(points) for solver, points in groups.items() if len(points) > 1}
