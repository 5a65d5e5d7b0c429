"""Tension of a belt that slips on a round body, and of a web between two nips."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.model.tables import Floats


def polygon(mu: float, angle: float, count: int) -> float:
    """Ratio of the tensions of a belt of `count` rigid links that lie on an arc of `angle` [rad] with their
    middles: [(1 + mu tan(h)) / (1 - mu tan(h))]^n, h half a link's angle; e^(mu angle) for many."""
    lean = mu * math.tan(0.5 * angle / count)
    return ((1 + lean) / (1 - lean)) ** count


def creep(force: float, most: float, smoothing: float) -> float:
    """Slip at which friction that may bear `most` bears `force`: (3 u - u^3)/2 = force/most, u the slip over
    the smoothing speed (the cubic STEP)."""
    part = min(max(force / most, -1.0), 1.0)
    return smoothing * 2.0 * math.sin(math.asin(part) / 3.0)


def web(
    times: Floats, span: float, speed: float, draw: float, stiffness: float, most: float, smoothing: float
) -> Floats:
    """Strain of a web between two nips at `speed` and `speed` (1 + `draw`), free of it at the start and
    before the first; `stiffness` is force over strain, `most` what a nip may bear.

    The material between the nips is conserved: d/dt L/(1 + e) = v1 - v2/(1 + e).
    """
    from scipy.integrate import solve_ivp

    def rate(_: float, strain: Floats) -> Floats:
        slip = creep(stiffness * float(strain[0]), most, smoothing)
        into, out = speed + slip, speed * (1.0 + draw) - slip
        return ((1.0 + strain) * out - (1.0 + strain) ** 2 * into) / span

    ran = solve_ivp(rate, (0.0, float(times[-1])), [0.0], t_eval=times, rtol=1e-10, atol=1e-14)
    return np.asarray(ran.y[0])
