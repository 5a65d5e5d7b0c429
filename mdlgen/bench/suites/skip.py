"""Savings by each rule that leaves out unneeded parts of a scene: all of them against all but one."""

from __future__ import annotations

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Measure, Reference, Run
from mdlgen.registry import FAST, REFERENCE
from mdlgen.results.compare import scale
from mdlgen.results.result import Result

SAMPLE = "transport_4x4"
STEP = 0.05  # [ms]
# Of the run [ms]; exudyn takes a second for each.
DURATION = {REFERENCE: 5.0}
OTHER_DURATION, QUICK_DURATION = 50.0, 1.0
# Leaving out these changes nothing but the order of sums.
EXACT = 1e-6
# These change where the iterations of a step end, which is within what a run promises at its default
# tolerance.
NEAR = 1e-3
EVERY, BUT = "every rule", "every rule but "
# A second note, clamped at an edge, and a driven and a free roller, above the machine and free of contact. A
# scene has no way yet to say that a part rests, so the run that skips them is of the scene without them.
IDLE = (
    "sheets.spare={material: eur10, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [10, 20],"
    " center: [0 mm, 0 mm, 100 mm], clamp: {edge: y_min}}",
    "rollers.spare_motor={center: [0 mm, 0 mm, 150 mm], axis: y, radius: 7.5 mm, width: 5 mm, mass: 0.88 g,"
    " drive: {speed: 186.7 rad/s, ramp: 5 ms}}",
    "rollers.spare_counter={center: [0 mm, 0 mm, 170 mm], axis: y, radius: 5 mm, width: 5 mm, mass: 0.39 g}",
)


def unchanged(result: Result, reference: Result | None) -> list[Finding]:
    """Difference of a run that must be the same."""
    return [_difference(result, reference, EXACT)]


def near(result: Result, reference: Result | None) -> list[Finding]:
    """Difference of a run that may end its iterations elsewhere."""
    return [_difference(result, reference, NEAR)]


# Rules of a solver that it can also do without: name in the solver, description, and measure of the
# difference.
OWN: dict[str, tuple[tuple[str, str, Measure], ...]] = {
    FAST: (
        ("folding", "folded bushings", unchanged),
        ("factors", "kept factors", near),
        ("symmetry", "a half of what is symmetric", near),
    )
}


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """The scene with every rule, and without one of them at a time."""
    duration = QUICK_DURATION if quick else DURATION.get(solver, OTHER_DURATION)
    sets = (f"run.duration={duration} ms",)
    every = Run(SAMPLE, sets, STEP)
    exact = Reference(every, solver)
    made = [
        BenchCase("skip", EVERY, every, unchanged, exact),
        BenchCase(
            "skip", BUT + "pruned contacts", Run(SAMPLE, (*sets, "run.prune=false"), STEP), unchanged, exact
        ),
        BenchCase("skip", BUT + "idle parts left out", Run(SAMPLE, (*sets, *IDLE), STEP), near, exact),
    ]
    return made + [
        BenchCase("skip", BUT + what, Run(SAMPLE, sets, STEP, (rule,)), measure, exact)
        for rule, what, measure in OWN.get(solver, ())
    ]


def _difference(result: Result, reference: Result | None, tolerance: float) -> Finding:
    """Difference of the first sheet's positions to the run with every rule: only one has a spare sheet."""
    assert reference is not None, "the cases of skip have one"
    boxes = slice(0, result.model.sheets[0].count)
    apart = np.linalg.norm(result.position[:, boxes] - reference.position[:, boxes], axis=2)
    return Finding(
        "difference of positions to every rule used, RMS, relative",
        float(np.sqrt(np.mean(apart**2))) / scale(result),
        tolerance,
        {"pairs": float(len(result.model.pairs))},
    )
