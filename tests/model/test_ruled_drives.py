"""Lints of drives that stand still until a rule orders a speed."""

from __future__ import annotations

import pytest

from mdlgen.checks import lints
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

# A note in a nip whose motor waits for a rule.
WAITS = """
name: waits
materials: {paper: {E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.40 N*mm, D_cd: 0.24 N*mm}}
sheets:
  note: {material: paper, size: [60 mm, 24 mm], thickness: 0.1 mm, mass: 0.12 g, boxes: [6, 1]}
rollers:
  motor: {center: [0 mm, 0 mm, -7.55 mm], axis: y, radius: 7.5 mm, width: 10 mm, mass: 2 g,
    drive: {speed: 0 rad/s}, one_way: {direction: 1, torque: 20 N*mm}}
  idler: {center: [0 mm, 0 mm, 5.05 mm], axis: y, radius: 5 mm, width: 10 mm, mass: 1 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 1 N}}
contacts:
  - {between: [note, [motor, idler]], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s}
  - {between: [motor, idler], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s}
run: {duration: 40 ms}
"""
RULE = "rules=[{{when: time >= 20 ms, do: {{speed: {{motor: {speed}}}}}}}]"


def found(*overrides: str) -> dict[str, str]:
    return {lint.code: str(lint) for lint in lints(lower(loads(WAITS, overrides=overrides)))}


@pytest.mark.parametrize(
    ("overrides", "idle"),
    [((), True), ((RULE.format(speed="0 rad/s"),), True), ((RULE.format(speed="90 rad/s"),), False)],
)
def test_a_drive_that_a_rule_starts_is_not_idle(overrides: tuple[str, ...], idle: bool) -> None:
    assert ("W108" in found(*overrides)) is idle


def test_a_rule_that_drives_against_its_clutch_is_found() -> None:
    assert "W117" in found(RULE.format(speed="-90 rad/s"))
    assert "W117" not in found(RULE.format(speed="90 rad/s"))


def test_a_rule_may_end_the_time_for_which_a_drive_stands() -> None:
    assert "stands still for 40 ms, and" in found()["W139"]
    assert (
        "stands still for 40 ms unless a rule moves it, and" in found(RULE.format(speed="90 rad/s"))["W139"]
    )
