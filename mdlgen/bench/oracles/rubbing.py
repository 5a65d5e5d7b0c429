"""A block that slides on a level plane with friction as it is measured, by scipy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def aslant(
    speed: tuple[float, float], mu: tuple[float, float], gravity: float, time: float
) -> tuple[np.ndarray, np.ndarray]:
    """Way and velocity after `time` where friction is mu[0] along MD and mu[1] along CD: a = -g M^2 v/|M v|,
    M = diag(mu), whose force is on the ellipse and whose velocity is square to it."""
    squares = np.square(mu)

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        v = y[2:]
        return np.concatenate([v, -gravity * squares * v / np.sqrt((squares * v * v).sum())])

    end = _end(rate, [0.0, 0.0, *speed], time)
    return end[:2], end[2:]


def over_speeds(
    speed: float, mu: Callable[[float], float], gravity: float, time: float
) -> tuple[float, float]:
    """Way and speed after `time` where friction is mu(v)."""
    way, v = _end(lambda _, y: np.array([y[1], -gravity * mu(y[1])]), [0.0, speed], time)
    return float(way), float(v)


def _end(rate: Callable[[float, np.ndarray], np.ndarray], start: list[float], time: float) -> np.ndarray:
    from scipy.integrate import solve_ivp

    found = solve_ivp(rate, (0.0, time), start, method="DOP853", rtol=1e-10, atol=1e-12)
    return found.y[:, -1]
