"""Friction that sticks between two boxes: its force, its energy, and stretches that find new corners."""

from __future__ import annotations

import numpy as np
import pytest

from mdlgen.mechanics.frame import Box, Frame, Law
from mdlgen.mechanics.overlap import OVERLAP, STIFF, find
from mdlgen.mechanics.point import DISSIPATED, FACES, FORCE_A, FORCE_B, GRIP, PRESSING, RUBBING, TORQUE_A
from mdlgen.mechanics.stick import STRETCH, carry_stretch, end_step, let_go, press_sticking

pytestmark = pytest.mark.usefixtures("as_python")

UNTURNED = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
HALF, DEEP = (3.0, 2.0, 0.05), 2e-3
LAW = Law(2000.0, True, 0.0, 0.3, 0.3, 1e-3, 1e-3, 1e-3)
RATIO = 0.025  # k_t is 50 N/mm
H = 0.05


class Pair:
    """The first of two equal boxes lies on the other, and moves as a test says."""

    def __init__(self, law: Law = LAW):
        self.law, self.place = law, np.array([0.0, 0.0, 2.0 * HALF[2] - DEEP])
        self.kept = np.zeros(1, OVERLAP).view(np.recarray)[0]
        self.stuck = np.zeros(1, STRETCH).view(np.recarray)[0]
        self.find()

    def frames(self, rate=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0)) -> tuple[Frame, Frame]:
        still = (0.0, 0.0, 0.0)
        return Frame(tuple(self.place.tolist()), UNTURNED, rate, spin), Frame(still, UNTURNED, still, still)

    def find(self) -> None:
        a, b = self.frames()
        box = Box(HALF, 0)
        find.py_func(self.kept, a, box, b, box, self.law)
        carry_stretch(self.stuck, self.kept, a, b, RATIO)

    def step(self, rate, spin=(0.0, 0.0, 0.0)) -> np.ndarray:
        """Of 2 H; by how much it moves the first box is left out, but for its depth."""
        out = np.zeros(FACES)
        a, b = self.frames(rate, spin)
        assert press_sticking(out, self.kept, self.stuck, a, b, self.law, RATIO, H)
        end_step(self.stuck, self.kept, 0, 1)
        self.place[2] += 2.0 * H * rate[2]
        return out


NORMAL = LAW.k * DEEP**1.5


def test_a_stuck_pair_is_a_spring_that_gives_back_what_it_took() -> None:
    pair, way, taken = Pair(), 0.0, 0.0
    for rate in (1e-4, 2e-4, 0.0, -1e-4, -2e-4):
        out = pair.step((rate, 0.0, 0.0))
        way += 2.0 * H * rate
        assert out[FORCE_A] == pytest.approx(-50.0 * way, abs=1e-15)
        assert out[FORCE_B] == -out[FORCE_A]
        assert pair.stuck.energy == pytest.approx(25.0 * way * way, abs=1e-18)
        assert out[DISSIPATED] == pytest.approx(50.0 * H * rate * rate, abs=1e-18)
        taken += 2.0 * H * (-out[FORCE_A] * rate - out[DISSIPATED])
    assert taken == pytest.approx(0.0, abs=1e-18)


def test_it_slides_at_the_limit_and_turns_back_at_once() -> None:
    pair = Pair()
    for _ in range(20):
        out = pair.step((0.6e-3, 0.8e-3, 0.0))
    assert out[FORCE_A] == pytest.approx(-0.3 * NORMAL * 0.6, rel=1e-12)
    assert out[FORCE_A + 1] == pytest.approx(-0.3 * NORMAL * 0.8, rel=1e-12)
    assert out[RUBBING] == pytest.approx(out[GRIP], rel=1e-12)
    # in a steady slide all that is put in is lost
    assert out[DISSIPATED] == pytest.approx(0.3 * NORMAL * 1e-3, rel=1e-9)
    back = pair.step((-0.6e-4, -0.8e-4, 0.0))
    assert back[FORCE_A] - out[FORCE_A] == pytest.approx(50.0 * 2.0 * H * 0.6e-4, rel=1e-9)


