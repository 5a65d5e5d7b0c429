"""Closed forms and published tables, each with what the solvers get: expected, got, error, estimate.

One file per group; each row is a scene made from a sample, and an oracle that shares no code with the
solvers: scipy, or a number from the literature. No parameter of a solver is tuned to a row. A row that is
wrong is a finding.
"""

from __future__ import annotations

from mdlgen.bench.case import BenchCase
from mdlgen.bench.suites.validation import (
    belts,
    bending,
    driving,
    edges,
    moving,
    passing,
    plates,
    poisson,
    rigid,
    rolling,
    rubbing,
    sensing,
    starting,
    sticking,
    swinging,
    yielding,
)

GROUPS = (
    *(bending, plates, poisson, swinging, yielding, belts, rolling, rigid, rubbing, sticking, edges),
    *(driving, moving, sensing, passing, starting),
)


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """All rows, or one of each kind that both solvers end within seconds."""
    return [case for group in GROUPS for case in group.cases(quick)]
