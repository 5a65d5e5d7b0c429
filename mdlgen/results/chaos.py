"""Detects motions so sensitive to the start that no smaller step converges to one end."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from mdlgen.model.tables import Model
from mdlgen.results.estimates import FALLS
from mdlgen.results.quantities import Difference, differences
from mdlgen.results.result import Chaos, Result

# Difference of the starts [mm]. It is small against all that a run resolves, so that the result differs in
# proportion to it, and large against round-off of places, 1e-14 of some 100 mm.
START = 1e-9
# How far off a start is at least [mm]: a hundredth of the thickness of paper, which itself varies by more.
# Where that changes the motion by more than run.tolerance, no step brings the run within it.
KNOWN_START = 1e-3
# Two changes are as large as each other within this factor.
ALIKE = 2.0


def moved(model: Model) -> Model:
    """The same scene with each sheet moved by START as a whole, in a direction of its own, the same in each
    run."""
    place = model.bodies.position.copy()
    draw = np.random.default_rng(0)
    for sheet in model.sheets:
        way = draw.normal(size=3)
        boxes = np.arange(sheet.first, sheet.first + sheet.count)
        free = boxes[~model.bodies.fixed[boxes]]
        place[free] += START * way / np.linalg.norm(way)
    return replace(model, bodies=replace(model.bodies, position=place))


def falls(runs: list[Result], name: str) -> bool:
    """True where differences fall from run to run, each at half the step of the next one."""
    found = [_of(one, two, name) for one, two in pairwise(runs)]
    known = [difference.value * difference.scale for difference in found if difference is not None]
    return len(known) >= 2 and all(a * FALLS <= b for a, b in pairwise(known))


def chaos(result: Result, coarser: Result, other: Result) -> Chaos | None:
    """Divergence of `other`, a run of the scene from `moved`, from the result at the same step.

    None where that is less than the coarser run differs by, and so little that a start which is KNOWN_START
    off, in proportion, changes the motion by less than the tolerance: it is not chaotic.
    """
    name = result.error_estimate_of
    if name is None or not other.usable:
        return None
    apart, halved = _of(result, other, name), _of(result, coarser, name)
    if apart is None or halved is None:
        return None
    allowed = result.model.run.tolerance * (apart.judged or apart.scale) / apart.scale
    if ALIKE * apart.value < halved.value and KNOWN_START / START * apart.value < allowed:
        return None
    part = name.split(".")
    return Chaos(
        quantity=name,
        start_mm=START,
        apart=apart.value * apart.scale,
        step_apart=halved.value * halved.scale,
        unit=apart.unit,
        sheet=part[1] if part[0] == "sheets" else result.model.sheets[0].name,
    )


def _of(result: Result, other: Result, name: str) -> Difference | None:
    return differences(result, other, judged=True).get(name)


def in_words(found: Chaos) -> str:
    """The message to the reader about a chaotic run."""
    grown = ""
    if found.unit == "mm":
        grown = f", {found.apart / found.start_mm:,.0f} times as far: a start that is {KNOWN_START:g} mm off "
        grown += "changes more than run.tolerance allows"
    return (
        f"chaotic: two runs whose starts differ by {found.start_mm:g} mm part by {found.apart:.2g} "
        f"{found.unit} ({found.quantity}){grown}; half the step changes {found.step_apart:.2g} {found.unit}; "
        "no step will do: judge many runs, not one"
    )


def command(found: Chaos, center: tuple[float, float, float], spec: str) -> str:
    """The command of a sweep over starts."""
    low, high = (f"{center[0] + off:.10g} mm" for off in (-0.01, 0.01))
    return f'mdlgen sweep {spec} --over "sheets.{found.sheet}.center.0={low}:{high}:11"'
