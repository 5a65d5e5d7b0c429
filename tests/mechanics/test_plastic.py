"""The law of a joint that yields, against closed forms of bilinear bending with kinematic hardening."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mdlgen.mechanics import plastic
from mdlgen.mechanics.plastic import HINGE
from mdlgen.model.rotations import matrices

pytestmark = pytest.mark.usefixtures("as_python")

K, YIELD = 1.7, 0.06  # N mm/rad, rad: where it begins to yield
STEPS = 400


def hinge(share: float) -> Any:
    """One whose moment grows by `share` of K beyond YIELD."""
    made = np.zeros(1, HINGE)
    made["k"], made["moment"], made["hardening"] = K, K * YIELD, K * share / (1.0 - share)
    return made.view(np.recarray)[0]


def bent(of: Any, *turns: float) -> float:
    """Takes it from turn to turn [rad], each in equal steps. Returns the moment at the end [N mm]."""
    at = float(of.begun)
    for turn in turns:
        for now in np.linspace(at, turn, STEPS + 1)[1:].tolist():
            plastic.accept(of, at, now)
            at = now
    of.begun = at
    return K * (at - float(of.plastic))


@pytest.mark.parametrize(("share", "most"), [(0.01, 0.07), (0.01, 0.4), (0.2, 0.3), (0.2, -0.3), (0.7, 0.1)])
def test_it_springs_back_by_the_moment_over_the_stiffness(share: float, most: float) -> None:
    of = hinge(share)
    moment = bent(of, most)
    sign = np.sign(most)
    assert moment == pytest.approx(sign * K * (YIELD + share * (abs(most) - YIELD)), rel=1e-12)
    left = most - moment / K
    assert left == pytest.approx(sign * (1.0 - share) * (abs(most) - YIELD), rel=1e-12)
    assert bent(of, left) == pytest.approx(0.0, abs=1e-14)
    assert float(of.plastic) == pytest.approx(left, rel=1e-12)


def test_a_joint_that_hardens_much_yields_back_as_it_springs_back() -> None:
    """Where its moment was more than 2 M_y, it keeps M_y/H without moment."""
    of = hinge(0.5)
    assert bent(of, 0.5) > 2.0 * K * YIELD
    assert bent(of, YIELD) == pytest.approx(0.0, abs=1e-12)  # H = K, so M_y/H = YIELD
    assert float(of.plastic) == pytest.approx(YIELD, rel=1e-9)


def test_reversed_it_yields_once_the_moment_has_changed_by_twice_the_yield_moment() -> None:
    """Prager's law, and the Bauschinger effect of it."""
    of = hinge(0.25)
    most = bent(of, 0.2)
    turn, kept = 0.2 - 2.0 * YIELD, float(of.plastic)
    assert bent(of, turn + 1e-6) == pytest.approx(most - 2.0 * K * YIELD, abs=1e-5)
    assert float(of.plastic) == kept
    assert bent(of, turn - 0.05) == pytest.approx(most - 2.0 * K * YIELD - 0.25 * K * 0.05, rel=1e-9)


@pytest.mark.parametrize("share", [0.05, 0.5])
def test_a_cycle_dissipates_the_area_of_its_loop(share: float) -> None:
    """A parallelogram: 4 M_y times the plastic amplitude."""
    of, most = hinge(share), 0.25
    bent(of, most, -most, most)
    before = float(of.lost)
    bent(of, -most, most)
    area = 4.0 * K * YIELD * (1.0 - share) * (most - YIELD)
    # of each of two starts of yielding a half of one step's plastic turn is not counted at M_y
    assert float(of.lost) - before == pytest.approx(area, rel=2.0 / STEPS)


def test_work_is_stored_or_dissipated() -> None:
    """In the middle of each step the moment is that of the step: M dt = d(k (t - p)^2/2 + H p^2/2) + loss."""
    of, rng = hinge(0.3), np.random.default_rng(4)
    at = work = 0.0
    for turn in rng.uniform(-0.3, 0.3, 40).tolist():
        of.begun = at
        p = plastic.in_the_middle(of, 0.5 * (at + turn))
        work += K * (0.5 * (at + turn) - p) * (turn - at)
        assert plastic.accept(of, at, turn) >= -1e-15  # round-off where it stands at the yield moment
        at = turn
    stored = 0.5 * K * at**2 + plastic.stored(of, at, float(of.plastic))
    assert work == pytest.approx(stored + float(of.lost), rel=1e-12)
    assert float(of.lost) > 0.1 * work


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.3, -0.2, 0.1), (1.4, 0.9, -0.5)])
def test_the_couple_is_the_gradient_of_the_turn(axis: int, turn: tuple[float, float, float]) -> None:
    one, two = matrices(np.array([[0.4, 0.2, -0.7], turn]))
    two = one @ two
    flat = tuple(one.ravel().tolist())

    def bending(of: np.ndarray) -> float:
        return plastic.bending(flat, tuple(of.ravel().tolist()), axis)

    torque = plastic.couple(flat, tuple(two.ravel().tolist()), axis, 2.0)
    step = 1e-6
    for k, way in enumerate(step * np.eye(3)):
        ahead, behind = (matrices(np.array([sign * way]))[0] @ two for sign in (1.0, -1.0))
        slope = (bending(ahead) - bending(behind)) / (2.0 * step)
        assert torque[k] == pytest.approx(2.0 * slope, abs=1e-7)
