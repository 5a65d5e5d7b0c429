"""Findings of a sweep as a whole: probabilities of events, effects, interactions and Sobol's indices."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np

from mdlgen.results.summary import plain
from mdlgen.study.analysis.effects import (
    Indices,
    MainEffect,
    interaction,
    is_constant,
    main_effect,
    sobol,
)
from mdlgen.study.analysis.probability import caveat, probability
from mdlgen.study.analysis.table import Column
from mdlgen.study.design.task import Task
from mdlgen.study.execution.row import CaseRow

# Effects are printed on a terminal for so many measures; findings.json has all.
_SHOWN = 6
# An interaction of less than this part of the variance is not listed, nor one of more variables than this.
_SLIGHT, _MOST_VARIABLES = 0.01, 10


def findings(task: Task, how: str, rows: Sequence[CaseRow], columns: Sequence[Column]) -> dict[str, Any]:
    """Plain data for findings.json and the page; `columns` are the table's, `how` is the sweep's."""
    kind = how.partition(" ")[0]
    paths = [path for path, _ in rows[0].values]
    table = {column.name: column for column in columns}
    record: dict[str, Any] = {
        "cases": len(rows),
        "without_measures": sum(not row.measured for row in rows),
        "how": how,
        "events": {name: _event(task, name, table[name], kind) for name in task.events},
        "constant": {},
        "effects": {},
        "interactions": {},
        "indices": {},
    }
    names = [name for name, _ in task.measures if name not in task.events]
    for name in (*task.events, *names):
        measure = [float("nan") if cell is None else float(cell) for cell in table[name].cells]
        known = np.array([value for value in measure if np.isfinite(value)])
        if is_constant(known):  # a finding about it would be one about round-off
            if len(known) and name in names:
                record["constant"][name] = float(known[0])
            continue
        effects = {path: main_effect(places(table[path]), measure) for path in paths}
        record["effects"][name] = {path: _effect(found) for path, found in effects.items() if found}
        record["interactions"][name] = _interactions(paths, table, measure)
        if kind == "saltelli":
            found = sobol(measure, len(paths))
            record["indices"][name] = dict(zip(paths, map(_indices, found), strict=True)) if found else {}
    return plain(record)


def places(column: Column) -> list[float]:
    """Numbers for the cells: themselves, or of texts which one it is, in the order in which they come."""
    if all(isinstance(cell, (int, float)) for cell in column.cells):
        return [float(cell) for cell in column.cells]  # pyright: ignore[reportArgumentType]
    order = {cell: k for k, cell in enumerate(dict.fromkeys(column.cells))}
    return [float(order[cell]) for cell in column.cells]


def _event(task: Task, name: str, column: Column, kind: str) -> dict[str, Any]:
    known = [cell for cell in column.cells if cell is not None]
    found = probability(sum(bool(cell) for cell in known), len(known), len(column.cells) - len(known))
    return {
        "expression": dict(task.measures)[name],
        **vars(found),
        "part": found.value,
        "caveat": caveat(kind),
    }


def _effect(found: MainEffect) -> dict[str, Any]:
    return {"share": found.share, "range": found.range, "groups": [vars(group) for group in found.groups]}


def _interactions(
    paths: Sequence[str], table: dict[str, Column], measure: Sequence[float]
) -> list[dict[str, Any]]:
    """Interactions of two variables, the greatest first."""
    found: list[dict[str, Any]] = []
    for one, other in combinations(paths[:_MOST_VARIABLES], 2):
        share = interaction(places(table[one]), places(table[other]), measure)
        if share is not None and share >= _SLIGHT:
            found.append({"variables": [one, other], "share": share})
    return sorted(found, key=lambda row: -row["share"])


def _indices(found: Indices) -> dict[str, Any]:
    return {"first": vars(found.first), "total": vars(found.total)}


def findings_text(record: dict[str, Any]) -> list[str]:
    """Lines for a terminal."""
    lines = []
    for name, event in record["events"].items():
        line = f"probability of {name}: {_interval(event['part'], event)} with {_percent(event['level'])}"
        line += f", {event['hits']} of {event['known']} cases"
        if event["failed"]:
            line += f"; {event['failed']} cases without an answer could have gone either way"
        lines += [line, *([f"  {event['caveat']}"] if event["caveat"] else [])]
    for name, variables in list(record["indices"].items())[:_SHOWN]:
        for path, found in variables.items():
            first, total = (_interval(found[o]["value"], found[o]) for o in ("first", "total"))
            lines.append(f"{name}, part of its variance by {path}: alone {first}, with others {total}")
    if not record["indices"]:
        for name, variables in list(record["effects"].items())[:_SHOWN]:
            if len(variables) > 1:
                order = sorted(variables.items(), key=lambda item: -item[1]["share"])
                shares = ", ".join(f"{path} {_percent(found['share'])}" for path, found in order)
                line = f"{name}, part of its variance by each value alone: {shares}"
                both = record["interactions"].get(name, ())
                if both:
                    line += "; beyond that together: " + ", ".join(
                        f"{' and '.join(row['variables'])} {_percent(row['share'])}" for row in both[:_SHOWN]
                    )
                lines.append(line)
    if record["constant"]:
        values = ", ".join(f"{name} {value:.4g}" for name, value in list(record["constant"].items())[:_SHOWN])
        lines.append(f"the same in all cases: {values}")
    return lines


def _percent(part: float) -> str:
    return f"{100.0 * part:.0f} %"


def _interval(value: float | None, ends: dict[str, float]) -> str:
    return f"{'none' if value is None else f'{value:.3g}'} ({ends['low']:.3g} to {ends['high']:.3g})"
