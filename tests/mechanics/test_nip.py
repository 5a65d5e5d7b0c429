"""Boxes side by side under a roller have together what one sheet has, however the sheet lies under it."""

import math

import numpy as np
import pytest

from mdlgen.mechanics.contact import box_cylinder
from mdlgen.mechanics.frame import Box, Cylinder, Frame, Law
from mdlgen.mechanics.point import DISSIPATED, FORCE_B, MOST_POINTS, OUT, POINT, POINTS, STORED, TORQUE_B

pytestmark = pytest.mark.usefixtures("as_python")

RADIUS, WIDTH, STIFFNESS = 10.0, 30.0, 10.0
STILL = (0.0, 0.0, 0.0)
# Half of the thickness of a box, and halves of its other sides: of 10 by 5 boxes.
THIN, HALF = 0.05, (3.35, 6.0)


def _sheet(
    degrees: float,
    shift: tuple[float, float],
    depth: float,
    spread: float,
    leaning: float = 0.0,
    width: float = WIDTH,
    moving: tuple[float, float, float] = STILL,
    damping: float = 0.0,
) -> tuple[np.ndarray, int]:
    """What all boxes of a flat sheet have together, and the most points of one of them."""
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    law = Law(STIFFNESS, True, damping, 0.0, 0.0, 1e-3, 1e-3, 1e-2, spread)
    turn, upright = (
        (cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0),
        (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
    )
    b = Frame((0.0, 0.0, THIN + RADIUS - depth), upright, STILL, STILL)
    roller = Cylinder((0.0, math.cos(leaning), math.sin(leaning)), RADIUS, width)
    total, most = np.zeros(OUT), 0
    for i in range(10):
        for j in range(5):
            x, y = (2 * i - 9) * HALF[0] + shift[0], (2 * j - 4) * HALF[1] + shift[1]
            exposed = (i == 0) + 2 * (i == 9) + 4 * (j == 0) + 8 * (j == 4)
            out = np.zeros(OUT + 1 + POINT * MOST_POINTS)
            a = Frame((cos * x - sin * y, sin * x + cos * y, 0.0), turn, moving, STILL)
            box_cylinder(out, a, Box((*HALF, THIN), exposed), b, roller, law)
            total += out[:OUT]
            most = max(most, int(out[POINTS]))
    return total, most


@pytest.mark.parametrize("depth", [0.005, 0.046, 0.3])
@pytest.mark.parametrize("spread", [0.0, 30.0])
@pytest.mark.parametrize("degrees", [0.5, 5.0, 17.0, 30.0, 45.0, 80.0])
def test_a_sheet_that_lies_askew_is_pressed_as_one_that_does_not(
    degrees: float, spread: float, depth: float
) -> None:
    """k z^1.5, no force along the sheet, no moment, 2/5 k z^2.5 stored. Two lines of each part of a box alone
    were up to 5 % off, and pushed a sheet along by 2e-3 of the force."""
    random = np.random.default_rng(1)
    force = STIFFNESS * depth**1.5
    slim = depth / RADIUS  # where a round departs from its parabola
    for _ in range(6):
        shift = (random.uniform(-3, 3), random.uniform(-6, 6))
        total, most = _sheet(degrees, shift, depth, spread)
        assert total[2] == pytest.approx(-force, rel=1e-5 + 2.0 * slim**2)
        assert np.abs(total[:2]).max() < force * (1e-8 + 3e-2 * slim**2)
        assert total[STORED] == pytest.approx(0.4 * force * depth, rel=1e-5 + 2.0 * slim**2)
        assert abs(total[TORQUE_B]) < force * (1e-5 + 1e-2 * slim)  # about the roller's middle [N mm]
        assert total[DISSIPATED] == 0.0
        assert most <= MOST_POINTS


@pytest.mark.parametrize("degrees", [0.0, 17.0])
@pytest.mark.parametrize("leaning", [0.0005, 0.003])
def test_a_roller_that_leans_has_the_integral_of_its_depth(degrees: float, leaning: float) -> None:
    """k/w times the integral of z^1.5 along its width, where it is deep at one end, or out of the sheet."""
    depth = 0.03
    along = np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 200_001)
    deep = np.maximum(0.0, depth - along * math.sin(leaning)) ** 1.5
    expected = STIFFNESS / WIDTH * np.trapezoid(deep, along)
    total, _ = _sheet(degrees, (1.1, 2.3), depth, 0.0, leaning)
    assert total[2] == pytest.approx(-expected, rel=2e-3)


