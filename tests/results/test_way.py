"""How far a sheet goes along its way, how fast, and how askew: straight on, round a bend, and at rest."""

from __future__ import annotations

import math

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.result import Result
from mdlgen.results.way import at_the_end, way_of
from mdlgen.spec.load import load, loads

FREE = """
name: free
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {paper: {E_md: 3530 MPa, E_cd: 1113 MPa}}
sheets: {note: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [4, 6]}}
run: {duration: 10 ms, print_step: 0.1 ms}
"""


def free(*sets: str) -> Result:
    result = mdlgen.solve(lower(loads(FREE, "free", sets)))
    assert as_asked(result), result.status
    return result


@pytest.mark.parametrize(
    ("turn", "way", "skew"),
    [(0, 0, 0), (10, 0, 10), (-30, 0, -30), (0, 90, 0), (10, 90, 10), (80, 0, -10), (0, 35, -35)],
)
def test_a_sheet_that_flies_straight_on(turn: float, way: float, skew: float) -> None:
    x, y = (600 * f(math.radians(way)) for f in (math.cos, math.sin))
    result = free(f"sheets.note.turn={turn} deg", f"sheets.note.velocity=[{x} mm/s, {y} mm/s, 0 mm/s]")
    length, speed, angle = at_the_end(result, 0)
    assert (length, speed) == pytest.approx((6.0, 0.6), rel=1e-9)
    assert math.degrees(angle) == pytest.approx(skew, abs=1e-6)


def test_a_sheet_that_stands_has_no_skew_and_one_that_falls_flat_no_way() -> None:
    for sets in ((), ("sheets.note.velocity=[0 mm/s, 0 mm/s, -600 mm/s]",)):
        result = free(*sets)
        assert at_the_end(result, 0)[:2] == pytest.approx((0.0, 0.0), abs=1e-9)
        record = result.summary()["sheets"]["note"]
        assert (record["skew_deg"], record["way_mm"]) == (None, pytest.approx(0.0, abs=1e-9))


def test_round_a_bend_the_way_is_longer_than_the_travel() -> None:
    """A ticket between rollers goes as far as their surface, wherever the channel leads."""
    result = mdlgen.solve(
        lower(load(samples() / "channel.yaml", ["materials.paper.damping={time: 0.05 ms}"]))
    )
    assert as_asked(result), result.status
    motor = result.model.roller("motor")
    surface = np.abs(result.spin[:, motor.body] @ motor.axis) * motor.radius
    rolled = float(np.trapezoid(surface, result.time))
    way = way_of(result, 0).length[-1]
    record = result.summary()["sheets"]["note"]
    assert way == pytest.approx(rolled, rel=0.01)
    assert float(np.linalg.norm(record["travel_mm"])) < 0.97 * way
    assert abs(record["skew_deg"]) < 0.1


def test_a_requirement_of_the_way_and_the_skew() -> None:
    asked = (
        'require=["way from 5.9 mm to 6.1 mm", "skew within 11 deg throughout", "way below 3 mm at 5.1 ms"]'
    )
    result = free("sheets.note.turn=10 deg", "sheets.note.velocity=[0.6 m/s, 0 m/s, 0 m/s]", asked)
    found = result.summary()["verdict"]["requirements"]
    assert [one["passed"] for one in found] == [True, True, False]
