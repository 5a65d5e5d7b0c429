"""A sheet on a roller with a cover: what rolls goes at omega (R + lever z + bend z^2), and energy is kept."""

import numpy as np
import pytest

from mdlgen.mechanics.contact import box_cylinder, cylinder_cylinder
from mdlgen.mechanics.frame import Box, Cylinder, Frame, Law
from mdlgen.mechanics.point import DISSIPATED, FORCE_A, FORCE_B, OUT, TORQUE_A, TORQUE_B

pytestmark = pytest.mark.usefixtures("as_python")

RADIUS, WIDTH, K, MU = 10.0, 20.0, 120.0, 0.8
LEVER, BEND = -0.15, 4.0  # of a cover of 3 mm and 40 ShA, about
OMEGA, SMOOTH = 0.04, 4e-3  # [rad/ms], [mm/ms]
THIN = 0.05
UPRIGHT = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
STILL = (0.0, 0.0, 0.0)


def _sheet(boxes: tuple[int, int], depth: float, speed: float, mu: float = MU) -> np.ndarray:
    """What all boxes of a sheet of 60 x 60 mm have together that moves along x under a turning roller."""
    law = Law(K, True, 0.0, mu, mu, SMOOTH, SMOOTH, SMOOTH, 0.0, LEVER, BEND)
    b = Frame((0.7, 0.3, -THIN - RADIUS + depth), UPRIGHT, STILL, (0.0, OMEGA, 0.0))
    half = 30.0 / boxes[0], 30.0 / boxes[1]
    total = np.zeros(OUT)
    for i in range(boxes[0]):
        for j in range(boxes[1]):
            place = ((2 * i + 1) * half[0] - 30.0, (2 * j + 1) * half[1] - 30.0, 0.0)
            exposed = (i == 0) + 2 * (i == boxes[0] - 1) + 4 * (j == 0) + 8 * (j == boxes[1] - 1)
            out = np.zeros(OUT)
            a = Frame(place, UPRIGHT, (speed, 0.0, 0.0), STILL)
            box_cylinder(
                out, a, Box((*half, THIN), exposed), b, Cylinder((0.0, 1.0, 0.0), RADIUS, WIDTH), law
            )
            total += out
    return total


def _rolling(depth: float) -> float:
    return OMEGA * (RADIUS + LEVER * depth + BEND * depth**2)


@pytest.mark.parametrize("boxes", [(4, 3), (10, 6), (15, 12)])
@pytest.mark.parametrize("depth", [0.05, 0.2])
def test_force_of_the_nip_and_rolling_speed_are_those_of_the_cover_on_any_grid(boxes, depth):
    free = _sheet(boxes, depth, _rolling(depth))
    assert free[FORCE_A + 2] == pytest.approx(K * depth**1.5, rel=2e-3)  # z/(4R) of the parabola
    assert abs(free[FORCE_A]) < 5e-5 * free[FORCE_A + 2]  # at that speed no friction is left
    slow = _sheet(boxes, depth, _rolling(depth) - SMOOTH)
    assert slow[FORCE_A] == pytest.approx(MU * free[FORCE_A + 2], rel=1e-2)  # points stand askew by a/R


@pytest.mark.parametrize("slip", [-2.0, -0.3, 0.4])
def test_power_of_the_drive_is_that_on_the_sheet_and_what_friction_takes(slip):
    """The torque has the lever of the speed: power is neither made nor lost by the ratio."""
    depth, speed = 0.2, _rolling(0.2) + slip * SMOOTH
    # without what the round does that has no friction: it stores, and gives back
    total = _sheet((10, 6), depth, speed) - _sheet((10, 6), depth, speed, mu=0.0)
    drive = -total[TORQUE_B + 1] * OMEGA  # against the torque of the contact
    assert drive == pytest.approx(total[FORCE_A] * speed + total[DISSIPATED], rel=1e-9)
    assert total[DISSIPATED] > 0.0
    lever = _rolling(depth) / OMEGA
    assert abs(total[TORQUE_B + 1]) == pytest.approx(abs(total[FORCE_A]) * lever, rel=2e-3)  # z/(4R) again


def test_momenta_of_both_bodies_add_up_to_none():
    total = _sheet((1, 1), 0.2, 0.3)
    arm = np.array([0.7, 0.3, -THIN - RADIUS + 0.2])
    couple = total[TORQUE_A : TORQUE_A + 3] + total[TORQUE_B : TORQUE_B + 3]
    couple = couple + np.cross(arm, total[FORCE_B : FORCE_B + 3])
    assert total[FORCE_A : FORCE_A + 3] == pytest.approx(-total[FORCE_B : FORCE_B + 3])
    assert couple == pytest.approx(np.zeros(3), abs=1e-9)


def test_two_rollers_run_with_their_speeds_where_their_friction_stands():
    """R_a - z/2 + d and R_b - z/2 - d from the axes, d = lever z + bend z^2."""
    depth, one, two = 0.2, 10.0, 8.0
    law = Law(K, True, 0.0, MU, MU, SMOOTH, SMOOTH, SMOOTH, 0.0, 0.3, 0.5)
    aside = 0.3 * depth + 0.5 * depth**2
    radii = one - 0.5 * depth + aside, two - 0.5 * depth - aside
    a = Frame((0.0, 0.0, one + two - depth), UPRIGHT, STILL, (0.0, OMEGA, 0.0))
    b = Frame(STILL, UPRIGHT, STILL, (0.0, -OMEGA * radii[0] / radii[1], 0.0))
    out, axis = np.zeros(OUT), (0.0, 1.0, 0.0)
    cylinder_cylinder(out, a, Cylinder(axis, one, WIDTH), b, Cylinder(axis, two, WIDTH), law)
    assert out[FORCE_A + 2] == pytest.approx(K * depth**1.5)
    assert abs(out[FORCE_A]) < 1e-12
