"""Vectors of three numbers, as tuples: for a few values numpy is slower."""

from __future__ import annotations

import math

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.world import Vector

Axes = tuple[Vector, Vector, Vector]
GLOBAL: Axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
PARALLEL = 1e-9  # sine of the angle below which two directions are one


def minus(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def along(origin: Vector, direction: Vector, length: float) -> Vector:
    """The point `length` from `origin`."""
    x, y, z = (o + d * length for o, d in zip(origin, direction, strict=True))
    return (x, y, z)


def unit(v: Vector) -> Vector:
    """Raises Trouble for a vector without length."""
    size = math.hypot(*v)
    if not size > 0:
        raise Trouble("direction", "this direction has no length")
    return (v[0] / size + 0.0, v[1] / size + 0.0, v[2] / size + 0.0)


def two_axes(code: str, a: Vector, b: Vector) -> Axes:
    """Axes by two directions: code[0] lies along `a`, code[1] in the plane of `a` and `b`.

    Raises Trouble where the two are parallel.
    """
    first = unit(a)
    size = math.hypot(*b)
    side = cross(first, b)
    if not size > 0 or math.hypot(*side) <= PARALLEL * size:
        raise Trouble("direction", "the two directions are parallel; they span no plane")
    normal = unit(side)
    second = cross(normal, first)
    i, j = "XYZ".index(code[0]), "XYZ".index(code[1])
    axes: list[Vector] = [first, first, first]
    axes[j] = second
    right_handed = (j - i) % 3 == 1
    axes[3 - i - j] = normal if right_handed else (-normal[0] + 0.0, -normal[1] + 0.0, -normal[2] + 0.0)
    return (axes[0], axes[1], axes[2])


def one_axis(code: str, a: Vector) -> Axes:
    """Axes by one direction. MotionView then lays the next axis in the global XY plane.

    For Z along `a`, X is global Z x a (seen in decks); for Z along global Z, X is global X (seen).
    X and Y as the given axis follow the same rule by analogy.
    """
    first = unit(a)
    level: Vector = (-first[1], first[0], 0.0)  # global Z x first
    if math.hypot(*level) <= PARALLEL:
        level = (1.0, 0.0, 0.0)
    level = unit(level)
    other = {"Z": "X", "X": "Y", "Y": "X"}[code]
    return two_axes(code + other, first, level)


def round_axes(z: Vector) -> Axes:
    """X and Y of a cylinder as decks have them: Y is square to global X, on the side of global Y."""
    y = (0.0, z[2], -z[1]) if z[2] > 0 else (0.0, -z[2], z[1])
    if math.hypot(*y) < 1e-9:
        y = (0.0, 1.0, 0.0)
    y = unit(y)
    return (cross(y, z), y, z)
