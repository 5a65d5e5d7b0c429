"""A file of another program: times, and six numbers of each request, or series by name."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from mdlgen.errors import OutputError
from mdlgen.model.tables import Floats

SIX = ("f2", "f3", "f4", "f6", "f7", "f8")
"""Components of a request as MotionSolve counts them: f1 and f5 are sizes, which files do not hold."""


@dataclass(frozen=True)
class Recording:
    """Times [ms] and what was recorded; in mm, N, kg, s, rad."""

    file: str
    time: Floats  # [ms], increasing, (t,)
    requests: dict[str, Floats] = field(default_factory=dict)  # by label, nan: not in the file, (t, 6)
    series: dict[str, Floats] = field(default_factory=dict)  # by column of series.csv, (t,)


def damaged(file: Path, line: int, message: str) -> OutputError:
    """An error with its file and line."""
    return OutputError(f"{file}:{line}: {message}")


def increasing(file: Path, lines: list[int], time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Rows whose times increase: of several at one time the last one counts, as MotionSolve has it.

    `lines` are those of the times. Raises OutputError for a time before the one above it.
    """
    steps = np.diff(time)
    back = np.flatnonzero(steps < 0.0)
    if len(back):
        raise damaged(file, lines[int(back[0]) + 1], "a time before the one above it")
    last = np.append(steps > 0.0, True)
    return time[last], values[last]
