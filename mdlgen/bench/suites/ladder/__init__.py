"""The rungs of the stability ladder, by the kind of their scene."""

from __future__ import annotations

from mdlgen.bench.case import BenchCase, Measure, Reference, Run

# A run at a given step promises no error; a number that is off by more than this is wrong all the same.
FORCED = 2e-2
STEPS = (20.0, 2.0, 0.2, 0.02, 0.002, 0.0001)  # [ms]
MOST_STEPS = 2500


def rung(
    name: str, run: Run, measure: Measure, limit: float = 20.0, reference: Reference | None = None
) -> BenchCase:
    """One rung: run once, in a process of its own, for at most `limit` seconds."""
    return BenchCase("stability", name, run, measure, reference, repeats=False, limit=limit)


def lasting(time: float) -> tuple[str, str]:
    """Overrides of a duration [ms], with a hundred outputs."""
    return f"run.duration={round(time, 9)!r} ms", f"run.print_step={round(time / 100, 12)!r} ms"


def within(step: float, whole: float) -> tuple[str, str]:
    """Overrides of a duration: `whole` [ms], or what MOST_STEPS reach."""
    return lasting(max(step, min(whole, MOST_STEPS * step)))
