"""Rollers that face each other across a sheet spread the force of a nip over the same reach."""

from __future__ import annotations

import math

import pytest

from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

SCENE = """
name: facing
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {p: {E_md: 2000 MPa, E_cd: 2000 MPa, D_md: 0.3 N*mm, D_cd: 0.3 N*mm}}
sheets: {n: {material: p, size: [80 mm, 50 mm], thickness: 0.1 mm, mass: 1 g, boxes: [8, 5]}}
rollers:
  low: {center: [0 mm, 0 mm, -9.05 mm], axis: y, radius: 9 mm, width: 40 mm, mass: 10 g}
  top: {center: [0 mm, 0 mm, 4.05 mm], axis: y, radius: 4 mm, width: 40 mm, mass: 5 g}
  far: {center: [25 mm, 0 mm, 6.05 mm], axis: y, radius: 6 mm, width: 40 mm, mass: 5 g}
contacts:
  soft: {between: [n, low], stiffness: 200 N/mm^1.5, friction: 0}
  hard: {between: [n, top], stiffness: 900 N/mm^1.5, friction: 0}
  other: {between: [n, far], stiffness: 400 N/mm^1.5, friction: 0}
run: {duration: 1 ms}
"""


def spread(*overrides: str) -> dict[str, float]:
    contacts = lower(loads(SCENE, "facing", overrides)).contacts
    return dict(zip(contacts.part_b, contacts.spread.tolist(), strict=True))


def alike(**of: tuple[float, float]) -> dict[str, float]:
    """Radii of spread [mm] at which rollers of (radius [mm], stiffness) reach alike: sqrt(2 r z) is the same
    of all, the geometric mean of what their own radii ask for. z goes with k^(-2/3)."""
    reach = math.prod(math.sqrt(r * k ** (-2 / 3)) for r, k in of.values()) ** (1 / len(of))
    return {name: reach**2 * k ** (2 / 3) for name, (_, k) in of.items()}


LOW, TOP, FAR = (9.0, 200.0), (4.0, 900.0), (6.0, 400.0)


def test_two_that_face_each_other_reach_as_far_under_one_force() -> None:
    """sqrt(2 r z) with z = (N/k)^(2/3), about the mean of what the radii ask for."""
    found = spread()
    reach = {
        name: math.sqrt(2.0 * found[name] * (2.5 / k) ** (2 / 3))
        for name, k in (("low", 200.0), ("top", 900.0))
    }
    assert reach["low"] == pytest.approx(reach["top"], rel=1e-12)
    own = [math.sqrt(2.0 * r * (2.5 / k) ** (2 / 3)) for r, k in ((9.0, 200.0), (4.0, 900.0))]
    assert reach["low"] == pytest.approx(math.sqrt(own[0] * own[1]), rel=1e-12)
    assert found["far"] == 0.0


def test_rollers_that_are_alike_keep_their_radius() -> None:
    same = ("rollers.low.radius=4 mm", "rollers.low.center=[0 mm, 0 mm, -4.05 mm]")
    found = spread(*same, "contacts.hard.stiffness=200 N/mm^1.5")
    assert found["low"] == pytest.approx(4.0, rel=1e-14)
    assert found["top"] == pytest.approx(4.0, rel=1e-14)


@pytest.mark.parametrize(
    "apart",
    [
        "rollers.top.center=[0 mm, 0 mm, 8.1 mm]",  # lifted by more than its radius
        "rollers.top.axis=x",
        "rollers.top.center=[0 mm, 41 mm, 4.05 mm]",  # beside the other, along the axis
        "contacts.hard.share=pair",
    ],
)
def test_two_that_do_not_face_each_other_have_their_own_radii(apart: str) -> None:
    assert set(spread(apart).values()) == {0.0}


def test_rollers_round_one_drum_are_one_group() -> None:
    """A second idler on the drum: all three reach alike."""
    found = spread("rollers.far.center=[11 mm, 0 mm, 1.3 mm]")
    assert found == pytest.approx(alike(low=LOW, top=TOP, far=FAR), rel=1e-12)


PRESS = "{direction: -z, preload: 5 N, stiffness: 1 N/mm}"
SMALL = "rollers.low.radius=4 mm", "rollers.low.center=[0 mm, 0 mm, -4.05 mm]"


@pytest.mark.parametrize(
    "far",
    [
        # neighbours along the way of the sheet, fewer millimetres apart than their radii
        ("rollers.far.center=[14 mm, 0 mm, 6.05 mm]",),
        ("rollers.far.center=[18 mm, 0 mm, -6.05 mm]",),
        (
            "rollers.far.center=[14 mm, 0 mm, 6.05 mm]",
            f"rollers.far.press={PRESS}",
        ),
        (
            "rollers.far.center=[14 mm, 0 mm, 6.05 mm]",
            f"rollers.far.press={PRESS}",
            f"rollers.top.press={PRESS}",
        ),
        (
            "rollers.far.center=[14 mm, 0 mm, 6.05 mm]",
            "rollers.far.arm={pivot: [34 mm, 0 mm, 9 mm], mass: 3 g, torque: 6 N*mm}",
        ),
    ],
)
def test_neighbours_along_a_path_do_not_face_each_other(far: tuple[str, ...]) -> None:
    """A harder one beside two that are alike leaves these their radius."""
    found = spread(*SMALL, "contacts.hard.stiffness=200 N/mm^1.5", *far)
    assert found == {"low": pytest.approx(4.0, rel=1e-14), "top": pytest.approx(4.0, rel=1e-14), "far": 0.0}


@pytest.mark.parametrize(
    "top",
    [
        (),
        (f"rollers.top.press={PRESS}",),
        ("rollers.top.arm={pivot: [-20 mm, 0 mm, 4.05 mm], mass: 3 g, torque: 6 N*mm}",),
        (
            "rollers.top.center=[0 mm, 0 mm, 6 mm]",
            f"rollers.top.press={PRESS}",
        ),
    ],
)
def test_one_that_is_pressed_faces_the_other(top: tuple[str, ...]) -> None:
    """Both reach alike, wherever it is lifted to; the third keeps out of it."""
    assert spread(*top) == pytest.approx({**alike(low=LOW, top=TOP), "far": 0.0}, rel=1e-12)
