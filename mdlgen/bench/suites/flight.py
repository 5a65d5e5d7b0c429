"""A note strikes a post and flies on, bent and spinning: momentum is conserved from the last touch on."""

from __future__ import annotations

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.momentum import energy, momentum
from mdlgen.registry import REFERENCE
from mdlgen.results.result import Result

SAMPLE = "cantilever"
STRIKE, FLIGHT = 10.0, 100.0  # [ms]
# The post is met by a corner, which the note draws away from it: it bends, turns and does not come back.
SCENE = (
    "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
    "sheets.note.clamp=null",
    "sheets.note.velocity=[-3 m/s, 3 m/s, -2 m/s]",
    "rollers={post: {center: [31 mm, 61 mm, -5.1 mm], axis: [0.8, -0.6, 0], radius: 5 mm, width: 20 mm,"
    " mass: 10 g}}",
    "contacts=[{between: [note, post], stiffness: 30 N/mm^1.5, restitution: 0.8, friction: 0.2,"
    " smoothing: 20 mm/s}]",
    "run.analysis=transient",
    "run.prune=false",
)
STEPS = {REFERENCE: (0.1, 0.05)}
OTHER_STEPS = (0.2, 0.1, 0.05)
LINEAR, ANGULAR, ENERGY = 1e-12, 1e-6, 1e-6
# Stored states from the last touch to the first that counts: a rule of several steps remembers the touch.
LATER = 12
# Generalised-alpha is of second order in the momentum too; a midpoint rule keeps it.
ANGULAR_OF = {REFERENCE: 1e-4}


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """At the solver's own step and at given ones."""
    flight = FLIGHT / 10 if quick else FLIGHT
    sets = (*SCENE, f"run.duration={STRIKE + flight} ms", "sheets.note.boxes=[4,6]")
    if not quick:
        sets = sets[:-1]
    chosen = BenchCase("flight", "bent and spinning, step chosen", Run(SAMPLE, sets), drift)
    forced = BenchCase("flight", "bent and spinning, step given", chosen.run, plain_drift)
    steps = STEPS.get(solver, OTHER_STEPS)
    return [chosen, *(forced.at(step) for step in (steps[:1] if quick else steps))]


def drift(result: Result, _: Result | None) -> list[Finding]:
    """Drifts with the tolerances that a run at its default is held to."""
    return _drift(result, True)


def plain_drift(result: Result, _: Result | None) -> list[Finding]:
    """Drifts of a run whose step was given."""
    return _drift(result, False)


def _drift(result: Result, promised: bool) -> list[Finding]:
    touching = np.flatnonzero(result.contact_force.any(axis=1))
    start = min(int(touching[-1]) + LATER if len(touching) else 0, len(result.time) - 1)
    linear, angular = (values[start:] for values in momentum(result))
    total = energy(result)[start:]
    named = (
        ("linear momentum, greatest drift, relative", _change(linear), LINEAR),
        (
            "angular momentum, greatest drift, relative",
            _change(angular),
            ANGULAR_OF.get(result.solver, ANGULAR),
        ),
        ("energy above its start, greatest, relative", max(float(total.max() / total[0] - 1), 0.0), ENERGY),
    )
    details = {"from_ms": float(result.time[start]), "to_ms": float(result.time[-1])}
    return [Finding(name, value, limit if promised else None, details) for name, value, limit in named]


def _change(values: np.ndarray) -> float:
    return float(np.linalg.norm(values - values[0], axis=1).max() / np.linalg.norm(values[0]))
