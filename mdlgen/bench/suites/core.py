"""Cases that judge a change of the solver's core: machines, sheets on sheets, a fall, and campaign scenes.

Each runs as a user runs it, at its own step or the one that the solver chooses.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np

from mdlgen.bench.campaign.drawn_run import DrawnRun
from mdlgen.bench.case import BenchCase, Finding, Reference, Run
from mdlgen.bench.core_table import SUITE
from mdlgen.registry import REFERENCE
from mdlgen.results.compare import compare
from mdlgen.results.result import Result

FALLS = (
    "sheets={note: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [4, 6],"
    " center: [0 mm, 0 mm, 2 mm]}}",
    "contacts={floor: {between: [note, floor], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3,"
    " smoothing: 3 mm/s}}",
    "probes={}",
)
# Samples with the step of the finer run [ms] that they are compared with, an eighth of their own or less. A
# finer run of a feeder takes minutes: they are judged by their balance of energy.
SAMPLES: dict[str, tuple[str, tuple[str, ...], float | None]] = {
    "transport_4x4": ("transport_4x4", (), 0.005),
    "feeder_one": ("feeder_one", (), None),
    "feeder": ("feeder", (), None),
    "stack": ("stack", (), 0.0125),
    "pile": ("pile", (), 0.0075),
    "landing": ("landing", (), 0.015),
    "flat fall": ("landing", FALLS, 0.01),
}
# Scenes of the campaign with this seed, of another kind each: number, kind, the step of the finer run [ms].
SEED = 1
DRAWN: dict[int, tuple[str, float]] = {
    10: ("arc", 0.006),
    14: ("nip", 0.01),
    15: ("stack", 0.01),
    17: ("nip_arm", 0.009),
    23: ("gate", 0.006),
    25: ("slip_off", 0.011),
    31: ("slide", 0.0008),
    34: ("nips", 0.011),
    56: ("curled", 0.009),
    61: ("fall_tilted", 0.01),
}
QUICK = ("stack", "flat fall", "campaign 23, gate")
# Digits of the digest of a state that a float holds exactly.
HASHED = 13
LIMIT = 300.0  # [s]


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """All scenes, or three short ones; none for Exudyn, which takes minutes for most."""
    if solver == REFERENCE:
        return []
    runs = {name: (Run(sample, sets), fine) for name, (sample, sets, fine) in SAMPLES.items()}
    for number, (kind, fine) in DRAWN.items():
        name = f"campaign {number}, {kind}"
        runs[name] = DrawnRun(f"campaign_{number}", seed=SEED, number=number), fine
    made = [_case(name, run, fine, solver) for name, (run, fine) in runs.items()]
    return [case for case in made if case.name in QUICK] if quick else made


def _case(name: str, run: Run, fine: float | None, solver: str) -> BenchCase:
    case = BenchCase(SUITE, name, run, balance, limit=LIMIT, warm=True)
    if fine is None:
        return case
    return replace(case, measure=position, reference=Reference(case.at(fine).run, solver))


def position(result: Result, reference: Result | None) -> list[Finding]:
    """The distance from a finer run, which `run.tolerance` promises."""
    assert reference is not None
    error = compare(result, reference).relative
    return [Finding("RMS position, of the travel", error, result.model.run.tolerance, _work(result))]


def balance(result: Result, _: Result | None) -> list[Finding]:
    """The balance of energy."""
    return [Finding("energy balance, relative", abs(result.energy.balance_error), None, _work(result))]


def _work(result: Result) -> dict[str, float]:
    """The work of the last pass, and a number that differs where the state at its end does."""
    run = result.model.run
    planned = run.duration / result.step if result.step else 0.0
    state = np.concatenate([result.position[-1].ravel(), result.velocity[-1].ravel()])
    digest = hashlib.sha256(state.tobytes()).hexdigest()[:HASHED]
    counts = {name: float(count) for name, count in getattr(result, "counts", {}).items()}
    return {
        "planned": round(planned),
        **counts,
        "energy": result.energy.balance_error,
        "state": float(int(digest, 16)),
    }
