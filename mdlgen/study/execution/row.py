"""The outcome of one case: a row of the table."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

# Kinds of outcomes of a case. `inaccurate` has its measures, and an error estimate above run.tolerance;
# `refused`
# is a scene that cannot be meant or run; `failed` a run that ended with its reason; `lost` one that nothing
# is known of, because its process died: a resumed study runs it again.
OK, INACCURATE, REFUSED, FAILED, LOST = "ok", "inaccurate", "refused", "failed", "lost"


@dataclass(frozen=True)
class Times:
    """Times of a case [s]: solving, its error estimate, its preparation, all of it."""

    wall_s: float = 0.0
    estimate_s: float = 0.0
    build_s: float = 0.0
    compile_s: float = 0.0
    case_s: float = 0.0
    cpu_s: float = 0.0  # of the process, in all of it


@dataclass(frozen=True)
class CaseRow:
    """A case with its measures, or with the reason that there are none."""

    index: int
    values: tuple[tuple[str, str], ...]
    kind: str  # OK ...
    status: str  # "ok", or the reason
    measures: dict[str, float | None] = field(default_factory=dict)  # None: this run has no such number
    error_estimate: float | None = None
    solver: str = ""
    times: Times = Times()
    worker: str = ""
    # files of the run where they are stored, by name; not in the journal
    files: dict[str, bytes] = field(default_factory=dict, compare=False, repr=False)

    @property
    def ok(self) -> bool:
        return self.kind == OK

    @property
    def measured(self) -> bool:
        """True if there are measures."""
        return self.kind in (OK, INACCURATE)

    def json(self) -> dict[str, Any]:
        """The row in the form of the journal."""
        record = asdict(self)
        del record["files"]
        return record

    @classmethod
    def of(cls, record: dict[str, Any]) -> CaseRow:
        """The inverse of `json`. Raises KeyError, TypeError or ValueError for other data."""
        if record["kind"] not in (OK, INACCURATE, REFUSED, FAILED, LOST):
            raise ValueError(f"{record['kind']!r} is no kind of row")
        values = tuple((str(path), str(text)) for path, text in record["values"])
        measures = {str(k): None if v is None else float(v) for k, v in record["measures"].items()}
        typed = {"index": int(record["index"]), "values": values, "measures": measures}
        return cls(**{**record, **typed, "times": Times(**record["times"])})
