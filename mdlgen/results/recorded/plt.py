"""MotionSolve's plot file (.plt), which is text.

Seen: a file that MotionSolve 2022 wrote, and a public reader that was checked against HyperGraph.

    MotionSolve v9.1 Plot File
    Generated on ..
    requests, system of units, a factor
    for each request: id, type, markers, length of its label over four
                      its label
    for each time:    the time [s]
                      for each request its six numbers, with six digits
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mdlgen.errors import OutputError
from mdlgen.results.recorded.recording import Recording, damaged, increasing

HEAD = "Plot File"
UNITS = "MMKGS_N"  # mm, kg, s, N: those of all decks and scripts of mdlgen
_HEADER = 3  # lines before the list of requests


def is_plot(text: str) -> bool:
    """True if a text begins as a plot file does."""
    return text.startswith("MotionSolve") and HEAD in text[:200].split("\n", 1)[0]


def read(text: str, file: Path) -> Recording:
    """A plot file. Raises OutputError with the damaged line."""
    lines = text.splitlines()
    count = _count(lines, file)
    body = _HEADER + 2 * count
    if len(lines) < body:
        raise damaged(file, len(lines), f"the file ends among its {count} requests")
    labels: dict[str, int] = {}  # of several with one label the first keeps it
    for number, k in enumerate(range(_HEADER, body, 2)):
        if not lines[k].split() or not lines[k].split()[0].isdigit():
            raise damaged(file, k + 1, "an id is due here, and the label of a request below it")
        label = " ".join(lines[k + 1].split())
        labels[label if label not in labels else f"{label} (request {number + 1})"] = number
    rows = len(lines) - body
    if rows < count + 1 or rows % (count + 1):
        times = rows // (count + 1)
        what = f"{rows} lines of numbers, not {count + 1} for each time: it ends in that after {times}"
        raise damaged(file, len(lines), what)
    numbers = _numbers(lines, body, count, file)
    at = [body + 1 + k * (count + 1) for k in range(len(numbers))]
    time, values = increasing(file, at, numbers[:, 0], numbers[:, 1:])
    sixes = values.reshape(len(time), count, 6)
    return Recording(str(file), 1000.0 * time, {label: sixes[:, k] for label, k in labels.items()})


def _count(lines: list[str], file: Path) -> int:
    """Number of requests by the third line, in known units."""
    words = lines[2].split() if len(lines) > 2 else []
    if len(words) < 2 or not words[0].isdigit() or not 0 < int(words[0]) <= 1_000_000:
        raise damaged(file, min(len(lines), 3), "the number of requests and their units are due here")
    if not words[1].startswith(UNITS):
        what = f"its units are {words[1][:40]}, not {UNITS}, which decks and scripts of mdlgen have"
        raise damaged(file, 3, what)
    return int(words[0])


def _numbers(lines: list[str], body: int, count: int, file: Path) -> np.ndarray:
    """Time and all numbers of each time, (t, 1 + 6 count)."""
    found = []
    for start in range(body, len(lines), count + 1):
        row: list[float] = []
        for k in range(start, start + count + 1):
            words, due = lines[k].split(), 1 if k == start else 6
            try:
                row += [float(word) for word in words]
            except ValueError:
                raise damaged(file, k + 1, f"{lines[k].strip()[:60]!r} holds what is no number") from None
            if len(words) != due:
                raise damaged(file, k + 1, f"{len(words)} numbers, not {due}")
        found.append(row)
    numbers = np.array(found)
    if not np.isfinite(numbers).all():
        raise OutputError(f"{file}: it holds a number that is not finite")
    return numbers