@pytest.mark.parametrize("degrees", [0.0, 3.0, 17.0, 45.0])
@pytest.mark.parametrize("leaning", [-0.003, 0.0005, 0.02])
def test_a_roller_that_leans_does_not_push_a_wider_sheet_along_its_axis(
    degrees: float, leaning: float
) -> None:
    """Where the sheet is moved in its plane nothing changes. (It was pushed by the sine of the angle.) Nor do
    dampers push it as the nip closes, or hold it as it is moved along the axis."""
    for shift, depth in (((1.1, 2.3), 0.03), ((-2.0, 5.9), 0.1)):
        for moving, damping in ((STILL, 0.0), ((0.0, 0.0, 5e-4), 0.6), ((0.0, 400.0, 0.0), 0.6)):
            total, _ = _sheet(degrees, shift, depth, 0.0, leaning, moving=moving, damping=damping)
            push = np.array((total[0], total[1], 0.0))
            slim = depth / RADIUS
            assert np.abs(push).max() < -total[2] * (3e-3 * abs(leaning) + 3e-2 * slim**2)


@pytest.mark.parametrize("width", [30.0, 90.0])
@pytest.mark.parametrize("degrees", [0.0, 3.0, 17.0, 45.0])
@pytest.mark.parametrize("leaning", [0.0, 0.0008])
def test_a_sheet_is_pushed_along_the_axis_by_what_the_nip_loses_of_its_energy(
    leaning: float, degrees: float, width: float
) -> None:
    """One that lies with both sides between the ends of a roller that leans, or with one: moved that way, it
    has its force times the way less stored."""
    for y in (0.0, 30.0, 37.0):
        ahead, _ = _sheet(degrees, (0.3, y), 0.06, 0.0, leaning, width)
        cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        way = 0.4
        low, high = (
            _sheet(degrees, (0.3 + side * sin * way, y + side * cos * way), 0.06, 0.0, leaning, width)[0]
            for side in (-0.5, 0.5)
        )
        lost = (low[STORED] - high[STORED]) / way
        assert ahead[1] == pytest.approx(lost, abs=2e-2 * abs(lost) - 2e-5 * ahead[2])


def test_an_end_of_a_roller_at_a_joint_is_handed_on_from_box_to_box() -> None:
    """Moved by a nanometre across it, no force changes by more than goes with that. (Neither box had the end
    where it was at their joint, and either had all of it beside.)"""
    law = Law(STIFFNESS, True, 0.0, 0.0, 0.0, 1e-3, 1e-3, 1e-2, 0.0)
    upright = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    b = Frame((0.0, 0.0, THIN + RADIUS - 0.06), upright, STILL, STILL)
    roller = Cylinder((0.0, 1.0, 0.0), RADIUS, 2.0 * HALF[1])
    for j in (-1, 0, 1):  # the roller is as long as a box
        found = []
        for way in (-1e-6, 0.0, 1e-6):
            out = np.zeros(OUT)
            a = Frame((0.0, 2 * j * HALF[1] + way, 0.0), upright, STILL, STILL)
            box_cylinder(out, a, Box((*HALF, THIN), 0), b, roller, law)
            found.append(out[FORCE_B : TORQUE_B + 3])
        assert np.ptp(found, axis=0).max() < 1e-4 * STIFFNESS * 0.06**1.5
