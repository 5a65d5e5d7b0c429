"""Rigid bodies: a pendulum of any amplitude, and a body that turns freely."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.model.tables import Floats


def pendulum(time: float, length: float, gravity: float, start: float = 0.5 * math.pi) -> float:
    """Angle [rad] from the lowest point at `time` of a pendulum of equivalent length released at `start`.

    sin(angle/2) = k cd(w t, k), k = sin(start/2), w = sqrt(g / l): Jacobi's functions.
    """
    from scipy.special import ellipj

    k = math.sin(0.5 * start)
    _, cn, dn, _ = ellipj(math.sqrt(gravity / length) * time, k * k)
    return 2.0 * math.asin(k * cn / dn)


def period(length: float, gravity: float, start: float) -> float:
    """Of a pendulum: 4 K(sin(start/2)) sqrt(l / g)."""
    from scipy.special import ellipk

    return 4.0 * float(ellipk(math.sin(0.5 * start) ** 2)) * math.sqrt(length / gravity)


def tumble(inertia: Floats, spin: Floats, times: Floats) -> Floats:
    """Angular velocity in body axes (t, 3) of a free body by Euler's equations, to 1e-12.

    `inertia` and `spin` at the start are about the principal axes.
    """
    from scipy.integrate import solve_ivp

    def rates(_: float, w: Floats) -> Floats:
        return -np.cross(w, inertia * w) / inertia

    ran = solve_ivp(
        rates, (0.0, float(times[-1])), spin, method="DOP853", t_eval=times, rtol=1e-12, atol=1e-15
    )
    return ran.y.T


def slid_apart(speed: float, mu: float, gravity: float, top: float, bottom: float) -> tuple[float, float]:
    """(relative displacement, common speed at the end) of a block thrown along another one that lies on ice:
    v^2 / (2 mu g (1 + m/M)), v m/(m + M)."""
    return speed**2 / (2 * mu * gravity * (1 + top / bottom)), speed * top / (top + bottom)
