"""Forces of stops that a text must have, over place and rate of what is stopped."""

from __future__ import annotations

import numpy as np

from mdlgen.altair.stops import Stopped, stopped
from mdlgen.mechanics.gate import BLUNT
from mdlgen.model.tables import Floats, Model
from mdlgen.verify.expected.times import OF_STOPS, Times
from mdlgen.verify.expected.units import SECOND
from mdlgen.verify.tables import Table, table

_BEYOND = (0.002, 0.03)  # how far beyond a stop the law is evaluated, in times the way between both
_RATES = (-3.0, -0.6, 0.0, 0.3, 0.9, 3.0)  # in times the rate over which the damping changes its sign


def stop_stations(model: Model) -> dict[str, tuple[float, ...]]:
    """Of what has stops: place [mm, rad] and rate [mm/s, rad/s] of each point at which the force is
    evaluated, one after the other."""
    return {f"{OF_STOPS}{one.name}": _points(one) for one in stopped(model, BLUNT)}


def _points(one: Stopped) -> tuple[float, ...]:
    low, high = one.ends
    points = [(low + s * (high - low), k) for s in (0.1, 0.9) for k in (-1.0, 1.0)]
    for share in _BEYOND:
        z = share * (high - low)
        for k in _RATES:
            rate = k * one.blunt / SECOND * z
            points += [(low - z, rate), (high + z, rate)]
    return tuple(v for point in points for v in point)


def stops(model: Model, times: Times) -> Table:
    """Axis of each, and its force [N], or torque [N mm], at every place and rate."""
    found = [(one, np.reshape(times[f"{OF_STOPS}{one.name}"], (-1, 2))) for one in stopped(model, BLUNT)]
    width = max((len(points) for _, points in found), default=0)
    axes = np.zeros((len(found), 3))
    forces, scales = np.zeros((2, len(found), width))
    words = []
    for k, (one, points) in enumerate(found):
        axes[k] = one.axis
        forces[k], scales[k] = _law(one, *points.T)
        i, j = (f"j_{one.name}_{one.joint}.{end}" for end in "ij")
        calls = (f"{i},{j}", f"{i},{j},{j}") if one.turns else (f"{i},{j},{j}",)
        words.append((one.body, *calls, "torque" if one.turns else "force"))
    return table(
        [f"frc_{one.name}_stops" for one, _ in found], {"axis": (axes, 1.0), "force": (forces, scales)}, words
    )


def _law(one: Stopped, place: Floats, rate: Floats) -> tuple[Floats, Floats]:
    low, high = one.ends
    stiff, total, scale = one.stops.stiffness, np.zeros(len(place)), np.zeros(len(place))
    for side, z in ((1.0, place - high), (-1.0, low - place)):
        z = np.maximum(z, 0.0)
        over = np.where(z > 0.0, one.blunt / SECOND * z, 1.0)
        x = np.clip(side * rate / over, -1.0, 1.0)
        total -= side * stiff * z * (1.0 + one.share * 0.5 * x * (3.0 - x * x))
        # the place beyond is a difference, and the rate relative to it has its round-off
        scale += np.where(
            z > 0.0, stiff * (1.0 + 3.0 * one.share) * (np.abs(place) + max(abs(low), abs(high))), 0.0
        )
    return total, np.maximum(scale, stiff * (high - low))
