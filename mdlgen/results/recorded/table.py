"""Tables with a head of names (CSV): of requests, as a script of mdlgen writes them, or of a series.csv.

The first column is the time, in s unless its name says ms. A column of a request is called by its label and
the component, `o_lead.f2` or `Probe lead: position, velocity F2`; one of series.csv as there.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np

from mdlgen.model.tables import Floats
from mdlgen.results.recorded.recording import SIX, Recording, damaged, increasing

_COMPONENT = re.compile(r"(.*?)[\s.,/|:_-]+(f[2-8])", re.I)
_TIME = re.compile(r"time\b|time_", re.I)


def is_table(text: str) -> bool:
    """True if a text begins with a head whose first name is the time."""
    return _TIME.match(text.lstrip("\ufeff\"' \t")) is not None


def read(text: str, file: Path) -> Recording:
    """A table. Raises OutputError with the damaged line."""
    lines = text.lstrip("\ufeff").splitlines()
    rows = list(csv.reader(lines, delimiter=_delimiter(lines[0])))
    head = [" ".join(name.split()) for name in rows[0]]
    at = [k for k, row in enumerate(rows) if k and any(cell.strip() for cell in row)]
    if not at:
        raise damaged(file, 1, "there is no row below the names of the columns")
    found = []
    for k in at:
        if len(rows[k]) != len(head):
            raise damaged(file, k + 1, f"{len(rows[k])} columns, not {len(head)} as the names say")
        try:
            found.append([float(cell) for cell in rows[k]])
        except ValueError:
            raise damaged(file, k + 1, "a cell is no number") from None
    numbers = np.array(found)
    if not np.isfinite(numbers[:, 0]).all():
        raise damaged(file, 2, "a time is not finite")
    time, values = increasing(file, [k + 1 for k in at], numbers[:, 0], numbers[:, 1:])
    unit = 1.0 if re.search(r"(?<![a-z])ms\b|_ms\b", head[0], re.I) else 1000.0
    requests: dict[str, Floats] = {}
    series: dict[str, Floats] = {}
    for k, name in enumerate(head[1:]):
        component = _COMPONENT.fullmatch(name)
        if component is None or component[2].lower() not in SIX:
            series[name] = values[:, k]
            continue
        six = requests.setdefault(component[1], np.full((len(time), 6), np.nan))
        six[:, SIX.index(component[2].lower())] = values[:, k]
    return Recording(str(file), unit * time, requests, series)


def _delimiter(head: str) -> str:
    """The sign that parts the names most often."""
    return max(",;\t", key=head.count)
