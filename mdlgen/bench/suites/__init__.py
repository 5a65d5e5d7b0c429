"""The suites by name: each file makes the cases of one for a solver."""

from __future__ import annotations

from importlib import import_module

from mdlgen.bench.case import BenchCase
from mdlgen.errors import SpecError, did_you_mean
from mdlgen.registry import AUTO

SUITES = (
    *(
        "transport",
        "elastica",
        "impact",
        "friction",
        "flight",
        "scaling",
        "skip",
        "feeder",
        "piles",
        "streams",
    ),
    *("stability", "validation", "core"),
)


def cases(suite: str, solver: str, solvers: tuple[str, ...], quick: bool) -> list[BenchCase]:
    """The cases of a suite for one solver; `solvers` are all that there are, for references.

    Raises SpecError for a suite that there is not.
    """
    if suite not in SUITES:
        close = did_you_mean(suite[:40], SUITES)
        raise SpecError(f"there is no suite {suite[:40]!r}{close or ';'} there are: {', '.join(SUITES)}")
    # the solver whose finest run the others are compared with, where it is there
    known = [name for name in AUTO if name in solvers] or [solver]
    return import_module(f"mdlgen.bench.suites.{suite}").cases(solver, known[0], quick)
