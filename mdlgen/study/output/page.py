"""study.html: a study in a page that stands alone; figures of its cases, and how each is opened."""

from __future__ import annotations

import json
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mdlgen.paths import templates, write_atomic
from mdlgen.report import PAGE
from mdlgen.report.html.environment import environment
from mdlgen.study.analysis.table import Column
from mdlgen.study.analysis.table import columns as table
from mdlgen.study.design.case import Case
from mdlgen.study.design.task import Task
from mdlgen.study.execution.row import CaseRow
from mdlgen.study.optimise.goal import OBJECTIVE
from mdlgen.study.optimise.optimisation import Optimisation
from mdlgen.study.output.fragment import options

NAME = "study.html"
# More lines than these no browser draws at ease, and no reader can distinguish.
MOST_DRAWN = 5000
_SCRIPTS = ("drawing.js", "study.js")
_ELSEWHERE = ("status", "reason", "solver")  # columns that the page has in other places
_STATES = "result.h5"


def page(
    folder: Path,
    title: str,
    how: str,
    task: Task,
    rows: Sequence[CaseRow],
    columns: Sequence[Column],
    found: dict[str, Any] | None = None,
    best: CaseRow | None = None,
    objective: str = "",
    met: Sequence[bool] = (),
) -> str:
    """The page of a study in `folder`; `columns` are those of its table, `found` its findings.

    For an optimisation `objective` is the column to minimise, `best` the best row, and `met` is true for rows
    whose conditions hold. Every name and text is escaped.
    """
    rows = sorted(rows, key=lambda row: row.index)
    drawn = rows[:MOST_DRAWN]
    failed = [row for row in rows if not row.measured]
    record = {
        "columns": [_column(column, task, len(drawn)) for column in columns if column.name not in _ELSEWHERE],
        "kind": [row.kind for row in drawn],
        "reason": ["" if row.ok else row.status for row in drawn],
        "links": [_link(folder, row) for row in drawn],
        "commands": [_command(folder, task, row) for row in drawn],
        "best": rows.index(best) if best in rows[:MOST_DRAWN] else None,
        "objective": objective,
        "met": list(met[:MOST_DRAWN]),
    }
    data = json.dumps(record, allow_nan=False, separators=(",", ":"))
    place = templates() / "report"
    return (
        environment()
        .get_template("study.html.j2")
        .render(
            title=title,
            headline=f"{len(rows)} cases: {how}",
            best=f"Best: case {best.index}, " + ", ".join(f"{p} = {t}" for p, t in best.values)
            if best
            else "",
            cases=len(rows),
            drawn=len(drawn),
            failed=len(failed),
            reasons=_reasons(failed),
            found=found,
            spec=task.spec,
            source=task.text + "".join(f"# --set {item}\n" for item in task.sets),
            # inside a script element nothing may look like markup
            data=data.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"),
            style=(place / "style.css").read_text("utf-8"),
            scripts=[(place / name).read_text("utf-8") for name in _SCRIPTS],
        )
    )


def _column(column: Column, task: Task, count: int) -> dict[str, Any]:
    names = {name for name, _ in task.measures}
    role = "measure" if column.name in names else "variable"
    role = {"case": "case", "error_estimate": "error"}.get(column.name, role)
    cells = list(column.cells[:count])
    return {
        "name": column.name,
        "unit": column.unit,
        "role": role,
        "event": column.name in task.events,
        "cells": cells,
    }


def _link(folder: Path, row: CaseRow) -> str:
    """Link to the report of a stored case; "" for others."""
    name = Case(row.index, row.values).name
    return f"{name}/{PAGE}" if (folder / name / PAGE).is_file() else ""


def _command(folder: Path, task: Task, row: CaseRow) -> str:
    """The command that shows the run of a case: the page of a stored run, or the run itself."""
    case = Case(row.index, row.values)
    place = folder / case.name
    if (place / _STATES).is_file():
        return f"mdlgen view {shlex.quote(str(place))}"
    words = [f"mdlgen run {shlex.quote(task.spec)} {options(task.overrides(case))}"]
    words += [f"--limit {shlex.quote(limit)}" for limit in task.limits]
    if task.solver != "auto":
        words.append(f"--solver {task.solver}")
    if task.check_step:
        words.append("--check-step")
    return " ".join([*words, f"-o {shlex.quote(str(place))}"])


def _reasons(failed: Sequence[CaseRow]) -> list[dict[str, Any]]:
    """Why cases have no measures, the most frequent reason first, with some of the cases."""
    groups: dict[str, list[int]] = {}
    for row in failed:
        groups.setdefault(row.status, []).append(row.index)
    most = sorted(groups.items(), key=lambda item: (-len(item[1]), item[1][0]))[:200]
    return [
        {
            "count": len(which),
            "text": text,
            "which": ", ".join(map(str, which[:20])) + (", ..." if len(which) > 20 else ""),
        }
        for text, which in most
    ]


def write_page(folder: Path, found: Optimisation, rows: Sequence[CaseRow], best: CaseRow | None) -> Path:
    """Writes the page of an optimisation. Raises OutputError."""
    goal = found.goal
    columns = table(rows, [name for name, _ in found.task.measures])
    how = f"least {goal.minimise}" + "".join(f", with {condition}" for condition in goal.conditions)
    met = [goal.best([row]) is not None for row in sorted(rows, key=lambda row: row.index)]
    text = page(
        folder, found.name, f"{how} ({found.how})", found.task, rows, columns, None, best, OBJECTIVE, met
    )
    write_atomic(folder / NAME, text)
    return folder / NAME
