"""A row of bench.json: one number of one case, with its cost."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from typing import Any

from mdlgen.bench.case import BenchCase, Finding

OK, FAILED, WRONG = "ok", "failed", "wrong"


@dataclass(frozen=True)
class Outcome:
    """The outcome of the process that ran a case."""

    status: str  # of the solver: "ok" or its reason
    findings: list[Finding] = field(default_factory=list)
    step: float | None = None  # that was taken [ms]
    steps: int | None = None
    wall: float | None = None  # median over the repeats, solving only [s]
    compiled: float | None = None  # [s]
    built: float | None = None  # [s]
    boxes: int | None = None
    repeats: int = 0
    estimate: float | None = None  # the solver's own, relative to max(travel, sheet length / 10)
    estimating: float | None = None  # median time of the runs for it, in addition to the wall time [s]
    unknown: str = ""  # why its error may be of any size, where the solver says so
    iterations: int | None = None  # of Newton, a linear solve each, where the solver counts them
    cpu: float | None = None  # processor time of all passes of a run, median [s]


@dataclass(frozen=True)
class BenchRow:
    """`status` is ok, failed (the solver says why, or that its error is not known) or wrong (it said ok, but
    the error is above the tolerance). A row that is ok carries an error."""

    suite: str
    case: str
    solver: str
    step_s: float | None
    status: str
    reason: str | None
    error: float | None
    tolerance: float | None
    wall_s: float | None
    quantity: str
    error_estimate: float | None
    steps: int | None
    iterations: int | None
    estimate_s: float | None
    compile_s: float | None
    build_s: float | None
    boxes: int | None
    repeats: int
    details: dict[str, float]
    command: str
    group: str = ""
    expected: float | None = None
    found: float | None = None
    unit: str = ""
    source: str = ""
    because: str = ""
    cpu_s: float | None = None

    def json(self) -> dict[str, Any]:
        """Plain data; numbers that are not finite are left out. `rounds` is an older name of `iterations`."""
        from mdlgen.results.summary import plain

        return plain({**asdict(self), "rounds": self.iterations})


def rows(case: BenchCase, solver: str, outcome: Outcome) -> list[BenchRow]:
    """The rows of one case: one per finding, or a single row with the reason of a failure."""
    if outcome.status != OK:
        return [_row(case, solver, outcome, Finding("", math.nan), FAILED, outcome.status)]
    unknown = outcome.unknown
    return [_row(case, solver, outcome, finding, *_judged(finding, unknown)) for finding in outcome.findings]


def _judged(finding: Finding, unknown: str) -> tuple[str, str | None]:
    if not math.isfinite(finding.error):
        return WRONG, "the error is not finite"
    if unknown and finding.tolerance is not None and finding.error > finding.tolerance:
        return FAILED, unknown
    if finding.tolerance is not None and finding.error > finding.tolerance:
        return WRONG, f"the solver said ok, but the error {finding.error:.3g} is above {finding.tolerance:g}"
    return OK, None


def _row(
    case: BenchCase, solver: str, outcome: Outcome, finding: Finding, status: str, reason: str | None
) -> BenchRow:
    return BenchRow(
        suite=case.suite,
        case=case.name,
        solver=solver,
        step_s=None if outcome.step is None else outcome.step * 1e-3,
        status=status,
        reason=reason,
        error=finding.error if math.isfinite(finding.error) else None,
        tolerance=finding.tolerance,
        wall_s=outcome.wall,
        quantity=finding.quantity,
        error_estimate=outcome.estimate,
        steps=outcome.steps,
        iterations=outcome.iterations,
        estimate_s=outcome.estimating,
        compile_s=outcome.compiled,
        build_s=outcome.built,
        boxes=outcome.boxes,
        repeats=outcome.repeats,
        details=finding.details,
        command=case.run.command(solver),
        group=case.group,
        expected=finding.expected,
        found=finding.found,
        unit=finding.unit,
        source=finding.source,
        because=finding.because,
        cpu_s=outcome.cpu,
    )
