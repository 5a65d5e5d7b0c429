"""The files of a study: its table, and of a sweep its findings and its page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from mdlgen.paths import write_together
from mdlgen.study.analysis import table
from mdlgen.study.analysis.findings import findings, findings_text
from mdlgen.study.design.task import Task
from mdlgen.study.execution.row import CaseRow
from mdlgen.study.output.page import NAME, page
from mdlgen.study.sweep import Sweep


def write(folder: Path, task: Task, rows: Sequence[CaseRow], parquet: bool) -> list[Path]:
    """Writes table.csv, times.csv and, where asked for, table.parquet. Raises OutputError, RefusedError."""
    found = table.columns(rows, [name for name, _ in task.measures])
    files: dict[Path, str | bytes] = {
        folder / "table.csv": table.csv_text(found),
        folder / "times.csv": table.csv_text(table.times(rows)),
    }
    if parquet:
        files[folder / "table.parquet"] = table.parquet(found)
    write_together(files)
    return list(files)


def write_findings(folder: Path, wanted: Sweep, rows: Sequence[CaseRow]) -> tuple[list[Path], list[str]]:
    """Writes findings.json and study.html: their names, and the findings in words. Raises OutputError."""
    columns = table.columns(rows, [name for name, _ in wanted.task.measures])
    found = findings(wanted.task, wanted.how, rows, columns)
    files: dict[Path, str | bytes] = {
        folder / "findings.json": json.dumps(found, indent=2, allow_nan=False) + "\n",
        folder / NAME: page(folder, wanted.name, wanted.how, wanted.task, rows, columns, found),
    }
    write_together(files)
    return list(files), findings_text(found)
