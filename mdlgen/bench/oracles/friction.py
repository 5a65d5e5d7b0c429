"""A block under Coulomb friction that is regularised by the cubic STEP over a smoothing speed."""

from __future__ import annotations

import math

import numpy as np

# int_0^1 2/(3 - u^2) du - 1/2: addition to the displacement below the smoothing speed
STOP = 2 / math.sqrt(3) * math.atanh(1 / math.sqrt(3)) - 0.5


def slide_acceleration(gravity: float, angle: float, mu: float) -> float:
    """g (sin a - mu cos a) of a block that slides down a slope."""
    return gravity * (math.sin(angle) - mu * math.cos(angle))


def creep(angle: float, mu: float, smoothing: float) -> float:
    """Speed at which a block that sticks creeps down: (3 u - u^3)/2 = tan a / mu, u over the smoothing."""
    roots = np.roots([-0.5, 0.0, 1.5, -math.tan(angle) / mu])
    real = [r.real for r in roots if abs(r.imag) < 1e-9 and 0.0 <= r.real <= 1.0 + 1e-9]
    return min(real) * smoothing


def stopping_distance(speed: float, mu: float, gravity: float, smoothing: float) -> float:
    """Way of a block on a level plane until it stops."""
    return (0.5 * speed**2 + STOP * smoothing**2) / (mu * gravity)


def slid(speed: float, mu: float, gravity: float, smoothing: float, time: float) -> float:
    """Way of a block on a level plane after `time`; its last bit, below the smoothing speed, as stopped."""
    if mu == 0.0:
        return speed * time
    if time < (speed - smoothing) / (mu * gravity):
        return speed * time - 0.5 * mu * gravity * time**2
    return stopping_distance(speed, mu, gravity, smoothing)
