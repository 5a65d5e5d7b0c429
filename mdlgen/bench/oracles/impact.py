"""One impact with F = k z^1.5 (1 + beta s(v)), s the cubic STEP over the smoothing speed, no gravity.

From v dv/dz = -(k/m) z^1.5 (1 + beta s(v)) follows, whatever m, k and the exponent,
    int_0^e v dv / (1 - beta s) = int_0^1 v dv / (1 + beta s)      (speeds over that of the impact).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np


@dataclass(frozen=True)
class Impact:
    """The state after an impact, in the units of m, k and v0."""

    restitution: float
    time: float  # in contact
    depth: float  # greatest
    force: float  # greatest


def share(restitution: float) -> float:
    """beta = (1 - c^2)/(1 + c^2) of the paper's Eq. 11."""
    return (1 - restitution**2) / (1 + restitution**2)


def sign(speed: float, smoothing: float) -> float:
    """The cubic STEP from -1 to 1."""
    x = min(max(speed / smoothing, -1.0), 1.0)
    return 0.5 * x * (3.0 - x * x)


def rebound(into: float, beta: float, smoothing: float) -> float:
    """Speed with which a body leaves that has the energy `into` per mass at the greatest depth, relative
    to the undamped force: int_0^v v dv/(1 - beta s(v)) = into."""
    from scipy.integrate import quad

    def missing(speed: float) -> float:
        knee = [smoothing] if smoothing < speed else None
        done = quad(lambda v: v / (1 - beta * sign(v, smoothing)), 0.0, speed, points=knee, epsabs=1e-14)
        return done[0] - into

    high = np.sqrt(2.0 * into)
    if beta == 0.0:
        return float(high)
    if beta >= 1.0:
        return _all_damped(into, smoothing)
    return _root(missing, high)


def _all_damped(into: float, smoothing: float) -> float:
    """`rebound` for beta = 1: the body stays below the smoothing speed, where no force is left.

    With x = v / smoothing, 1 - s = (1 - x)^2 (2 + x) / 2, and x dx/(1 - s) has a closed integral.
    """

    def missing(log_gap: float) -> float:
        gap = np.exp(log_gap)
        done = 4 / 9 * (log_gap - np.log((3 - gap) / 2)) + 2 / 3 * (1 / gap - 1)
        return done - into / smoothing**2

    return smoothing * (1 - float(np.exp(_root(missing, 0.0, -60.0))))


def _root(function: Callable[[float], float], high: float, low: float = 0.0) -> float:
    from scipy.optimize import root_scalar

    return float(root_scalar(function, bracket=(low, high), xtol=1e-14).root)


def restitution(coefficient: float, smoothing: float) -> float:
    """Rebound speed over impact speed; `smoothing` is over the impact speed too."""
    from scipy.integrate import quad

    beta = share(coefficient)
    knee = [smoothing] if smoothing < 1.0 else None
    into = quad(lambda v: v / (1 + beta * sign(v, smoothing)), 0.0, 1.0, points=knee, epsabs=1e-14)
    return rebound(into[0], beta, smoothing)


class _Leaves:
    """The event of a body that comes out of the contact, as solve_ivp wants it."""

    terminal, direction = True, -1

    def __call__(self, _: float, y: np.ndarray) -> float:
        return float(y[0])


@cache
def impact(mass: float, stiffness: float, speed: float, coefficient: float, smoothing: float) -> Impact:
    """All of an impact; mass, stiffness of z^1.5, speed and smoothing speed in one set of units.

    Restitution by quadrature, the rest by integration in time to 1e-11.
    """
    from scipy.integrate import solve_ivp

    beta, smooth = share(coefficient), smoothing / speed
    length = (mass * speed**2 / stiffness) ** 0.4

    def force(z, v):
        return np.maximum(z, 0.0) ** 1.5 * (1.0 + beta * sign(v, smooth))

    ran = solve_ivp(
        lambda _, y: [y[1], -force(y[0], y[1])],
        (0.0, 1e3),
        [1e-14, 1.0],
        method="DOP853",
        events=_Leaves(),
        rtol=1e-11,
        atol=1e-14,
        max_step=0.01,
    )
    forces = [force(z, v) for z, v in ran.y.T]
    return Impact(
        restitution=restitution(coefficient, smooth),
        time=float(ran.t_events[0][0]) * length / speed,
        depth=float(ran.y[0].max()) * length,
        force=float(max(forces)) * stiffness * length**1.5,
    )
