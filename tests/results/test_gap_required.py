"""A required gap at a sensor is a length or a time."""

from __future__ import annotations

import pytest

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

# Two notes of 40 mm fly by a sensor at 2 m/s, 25 ms apart: 50 mm, so a gap of 10 mm, or of 5 ms.
FLY = """
name: fly
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{paper: {{E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.40 N*mm, D_cd: 0.24 N*mm}}}}
sheets:
  note: {{material: paper, size: [40 mm, 24 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [2, 1],
    velocity: [2 m/s, 0 m/s, 0 m/s]}}
streams: {{infeed: {{of: note, every: 25 ms, count: 2}}}}
sensors: {{eye: {{beam: [[30 mm, 0 mm, -2 mm], [30 mm, 0 mm, 2 mm]]}}}}
require: [{limit}]
run: {{duration: 40 ms, step: 0.5 ms}}
"""


@pytest.mark.parametrize(
    ("limit", "gap", "passed"),
    [
        ("gap at eye above 4 ms", 5.0, True),
        ("gap at eye above 6 ms", 5.0, False),
        ("gap at eye below 0.006 s", 0.005, True),
        ("gap at eye from 9 mm to 11 mm", 10.0, True),
    ],
)
def test_a_gap_has_the_unit_of_its_limit(limit: str, gap: float, passed: bool) -> None:
    result = mdlgen.solve(lower(loads(FLY.format(limit=limit))), "lattice")
    (outcome,) = result.verdict
    # an edge has to be 0.01 mm off before the sensor is clear: 0.1 % of the gap
    assert outcome.value == pytest.approx(gap, rel=1.1e-3) and outcome.passed is passed


def test_another_unit_is_refused() -> None:
    with pytest.raises(SpecError, match="gap at eye is in mm, the limit deg; give the limit in mm, or in ms"):
        mdlgen.solve(lower(loads(FLY.format(limit="gap at eye above 4 deg"))), "lattice")
