"""The heavy elastica over a sharp edge: a strip that lies on a table and hangs over its end.

With theta the slope below the horizontal, s along the strip from where it leaves the table, b up to the edge
and a beyond it, S the force at the first of these places and w the weight per length,

    D theta'' = -(S - w s) cos theta              up to the edge, theta(0) = theta'(0) = 0,
    D theta'' = -w (a + b - s) cos theta          beyond it, theta'(a + b) = 0,

and the strip is as high at the edge as on the table. The edge pushes upwards, as friction holds. Lifted, the
strip reaches less far: what lies between is drawn back over the edge. Where nothing of it lies flat, its end
alone stands on the table, theta(0) is not known, and b is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.model.tables import Floats

_TIGHT = 1e-10


class Overhang(NamedTuple):
    """How far the end hangs below the table, and its distance from the edge along it [mm]; the slope at
    the edge [rad], and the length that is lifted before it [mm]."""

    sag: float
    reach: float
    slope: float
    lifted: float


def overhang(weight: float, stiffness: float, length: float, out: float) -> Overhang:
    """A strip of a `length` [mm], weight [N/mm] and bending stiffness D times its width [N mm^2], laid flat
    with `out` [mm] of it beyond the edge and held by friction at its other end."""
    from scipy.optimize import least_squares

    group = weight * out**3 / stiffness  # in lengths of `out`, and forces of its weight
    rest = length / out - 1.0

    def shape(unknown: Floats) -> tuple[Floats, Floats]:
        force, start, free = unknown
        lies = start >= 0.0  # else it stands on its end, with that slope upwards
        lifted, slope = (start, 0.0) if lies else (rest + 1.0 - free, start)
        before = _run(lambda s: -group * (force - s), lifted, [slope, 0.0])
        beyond = _run(lambda s: -group * (free - s), free, [before[0], before[1]])
        return before, beyond

    def missing(unknown: Floats) -> Floats:
        before, beyond = shape(unknown)
        lifted = unknown[1] if unknown[1] >= 0.0 else rest + 1.0 - unknown[2]
        drawn = lifted - before[2]
        return np.array([before[3], beyond[1], unknown[2] - 1.0 + drawn])

    ends = np.array([0.35, 1.4, 1.0])
    if ends[1] > rest:
        ends = np.array([0.5 * rest, -1e-2, 1.0])
    best = least_squares(missing, ends, xtol=1e-14, ftol=1e-14, gtol=1e-14, x_scale=np.abs(ends))
    if np.abs(best.fun).max() > 1e-6 or best.x[1] > rest:
        raise ArithmeticError(f"no balance of a strip of {length:g} mm with {out:g} mm over the edge")
    before, beyond = shape(best.x)
    lifted = best.x[1] if best.x[1] >= 0.0 else rest + 1.0 - best.x[2]
    return Overhang(out * float(beyond[3]), out * float(beyond[2]), float(before[0]), out * float(lifted))


def _run(moment, length: float, start: list[float]) -> Floats:
    """(slope, its growth, way along and below the table) after a length of the strip."""
    from scipy.integrate import solve_ivp

    def rates(s, y):
        return [y[1], moment(s) * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])]

    return solve_ivp(rates, (0.0, length), [*start, 0.0, 0.0], rtol=_TIGHT, atol=_TIGHT).y[:, -1]
