"""Mass of the solids that graphics are, as MotionView sums them: overlaps count twice."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from mdlgen.backends.motionview.reader.things.vectors import Axes
from mdlgen.backends.motionview.reader.world import Vector

DENSITY = 7.86e-6  # kg/mm3, steel: MotionView's own, seen in a deck

NOTHING = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class Mass(NamedTuple):
    """Mass [kg], centre [mm] and inertia (xx, yy, zz, xy, yz, xz) [kg mm2] about it.

    Products are the integrals of x y dm and so on, in the sign of the deck.
    """

    mass: float
    center: Vector
    inertia: tuple[float, float, float, float, float, float]


def box(center: Vector, axes: Axes, lengths: Vector) -> Mass:
    """A box about its centre."""
    mass = DENSITY * math.prod(abs(length) for length in lengths)
    return _turned(mass, center, axes, (lengths[0] ** 2 / 12, lengths[1] ** 2 / 12, lengths[2] ** 2 / 12))


def sphere(center: Vector, axes: Axes, radius: float) -> Mass:
    """A ball."""
    mass = DENSITY * 4 / 3 * math.pi * abs(radius) ** 3
    return _turned(mass, center, axes, (radius**2 / 5,) * 3)


def frustum(start: Vector, axes: Axes, r1: float, r2: float, length: float) -> Mass:
    """A cut cone along its Z from `start`, where its radius is r1."""
    sum_2 = r1 * r1 + r1 * r2 + r2 * r2
    mass = DENSITY * math.pi * abs(length) * sum_2 / 3
    if not sum_2:
        return Mass(0.0, start, NOTHING)
    middle = length * (r1 * r1 + 2 * r1 * r2 + 3 * r2 * r2) / (4 * sum_2)
    across = 3 * sum(r1 ** (4 - k) * r2**k for k in range(5)) / (20 * sum_2)
    axial = length**2 * (r1 * r1 + 3 * r1 * r2 + 6 * r2 * r2) / (10 * sum_2) - middle**2
    z = axes[2]
    center = (start[0] + z[0] * middle, start[1] + z[1] * middle, start[2] + z[2] * middle)
    return _turned(mass, center, axes, (across, across, axial))


def total(parts: Iterable[Mass]) -> Mass:
    """The sum, about the common centre."""
    solids = [p for p in parts if p.mass]
    mass = sum(p.mass for p in solids)
    if not mass:
        return Mass(0.0, (0.0, 0.0, 0.0), NOTHING)
    x, y, z = (sum(p.mass * p.center[k] for p in solids) / mass for k in range(3))
    moments = [0.0] * 6
    for p in solids:
        a, b, c = p.center[0] - x, p.center[1] - y, p.center[2] - z
        steiner = (b * b + c * c, a * a + c * c, a * a + b * b, a * b, b * c, a * c)
        for k in range(6):
            moments[k] += p.inertia[k] + p.mass * steiner[k]
    xx, yy, zz, xy, yz, xz = moments
    return Mass(mass, (x, y, z), (xx, yy, zz, xy, yz, xz))


def _turned(mass: float, center: Vector, axes: Axes, second: tuple[float, ...]) -> Mass:
    """From the mean squares along own axes to inertia along global ones."""

    def moment(i: int, j: int) -> float:
        return mass * sum(second[k] * axes[k][i] * axes[k][j] for k in range(3))

    x, y, z = moment(0, 0), moment(1, 1), moment(2, 2)
    return Mass(mass, center, (y + z, x + z, x + y, moment(0, 1), moment(1, 2), moment(0, 2)))
