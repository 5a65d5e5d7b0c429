"""What each rule saves that leaves out what a scene does not need: the same scene with and without it."""

from __future__ import annotations

from mdlgen.bench.case import Case, Finding, Reference, Run
from mdlgen.results.compare import compare
from mdlgen.results.result import Result

SAMPLE = "transport_4x4"
STEP = 0.05  # [ms]
# Leaving out must change nothing but the order of sums, to what Newton's tolerance lets through.
SAME = 1e-6


def cases(solver: str, reference: str, quick: bool) -> list[Case]:
    """Contacts that cannot meet: pruned, as is the default, and all kept."""
    sets = (f"run.duration={1 if quick else 5} ms",)
    everything = Run(SAMPLE, (*sets, "run.prune=false"), STEP)
    exact = Reference(everything, solver)
    return [
        Case("skip", "contacts pruned", Run(SAMPLE, sets, STEP), same, exact),
        Case("skip", "contacts all kept", everything, same, exact),
    ]


def same(result: Result, reference: Result | None) -> list[Finding]:
    """Difference of positions to the run that skips nothing."""
    assert reference is not None, "the cases of skip have one"
    details = {"pairs": float(len(result.model.pairs))}
    return [
        Finding(
            "position against skipping nothing, relative", compare(result, reference).relative, SAME, details
        )
    ]
