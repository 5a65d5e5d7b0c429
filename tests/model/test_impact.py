"""How short an impact the steps of a run are measured by."""

from __future__ import annotations

import math

import pytest

import mdlgen
from mdlgen.model.impact import approach_time, lasting
from mdlgen.spec.load import loads

FALLING = """
name: falling
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {paper: {E_md: 3530 MPa, E_cd: 1113 MPa}}
sheets:
  note: {material: paper, size: [60 mm, 30 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [6, 3],
    center: [0 mm, 0 mm, 3.05 mm]}
planes: {floor: {center: [0 mm, 0 mm, -1 mm], normal: z, size: [200 mm, 200 mm, 2 mm]}}
contacts: [{between: [note, floor], stiffness: 300 N/mm^1.5, friction: 0.3}]
run: {duration: 40 ms, print_step: 0.1 ms}
"""
G, BOX = 9.81e-3, 0.3 / 18  # mm/ms^2, g


@pytest.mark.parametrize(
    ("sets", "speed"),
    [
        ((), math.sqrt(2 * G * 3.0)),
        (("run.duration=10 ms",), 10 * G),  # it does not arrive
        (("sheets.note.velocity=[0 m/s, 0 m/s, -0.3 m/s]",), math.sqrt(0.3**2 + 2 * G * 3.0)),
        (("gravity=[0 m/s^2, 0 m/s^2, 9.81 m/s^2]",), 0.0),
        (("sheets.note.center.2=0.05 mm",), 0.0),  # it lies there
        (("sheets.note.clamp={edge: x_min}",), 0.0),  # it is held
    ],
)
def test_a_note_falls_at_a_floor_with_what_gravity_gives_it(sets: tuple[str, ...], speed: float) -> None:
    model = mdlgen.lower(loads(FALLING, "falling", sets))
    found = approach_time(model, 0)
    assert found == (pytest.approx(lasting(BOX, 300.0, speed)) if speed else math.inf)
