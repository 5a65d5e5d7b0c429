"""Outer sides of a sheet that stand before an end of a plate, and those that come in over its face."""

from __future__ import annotations

import math

import numpy as np
import pytest
from edges import HALF, K, before_the_end, pushed, remembered
from scipy.spatial.transform import Rotation

pytestmark = pytest.mark.usefixtures("as_python")


def test_a_side_remembers_whether_it_came_from_above_or_from_the_end():
    edge = (0.02, 0.02, 0.0)
    beside = before_the_end(0.05, edge)
    assert beside != 0
    inside = (0.08 - HALF[0], 0.0, HALF[2] - 0.05)  # deeper past the end than below the face
    stubbed, lying = pushed(inside, edge=edge, beside=beside), pushed(inside, edge=edge)
    assert stubbed[0] < 0.0 and abs(stubbed[2]) < 1e-9 * abs(stubbed[0])
    assert lying[2] > 0.0 and abs(lying[0]) < 1e-9 * lying[2]
    kept = remembered(inside, edge, 2, beside)
    assert kept == beside
    # above the face, and below the plate, it is free
    for height in (HALF[2] + 0.001, -1.0 - HALF[2] - 0.001):
        place = (0.08 - HALF[0], 0.0, height)
        assert remembered(place, edge, 2, beside) == 0
        assert pushed(place, edge=edge)[12] == 0.0
    # a side that has a neighbour in its sheet catches on nothing
    assert remembered(inside, edge, 0, 0) == 0


@pytest.mark.parametrize("twist", [-0.03, 0.03, 0.1])
def test_a_twisted_side_stands_before_an_end_until_all_of_it_is_over(twist):
    """One corner comes over the round while another is up to 1 mm below the face: the side is not let in."""
    edge, high = (0.1, 0.1, 0.0), HALF[1] * abs(math.sin(twist))
    beside = before_the_end(0.3, edge)
    climbs = (0.09 - HALF[0], 0.0, HALF[2] - 0.02 - high)  # its highest corner is 0.02 mm below the face
    assert remembered(climbs, edge, 2, beside, twist) == beside
    level = (0.09 - HALF[0], 0.0, HALF[2] - 0.02)
    assert remembered(level, edge, 2, beside) == 0


@pytest.mark.parametrize("deep", [0.03, 0.05, 0.12])
@pytest.mark.parametrize("from_the_end", [0.2, 0.3, 0.4])
def test_a_side_that_comes_in_over_the_face_does_not_meet_the_end(deep, from_the_end):
    """A sheet stands on the plate, deeper than the edge is round and nearer to the end than the middle of the
    end is high. The end looks at its broad face, but it has the force that it has far away."""
    edge, upright = (0.02, 0.02, 0.0), math.pi / 2  # its leading side looks down
    near, far = (pushed((x + HALF[2], 0.0, HALF[0] - deep), upright, edge) for x in (from_the_end, 60.0))
    assert far[12] > 0.0
    assert near[:6] == pytest.approx(far[:6], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("slope", [0.12, 0.2, 0.3])
@pytest.mark.parametrize("radius", [0.1, 0.4])
def test_a_free_side_that_slides_out_over_an_end_is_held_all_the_way(slope, radius):
    """A box slopes down beyond the end, its lowest corners 0.01 mm below the face. They hand over to the edge
    while they are on its round: the force falls from that of the face as the round does, and is nowhere 0."""
    turned = Rotation.from_rotvec([0.0, -slope, 0.0])

    def lift(inset: float) -> float:
        corner = turned.apply([-HALF[0], 0.0, -HALF[2]])
        place = np.array([inset, 0.0, -0.01]) - corner
        return float(pushed(tuple(place), -slope, (radius, 0.1, 0.0), exposed=1)[2])

    forces = [lift(part * radius) for part in (0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.6, 2.0, 3.0)]
    assert forces[0] > 0.0 and (np.diff(forces[:5]) > 0.0).all()
    assert forces[4:] == pytest.approx([forces[-1]] * 5, rel=1e-6)


@pytest.mark.parametrize("yaw", [-0.3, 0.3])
def test_a_side_with_a_neighbour_is_no_face_of_a_steep_box(yaw):
    """A box of a sheet bends over an end, askew. Beyond some 46 deg its side, the joint to the next box,
    looks down more than its broad face does; the force of the plate does not know."""
    forces = []
    for slope in (0.80, 0.82):
        turned = Rotation.from_rotvec([0.0, -slope, 0.0]) * Rotation.from_rotvec([0.0, 0.0, yaw])
        lower = turned.apply([[x * HALF[0], y * HALF[1], -HALF[2]] for x in (-1, 1) for y in (-1, 1)])
        corner = lower[lower[:, 2].argmin()]  # 0.3 mm beyond the end, and 0.05 mm below the face at the end
        place = np.array([-0.3, 0.0, -0.05 - 0.3 * math.tan(slope)]) - corner
        forces.append(pushed(tuple(place), -slope, (0.02, 0.02, 0.0), exposed=0, yaw=yaw)[:3])
    assert np.abs(forces[1] - forces[0]).max() < 0.02 * K * 0.05**1.5
