"""The table of a study: a row for each case, by index. Its bits do not depend on where and when cases ran."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields

from mdlgen.errors import RefusedError
from mdlgen.study.design.variable import quantity
from mdlgen.study.execution.row import CaseRow, Times

Cell = int | float | str | None
MISSING = (
    "--parquet needs pyarrow, which is not installed: pip install 'mdlgen[sweep]'; table.csv needs nothing"
)


@dataclass(frozen=True)
class Column:
    """`unit` is that of all numbers, "" where they have none, are measures, or are texts."""

    name: str
    unit: str
    cells: tuple[Cell, ...]

    @property
    def title(self) -> str:
        """`rollers.feed.drive.speed [rad/s]`."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


def columns(rows: Sequence[CaseRow], measures: Sequence[str]) -> list[Column]:
    """case; values, as numbers where all have one unit; measures; status, reason, error_estimate, solver."""
    rows = sorted(rows, key=lambda row: row.index)
    paths = [path for path, _ in rows[0].values] if rows else []
    return [
        Column("case", "", tuple(row.index for row in rows)),
        *(_values(path, [row.values[k][1] for row in rows]) for k, path in enumerate(paths)),
        *(Column(name, "", tuple(row.measures.get(name) for row in rows)) for name in measures),
        Column("status", "", tuple(row.kind for row in rows)),
        Column("reason", "", tuple("" if row.ok else row.status for row in rows)),
        Column("error_estimate", "", tuple(row.error_estimate for row in rows)),
        Column("solver", "", tuple(row.solver for row in rows)),
    ]


def _values(path: str, texts: Sequence[str]) -> Column:
    found = [quantity(text) for text in texts]
    units = {None if part is None else part[1] for part in found}
    if len(units) == 1 and None not in units:
        return Column(path, str(units.pop()), tuple(part[0] for part in found if part))
    return Column(path, "", tuple(texts))


def times(rows: Sequence[CaseRow]) -> list[Column]:
    """Time of each case [s], and the worker that ran it."""
    rows = sorted(rows, key=lambda row: row.index)
    took = [asdict(row.times) for row in rows]
    return [
        Column("case", "", tuple(row.index for row in rows)),
        *(Column(f.name, "", tuple(t[f.name] for t in took)) for f in fields(Times)),
        Column("worker", "", tuple(row.worker for row in rows)),
    ]


def csv_text(table: Sequence[Column]) -> str:
    """As CSV: every float with all its digits, nothing where there is no number."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(column.title for column in table)
    cells = zip(*(column.cells for column in table), strict=True)
    writer.writerows(["" if cell is None else _text(cell) for cell in line] for line in cells)
    return stream.getvalue()


def _text(cell: Cell) -> str:
    return repr(cell) if isinstance(cell, float) else str(cell)


def installed() -> bool:
    """True if a package that writes Parquet is installed."""
    from importlib.util import find_spec

    return find_spec("pyarrow") is not None


def check_parquet() -> None:
    """Raises RefusedError where there is nothing that writes Parquet."""
    if not installed():
        raise RefusedError(MISSING)


def parquet(table: Sequence[Column]) -> bytes:
    """As Parquet, with the same columns and types float64, int64, string. Raises RefusedError."""
    check_parquet()
    import pyarrow as arrow
    import pyarrow.parquet as writer

    def array(column: Column) -> arrow.Array:
        kinds = {type(cell) for cell in column.cells if cell is not None}
        kind = arrow.string() if str in kinds else arrow.int64() if kinds == {int} else arrow.float64()
        return arrow.array(column.cells, kind)

    stream = io.BytesIO()
    writer.write_table(arrow.table({column.title: array(column) for column in table}), stream)
    return stream.getvalue()
