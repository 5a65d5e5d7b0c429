"""Entities of one kind as a table, and how far one table is from another.

Units are those of the text: mm, N, kg, s, rad.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from mdlgen.model.tables import Floats

LIMIT = 1e-12
"""Largest relative difference that passes."""

ANY = "*"
"""A word that may be any."""

Words = tuple[tuple[str, ...], ...]
Part = tuple[Floats, Floats | float | None]  # numbers (n, w); their scale, or None: each for itself


@dataclass(frozen=True)
class Table:
    """Numbers and words of entities, one row each.

    `scale` is what a difference is divided by: the size of the number itself, or where a number may be a
    sum that cancels (a coordinate, an axis) the size of the terms.
    """

    names: tuple[str, ...]
    columns: tuple[str, ...]
    numbers: Floats  # (n, columns)
    scale: Floats  # (n, columns)
    words: Words = field(default=())

    @cached_property
    def index(self) -> dict[str, int]:
        """Row by name."""
        return {name: row for row, name in enumerate(self.names)}

    def only(self, keep: Callable[[str], bool]) -> Table:
        """The rows with the chosen names."""
        rows = [k for k, name in enumerate(self.names) if keep(name)]
        words = tuple(self.words[k] for k in rows) if self.words else ()
        names = tuple(self.names[k] for k in rows)
        return Table(names, self.columns, self.numbers[rows], self.scale[rows], words)

    def without(self, column: int) -> Table:
        """The table without one of its columns."""
        keep = [k for k in range(len(self.columns)) if k != column]
        names = tuple(self.columns[k] for k in keep)
        return Table(self.names, names, self.numbers[:, keep], self.scale[:, keep], self.words)

    def updated(self, other: Table) -> Table:
        """This table with the rows of another one in place of its own; names that are new are left out."""
        rows = [(self.index[name], k) for k, name in enumerate(other.names) if name in self.index]
        if not rows:
            return self
        mine, theirs = zip(*rows, strict=True)
        numbers = self.numbers.copy()
        numbers[list(mine)] = other.numbers[list(theirs)]
        return Table(self.names, self.columns, numbers, self.scale, self.words)


def table(
    names: Iterable[str], parts: Mapping[str, Part], words: Sequence[Sequence[str]] | None = None
) -> Table:
    """A table from named groups of columns; `cm` of width 3 becomes `cm.0`, `cm.1`, `cm.2`."""
    names = tuple(names)
    columns: list[str] = []
    numbers, scales = [np.zeros((len(names), 0))], [np.zeros((len(names), 0))]
    for name, (values, scale) in parts.items():
        values = np.asarray(values, float)
        width = math.prod(values.shape[1:])
        values = values.reshape(len(names), width)
        columns += [name] if width == 1 else [f"{name}.{k}" for k in range(width)]
        numbers.append(values)
        scales.append(np.abs(values) if scale is None else np.broadcast_to(scale, values.shape))
    found = tuple(tuple(row) for row in words) if words is not None else ()
    return Table(names, tuple(columns), np.hstack(numbers), np.hstack(scales), found)


class Difference(NamedTuple):
    """One thing that is not as the Model has it."""

    kind: str
    name: str
    what: str

    def __str__(self) -> str:
        return f"{self.kind} {self.name}: {self.what}" if self.name else f"{self.kind}: {self.what}"


class Compared(NamedTuple):
    """One kind, compared."""

    kind: str
    entities: int
    largest: float  # relative
    where: str  # entity and column of the largest
    differences: tuple[Difference, ...]  # those above LIMIT, names that are missing, words that differ


def compare(kind: str, expected: Table, found: Table | None, words: bool = True) -> Compared:
    """Difference of `found` from `expected`."""
    if found is None:
        found = Table((), expected.columns, np.zeros((0, len(expected.columns))), np.zeros((0, 0)))
    differences = _names(kind, expected, found)
    same = expected.names == found.names
    rows = [n for n in expected.names if same or n in found.index]
    mine = slice(None) if same else [expected.index[n] for n in rows]
    theirs = slice(None) if same else [found.index[n] for n in rows]
    if len(expected.columns) != len(found.columns):
        raise ValueError(f"{kind} has {len(found.columns)} columns, not {len(expected.columns)}")
    want, have = expected.numbers[mine], found.numbers[theirs].reshape(len(rows), len(expected.columns))
    away = np.abs(have - want)
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(away == 0.0, 0.0, away / np.maximum(np.abs(want), expected.scale[mine]))
    relative = np.where(np.isnan(relative), np.inf, relative)
    for row, column in zip(*np.nonzero(relative > LIMIT), strict=True):
        what = f"{expected.columns[column]} is {have[row, column]:.15g}, not {want[row, column]:.15g}"
        differences.append(Difference(kind, rows[row], what))
    if words and expected.words and found.words:
        differences += _words(kind, rows, expected, found)
    largest, where = 0.0, ""
    if relative.size and np.max(relative) > 0.0:
        row, column = np.unravel_index(int(np.argmax(relative)), relative.shape)
        largest, where = float(relative[row, column]), f"{rows[int(row)]} {expected.columns[int(column)]}"
    return Compared(kind, len(expected.names), largest, where, tuple(differences))


def _names(kind: str, expected: Table, found: Table) -> list[Difference]:
    if expected.names == found.names:
        return []
    return [
        *(Difference(kind, n, "is missing") for n in expected.names if n not in found.index),
        *(Difference(kind, n, "is not in the Model") for n in found.names if n not in expected.index),
    ]


def _words(kind: str, rows: list[str], expected: Table, found: Table) -> list[Difference]:
    differences = []
    for name in rows:
        want, have = expected.words[expected.index[name]], found.words[found.index[name]]
        odd = [
            f"{h or 'nothing'}, not {w or 'nothing'}"
            for w, h in zip(want, have, strict=False)
            if w not in (h, ANY)
        ]
        if len(want) != len(have):
            odd.append(f"{len(have)} words, not {len(want)}")
        if odd:
            differences.append(Difference(kind, name, "; ".join(odd)))
    return differences
