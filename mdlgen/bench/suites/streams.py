"""Wall time over the number of notes of a stream: what has left, or has not come yet, costs nothing."""

from __future__ import annotations

from mdlgen.bench.case import BenchCase, Run
from mdlgen.bench.suites.scaling import balance
from mdlgen.registry import REFERENCE

SAMPLE, STEP = "stream", 0.1  # [ms]
# Notes that come in every 60 ms and are gone after 107 ms, and the time for all of them [ms].
NOTES, QUICK = {1: 110.0, 40: 2450.0}, {1: 110.0, 3: 230.0}
# Boxes of a note: those of the sample, and about as many as the paper's note has.
BOXES = {"": (), "200 boxes": ("sheets.note.boxes=[20, 10]",)}


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """One note through two nips, and 40 of them: these are to take at most 1.3 times as long for each. The
    reference solver would take an hour, and has 3 of few boxes at most."""
    few = quick or solver == REFERENCE
    return [
        BenchCase(
            "streams",
            ", ".join(filter(None, (f"{count} of a stream" if count > 1 else "1 note", boxes))),
            Run(
                SAMPLE,
                (f"streams.infeed.count={count}", f"run.duration={duration} ms", "require=[]", *sets),
                STEP,
            ),
            balance,
        )
        for boxes, sets in BOXES.items()
        if not boxes or solver != REFERENCE
        for count, duration in (QUICK if few else NOTES).items()
    ]
