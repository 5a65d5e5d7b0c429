"""The velocities that a step begins its iterations with."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from mdlgen.backends.lattice.kernels.integrate.guess import add_to_history, forget, guess_velocities
from mdlgen.backends.lattice.kernels.state import GUESSES, OWN, OWN_SIZE, History

# Sheets of two boxes: one goes along a parabola, one along a line, one back and forth from step to step; and
# a roller, along a line.
SMOOTH, STRAIGHT, FLUTTERS = range(3)
LABEL = np.repeat([SMOOTH, STRAIGHT, FLUTTERS], 2)
STEPS = [0.1, 0.1, 0.05, 0.05, 0.025, 0.2, 0.1, 0.1, 0.1, 0.1]  # [ms]


pytestmark = pytest.mark.usefixtures("as_python")


class Motion:
    """Velocities in the middles of steps, and the work and history that belong to them."""

    def __init__(self) -> None:
        draw = np.random.default_rng(1)
        self.shape = draw.normal(size=(4, 6, 6))
        boxes = np.zeros((6, OWN))
        boxes[:, OWN_SIZE] = 6.0
        self.work: Any = SimpleNamespace(
            tables=SimpleNamespace(boxes=boxes),
            state=SimpleNamespace(u=np.zeros((6, 6)), ub=np.zeros(1)),
            free=SimpleNamespace(label=LABEL),
        )
        self.history = History(
            np.zeros((6, 6)), np.zeros(1), np.zeros((6, 6)), np.zeros(3), np.zeros((3, GUESSES))
        )
        self.t, self.many = 0.0, 0
        state, history = self.work.state, self.history
        state.u[:], state.ub[:] = self.at(0.0, -1), 2.0
        history.u[:], history.ub[:], history.earlier[:] = state.u, state.ub, state.u

    def at(self, t: float, many: int) -> np.ndarray:
        one, two, three, four = self.shape
        u = one + two * t
        u[LABEL == SMOOTH] += (three * t * t)[LABEL == SMOOTH]
        u[LABEL == FLUTTERS] += (-1) ** many * four[LABEL == FLUTTERS]
        return u

    def step(self, dt: float, bends: bool = True) -> tuple[np.ndarray, np.ndarray]:
        """Takes a step. Returns what was guessed of it and what it was."""
        state = self.work.state
        last, last_b = state.u.copy(), state.ub.copy()
        guess_velocities(self.work, self.history, dt, bends)
        guess, middle = np.append(state.u, state.ub), self.t + 0.5 * dt
        state.u[:], state.ub[:] = self.at(middle, self.many), 2.0 - 3.0 * middle
        add_to_history(self.work, self.history, dt, last, last_b)
        self.t, self.many = self.t + dt, self.many + 1
        return guess, np.append(state.u, state.ub)

    def taken(self, bends: bool = True) -> tuple[np.ndarray, np.ndarray]:
        """The last of the steps."""
        for dt in STEPS[:-1]:
            self.step(dt, bends)
        return self.step(STEPS[-1], bends)


def of(sheet: int, numbers: np.ndarray) -> np.ndarray:
    return numbers[:-1].reshape(6, 6)[sheet == LABEL]


@pytest.mark.parametrize("sheet", [SMOOTH, STRAIGHT])
def test_what_moves_smoothly_is_met(sheet: int) -> None:
    """At steps of any size."""
    guess, found = Motion().taken()
    assert of(sheet, guess) == pytest.approx(of(sheet, found), abs=1e-9)


def test_rollers_go_on_along_a_line() -> None:
    guess, found = Motion().taken()
    assert guess[-1] == pytest.approx(found[-1], abs=1e-12)


def test_what_flutters_goes_half_the_way() -> None:
    """That misses it by three times how far it flutters, a line by four times, a parabola by eight times."""
    motion = Motion()
    guess, found = motion.taken()
    off, far = of(FLUTTERS, guess - found), motion.shape[3][LABEL == FLUTTERS]
    assert np.linalg.norm(off) == pytest.approx(3.0 * np.linalg.norm(far), rel=0.05)


def test_steps_that_go_by_what_a_guess_misses_have_it_along_a_line() -> None:
    guess, found = Motion().taken(bends=False)
    assert np.abs(of(SMOOTH, guess - found)).min() > 1e-4
    assert of(STRAIGHT, guess) == pytest.approx(of(STRAIGHT, found), abs=1e-9)


def test_after_a_step_that_was_given_up_velocities_are_those_of_the_last_one() -> None:
    motion = Motion()
    motion.taken()
    before = motion.work.state.u.copy()
    forget(motion.history)
    guess, _ = motion.step(0.1)
    assert np.array_equal(guess[:-1].reshape(6, 6), before)
    # then along a line, and a parabola again once three steps are known
    guess, found = motion.step(0.1)
    assert of(STRAIGHT, guess) == pytest.approx(of(STRAIGHT, found), abs=1e-9)
    for _ in range(8):
        guess, found = motion.step(0.1)
    assert of(SMOOTH, guess) == pytest.approx(of(SMOOTH, found), abs=1e-9)
