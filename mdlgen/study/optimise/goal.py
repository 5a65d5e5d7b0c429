"""The goal of an optimisation: a number to minimise, and conditions that must hold."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from mdlgen.errors import SpecError
from mdlgen.study.design.expression import Value, read
from mdlgen.study.design.measure import check_apart, measures
from mdlgen.study.execution.row import CaseRow

OBJECTIVE, CONDITION = "objective", "condition"
# A condition holds where it is missed by less than this part of the most that it was ever missed or met by.
_HOLDS = 1e-6
_COMPARISON = re.compile(r"<=|>=|==|!=|<|>")


@dataclass(frozen=True)
class Goal:
    """`minimise` is an expression of a run's numbers; `conditions` are texts like `A <= B`, with A - B (or
    B - A) for each, which is to be 0 or less."""

    minimise: str
    conditions: tuple[str, ...]
    margins: tuple[str, ...]

    def measures(self, names: Mapping[str, Value], more: Iterable[str] = ()) -> tuple[tuple[str, str], ...]:
        """Name and expression of what each run is asked for, and `more` as of --measure; `names` are the
        numbers that there are. Raises SpecError."""
        found = measures([f"{OBJECTIVE}={self.minimise}"], names, "--minimise")
        margins = [f"{name}={margin}" for name, margin in zip(self.names, self.margins, strict=True)]
        found += measures(margins, names, "--subject-to")
        rest = measures(more, names, "--measure")
        check_apart([name for name, _ in (*found, *rest)])
        if any(name not in (OBJECTIVE, *self.names) for name, _ in found):
            raise SpecError(f"--minimise: {self.minimise[:80]!r} is a vector; write {self.minimise[:80]}.x")
        return found + rest

    @property
    def names(self) -> tuple[str, ...]:
        """Columns of the conditions in the table."""
        return tuple(f"{CONDITION}_{k}" for k in range(1, len(self.margins) + 1))

    def best(self, rows: Sequence[CaseRow]) -> CaseRow | None:
        """The row of the least objective among those in which all conditions hold; None where none is."""
        known = [row for row in rows if self.complete(row)]
        slack = {
            name: _HOLDS * max((abs(row.measures[name] or 0.0) for row in known), default=0.0)
            for name in self.names
        }
        good = [row for row in known if all((row.measures[n] or 0.0) <= slack[n] for n in self.names)]
        return min(good, key=lambda row: (row.measures[OBJECTIVE], row.index), default=None)

    def complete(self, row: CaseRow) -> bool:
        """True if the run gave every number that the goal asks for."""
        return row.measured and all(row.measures.get(n) is not None for n in (OBJECTIVE, *self.names))


def goal(minimise: str, conditions: Sequence[str]) -> Goal:
    """The goal of `--minimise` and `--subject-to`. Raises SpecError for a condition that compares no two."""
    read(minimise, "--minimise")
    margins = []
    for text in conditions:
        found = _COMPARISON.findall(text)
        sides = _COMPARISON.split(text)
        if len(found) != 1 or found[0] in ("==", "!="):
            raise SpecError(f"--subject-to: {text[:80]!r} is not A <= B or A >= B")
        low, high = sides if found[0] in ("<", "<=") else reversed(sides)
        for side in (low, high):
            read(side, "--subject-to")
        margins.append(f"({low.strip()}) - ({high.strip()})")
    return Goal(minimise.strip(), tuple(text.strip() for text in conditions), tuple(margins))
