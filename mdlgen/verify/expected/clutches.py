"""One-way clutches that a text must have: a torque on the roller, along its axle, over its spin."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Model, OneWay, RollerPart
from mdlgen.verify.expected.times import Times, longest
from mdlgen.verify.expected.units import SECOND
from mdlgen.verify.tables import Table, table

SPINS = (-200.0, -3.0, -0.05, 0.0, 0.05, 3.0, 200.0)
"""Relative spins of a roller at which the law of its clutch is evaluated [rad/s]."""
IDLE = ("0",) * 5
"""Components that a clutch does not have: three forces, and two torques."""


def clutch_times(times: Times, roller: str) -> tuple[float, ...]:
    """Times at which the law of a clutch is evaluated [s]: those of its shaft."""
    return times.get(f"mot_{roller}", (0.0,) * (longest(times) or 1))


def clutches(model: Model, times: Times) -> Table:
    """Axis of each, and its torque [N mm] at every time and spin."""
    found = [(roller, roller.one_way) for roller in model.rollers if roller.one_way is not None]
    width = len(clutch_times(times, "")) * len(SPINS)
    axes = np.zeros((len(found), 3))
    torques, scales = np.zeros((2, len(found), width))
    words = []
    for k, (roller, way) in enumerate(found):
        axes[k] = roller.axis
        torques[k], scales[k] = _law(roller, way, clutch_times(times, roller.name))
        name = roller.name
        words.append((f"b_{name}", f"j_{name}.i,j_{name}.j,j_{name}.j", *IDLE))
    parts = {"axis": (axes, 1.0), "torque": (torques, scales)}
    return table([f"frc_{roller.name}_clutch" for roller, _ in found], parts, words)


def _law(roller: RollerPart, way: OneWay, times: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """2 torque s^2 / (1 + s) of the speed s against the free sense, relative to the creep; and the size of
    the speeds whose difference s is."""
    shaft = np.zeros(len(times))
    if roller.speed is not None:
        shaft = roller.prescribed(np.array(times) / SECOND) / SECOND
    spin, creep = np.array(SPINS), way.creep / SECOND
    s = np.maximum(0.0, way.direction * (shaft[:, None] - spin) / creep)
    size = 2 * way.torque * (np.abs(shaft)[:, None] + np.abs(spin)) / creep
    return (2 * way.direction * way.torque * s**2 / (1 + s)).ravel(), size.ravel()
