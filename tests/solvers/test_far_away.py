"""What is far apart: a body that touches nothing moves as it would alone, and a pile at rest stays there."""

from __future__ import annotations

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

MATERIAL = "{paper: {E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.40 N*mm, D_cd: 0.24 N*mm}}"
NOTE = "material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g"
FLOOR = "floor: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 200 mm, 10 mm]}"


def ran(text: str, *sets: str) -> Result:
    result = mdlgen.solve(lower(loads(text, overrides=list(sets))), "lattice")
    assert as_asked(result), result.status
    return result


FLIES = f"""
name: fly
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {MATERIAL}
sheets:
  low: {{{NOTE}, boxes: BOXES, center: [0 mm, 0 mm, 0.05 mm]}}
  fly: {{material: paper, size: [80 mm, 40 mm], thickness: 5 mm, mass: 10 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 3000 mm], spin: [0.5 rad/s, 50 rad/s, 0.5 rad/s]}}
planes: {{{FLOOR}}}
contacts: [{{between: [low, floor], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3}}]
run: {{duration: 300 ms, print_step: 3 ms, prune: false, step: 0.3 ms}}
"""


@pytest.mark.parametrize("boxes", ["[1, 1]", "[4, 5]"])
def test_a_body_that_touches_nothing_moves_as_it_would_alone(boxes: str) -> None:
    """About its middle axis, which is unstable: what iterations leave grows. (Its iterations ended with those
    of the sheet that lay on the floor, and its turn was off by six times its estimate.)"""
    text = FLIES.replace("BOXES", boxes)
    beside = ran(text)
    alone = "\n".join(
        line for line in text.splitlines() if not line.startswith(("  low", "contacts", "planes"))
    )
    free = ran(alone)
    fly = next(sheet.first for sheet in beside.model.sheets if sheet.name == "fly")
    assert beside.spin[-1, fly] == pytest.approx(free.spin[-1, 0], abs=1e-6 * 0.05)
    assert beside.position[-1, fly] == pytest.approx(free.position[-1, 0], abs=1e-6)


RESTS = f"""
name: far
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {MATERIAL}
sheets:
  low: {{{NOTE}, boxes: [2, 2], center: [0 mm, 0 mm, 0.049853907582750434 mm]}}
  top: {{{NOTE}, boxes: [2, 2], center: [0 mm, 0 mm, 0.14976187512688904 mm]}}
planes: {{{FLOOR}}}
rollers: {{far: {{center: [120 mm, 0 mm, 30 mm], axis: y, radius: 12 mm, width: 40 mm, mass: 15 g,
  drive: {{speed: SPEED}}}}}}
contacts:
  - {{between: [low, floor], stiffness: 2000 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 1 mm/s}}
  - {{between: [low, top], stiffness: 2000 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 1 mm/s}}
  - {{between: [low, far], stiffness: 100 N/mm^1.5, friction: 0.3, smoothing: 1 mm/s}}
run: {{duration: 300 ms, print_step: 3 ms, margin: 20 mm}}
"""


@pytest.mark.parametrize("speed", ["1000 rad/s", "50000 rad/s"])
@pytest.mark.parametrize("step", ["1 ms", "0.25 ms"])
def test_a_pile_in_balance_stays_there_whatever_turns_far_away(speed: str, step: str) -> None:
    """The limit of an iteration goes with the fastest body of a scene. (Guesses that were taken without a
    solve grew up to it, and threw the pile up.)"""
    result = ran(RESTS.replace("SPEED", speed), f"run.step={step}")
    count = 8
    moved = np.abs(result.position[:, :count] - result.position[0, :count]).max()
    assert moved < 1e-6
    weight = 2 * 0.72 * 9.81e-3
    # steps without a solve leave a ten thousandth of it
    assert result.contact_force[1:, 0] == pytest.approx(weight, rel=2e-4)
