"""Closed solids as triangles, seen from outside counterclockwise [mm]: what machines are drawn with."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.geometry.arrays import Floats, Ints

SIDES = 48  # of a whole round
# corners of a box in half lengths, and its faces
CORNERS = np.array([[i, j, k] for k in (-1.0, 1.0) for j in (-1.0, 1.0) for i in (-1.0, 1.0)])
FACES = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
BOX = np.concatenate([FACES[:, [0, 1, 2]], FACES[:, [0, 2, 3]]])


class Solid(NamedTuple):
    points: Floats  # (n, 3)
    triangles: Ints  # (m, 3)


def join(*solids: Solid) -> Solid:
    """Several as one."""
    first = np.cumsum([0, *(len(solid.points) for solid in solids)])
    moved = [solid.triangles + k for solid, k in zip(solids, first, strict=False)]
    return Solid(np.concatenate([solid.points for solid in solids]), np.concatenate(moved))


def arc(radius: float, begin: float, end: float) -> Floats:
    """Points of a round from one angle to the next [rad], about a side of SIDES apart, (n, 2)."""
    count = max(2, int(np.ceil((end - begin) * SIDES / (2.0 * np.pi) - 1e-9)))
    angle = np.linspace(begin, end, count + 1)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def prism(outline: Floats, low: float, high: float, caps: Ints | None = None) -> Solid:
    """A prism of an outline in x and y, counterclockwise, (n, 2), from z = low to z = high. `caps` are the
    triangles of its ends, (m, 3). If left out they start at the mean of its points, from which all of it must
    be seen."""
    k = np.arange(len(outline))
    after = np.roll(k, -1)
    if caps is None:
        caps = np.stack([np.full(len(k), len(k)), k, after], axis=1)
        outline = np.concatenate([outline, outline.mean(axis=0)[None]])
    n = len(outline)
    walls = [np.stack([k, after, after + n], axis=1), np.stack([k, after + n, k + n], axis=1)]
    points = [np.column_stack([outline, np.full(n, z)]) for z in (low, high)]
    return Solid(np.concatenate(points), np.concatenate([*walls, caps[:, ::-1], caps + n]))


def cylinder(radius: float, low: float, high: float) -> Solid:
    return prism(arc(radius, 0.0, 2.0 * np.pi)[:-1], low, high)


def arrow(length: float, breadth: float) -> Solid:
    """From the origin along z to its tip; `breadth` is that of the head."""
    head = min(1.5 * breadth, 0.6 * length)
    ring = arc(breadth / 2, 0.0, 2.0 * np.pi)[:-1]
    n = len(ring)
    k = np.arange(n)
    after = np.roll(k, -1)
    points = np.vstack(
        [np.column_stack([ring, np.full(n, length - head)]), [[0, 0, length], [0, 0, length - head]]]
    )
    cone = np.concatenate(
        [np.stack([k, after, np.full(n, n)], axis=1), np.stack([after, k, np.full(n, n + 1)], axis=1)]
    )
    return join(cylinder(0.2 * breadth, 0.0, length - head), Solid(points, cone))


def slice_(radius: float, begin: float, end: float, half: float) -> Solid:
    """The part of a cylinder between two angles [rad], from its axis."""
    outline = np.concatenate([[[0.0, 0.0]], arc(radius, begin, end)])
    k = np.arange(1, len(outline) - 1)
    return prism(outline, -half, half, np.stack([np.zeros_like(k), k, k + 1], axis=1))


def bent_plate(inner: float, outer: float, begin: float, end: float, half: float) -> Solid:
    """The part of a tube between two angles [rad]."""
    far, near = arc(outer, begin, end), arc(inner, begin, end)
    n = len(far)
    k = np.arange(n - 1)
    mate = 2 * n - 1 - k  # the inner points, of which the last comes first
    caps = np.concatenate([np.stack([k, k + 1, mate], axis=1), np.stack([k + 1, mate - 1, mate], axis=1)])
    return prism(np.concatenate([far, near[::-1]]), -half, half, caps)


def bar(length: float, breadth: float, low: float, high: float) -> Solid:
    """From the origin along x, round at both ends, as far beyond them as half its breadth."""
    end = arc(breadth / 2, -np.pi / 2, np.pi / 2)
    return prism(np.concatenate([end + np.array([length, 0.0]), -end]), low, high)
