"""Plates, guides, arcs and meshes as a roller meets them before a run: for presses that begin in balance.

The law is that of mechanics.roller_plate, in plain Python; a face pushes on where the axis is behind it, so
that a balance is not lost there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mdlgen.model.grid import rotation_matrix
from mdlgen.model.tables import Floats, GuidePart
from mdlgen.spec.mesh import Mesh
from mdlgen.spec.solid import SCALES

_GAUSS = 1.0 / math.sqrt(3.0)
SLICES = 8  # of a roller's width over a mesh, as in mechanics.roller_mesh
_MOST_STEPS = 400


@dataclass(frozen=True)
class Wheel:
    """A roller against one part: place, axis, radius there, width, and k with the rim's own factor."""

    center: Floats
    axis: Floats
    radius: float
    width: float
    stiffness: float


def _reached(gap: Floats, way: Floats, radius: float) -> float | None:
    """Distance along `way` at which a shrinking gap first has a given length; None: it never has."""
    a, b = float(way @ way), float(gap @ way)
    square = b * b - a * (float(gap @ gap) - radius * radius)
    return None if b >= 0.0 or square < 0.0 else (-b - math.sqrt(square)) / a


def _left(gap: Floats, way: Floats, radius: float) -> float | None:
    """Distance along `way` at which a gap last has a given length; None: it never has."""
    a, b = float(way @ way), float(gap @ way)
    square = b * b - a * (float(gap @ gap) - radius * radius)
    return None if a < 1e-12 or square < 0.0 else (-b + math.sqrt(square)) / a


@dataclass(frozen=True)
class Face:
    """A flat plate: middle of its face, two ways in it and its normal in columns, half lengths, thickness."""

    middle: Floats
    ways: Floats
    half: tuple[float, float]
    thickness: float

    def _within(self, start: Floats, step: Floats, low: float, high: float) -> tuple[float, float]:
        """Range of u in which start + u step is in the face, between low and high."""
        for at, rate, half in zip(start.tolist(), step.tolist(), self.half, strict=True):
            if abs(rate) < 1e-12:
                if abs(at) > half:
                    high = low
                continue
            ends = sorted(((-half - at) / rate, (half - at) / rate))
            low, high = max(low, ends[0]), min(high, ends[1])
        return low, high

    def _over(self, wheel: Wheel, at: Floats) -> tuple[Floats, Floats, float, float, float]:
        """Centre and axis of a roller in the face's axes, cosine of its lean, and from where to where of its
        width the lowest line is over the face."""
        gap, own = (at - self.middle) @ self.ways, wheel.axis @ self.ways
        lean = float(own[2])
        cosine = math.sqrt(1.0 - lean * lean)
        # the nearest point of a place u of the axis is at gap + u own + R (lean own - normal) / cosine
        near = gap[:2] + wheel.radius * lean / cosine * own[:2]
        half = 0.5 * wheel.width
        return gap, own, cosine, *self._within(near, own[:2], -half, half)

    def force(self, wheel: Wheel, at: Floats) -> Floats:
        """Force on the roller where its centre is at a place [N], (3,)."""
        gap, own, cosine, low, high = self._over(wheel, at)
        lean, half, total = float(own[2]), 0.5 * wheel.width, np.zeros(3)
        if high <= low:
            low = high = 0.0
        first, last = low, high
        if abs(lean) > 1e-12:
            level = (wheel.radius * cosine - float(gap[2])) / lean
            first, last = (low, min(high, level)) if lean > 0.0 else (max(low, level), high)
        for begin, end, beside in ((first, last, False), (-half, low, True), (high, half, True)):
            for side in (-0.5, 0.5):
                if end - begin <= 1e-9 * wheel.width:
                    continue
                u = 0.5 * (begin + end) + side * _GAUSS * (end - begin)
                share = 0.5 * (end - begin) / wheel.width
                total += share * wheel.stiffness * self._pushed(wheel, gap + u * own, own, cosine, beside)
        return self.ways @ total

    def _pushed(self, wheel: Wheel, at: Floats, own: Floats, cosine: float, beside: bool) -> Floats:
        """z^1.5 and its way at one place of the width, in the face's axes, (3,)."""
        if not beside:  # it only grows as the roller comes nearer
            depth = min(max(wheel.radius * cosine - float(at[2]), 0.0), wheel.radius)
            return np.array([0.0, 0.0, depth**1.5])
        across = np.array([-own[1], own[0]]) / cosine
        near, far = self._within(at[:2], across, -math.inf, math.inf)
        if far <= near or near < 0.0 < far:
            return np.zeros(3)
        along = near if near >= 0.0 else far
        back = at[2] - min(0.0, max(-self.thickness, float(at[2])))
        away = np.array([*(-along * across), back])
        distance = float(np.linalg.norm(away))
        return max(0.0, wheel.radius - distance) ** 1.5 * away / distance

    def touch(self, wheel: Wheel, direction: Floats) -> float | None:
        """Distance along a direction at which the roller just touches; None: it never reaches the face."""
        closing = -float(direction @ self.ways[:, 2])
        gap, own, cosine, low, high = self._over(wheel, wheel.center)
        if closing > 1e-9:
            lean = 0.5 * wheel.width * abs(float(own[2]))
            offset = (float(gap[2]) - wheel.radius * cosine - lean) / closing
            _, _, _, low, high = self._over(wheel, wheel.center + offset * direction)
            if high > low:
                return offset
        # an edge, square to the axis from the middle of the width
        across = np.array([-own[1], own[0]]) / cosine
        near, far = self._within(gap[:2], across, -math.inf, math.inf)
        if far <= near or near < 0.0 < far:
            return None
        along = near if near >= 0.0 else far
        way = direction @ self.ways
        return _reached(
            np.array([-along, gap[2]]), np.array([way[:2] @ across, way[2]]), wheel.radius
        )  # fmt: skip


