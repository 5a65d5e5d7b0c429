"""Wall time over the number of boxes at a fixed aspect: a piece of the transport at a given step."""

from __future__ import annotations

from mdlgen.bench.case import Case, Finding, Run
from mdlgen.results.result import Result

SAMPLE = "transport_4x4"
GRIDS = ((5, 10), (10, 20), (14, 28), (20, 40))
STEP, DURATION = 0.05, 2.0  # [ms]


def cases(solver: str, reference: str, quick: bool) -> list[Case]:
    """50 to 800 boxes; what is compared is the wall time per step."""
    return [
        Case(
            "scaling",
            f"{n_x * n_y} boxes",
            Run(SAMPLE, (f"sheets.note.boxes=[{n_x},{n_y}]", f"run.duration={DURATION} ms"), STEP),
            balance,
        )
        for n_x, n_y in (GRIDS[:2] if quick else GRIDS)
    ]


def balance(result: Result, _: Result | None) -> list[Finding]:
    """Energy that came from nowhere or went there, over what passed through."""
    return [Finding("energy balance, relative", abs(result.energy.balance_error))]
