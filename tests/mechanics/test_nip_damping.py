"""Damping at the points of a nip: it takes energy however a box turns, and parts add up."""

from __future__ import annotations

import math

import numpy as np
import pytest
from laws import box_cylinder

from mdlgen.mechanics.frame import Box, Cylinder, Frame, Law
from mdlgen.mechanics.point import DISSIPATED, FORCE, MOST_POINTS, OUT, POINT, PRESSING, RATE


def _under(out, at, speed, law):
    zero, one = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    a, b = Frame((at, 0.0, 0.0), one, speed, zero), Frame((0.0, 0.0, 7.51), one, zero, (0.0, 0.07, 0.0))
    box_cylinder(out, a, Box((2.0, 3.0, 0.05), 0), b, Cylinder((0.0, 1.0, 0.0), 7.5, 4.0), law)


def _over(out, at, rise, spin, law):
    zero, one = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    a = Frame((at, 0.0, 0.0), one, (0.0, 0.0, rise), (0.0, spin, 0.0))
    b = Frame((0.0, 0.0, 7.51), one, zero, zero)
    box_cylinder(out, a, Box((2.0, 3.0, 0.05), 0), b, Cylinder((0.0, 1.0, 0.0), 7.5, 4.0), law)


def test_damping_takes_energy_however_a_box_in_a_nip_turns() -> None:
    """One that ends in the nip, too, and turns about a place there."""
    law = Law(300.0, True, 0.9, 0.0, 0.0, 1e-3, 1e-3, 5e-3)
    draw = np.random.default_rng(1)
    for at, rise, spin in draw.uniform([-2.7, -0.02, -0.1], [2.7, 0.02, 0.1], (400, 3)):
        out = np.zeros(OUT)
        _over(out, at, rise, spin, law)
        fastest = abs(rise) + abs(spin) * (abs(at) + 0.8)
        # forces lean with the round, by 0.05 at most, which the rate of the depth does not know
        assert out[DISSIPATED] > -0.02 * out[PRESSING] * fastest


@pytest.mark.parametrize("rate", [-0.03, -0.004, 0.0, 0.004, 0.03])
@pytest.mark.parametrize("beta", [0.6, 1.0])
@pytest.mark.parametrize("passing", [0.0, 0.05])
def test_all_points_of_a_nip_are_damped_by_its_one_rate(rate: float, beta: float, passing: float) -> None:
    """Two boxes side by side, the joint anywhere under the roller: together F = k z^1.5 (1 + beta s(rate))
    along the normal of the face, never below zero, and nothing along it; stored is 2/5 k z^2.5, and what
    is lost is the work of the damping. That of boxes that pass is whole over the speed at which they are
    pressed in, too."""
    law, k, z = (beta, 0.0, 0.0, 1.0, 1.0, 0.01), 300.0, 0.04
    x = rate / math.hypot(0.01, passing * math.sqrt(7.5**2 - (7.5 - z) ** 2) / 7.5)
    step = math.copysign(1.0, rate) if abs(x) >= 1.0 else 0.5 * x * (3.0 - x * x)
    for joint in np.linspace(-1.0, 1.0, 9):
        total = np.zeros(OUT)
        for side in (-2.0, 2.0):
            out = np.zeros(OUT + 1 + POINT * MOST_POINTS)
            _under(out, joint + side, (passing, 0.0, rate), Law(k, True, *law))
            total += out[:OUT]
            points = out[OUT + 1 :].reshape(-1, POINT)[: int(out[OUT])]
            assert (points[:, FORCE] >= 0.0).all()
            np.testing.assert_allclose(points[:, RATE], rate, atol=1e-12)
        force = k * z**1.5 * (1.0 + beta * step)
        assert total[2] == pytest.approx(-force, rel=2e-3, abs=1e-9)
        assert abs(total[0]) <= 1e-3 * force + 1e-12
        assert total[13] == pytest.approx(0.4 * k * z**2.5, rel=2e-3)
        assert total[14] == pytest.approx(beta * step * k * z**1.5 * rate, rel=5e-3, abs=2e-4 * force)


def _pressed(out, at, depth, law):
    zero, one = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    a, b = Frame((at, 0.0, 0.0), one, zero, zero), Frame((0.0, 0.0, 7.55 - depth), one, zero, zero)
    box_cylinder(out, a, Box((4.0, 3.0, 0.05), 0), b, Cylinder((0.0, 1.0, 0.0), 7.5, 4.0), law)


@pytest.mark.parametrize("depth", [0.02, 0.1, 0.45])
@pytest.mark.parametrize("wide", [0.0, 15.0])
def test_parts_of_a_nip_add_up_wherever_a_joint_is(depth: float, wide: float) -> None:
    """To the force of the whole nip, and to nothing along the sheet: else a joint that passes lifts the
    roller and draws a light sheet forth and back (by 0.6 % and 0.1 % of the force at the last depth)."""
    law = Law(300.0, True, 0.0, 0.0, 0.0, 1e-3, 1e-3, 1e-2)._replace(spread=wide)
    whole = np.zeros(OUT)
    _pressed(whole, 0.0, depth, law)
    for joint in np.linspace(-3.0, 3.0, 25):
        total = np.zeros(OUT)
        for side in (-4.0, 4.0):
            out = np.zeros(OUT)
            _pressed(out, joint + side, depth, law)
            total += out
        assert total[2] == pytest.approx(whole[2], rel=1e-4)
        assert abs(total[0]) < 1e-6 * abs(whole[2])
        assert total[13] == pytest.approx(whole[13], rel=2e-3)
