"""Wall time over the number of boxes at a fixed aspect: the same time of the transport at the same step; and
over the number of notes of a stream, of which two are there at a time."""

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
# Notes that come in every 60 ms and are gone after 107 ms, and the time for all of them [ms].
STREAM, NOTES, STREAM_STEP = "stream", {1: 110.0, 40: 2450.0}, 0.1
QUICK_NOTES = {1: 110.0, 3: 230.0}


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """72 to 800 boxes; what is compared is the wall time of the whole run."""
    duration = DURATION[REFERENCE] if quick else DURATION.get(solver, OTHER_DURATION)
    streams = [] if solver == REFERENCE else _streams(QUICK_NOTES if quick else NOTES)
    return streams + [
        BenchCase(
            "scaling",
            f"{n_x * n_y} boxes",
            Run(SAMPLE, (f"sheets.note.boxes=[{n_x},{n_y}]", f"run.duration={duration} ms"), STEP),
            balance,
        )
        for n_x, n_y in (GRIDS[:2] if quick else GRIDS)
    ]


def _streams(notes: dict[int, float]) -> list[BenchCase]:
    """One note through two nips, and many of them: the second takes at most 1.3 times as long for each."""
    return [
        BenchCase(
            "scaling",
            f"stream of {count}",
            Run(
                STREAM,
                (f"streams.infeed.count={count}", f"run.duration={duration} ms", "require=[]"),
                STREAM_STEP,
            ),
            balance,
        )
        for count, duration in notes.items()
    ]


def balance(result: Result, _: Result | None) -> list[Finding]:
    """Energy that came from nowhere or went there, over what passed through."""
    return [Finding("energy balance, relative", abs(result.energy.balance_error))]
