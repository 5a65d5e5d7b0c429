"""Where a pressed roller touches its counterpart, and where it stands in static equilibrium."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from mdlgen.model.tables import Floats, SheetPart


@dataclass(frozen=True)
class Cylinder:
    """A counterpart: centre, radius and stiffness of the contact."""

    center: Floats
    radius: float
    stiffness: float


def touch_offset(
    center: Floats, axis: Floats, direction: Floats, radius: float, others: Sequence[Cylinder]
) -> float:
    """Offset along `direction` at which the roller just touches the first counterpart ahead [mm].

    0 where there is none in its way.
    """
    offsets = []
    for other in others:
        gap = other.center - center
        gap = gap - axis * (gap @ axis)
        along = gap @ direction
        across2 = gap @ gap - along**2
        reach = radius + other.radius
        if across2 < reach**2:
            offsets.append(along - math.sqrt(reach**2 - across2))
    return float(min(offsets, default=0.0))


def covered_share(sheet: SheetPart, center: Floats, axis: Floats, width: float) -> float:
    """Part of a roller's width whose foot points lie on the (flat) sheet, 0 to 1."""
    stations = (np.arange(200) + 0.5) / 200 - 0.5
    points = (center + np.outer(stations * width, axis) - sheet.center) @ sheet.rotation
    half = np.array([sheet.n_x * sheet.d_x, sheet.n_y * sheet.d_y]) / 2
    return float(np.mean(np.all(np.abs(points[:, :2]) <= half, axis=1)))


def sheet_contact(
    sheet: SheetPart, axis: Floats, radius: float, width: float, stiffness: float
) -> Callable[[Floats], Floats]:
    """Force on a roller at a given centre from the flat sheet held where it starts [N], (3,)."""
    normal = sheet.rotation[:, 2]

    def force(center: Floats) -> Floats:
        height = float((center - sheet.center) @ normal)
        depth = radius + sheet.thickness / 2 - abs(height)
        if depth <= 0.0:
            return np.zeros(3)
        share = covered_share(sheet, center, axis, width)
        return math.copysign(stiffness * share * depth**1.5, height) * normal

    return force


def cylinder_contact(other: Cylinder, axis: Floats, radius: float) -> Callable[[Floats], Floats]:
    """Force on a roller at a given centre from a parallel roller held where it starts [N], (3,)."""

    def force(center: Floats) -> Floats:
        gap = center - other.center
        gap = gap - axis * (gap @ axis)
        distance = math.sqrt(gap @ gap)
        depth = radius + other.radius - distance
        if depth <= 0.0 or distance == 0.0:
            return np.zeros(3)
        return other.stiffness * depth**1.5 / distance * gap

    return force


def equilibrium(
    center: Floats,
    direction: Floats,
    spring: Callable[[float], float],
    contacts: Sequence[Callable[[Floats], Floats]],
    radius: float,
    touch: float,
) -> float:
    """Offset along `direction` where spring and contacts balance [mm]; `spring(offset)` is its push.

    Bisection between well back and well ahead of the touching position; where the spring cannot be
    balanced in that range the offset is its end.
    """

    def push(offset: float) -> float:
        at = center + offset * direction
        return spring(offset) + sum(float(c(at) @ direction) for c in contacts)

    low, high = touch - 2 * radius, touch
    if push(low) <= 0.0:
        return float(low)
    # Ahead of the touching position the balance is lost once a counterpart's centre is passed.
    while push(high) > 0.0 and high < touch + radius:
        high += radius / 16
    if push(high) > 0.0:
        return float(touch)
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if push(middle) > 0.0 else (low, middle)
    return float(0.5 * (low + high))
