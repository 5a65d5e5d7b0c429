"""Places where a pressed roller touches its counterpart, and where it or a pressed plate is in balance."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from mdlgen.model.tables import Floats, SheetPart


@dataclass(frozen=True)
class Cylinder:
    """A counterpart: centre, radius, width, and stiffness of the contact."""

    center: Floats
    radius: float
    width: float
    stiffness: float

    def share(self, center: Floats, axis: Floats, width: float) -> float:
        """Part of the narrower roller's width on which the two meet, 0 to 1."""
        offset = float((center - self.center) @ axis)
        low, high = max(offset - width / 2, -self.width / 2), min(offset + width / 2, self.width / 2)
        return max(0.0, high - low) / min(width, self.width)


def touch_offset(
    center: Floats,
    axis: Floats,
    direction: Floats,
    radius: float,
    width: float,
    others: Sequence[Cylinder],
    faces: Sequence[float | None] = (),
) -> float:
    """Offset along `direction` at which the roller just touches the first counterpart ahead [mm].

    `faces` are the offsets at which it touches plates and guides. 0 where there is none in its way.
    """
    offsets: list[float] = [offset for offset in faces if offset is not None]
    for other in others:
        if other.share(center, axis, width) == 0.0:
            continue
        gap = other.center - center
        gap = gap - axis * (gap @ axis)
        along = gap @ direction
        across2 = gap @ gap - along**2
        reach = radius + other.radius
        if across2 < reach**2:
            offsets.append(float(along - math.sqrt(reach**2 - across2)))
    return float(min(offsets, default=0.0))


def covered_shares(
    sheet: SheetPart, center: Floats, axis: Floats, width: float, shared: bool
) -> list[tuple[float, float]]:
    """Parts of k that the (flat) sheet under a roller contributes, one for each thickness there: (share,
    thickness). A share is the part of the width that is covered, or, where pairs do not share, the number of
    boxes that the roller stands on."""
    stations = (np.arange(200) + 0.5) / 200 - 0.5
    points = (center + np.outer(stations * width, axis) - sheet.center) @ sheet.rotation
    half = np.array(sheet.outline) / 2
    inside = np.all(np.abs(points[:, :2]) <= half, axis=1)
    i, j = [
        np.clip(np.searchsorted(lines, points[inside, k]) - 1, 0, len(lines) - 2)
        for k, lines in enumerate((sheet.lines_x, sheet.lines_y))
    ]
    boxes, whole = j * sheet.n_x + i, len(stations)
    if not shared:
        boxes, whole = sorted(set(boxes.tolist())), 1
    thick = sheet.thick[boxes]
    return [(float(np.sum(thick == s)) / whole, s) for s in sorted(set(thick.tolist()))]


def sheet_contact(
    sheet: SheetPart, axis: Floats, radius: float, width: float, stiffness: float, shared: bool
) -> Callable[[Floats], Floats]:
    """Force on a roller at a given centre from the flat sheet held where it starts [N], (3,)."""
    thickest = float(sheet.thick.max())
    normal = sheet.rotation[:, 2]
    # A move square to the sheet, along a global axis, leaves the share as it is, to the last bit.
    across = np.any(sheet.rotation[:, :2] != 0.0, axis=1)
    shares: dict[tuple[float, ...], list[tuple[float, float]]] = {}

    def force(center: Floats) -> Floats:
        height = float((center - sheet.center) @ normal)
        if radius + thickest / 2 <= abs(height):
            return np.zeros(3)
        place = tuple(center[across].tolist())
        if place not in shares:
            shares[place] = covered_shares(sheet, center, axis, width, shared)
        total = 0.0
        for share, s in shares[place]:
            total += stiffness * share * max(0.0, radius + s / 2 - abs(height)) ** 1.5
        return math.copysign(total, height) * normal

    return force


def cylinder_contact(
    other: Cylinder, axis: Floats, radius: float, width: float
) -> Callable[[Floats], Floats]:
    """Force on a roller at a given centre from a parallel roller held where it starts [N], (3,)."""

    def force(center: Floats) -> Floats:
        gap = center - other.center
        gap = gap - axis * (gap @ axis)
        distance = math.sqrt(gap @ gap)
        depth = radius + other.radius - distance
        if depth <= 0.0 or distance == 0.0:
            return np.zeros(3)
        return other.share(center, axis, width) * other.stiffness * depth**1.5 / distance * gap

    return force


