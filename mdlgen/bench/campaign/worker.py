"""A process that draws and runs scenes of a campaign, one after the other.

It reads pickled tasks from standard input and writes pickled rows to standard output. Output of a solver goes
to standard error.
"""

from __future__ import annotations

import contextlib
import math
import pickle
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from mdlgen.bench.campaign.row import INACCURATE, NONE, OK, CampaignRow
from mdlgen.bench.campaign.task import FINER, Begun, Task
from mdlgen.bench.process import STARTING, sender
from mdlgen.errors import MdlgenError

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.result import Result


def main() -> None:
    """Entry point of `python -m mdlgen.bench.campaign.worker`."""
    send = sender()
    with contextlib.suppress(EOFError, OSError):
        while True:
            task: Task = pickle.load(sys.stdin.buffer)
            if task.compile:
                _compile(task.solver)
                send(True)
                continue
            for message in perform(task):
                send(message)


def perform(task: Task) -> Iterator[Begun | CampaignRow]:
    """Yields Begun, then the row. A `fine` task yields the row again, with its errors compared."""
    from mdlgen.bench.campaign.scene import drawn

    _allow(STARTING)  # the limit of the scene before may be near
    try:
        scene = drawn(task.seed, task.number, task.kind, task.sticking)
        model = scene.model()
    except MdlgenError as error:
        reason = f"rejected at check: {error}"
        yield CampaignRow(task.number, task.kind, NONE, reason)
        return
    boxes = sum(sheet.count for sheet in model.sheets)
    yield Begun(scene.kind, boxes, scene.rejected)
    _allow(task.limit)
    row = CampaignRow(task.number, scene.kind, NONE, boxes=boxes, rejected=scene.rejected)
    wall, cpu = time.perf_counter(), time.process_time()
    try:
        result = _solve(model, task.solver)
    except Exception as error:  # the campaign reports internal errors
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        known = isinstance(error, MdlgenError)
        reason = f"refused: {error}" if known else f"internal error: {type(error).__name__}: {error}"
        yield replace(row, reason=reason, wall_s=wall, cpu_s=cpu)
        return
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    row = judged(replace(row, wall_s=wall, cpu_s=cpu), result)
    yield row
    if task.fine and row.status != NONE and not row.chaotic and result.step > 0.0:
        from mdlgen.bench.campaign.finer import Finer, finer
        from mdlgen.registry import solver

        _allow(FINER * task.limit)
        try:
            found = finer(result, lambda step: solver(result.solver).solve(model, step=step))
        except Exception as error:
            found = Finer(failed=f"internal error: {type(error).__name__}: {error}")
        yield replace(row, finer=found)


def _allow(seconds: float) -> None:
    """Sets the time after which the system ends this process [s]. It counts processor time, so that other
    programs do not matter."""
    try:
        import resource
    except ImportError:  # not on Windows, where the parent's limit of wall time counts
        return
    _, most = resource.getrlimit(resource.RLIMIT_CPU)
    wanted = math.ceil(time.process_time() + seconds)
    resource.setrlimit(resource.RLIMIT_CPU, (wanted if most < 0 else min(wanted, most), most))


def judged(row: CampaignRow, result: Result) -> CampaignRow:
    """Returns the row of a result, judged by status and estimate as `mdlgen run` does."""
    estimate, tolerance = result.error_estimate, result.model.run.tolerance
    row = replace(
        row,
        solver=result.solver,
        step_ms=result.step or None,
        steps=result.steps,
        estimate=estimate,
        estimate_of=result.error_estimate_of,
        chaotic=bool(getattr(result, "chaotic", False)),
    )
    reason = result.error_unknown
    if not reason and estimate is not None and not estimate <= tolerance:
        reason = f"the estimate of {result.error_estimate_of} is {estimate:.3g}, above {tolerance:g}"
    if result.status == INACCURATE or (result.ok and reason):
        return replace(row, status=INACCURATE, reason=reason or "the error is not known")
    return replace(row, status=OK) if result.ok else replace(row, status=NONE, reason=result.status)


def _solve(model: Model, solver: str) -> Result:
    from mdlgen import registry

    return registry.solve(model, solver)


def _compile(solver: str) -> None:
    """Loads the compiled code of a solver before the first measurement."""
    from mdlgen import registry
    from mdlgen.bench.case import WARM

    with contextlib.suppress(MdlgenError):
        registry.solve(WARM.model(), solver)


if __name__ == "__main__":
    main()