def test_a_couple_about_the_normal_is_held() -> None:
    pair = Pair()
    spin = 1e-5
    out = pair.step((0.0, 0.0, 0.0), (0.0, 0.0, spin))
    # four corners with a quarter of k_t each
    assert out[TORQUE_A + 2] == pytest.approx(-50.0 * 13.0 * 2.0 * H * spin, rel=1e-9)
    assert np.abs(out[FORCE_A : FORCE_A + 2]).max() < 1e-15


@pytest.mark.parametrize("seed", range(20))
def test_it_makes_no_energy_whatever_the_motion_and_the_load(seed) -> None:
    draw = np.random.default_rng(seed)
    pair = Pair(LAW._replace(mu_static=0.4, mu_dynamic=0.2, sliding=2e-3))
    for k in range(60):
        depth = 2.0 * HALF[2] - pair.place[2]
        up = (DEEP * draw.uniform(0.2, 2.0) - depth) / (-2.0 * H)
        rate, spin = draw.normal(0.0, 1e-3, 2), draw.normal(0.0, 1e-4)
        before = pair.stuck.energy
        out = pair.step((*rate.tolist(), float(up)), (0.0, 0.0, float(spin)))
        assert out[DISSIPATED] > -1e-16
        assert out[RUBBING] <= out[GRIP] * (1.0 + 1e-12)
        assert pair.stuck.energy <= before + 2.0 * H * _power(out, rate, up, spin, pair) + 1e-16
        if k % 5 == 4:
            energy = pair.stuck.energy
            pair.place[:2] += draw.normal(0.0, 1e-3, 2)
            pair.find()
            kept, now = pair.kept, pair.stuck.now
            count = int(kept.count)
            stiffness = kept.corners[:count, STIFF, None]
            assert 0.5 * RATIO * (stiffness * now[:count] ** 2).sum() <= energy * (1 + 1e-12)
    assert let_go(pair.stuck) >= 0.0 and pair.stuck.count == 0


def _power(out, rate, up, spin, pair) -> float:
    """What is put into friction: that of the normal force is elastic."""
    normal = out[PRESSING] * up
    force = out[FORCE_A : FORCE_A + 3] @ np.array([*rate, up])
    return -(force - normal + out[TORQUE_A + 2] * spin)


def test_corners_that_are_found_anew_go_on_with_the_force() -> None:
    pair = Pair()
    out = pair.step((2e-4, 1e-4, 0.0))
    pair.place[:2] += 1e-3
    pair.find()
    again = pair.step((0.0, 0.0, 0.0))
    assert again[FORCE_A : FORCE_A + 2] == pytest.approx(out[FORCE_A : FORCE_A + 2], rel=1e-3)
    # nothing has moved: the same corners, to the last bit
    once = pair.step((0.0, 0.0, 0.0))
    pair.find()
    assert np.array_equal(pair.step((0.0, 0.0, 0.0)), once)


def test_the_force_stays_where_the_other_face_comes_to_own_the_contact() -> None:
    pair = Pair()
    out = pair.step((2e-4, 1e-4, 0.0), (0.0, 0.0, 1e-6))
    assert pair.stuck.first == 1
    # as the other box would have found it
    a, b = pair.frames()
    half = pair.kept.corners.copy()
    pair.kept.first = 0
    for k in range(4):
        pair.kept.corners[k, :2] = half[k, :2] + pair.place[:2]
    pair.kept.side = 1
    carry_stretch(pair.stuck, pair.kept, a, b, RATIO)
    again = pair.step((0.0, 0.0, 0.0))
    assert again[FORCE_A : FORCE_A + 2] == pytest.approx(out[FORCE_A : FORCE_A + 2], rel=1e-12)