@dataclass(frozen=True)
class Bow:
    """A face that is a part of a cylinder: on its axis, axes as of a guide, radius, from where to where."""

    center: Floats
    axes: Floats
    radius: float
    hollow: bool
    middle: float
    half_angle: float
    half_width: float

    def _share(self, wheel: Wheel, own: Floats) -> float:
        """Part of the roller's width that is over the face."""
        low = max(own[2] - 0.5 * wheel.width, -self.half_width)
        high = min(own[2] + 0.5 * wheel.width, self.half_width)
        return max(0.0, high - low) / wheel.width

    def _beside(self, own: Floats) -> bool:
        turn = math.remainder(math.atan2(own[1], own[0]) - self.middle, 2 * math.pi)
        return abs(turn) > self.half_angle

    def _ends(self) -> list[Floats]:
        angles = (self.middle - self.half_angle, self.middle + self.half_angle)
        return [self.radius * np.array([math.cos(a), math.sin(a)]) for a in angles]

    def force(self, wheel: Wheel, at: Floats) -> Floats:
        """As of a Face."""
        own = (at - self.center) @ self.axes
        k, total = self._share(wheel, own) * wheel.stiffness, np.zeros(2)
        distance = math.hypot(own[0], own[1])
        if self._beside(own):
            for end in self._ends():
                away = own[:2] - end
                gap = float(np.linalg.norm(away))
                total += k * max(0.0, wheel.radius - gap) ** 1.5 * away / max(gap, 1e-12)
        elif distance > 0.0:
            sign = -1.0 if self.hollow else 1.0
            depth = wheel.radius - sign * (distance - self.radius)
            total = sign * k * min(max(depth, 0.0), wheel.radius) ** 1.5 * own[:2] / distance
        return self.axes[:, :2] @ total

    def touch(self, wheel: Wheel, direction: Floats) -> float | None:
        """As of a Face."""
        own, way = (wheel.center - self.center) @ self.axes, direction @ self.axes
        if self._share(wheel, own) == 0.0:
            return None
        found = None
        if not self.hollow:
            found = _reached(own[:2], way[:2], self.radius + wheel.radius)
        elif self.radius > wheel.radius:  # it comes from inside
            found = _left(own[:2], way[:2], self.radius - wheel.radius)
        if found is not None and not self._beside(own + found * way):
            return found
        ends = [_reached(own[:2] - end, way[:2], wheel.radius) for end in self._ends()]
        return min((end for end in ends if end is not None), default=None)


