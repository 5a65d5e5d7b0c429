"""Torques of motors, limiters and bearings that a text must have, over the time and the roller's spin."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Floats, Model, RollerPart
from mdlgen.model.tables.axle import LIMITER, OPEN, AxlePart
from mdlgen.verify.expected.clutches import IDLE
from mdlgen.verify.expected.times import OF_AXLES, Times
from mdlgen.verify.expected.units import SECOND
from mdlgen.verify.tables import Table, table

# Spins at which all is evaluated [rad/s]; and those about a speed where a law changes, in its width.
_SPINS = (-200.0, -0.03, 0.0, 0.03, 200.0)
_ABOUT = (-2.0, -0.6, 0.3, 0.8)


def axle_stations(model: Model, times: Times) -> dict[str, tuple[float, ...]]:
    """Of each roller with a motor, a limiter or a bearing: time [s] and spin [rad/s] of each point at which
    its torque is evaluated, one after the other; as many for all."""
    found = {}
    for roller in model.rollers:
        if roller.axle is not None:
            found[f"{OF_AXLES}{roller.name}"] = _points(roller, roller.axle, times)
    most = max(map(len, found.values()), default=0)
    return {name: points + points[-2:] * ((most - len(points)) // 2) for name, points in found.items()}


def _points(roller: RollerPart, axle: AxlePart, times: Times) -> tuple[float, ...]:
    """At each time of its speed one spin; at the last one, all places where its laws change."""
    along = times.get(f"mot_{roller.name}", (0.0,))
    width = axle.creep if axle.kind == LIMITER else axle.no_load or axle.ease
    aims = _aims(roller, np.array(along))
    points = [(t, w - 0.37 * width / SECOND) for t, w in zip(along, aims.tolist(), strict=True)]
    last = float(aims[-1])
    spins = [*_SPINS, *(k * axle.ease / SECOND for k in _ABOUT)]
    if axle.kind == LIMITER:
        spins += [last + k * axle.creep / SECOND for k in _ABOUT]
    for slow in axle.curve[1:, 0].tolist() if axle.kind == OPEN else ():
        spins += [last + k * slow / SECOND for k in (-1.1, -0.9, 0.9, 1.1)]
    points += [(along[-1], w) for w in spins]
    return tuple(v for point in points for v in point)


def axles(model: Model, times: Times) -> Table:
    """Axis of each, and its torque [N mm] at every time and spin."""
    found = [(r, r.axle, np.reshape(times[f"{OF_AXLES}{r.name}"], (-1, 2))) for r in model.rollers if r.axle]
    width = max((len(points) for _, _, points in found), default=0)
    axes = np.zeros((len(found), 3))
    torques, scales = np.zeros((2, len(found), width))
    words = []
    for k, (roller, axle, points) in enumerate(found):
        axes[k] = roller.axis
        torques[k], scales[k] = _law(roller, axle, *points.T)
        words.append((f"b_{roller.name}", f"j_{roller.name}.i,j_{roller.name}.j,j_{roller.name}.j", *IDLE))
    parts = {"axis": (axes, 1.0), "torque": (torques, scales)}
    return table([f"frc_{roller.name}_axle" for roller, _, _ in found], parts, words)


def _aims(roller: RollerPart, times: Floats) -> Floats:
    """Speed of its shaft, or its no-load speed [rad/s]."""
    if roller.speed is None:
        return np.zeros(len(times))
    return roller.prescribed(times / SECOND) / SECOND


def _law(roller: RollerPart, axle: AxlePart, times: Floats, spin: Floats) -> tuple[Floats, Floats]:
    """Torque [N mm] at times [s] and spins [rad/s], and the size of what is added up to it."""
    rate = _aims(roller, times) - spin
    size = np.abs(rate + spin) + np.abs(spin)
    torque, scale = np.zeros((2, len(times)))
    if axle.kind == OPEN:
        torque += axle.of_curve(rate * SECOND)
        steepest = float((np.diff(axle.curve[:, 1]) / np.diff(axle.curve[:, 0])).max())
        scale += steepest * size * SECOND
    elif axle.kind == LIMITER:
        torque += axle.limit * _smooth(rate * SECOND / axle.creep)
        scale += 1.5 * axle.limit * size * SECOND / axle.creep
    torque -= axle.friction * _smooth(spin * SECOND / axle.ease) + axle.drag * spin * SECOND
    scale += (1.5 * axle.friction / axle.ease + axle.drag) * np.abs(spin) * SECOND
    return torque, scale


def _smooth(x: Floats) -> Floats:
    """The cubic STEP from -1 at -1 to 1 at 1."""
    x = np.clip(x, -1.0, 1.0)
    return 0.5 * x * (3.0 - x * x)
