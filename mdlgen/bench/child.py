"""The process in which a case is run: a crash or a hang there costs one row, not the bench.

A task comes pickled on standard input, the outcome goes pickled to standard output; whatever a solver
prints goes to standard error.
"""

from __future__ import annotations

import math
import os
import pickle
import signal
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mdlgen.bench.case import WARM, BenchCase
from mdlgen.bench.row import OK, Outcome
from mdlgen.errors import MdlgenError

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# After its limit and this [s] a child ends by itself; its parent would have stopped it before.
ALONE = 60.0


@dataclass(frozen=True)
class Job:
    """A job for the child process."""

    case: BenchCase
    solver: str
    module: str  # of the solver, as the registry of the parent has it
    repeats: int
    reference: str | None  # file of the states to compare with
    keep: str | None = None  # file in which to keep the states


def perform(task: Job) -> Outcome:
    """Run the case `repeats` times and measure the last result."""
    from mdlgen import registry
    from mdlgen.bench.reference import keep, states

    registry.SOLVERS.setdefault(task.solver, task.module)
    try:
        model = task.case.run.model()
        solve: Callable[..., Result] = registry.solver(task.solver).solve
        # only a solver that can do without a rule is asked to
        without = {"without": task.case.run.without} if task.case.run.without else {}
        if task.case.warm:
            solve(WARM.model())
        results, times = [], []
        for _ in range(max(1, task.repeats)):
            began = time.process_time()
            results.append(solve(model, **without))
            times.append(time.process_time() - began)
    except MdlgenError as error:
        return Outcome(f"refused: {error}")
    last = results[-1]
    failed = [result for result in results if not result.usable]
    findings = []
    if not failed:
        reference = states(task.reference, model) if task.reference else None
        findings = task.case.measure(last, reference)
        if task.keep:
            keep(last, task.keep)
    return Outcome(
        status=failed[0].status if failed else OK,
        findings=findings,
        step=last.step or None,
        steps=last.steps,
        iterations=last.iterations,
        wall=statistics.median(result.wall_s for result in results),
        estimating=statistics.median(result.estimate_s for result in results),
        compiled=results[0].compile_s,
        built=last.build_s,
        boxes=sum(sheet.count for sheet in model.sheets),
        repeats=len(results),
        estimate=last.error_estimate,
        unknown=last.error_unknown,
        cpu=statistics.median(times),
    )


def main() -> None:
    """Entry point of `python -m mdlgen.bench.child`."""
    answer = os.dup(1)
    os.dup2(2, 1)
    task = pickle.load(sys.stdin.buffer)
    if hasattr(signal, "alarm"):  # also where the parent was killed and nobody waits any more
        signal.alarm(math.ceil(task.case.limit * max(1, task.repeats) + ALONE))
    outcome = perform(task)
    with os.fdopen(answer, "wb") as stream:
        pickle.dump(outcome, stream)


if __name__ == "__main__":
    main()