@dataclass(frozen=True)
class Facets:
    """Triangles of a fixed mesh, global: corners (n, 3, 3), and outward normals (n, 3)."""

    corners: Floats
    normals: Floats

    def _nearest(self, wheel: Wheel, at: Floats) -> list[Floats]:
        """The way from the axis to the nearest place of each slice of the width that meets the mesh."""
        found = []
        for part in range(SLICES):
            place = at + ((part + 0.5) / SLICES - 0.5) * wheel.width * wheel.axis
            gap = self.corners - place
            height = gap @ wheel.axis
            outer = np.einsum("nk,nk->n", self.normals, gap[:, 0]) < 0.0
            above = height >= 0.0
            cut = outer & (above.any(axis=1) != above.all(axis=1))
            if not cut.any():
                continue
            gap, height, above = gap[cut], height[cut], above[cut]
            # the corner that is alone on its side, and where the sides from it go through the slice
            lone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)
            rows = np.arange(len(gap))
            ends = []
            for step in (1, 2):
                other = (lone + step) % 3
                share = height[rows, lone] / (height[rows, lone] - height[rows, other])
                ends.append(gap[rows, lone] + share[:, None] * (gap[rows, other] - gap[rows, lone]))
            edge = ends[1] - ends[0]
            square = np.maximum(np.einsum("nk,nk->n", edge, edge), 1e-300)
            along = np.clip(-np.einsum("nk,nk->n", ends[0], edge) / square, 0.0, 1.0)
            way = ends[0] + along[:, None] * edge
            found.append(way[int(np.argmin(np.einsum("nk,nk->n", way, way)))])
        return found

    def force(self, wheel: Wheel, at: Floats) -> Floats:
        """As of a Face, by the nearest place of each slice."""
        total = np.zeros(3)
        for way in self._nearest(wheel, at):
            distance = float(np.linalg.norm(way))
            total -= max(0.0, wheel.radius - distance) ** 1.5 * way / max(distance, 1e-12)
        return wheel.stiffness / SLICES * total

    def touch(self, wheel: Wheel, direction: Floats) -> float | None:
        """As of a Face; found from two radii back on."""
        offset = -2.0 * wheel.radius
        for _ in range(_MOST_STEPS):
            ways = self._nearest(wheel, wheel.center + offset * direction)
            if not ways:
                return None
            gap = min(float(np.linalg.norm(way)) for way in ways) - wheel.radius
            if gap < 1e-10:
                return offset if offset > -2.0 * wheel.radius else None
            offset += gap
        return None


def facets_of_mesh(mesh: Mesh) -> Facets:
    """A fixed mesh as a roller meets it."""
    turn = rotation_matrix(mesh.rotation)
    places = np.array(mesh.center) + (mesh.solid.corners * SCALES[mesh.units]) @ turn.T
    corners = places[mesh.solid.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return Facets(corners, normals)


def faces_of_plate(center: Floats, axes: Floats, size: tuple[float, float, float], at: Floats) -> Face:
    """The face of a plane (its axes in columns, the third its normal) that looks at a place."""
    ahead = float((at - center) @ axes[:, 2]) >= 0.0
    ways = axes if ahead else axes * np.array([1.0, 1.0, -1.0])
    return Face(center + 0.5 * size[2] * ways[:, 2], ways, (size[0] / 2, size[1] / 2), size[2])


def face_of_guide(guide: GuidePart, at: Floats) -> Face | Bow | None:
    """The face of a guide that a roller at a place touches; None: it is on a side that is not touched."""
    own = (at - guide.center) @ guide.axes
    inner = own[1] if guide.radius == 0.0 else guide.radius - math.hypot(own[0], own[1])
    side = guide.sides if guide.sides != 3 else 1 if inner >= 0.0 else 2
    sign, off = (1.0 if side == 1 else -1.0), (0.5 * guide.thickness if guide.sides == 3 else 0.0)
    if guide.radius == 0.0:
        ways = guide.axes[:, [0, 2, 1]] * np.array([1.0, 1.0, sign])
        if sign * inner < -guide.thickness:
            return None
        half = (guide.length / 2, guide.width / 2)
        return Face(guide.center + off * ways[:, 2], ways, half, guide.thickness)
    if sign * inner < -guide.thickness:
        return None
    radius = guide.radius - sign * off
    return Bow(
        guide.center, guide.axes, radius, side == 1, guide.middle, guide.half_angle, guide.width / 2
    )  # fmt: skip


def onto(part: Face | Bow | Facets, wheel: Wheel) -> Callable[[Floats], Floats]:
    """Force on the roller at a given centre [N], (3,)."""
    return lambda at: part.force(wheel, at)


def onto_plate(part: Face, wheel: Wheel, start: Floats) -> Callable[[Floats], Floats]:
    """Force on a plate at a given centre from a roller that stays, with its face as it is at `start`."""
    return lambda at: -part.force(wheel, wheel.center - (at - start))
