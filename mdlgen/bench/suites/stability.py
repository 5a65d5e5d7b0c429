"""The stability ladder: scenes that break solvers. A rung ends right within its tolerance or as a failure
with its reason; a wrong number with status ok is what the bench exits with 5 for.

The rungs of each kind stand in a file of their own, with their oracles.
"""

from __future__ import annotations

from mdlgen.bench.case import BenchCase
from mdlgen.bench.suites.ladder import blocks, laws, machines, piles, reacting, strips

# One rung of each kind that a slow solver ends within a few seconds.
QUICK = (
    "step 0.02 s: note in free fall",
    "step 2e-05 s: sliding block",
    "membrane x 10000: static",
    "bending x 1000: static",
    "bending x 0.01: static",
    "mu 0: sliding block",
    "c_R 0: impact",
    "c_R 1: impact",
    "roller at 100000 rad/s: block on it",
    "overlap 10 thicknesses: rigid note",
    "world rotated: static strip",
    "pile of 10: laid down",
    "step 0.0001 s: thrown along a pile",
    "step 0.0002 s: block stuck on a slope",
    "mu along CD x 20: block aslant",
    "poisson 0.49: pulled plate",
    "hardening 0.01: box that swings on its hinge",
    "cover of 0.3 mm with poisson 0.49: note in its nip",
    "step 0.0002 s: sheet that falls past a beam",
    "gear of 200: motor that spins a roller up",
)


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """All rungs, or one of each kind."""
    kinds = [
        *(strips.rungs(reference), blocks.rungs(), machines.rungs(reference)),
        *(piles.rungs(), laws.rungs(), reacting.rungs()),
    ]
    rungs = [rung for kind in kinds for rung in kind]
    return [rung for rung in rungs if rung.name in QUICK] if quick else rungs
