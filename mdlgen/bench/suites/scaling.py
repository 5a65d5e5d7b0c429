"""Wall time over the number of boxes at a fixed aspect: the same time of the transport at the same step."""

from __future__ import annotations

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.registry import REFERENCE
from mdlgen.results.result import Result

SAMPLE = "transport_4x4"
# Boxes twice as many along the note's longer side, as the paper's 10 x 20. A number of columns that is odd
# would have one on the plane of symmetry, and the lattice would solve the whole note.
GRIDS = ((6, 12), (10, 20), (14, 28), (18, 36), (20, 40))
STEP = 0.05  # [ms]
# Of the run [ms]: the whole transport, and a piece of it where that would take an hour.
DURATION = {REFERENCE: 2.0}
OTHER_DURATION = 50.0


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """72 to 800 boxes; what is compared is the wall time of the whole run."""
    duration = DURATION[REFERENCE] if quick else DURATION.get(solver, OTHER_DURATION)
    return [
        BenchCase(
            "scaling",
            f"{n_x * n_y} boxes",
            Run(SAMPLE, (f"sheets.note.boxes=[{n_x},{n_y}]", f"run.duration={duration} ms"), STEP),
            balance,
        )
        for n_x, n_y in (GRIDS[:2] if quick else GRIDS)
    ]


def balance(result: Result, _: Result | None) -> list[Finding]:
    """Energy that came from nowhere or went there, over what passed through."""
    return [Finding("energy balance, relative", abs(result.energy.balance_error))]
