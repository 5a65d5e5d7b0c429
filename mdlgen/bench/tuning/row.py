"""Results of the bench of the numbers: a row for each number and factor, an outcome for each scene."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from mdlgen.bench.tuning.numbers import Number

# The run took more than TIMES the processor time of its reference, and was ended.
CUT = "cut"


@dataclass(frozen=True)
class Reference:
    """The run of a scene with all numbers as they are."""

    scene: str
    meaning: str
    status: str
    ended: bool
    steps: int
    iterations: int
    travel_mm: float  # greatest displacement of a body
    cpu_s: float


@dataclass(frozen=True)
class Outcome:
    """The run of a scene with one number changed, compared with its reference."""

    scene: str
    status: str
    ended: bool  # complete, whatever its error is
    decided: bool  # it ended and its reference did not, or the other way round
    same: bool = False  # bitwise
    moved: float | None = None  # largest difference of a final position over the travel of the reference
    iterations: float | None = None  # over those of the reference
    steps: float | None = None  # over those of the reference, of the last pass


@dataclass(frozen=True)
class TuningRow:
    """One number at one factor."""

    name: str
    factor: float
    value: float
    outcomes: tuple[Outcome, ...]


@dataclass
class Tuning:
    """All numbers, references and rows, with machine and versions."""

    numbers: list[Number]
    machine: dict[str, Any] = field(default_factory=dict)
    versions: dict[str, str] = field(default_factory=dict)
    references: list[Reference] = field(default_factory=list)
    rows: list[TuningRow] = field(default_factory=list)

    def of(self, name: str) -> list[TuningRow]:
        """The rows of a number."""
        return [row for row in self.rows if row.name == name]

    def json(self) -> dict[str, Any]:
        """The content of tuning.json; numbers that are not finite are left out."""
        from mdlgen.results.summary import plain

        return plain(asdict(self))
