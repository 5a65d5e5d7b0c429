"""Runs one case: a function of plain data alone, which any process on any machine may call."""

from __future__ import annotations

import contextlib
import io
import json
import time
from collections.abc import Callable
from threading import Lock
from typing import TYPE_CHECKING, Any

from mdlgen.errors import MdlgenError, SpecError
from mdlgen.study.design.case import Case
from mdlgen.study.design.task import Task
from mdlgen.study.execution.row import FAILED, INACCURATE, OK, REFUSED, CaseRow, Times

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# A worker of a cluster may have several threads; the solvers' scratch and numba's loading are of one.
_ONE = Lock()


def perform(task: Task, case: Case, begun: Callable[[], None] | None = None) -> CaseRow:
    """The row of a case; whatever goes wrong is a row with its reason.

    `begun` is called once, when the solver is at work and all code is compiled.
    """
    with _ONE:
        started, cpu = time.perf_counter(), time.process_time()
        record: dict[str, Any]
        try:
            record = _run(task, case, begun)
        except MdlgenError as error:
            record = {"kind": REFUSED, "status": _said(error)}
        except MemoryError:
            record = {"kind": FAILED, "status": "not enough memory for this case"}
        except Exception as error:  # one bad case is no end of a study
            record = {"kind": FAILED, "status": f"internal error: {type(error).__name__}: {error}"[:500]}
        times: dict[str, float] = record.pop("times", {})
        times |= {"case_s": time.perf_counter() - started, "cpu_s": time.process_time() - cpu}
        return CaseRow(case.index, case.values, **record, times=Times(**times))


def _said(error: MdlgenError) -> str:
    """The line of an error; its place where that is in a file, since a value that was set says its path."""
    if isinstance(error, SpecError) and error.place is not None and error.place.file.startswith("--set "):
        return str(SpecError(error.message, error.path))
    return str(error)


def _run(task: Task, case: Case, begun: Callable[[], None] | None) -> dict[str, Any]:
    from mdlgen import registry

    def progress(*_: float) -> None:
        nonlocal begun
        if begun is not None:
            begun()
            begun = None

    model = task.model(case)
    with contextlib.redirect_stdout(io.StringIO()):  # a solver may talk there
        # cases keep the processors busy
        result = registry.solve(model, task.solver, progress, task.check_step, threads=1)
    times = {name: getattr(result, name) for name in ("wall_s", "estimate_s", "build_s", "compile_s")}
    record = {"solver": result.solver, "error_estimate": result.error_estimate, "times": times}
    if not result.usable:
        return {**record, "kind": FAILED, "status": result.status}
    from mdlgen.results.estimates import accuracy
    from mdlgen.study.design.measure import measured

    try:
        record["measures"] = measured(result, task.expressions())
    except ValueError as error:
        return {**record, "kind": FAILED, "status": f"measure {error}"}
    if task.keep:
        record["files"] = _files(task, case, result)
    if not result.ok:
        return {**record, "kind": INACCURATE, "status": accuracy(result)}
    return {**record, "kind": OK, "status": "ok"}


def _files(task: Task, case: Case, result: Result) -> dict[str, bytes]:
    from mdlgen.report import PAGE
    from mdlgen.report.html.page import page
    from mdlgen.results.io.series import csv
    from mdlgen.results.io.store import hdf5
    from mdlgen.results.summary import summary

    result.source = task.text + "".join(f"# --set {item}\n" for item in task.overrides(case))
    return {
        "summary.json": (json.dumps(summary(result), indent=2, allow_nan=False) + "\n").encode(),
        "series.csv": csv(result).encode(),
        "result.h5": hdf5(result),
        PAGE: page([result]).encode(),
    }
