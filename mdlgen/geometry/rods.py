"""Depth of a rod, a cylinder with an axis, in blocks and in triangles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from mdlgen.geometry.arrays import Floats

_STATIONS = np.linspace(-0.5, 0.5, 9)
_FIRST = 4  # directions: those of a block's faces and of a rod's ends


class Box(NamedTuple):
    """A block: middle, axes in columns, half lengths [mm]."""

    center: Floats
    axes: Floats
    half: Floats


class Rod(NamedTuple):
    """A roller: centre, axis, the least radius of its rim, half of its width [mm]."""

    center: Floats
    axis: Floats
    radius: float
    half: float

    def reach(self, way: Floats) -> float:
        """Half of its extent along a unit vector."""
        lean = float(self.axis @ way)
        return self.half * abs(lean) + self.radius * math.sqrt(max(0.0, 1.0 - lean * lean))


def into_box(roller: Rod, box: Box) -> float:
    """How far a roller and a block overlap, by the way that is shortest out [mm]; below zero by how far they
    are apart at least."""
    gap = box.center - roller.center
    least = math.inf
    for k, way in enumerate(_ways(roller, box)):
        if k == _FIRST and least < 0.0:
            break
        length = float(np.linalg.norm(way))
        if length < 1e-9:
            continue
        unit = way / length
        reach = roller.reach(unit) + float(np.abs(unit @ box.axes) @ box.half)
        least = min(least, reach - abs(float(gap @ unit)))
    return least


def _ways(roller: Rod, box: Box) -> Iterator[np.ndarray]:
    """Directions in which the two may be apart; most that are, are so in one of the first, which take no
    time."""
    yield from box.axes.T
    yield roller.axis
    for side in box.axes.T:
        yield np.cross(roller.axis, side)
    # from the axis to the nearest corner of the block
    places = roller.center + np.outer(2.0 * roller.half * _STATIONS, roller.axis)
    own = (places - box.center) @ box.axes
    near = own - np.clip(own, -box.half, box.half)
    away = box.axes @ near[int(np.argmin((near**2).sum(axis=1)))]
    yield away - roller.axis * float(away @ roller.axis)


def into_triangles(roller: Rod, triangles: Floats) -> float:
    """How far triangles (n, 3, 3) come into a roller from its curved face [mm]; below zero by how far they
    are apart at least."""
    extent = np.array([roller.reach(way) for way in np.eye(3)])
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    gaps = np.maximum(low - roller.center, roller.center - high) - extent
    apart = gaps.max(axis=1)
    close = apart <= 0.0
    if not close.any():
        return -float(apart.min())
    first = np.cross(roller.axis, np.eye(3)[int(np.argmin(np.abs(roller.axis)))])
    first = first / np.linalg.norm(first)
    frame = np.stack([first, np.cross(roller.axis, first), roller.axis], axis=1)
    deepest = 0.0
    for corners in (triangles[close] - roller.center) @ frame:
        flat = _slab(corners, roller.half)
        if len(flat):
            deepest = max(deepest, roller.radius - _distance(flat[:, :2]))
    return deepest


def _slab(corners: Floats, half: float) -> Floats:
    """The part of a polygon with a third coordinate within +-half, (n, 3)."""
    for sign in (1.0, -1.0):
        kept: list[Floats] = []
        for k in range(len(corners)):
            one, two = corners[k - 1], corners[k]
            a, b = half - sign * one[2], half - sign * two[2]
            if a * b < 0.0:
                kept.append(one + (two - one) * (a / (a - b)))
            if b >= 0.0:
                kept.append(two)
        corners = np.array(kept).reshape(-1, 3)
    return corners


def _distance(polygon: Floats) -> float:
    """Distance of the origin from a convex polygon (n, 2); 0 inside."""
    best, sides = math.inf, set()
    for k in range(len(polygon)):
        one, two = polygon[k - 1], polygon[k]
        edge = two - one
        square = float(edge @ edge)
        t = 0.0 if square == 0.0 else min(1.0, max(0.0, -float(one @ edge) / square))
        best = min(best, float(np.linalg.norm(one + t * edge)))
        turn = float(edge[0] * one[1] - edge[1] * one[0])
        if turn != 0.0:
            sides.add(turn > 0.0)
    return 0.0 if len(sides) == 1 and len(polygon) > 2 else best
