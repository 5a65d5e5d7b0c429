"""Measurements: one static drop, or a drop over time read from a CSV file."""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.model.tables import Floats
from mdlgen.paths import read_text
from mdlgen.units import parse_quantity

# A header cell: the name, then a unit in brackets or behind an underscore or blank.
_COLUMN = re.compile(r"(time|drop)(?:[\s_]*[\[(]\s*([^\])]+?)\s*[\])]|[\s_]+(\S+))?", re.IGNORECASE)
_UNITS = {"time": "ms", "drop": "mm"}
# A curve of fewer points than this says nothing of a decay.
_LEAST = 3


@dataclass(frozen=True)
class Decay:
    """A measured curve: drop along gravity from the start of the scene [mm] over time [ms], (n,) each."""

    time: Floats
    drop: Floats


def read_measured(text: str) -> float | Decay:
    """`60.76 mm` as a drop [mm], or the name of a CSV file as a Decay.

    Raises SpecError for what is neither, OutputError for a file that cannot be read.
    """
    if text.lower().endswith(".csv") or Path(text[:4000]).is_file():
        return _curve(Path(text))
    try:
        drop = parse_quantity(text, "mm")
    except ValueError as error:
        raise SpecError(f"--measured: {error}; or name a file .csv") from None
    if drop <= 0.0:
        raise SpecError(f"--measured: {text.strip()} is no drop: it counts along gravity and is above zero")
    return drop


def _curve(path: Path) -> Decay:
    text = read_text(path)
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if line.strip() and line[0] != "#"]
    if not lines:
        raise SpecError(f"{path}: holds no table; its first line names the columns: time_ms,drop_mm")
    separator = next((c for c in ";\t" if c in lines[0][1]), ",")
    rows = csv.reader(io.StringIO("\n".join(line for _, line in lines)), delimiter=separator)
    columns = _columns(path, next(rows))
    width = max(column for column, _ in columns.values())
    values: list[list[float]] = []
    for (number, _), row in zip(lines[1:], rows, strict=False):
        if len(row) <= width:
            raise SpecError(f"{path}:{number}: has {len(row)} columns; expected {width + 1}")
        values.append([_number(path, number, row[column]) * scale for column, scale in columns.values()])
    if len(values) < _LEAST:
        raise SpecError(f"{path}: has {len(values)} points; a curve needs {_LEAST} at least")
    time, drop = np.array(values).T
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if time[0] < 0.0 or len(back):
        number = lines[1 + (int(back[0]) + 1 if len(back) else 0)][0]
        raise SpecError(f"{path}:{number}: time must grow from line to line, from 0 at the scene's start on")
    if not (drop > 0.0).any():
        raise SpecError(f"{path}: no drop is above zero; drops count along gravity")
    return Decay(time, drop)


def _columns(path: Path, header: list[str]) -> dict[str, tuple[int, float]]:
    """Column and factor to internal units of `time` and of `drop`; ms and mm where no unit stands."""
    found: dict[str, tuple[int, float]] = {}
    for index, cell in enumerate(header):
        match = _COLUMN.fullmatch(cell.strip())
        if match is None:
            continue
        name = match[1].lower()
        if name in found:
            raise SpecError(f"{path}:1: the column {name} stands twice")
        try:
            factor = parse_quantity(f"1 {match[2] or match[3] or _UNITS[name]}", _UNITS[name])
        except ValueError as error:
            raise SpecError(f"{path}:1: column {name}: {error}") from None
        found[name] = (index, factor)
    if len(found) < len(_UNITS):
        names = ", ".join(cell.strip()[:40] for cell in header)
        raise SpecError(f"{path}:1: needs the columns time and drop, as time_ms,drop_mm; has: {names}")
    return {name: found[name] for name in _UNITS}


def _number(path: Path, line: int, cell: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise SpecError(f"{path}:{line}: {cell.strip()[:40]!r} is not a finite number")
    return value
