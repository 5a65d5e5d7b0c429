"""A sweep in this process, for those who have the scene in Python: its cases are run one after the other."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

from mdlgen.errors import MdlgenError, RefusedError, SpecError
from mdlgen.study.analysis.table import Column, columns
from mdlgen.study.design.measure import defaults, known, measured, measures
from mdlgen.study.design.variable import check_count
from mdlgen.study.execution.row import FAILED, INACCURATE, OK, REFUSED, CaseRow, Times

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.spec.scene import Scene
    from mdlgen.study.design.expression import Expression


@dataclass(frozen=True)
class Runs:
    """The rows of a sweep, and the measures that each has."""

    rows: tuple[CaseRow, ...]
    measures: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[CaseRow]:
        return iter(self.rows)

    def __repr__(self) -> str:
        bad = sum(not row.measured for row in self.rows)
        return f"<Runs: {len(self)} cases, {bad or 'none'} failed, of {', '.join(self.measures)}>"

    @property
    def columns(self) -> list[Column]:
        """As of table.csv: case, values, measures, status, reason, error_estimate, solver."""
        return columns(self.rows, self.measures)

    def to_pandas(self) -> Any:
        """The columns as a pandas.DataFrame, whose `attrs["units"]` has the units of values. Raises
        RefusedError where pandas is not installed."""
        try:
            import pandas
        except ImportError:
            raise RefusedError("to_pandas needs pandas; install it: pip install 'mdlgen[pandas]'") from None
        message = self.columns
        table = pandas.DataFrame({column.name: list(column.cells) for column in message}).set_index("case")
        table.attrs["units"] = {column.name: column.unit for column in message if column.unit}
        return table


def sweep(
    scene: Scene, over: Mapping[str, Sequence[object]], measure: Sequence[str] = (), solver: str = "auto"
) -> Runs:
    """See `Scene.sweep`."""
    from mdlgen import registry
    from mdlgen.model.lower import lower
    from mdlgen.study.design.expression import read

    if isinstance(measure, str):
        raise SpecError(f"measures are a list of texts; write [{measure[:80]!r}]")
    for path, values in over.items():
        if isinstance(values, (str, Mapping)) or not list(values):
            raise SpecError(f"{path[:80]}: give a list of values, as [0.1, 0.3], or ['2 N', '3 N']")
    if not over:
        raise SpecError('name what is to differ, as {"contacts.0.friction": [0.1, 0.3]}')
    registry.check_solver(solver)
    cases = [dict(zip(over, values, strict=True)) for values in product(*over.values())]
    check_count(len(cases))
    first = lower(scene.with_(cases[0]))
    wanted = measures(list(measure) or defaults(first), known(first), "measure")
    expressions = [(name, read(text, "measure")) for name, text in wanted]
    rows = tuple(_row(scene, k, case, expressions, solver) for k, case in enumerate(cases))
    return Runs(rows, tuple(name for name, _ in wanted))


def _row(
    scene: Scene,
    index: int,
    case: Mapping[str, object],
    expressions: Sequence[tuple[str, Expression]],
    solver: str,
) -> CaseRow:
    """One case; whatever is wrong with it is a row with its reason."""
    from mdlgen.model.lower import lower

    values = tuple((p, v if isinstance(v, str) else json.dumps(v)) for p, v in case.items())
    started = time.perf_counter()
    message: dict[str, Any]
    try:
        message = _ran(lower(scene.with_(case)), expressions, solver)
    except MdlgenError as error:
        message = {"kind": REFUSED, "status": str(error)}
    return CaseRow(index, values, **message, times=Times(case_s=time.perf_counter() - started))


def _ran(model: Model, expressions: Sequence[tuple[str, Expression]], solver: str) -> dict[str, Any]:
    from mdlgen import registry
    from mdlgen.results.estimates import accuracy

    result = registry.solve(model, solver, threads=1)
    record: dict[str, Any] = {"solver": result.solver, "error_estimate": result.error_estimate}
    if not result.usable:
        return {**record, "kind": FAILED, "status": result.status}
    try:
        record["measures"] = measured(result, expressions)
    except ValueError as error:
        return {**record, "kind": FAILED, "status": f"measure {error}"}
    if result.ok:
        return {**record, "kind": OK, "status": "ok"}
    return {**record, "kind": INACCURATE, "status": accuracy(result)}
