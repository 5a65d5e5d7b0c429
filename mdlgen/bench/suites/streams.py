"""Wall time over the number of notes of a stream: what has left, or has not come yet, costs nothing."""

from __future__ import annotations

from mdlgen.bench.case import BenchCase, Run
from mdlgen.bench.suites.scaling import balance
from mdlgen.registry import REFERENCE

SAMPLE, STEP = "stream", 0.1  # [ms]
# Notes that come in every 60 ms and are gone after 107 ms, and the time for all of them [ms].
NOTES, QUICK = {1: 110.0, 40: 2450.0}, {1: 110.0, 3: 230.0}


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """One note through two nips, and 40 of them: these are to take at most 1.3 times as long for each. The
    reference solver would take an hour, and has 3 at most."""
    return [
        BenchCase(
            "streams",
            f"{count} of a stream" if count > 1 else "1 note",
            Run(
                SAMPLE,
                (f"streams.infeed.count={count}", f"run.duration={duration} ms", "require=[]"),
                STEP,
            ),
            balance,
        )
        for count, duration in (QUICK if quick or solver == REFERENCE else NOTES).items()
    ]
