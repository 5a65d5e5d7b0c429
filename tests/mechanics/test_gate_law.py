"""The law of a part that moves by corners, its command, and the stop of a free one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mdlgen.backends.lattice.arrays import BODY
from mdlgen.mechanics.gate import command, course, gate, stop
from mdlgen.model.tables import MovingPart, StopsPart

pytestmark = pytest.mark.usefixtures("as_python")

X = np.array([1.0, 0.0, 0.0])


def body(moving: MovingPart) -> np.ndarray:
    """A record of a part that moves, in the Model's units."""
    bodies = np.zeros(1, BODY)
    gate(bodies[0], moving, 1.0, 1.0, 1.0)
    return bodies


def slides(*corners: tuple[float, float]) -> np.ndarray:
    return body(MovingPart(False, X, np.zeros(3), np.array([(*corner, 0.0) for corner in corners])))


def test_it_goes_by_the_cubic_of_its_share_of_time():
    bodies = slides((10.0, 0.0), (30.0, 4.0), (40.0, 1.0))
    for t in (0.0, 10.0, 12.5, 20.0, 29.0, 30.0, 33.0, 40.0, 99.0):
        begin, end, way, start = (10.0, 30.0, 4.0, 0.0) if t < 30.0 else (30.0, 40.0, -3.0, 4.0)
        s = min(max((t - begin) / (end - begin), 0.0), 1.0)
        place, rate = course(bodies[0], t)
        assert place == pytest.approx(start + way * s * s * (3.0 - 2.0 * s), abs=1e-14)
        assert rate == pytest.approx(way * 6.0 * s * (1.0 - s) / (end - begin), abs=1e-15)


def test_a_command_continues_in_place_and_velocity():
    bodies = slides((0.0, 0.0), (20.0, 5.0))
    before = course(bodies[0], 8.0)
    command(bodies, 0, 8.0, -2.0, 10.0)
    now, end = course(bodies[0], 8.0), course(bodies[0], 18.0)
    assert now == pytest.approx(before, rel=1e-15)
    assert before.rate == pytest.approx(5.0 * 6.0 * 0.4 * 0.6 / 20.0, rel=1e-12)
    assert end == pytest.approx((-2.0, 0.0), abs=1e-15)
    # the rate is that of the place
    for t in (8.5, 12.0, 17.0):
        quotient = (course(bodies[0], t + 1e-5).place - course(bodies[0], t - 1e-5).place) / 2e-5
        assert course(bodies[0], t).rate == pytest.approx(quotient, abs=1e-9)
    # again, while it moves
    command(bodies, 0, 12.0, 3.0, 5.0)
    assert course(bodies[0], 17.0) == pytest.approx((3.0, 0.0), abs=1e-14)


def test_a_command_to_what_has_no_law_is_refused():
    free = body(MovingPart(False, X, np.zeros(3), np.zeros((0, 3)), inertia=1.0))
    with pytest.raises(ValueError, match="no law"):
        command(free, 0, 1.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="duration above 0"):
        command(slides((0.0, 0.0)), 0, 1.0, 1.0, 0.0)


@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("speed", [0.01, 3.0])
def test_a_stop_returns_what_hits_it_with_its_restitution(restitution: float, speed: float):
    inertia, stops = 7.0, StopsPart(-2.0, 1.0, 40.0, restitution)
    bodies = body(MovingPart(False, X, np.zeros(3), np.zeros((0, 3)), inertia=inertia, stops=stops))
    for side in (1.0, -1.0):
        place, rate = (1.0 if side > 0.0 else -2.0), side * speed
        dt, dissipated = 2e-4, 0.0
        place += 0.5 * dt * rate
        while side * rate > 0.0 or stop(bodies[0], place, rate).force != 0.0:
            # leapfrog with the rate in the middle by two rounds
            middle = rate
            for _ in range(2):
                middle = rate + 0.5 * dt * stop(bodies[0], place, middle).force / inertia
            acts = stop(bodies[0], place, middle)
            dissipated += dt * acts.lost
            rate = 2.0 * middle - rate
            place += dt * rate
        # 1 %: the damping changes its sign over a part of the speed of the impact
        assert -side * rate == pytest.approx(restitution * speed, rel=0.01)
        assert dissipated == pytest.approx(
            0.5 * inertia * (speed**2 - rate**2), abs=2e-4 * inertia * speed**2
        )


def test_the_slopes_of_a_stop_are_those_of_its_force():
    stops = StopsPart(-1.0, 1.0, 40.0, 0.4)
    bodies = body(MovingPart(False, X, np.zeros(3), np.zeros((0, 3)), inertia=2.0, stops=stops))
    for place in (1.3, -1.2):
        for rate in (0.0, 0.05, -0.08, 2.0, -3.0):
            acts = stop(bodies[0], place, rate)
            by_place = -(
                stop(bodies[0], place + 1e-7, rate).force - stop(bodies[0], place - 1e-7, rate).force
            )
            by_rate = -(stop(bodies[0], place, rate + 1e-7).force - stop(bodies[0], place, rate - 1e-7).force)
            assert acts.by_place == pytest.approx(by_place / 2e-7, rel=1e-5)
            assert acts.by_rate == pytest.approx(by_rate / 2e-7, rel=1e-5, abs=1e-5)
            assert acts.lost >= 0.0
            assert acts.force * math.copysign(1.0, place) <= 0.0