def plate_contact(
    sheet: SheetPart, frame: Floats, size: Sequence[float], center: Floats, stiffness: float
) -> Callable[[Floats], Floats]:
    """Force on a plate near a given centre from the flat sheet held where it starts [N], (3,).

    The corners of what of each box lies over the plate share k, as in a run; what lies over it is taken to
    be the same wherever along its slide the plate is. The force only grows as the plate comes nearer.
    """
    normal = frame[:, 2]
    side = -math.copysign(1.0, float(sheet.rotation[:, 2] @ normal))
    over = [(sign * frame[:, axis], size[axis] / 2) for axis in range(2) for sign in (1.0, -1.0)]
    heights, shares = [], []
    for j in range(sheet.n_y):
        for i in range(sheet.n_x):
            x, y = sheet.lines_x[i : i + 2], sheet.lines_y[j : j + 2]
            face = side * 0.5 * sheet.thick[j * sheet.n_x + i]
            flat = np.array([(x[a], y[b], face) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))])
            corners = sheet.center + flat @ sheet.rotation.T - center
            for way, most in over:
                corners = _cut(corners, way, most)
            heights.append(corners @ normal)
            shares.append(np.full(len(corners), stiffness / max(1, len(corners))))
    height, share = np.concatenate(heights), np.concatenate(shares)
    # parts behind the plate do not touch it
    before = 0.5 * size[2] - height <= size[2]
    height, share = height[before], share[before]

    def force(at: Floats) -> Floats:
        depth = float((at - center) @ normal) + 0.5 * size[2] - height
        return -float(share @ np.clip(depth, 0.0, size[2]) ** 1.5) * normal

    return force


def _cut(corners: Floats, way: Floats, most: float) -> Floats:
    """The part of a polygon (n, 3) that is not further than `most` along `way`."""
    beyond = corners @ way - most
    if np.all(beyond <= 0.0):
        return corners
    kept = []
    for k in range(len(corners)):
        one, two = beyond[k - 1], beyond[k]
        if one * two < 0.0:
            kept.append(corners[k - 1] + one / (one - two) * (corners[k] - corners[k - 1]))
        if two <= 0.0:
            kept.append(corners[k])
    return np.array(kept).reshape(-1, 3)


def equilibrium(
    center: Floats,
    direction: Floats,
    spring: Callable[[float], float],
    contacts: Sequence[Callable[[Floats], Floats]],
    radius: float,
    touch: float,
) -> float:
    """Offset along `direction` where a roller's spring, a push `spring(offset)`, and contacts balance [mm].

    Bisection between well back and well ahead of the touching position; where the spring cannot be
    balanced in that range the offset is its end.
    """
    push = _push(center, direction, spring, contacts)
    low, high = touch - 2 * radius, touch
    if push(low) <= 0.0:
        return float(low)
    # Ahead of the touching position the balance is lost once a counterpart's centre is passed.
    while push(high) > 0.0 and high < touch + radius:
        high += radius / 16
    if push(high) > 0.0:
        return float(touch)
    return _root(push, low, high)


def plate_balance(
    center: Floats,
    direction: Floats,
    spring: Callable[[float], float],
    contacts: Sequence[Callable[[Floats], Floats]],
    far: float,
) -> tuple[float, float]:
    """Offset along `direction` where a plate's spring and contacts balance [mm], and the remaining push [N].
    The push is not 0 where the offset would be further than `far` either way; it then is at that end."""
    push = _push(center, direction, spring, contacts)
    if push(0.0) == 0.0:  # nothing pushes it: anywhere about is balance
        return 0.0, 0.0
    # the push of spring and contacts never grows along the way
    for end, sign in ((-far, -1.0), (far, 1.0)):
        if sign * push(end) > 0.0:
            return end, push(end)
    return _root(push, -far, far), 0.0


def _push(
    center: Floats,
    direction: Floats,
    spring: Callable[[float], float],
    contacts: Sequence[Callable[[Floats], Floats]],
) -> Callable[[float], float]:
    """Force along `direction` at an offset [N]."""

    def push(offset: float) -> float:
        at = center + offset * direction
        return spring(offset) + sum(float(c(at) @ direction) for c in contacts)

    return push


def _root(push: Callable[[float], float], low: float, high: float) -> float:
    """Root of a push that falls from `low` to `high`, to the last bit."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if push(middle) > 0.0 else (low, middle)
    return float(0.5 * (low + high))
