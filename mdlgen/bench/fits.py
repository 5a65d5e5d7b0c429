"""Fits over all rows: order of a step, wall time at equal error, growth with the boxes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from mdlgen.bench.row import OK, BenchRow
from mdlgen.bench.suites.piles import LANDING, NAMES
from mdlgen.bench.suites.skip import BUT, EVERY

# The error at which solvers are compared: 0.04 % of the travel, which lies among the errors of both of ours.
EQUAL_ERROR = 4e-4
# An estimate of the error is honest between these parts of the true error, where that is not tiny.
HONEST, SMALL = (0.5, 10.0), 1e-6
Line = tuple[str, list[float], list[float]]


def lines(rows: Iterable[BenchRow]) -> list[Line]:
    """(label, errors, wall times [s]) of each solver and grid of `transport`, finest step first."""
    groups: dict[str, list[BenchRow]] = {}
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


def wall_at(error: float, errors: list[float], walls: list[float]) -> float | None:
    """Wall time [s] at an error, on the straight line through log error and log wall time. None with fewer
    than two errors, and outside of them: where a finer step no longer helps, the line goes anywhere."""
    if len(set(errors)) < 2 or not min(errors) <= error <= max(errors):
        return None
    power, start = np.polyfit(np.log(errors), np.log(walls), 1)
    return math.exp(start + power * math.log(error))


def slope(points: list[tuple[float, float]]) -> float:
    """Exponent p of y = c x^p through points (x, y)."""
    x, y = np.log(np.array(points)).T
    return float(np.polyfit(x, y, 1)[0])


def fits(rows: list[BenchRow]) -> dict[str, Any]:
    """The fits as plain data. Per case and solver: `order`. Per line: `wall_at_equal_error`, and
    `least_error` where that error is not reached. Per solver: `growth`, that of `piles` by kind, and what
    each rule `saves`. And the estimates of errors that are too small."""
    return {
        "order": _orders(rows),
        "wall_at_equal_error": _equal(rows),
        "least_error": _short(rows),
        "growth": _growth(rows),
        "piles": _piles(rows),
        "saves": _saves(rows),
        "estimates_off": _off(rows),
    }


def _equal(rows: list[BenchRow]) -> dict[str, dict[str, Any]]:
    """Wall time of each line at EQUAL_ERROR, and how many times that of the fastest with as many boxes."""
    found: dict[str, dict[str, Any]] = {}
    for label, errors, walls in lines(rows):
        at = wall_at(EQUAL_ERROR, errors, walls)
        if at is not None:
            found[label] = {"error": EQUAL_ERROR, "wall_s": at}
    for label, at in found.items():
        boxes = label.rpartition(", ")[2]
        peers = [other for other in found if other.rpartition(", ")[2] == boxes]
        at["fastest"] = min(peers, key=lambda other: found[other]["wall_s"])
        at["times_fastest"] = at["wall_s"] / found[at["fastest"]]["wall_s"]
    return found


def _short(rows: list[BenchRow]) -> dict[str, dict[str, float]]:
    """The least error of each line that does not come to EQUAL_ERROR, and its wall time."""
    best = {label: min(zip(errors, walls, strict=True)) for label, errors, walls in lines(rows)}
    return {
        label: {"error": error, "wall_s": wall}
        for label, (error, wall) in best.items()
        if error > EQUAL_ERROR
    }


def _saves(rows: list[BenchRow]) -> dict[str, float]:
    """Part of the wall time without a rule that it saves: 1 - with / without, per solver and rule."""
    walls = {
        (row.solver, row.case): row.wall_s
        for row in rows
        if row.suite == "skip" and row.status == OK and row.wall_s
    }
    return {
        f"{solver}: {case.removeprefix(BUT)}": 1 - walls[solver, EVERY] / wall
        for (solver, case), wall in walls.items()
        if case != EVERY and (solver, EVERY) in walls
    }


def _off(rows: list[BenchRow]) -> list[str]:
    """Rows whose solver estimated its error below half of the true one, or above ten times it."""
    found = []
    for row in rows:
        if row.error_estimate is None or row.error is None or not row.quantity.startswith("position"):
            continue
        low, high = HONEST[0] * row.error, HONEST[1] * max(row.error, SMALL)
        if not low <= row.error_estimate <= high:
            message = f"estimated {row.error_estimate:.3g}, is {row.error:.3g}"
            found.append(f"{row.suite}, {row.solver}: {row.case}: {message}")
    return found


def _orders(rows: list[BenchRow]) -> dict[str, float]:
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


def _growth(rows: list[BenchRow]) -> dict[str, float]:
    """Exponent of the wall time over the boxes, for the same time at the same step, per solver."""
    groups: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        if row.suite == "scaling" and row.status == OK and row.boxes and row.wall_s:
            groups.setdefault(row.solver, []).append((row.boxes, row.wall_s))
    return {solver: slope(points) for solver, points in groups.items() if len(points) > 1}


def _piles(rows: list[BenchRow]) -> dict[str, dict[str, float]]:
    """Ratio of the times of a step for a pile and for the smaller one before it in its kind, per solver and
    kind; `notes` is the ratio of their numbers of notes. Piles without sleeping notes are listed again
    without the first milliseconds, in which the notes land."""
    taken: dict[str, dict[int, tuple[float, int]]] = {}
    for row in rows:
        count, _, kind = row.case.partition(" notes ")
        if row.suite == "piles" and row.status == OK and kind and row.wall_s and row.steps:
            taken.setdefault(f"{row.solver}: {kind}", {})[int(count)] = row.wall_s, row.steps
    for label, whole in list(taken.items()):
        landing = taken.get(label.replace(NAMES["awake"], NAMES["lands"]), {})
        if label.endswith(NAMES["awake"]) and landing:
            taken[f"{label}, without the first {LANDING:g} ms"] = {
                notes: (wall - landing[notes][0], steps - landing[notes][1])
                for notes, (wall, steps) in whole.items()
                if notes in landing and wall > landing[notes][0] and steps > landing[notes][1]
            }
    found = {}
    for label, times in taken.items():
        for (before, (wall, steps)), (notes, (longer, more)) in pairwise(times.items()):
            growth = (longer / more) / (wall / steps)
            found[f"{label}, {before} to {notes} notes"] = {"notes": notes / before, "times": growth}
    return found
