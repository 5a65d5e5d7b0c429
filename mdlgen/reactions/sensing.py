"""Readings of a sensor: how far edges of sheets are from it, and how a sheet passes it.

A sensor looks from each point of a line between two ends, along its way; for a beam and a point both ends are
equal. Seen along the way, the line projects onto the middle plane of a box as a straight line. The sheet
covers the sensor where that line meets the box's rectangle. The distance is the greatest separation over four
directions (separating axes, exact in sign, continuous): along the two sides of the rectangle, across the
line, and along the way beyond the end of the view. On sides with a neighbour a rectangle reaches half a box
further, so that no line between two boxes is taken for an edge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.model.tables import Floats, Model, SensorPart

# A box that is seen from the side is not seen: cosine of the angle of its normal to the way. There the place
# at which the sensor meets its plane runs away (convention: 87 deg).
EDGE_ON = 0.05
# How far a rectangle reaches into its neighbour, in its half lengths (convention: far more than boxes part at
# a bend, and less than the neighbour is long).
INTO_NEIGHBOUR = 0.5
FAR = 1e9  # how far off it is that a sensor cannot see [mm]
ROUND_OFF = 1e-6  # of two distances that are found in two ways, far more than their round-off [mm]


class Poses(NamedTuple):
    """Places and velocities of all bodies, global axes, in mm, ms, rad: positions x and velocities u and w
    (bodies, 3), rotations r (bodies, 9)."""

    x: Floats
    r: Floats
    u: Floats
    w: Floats

    def after(self, time: float) -> Poses:
        """Poses after a time [ms] (below 0: before it), with constant velocities."""
        return self._replace(x=self.x + time * self.u, r=_turned(self.r, time * self.w))

    def of(self, bodies: slice) -> Poses:
        return Poses(*(array[bodies] for array in self))

    def copy(self) -> Poses:
        return Poses(*(array.copy() for array in self))


class Passing(NamedTuple):
    """Motion of a sheet past a sensor as its edge is there."""

    speed: float  # of the sheet along itself, its mean; for a line across that [mm/ms]
    skew: (
        float  # from where it goes, for a line from across that, to its nearest side, about its normal [rad]
    )
    position: float  # offset of its middle from the sensor, along way x direction in which it goes [mm]


def between(one: Poses, two: Poses, part: float, time: float) -> Poses:
    """A state in a step that took `time` [ms] from one to the other, a part of it after the first: places in
    proportion, turned from the first one by the mean rate."""
    mean = 0.5 * (one.w + two.w)
    return Poses(one.x + part * (two.x - one.x), _turned(one.r, part * time * mean), two.u, two.w)


def _turned(r: Floats, angle: Floats) -> Floats:
    """Rotations (n, 9), turned by rotation vectors (n, 3) about global axes (Rodrigues)."""
    size = np.linalg.norm(angle, axis=1)
    if not size.any():
        return r
    near = size < 1e-8
    safe = np.where(near, 1.0, size)
    one = np.where(near, 1.0, np.sin(safe) / safe)[:, None, None]
    two = np.where(near, 0.5, (1.0 - np.cos(safe)) / safe**2)[:, None, None]
    cross = np.zeros((len(r), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -angle[:, 2], angle[:, 1], -angle[:, 0]
    cross -= cross.transpose(0, 2, 1)
    turn = np.eye(3) + one * cross + two * (cross @ cross)
    return (turn @ r.reshape(-1, 3, 3)).reshape(-1, 9)


class _Outline(NamedTuple):
    """All boxes that a sensor may see, sheet by sheet, as circles, and where it looks."""

    boxes: NDArray[np.intp]  # (n,)
    firsts: NDArray[np.intp]  # the first of each sheet among them, (sheets,)
    radius: Floats  # of the reach of each box over the root of 2 [mm], (n,)
    way: Floats  # direction, (3,)
    line: Floats  # from the first to the second end, square to the way [mm], (3,)

    @classmethod
    def of(cls, eye: Eye) -> _Outline:
        own = list(eye.boxes.values())
        counts = [boxes.stop - boxes.start for boxes in own]
        reach = [np.linalg.norm(np.abs(eye.middle[k]) + eye.half[k], axis=1) for k in eye.sheets]
        way = eye.way / np.linalg.norm(eye.way)
        line = eye.ends[1] - eye.ends[0]
        return cls(
            np.concatenate([np.arange(boxes.start, boxes.stop) for boxes in own] or [np.zeros(0, int)]),
            np.cumsum([0, *counts[:-1]]),
            np.concatenate([*reach, np.zeros(0)]) * np.sqrt(0.5),
            way,
            line - (line @ way) * way,
        )


class Eye:
    """A sensor of a Model, and the sheets that it sees."""

    def __init__(self, model: Model, sensor: SensorPart):
        self.name, self.hysteresis, self.sheets = sensor.name, sensor.hysteresis, sensor.sheets.tolist()
        self.ends, self.way = sensor.ends, sensor.way
        self._reach = float(np.linalg.norm(sensor.way))
        self._wide = sensor.kind == "line"
        self.boxes = {}
        self.middle, self.half = {}, {}
        for k in self.sheets:
            sheet = model.sheets[k]
            boxes = self.boxes[k] = slice(sheet.first, sheet.first + sheet.count)
            half = model.bodies.half[boxes]
            beyond = 1.0 + INTO_NEIGHBOUR * ~model.bodies.exposed[boxes]
            low, high = half[:, :2] * beyond[:, 0::2], half[:, :2] * beyond[:, 1::2]
            self.middle[k], self.half[k] = 0.5 * (high - low), 0.5 * (high + low)
        self._share = {k: model.mass_share(k) for k in self.sheets}
        self._outline = _Outline.of(self)

    def at_least(self, poses: Poses) -> dict[int, float]:
        """A distance [mm] that each sheet is off at least, see `off`: a bound that costs far less; `poses` of
        all bodies.

        The sensor meets the plane of a box on a line along its way, so no nearer than that line is to the
        middle of the box. The separation along sides that are square is the distance over the root of 2 at
        least.
        """
        outline = self._outline
        if not self.sheets:
            return {}
        away = poses.x[outline.boxes] - self.ends[0]
        away -= (away @ outline.way)[:, None] * outline.way
        if self._wide:
            part = np.clip(away @ outline.line / max(float(outline.line @ outline.line), 1e-12), 0.0, 1.0)
            away -= part[:, None] * outline.line
        off = np.sqrt(0.5 * np.einsum("ij,ij->i", away, away)) - outline.radius
        least = np.minimum.reduceat(off, outline.firsts) - ROUND_OFF
        return dict(zip(self.sheets, least.tolist(), strict=True))

    def off(self, sheet: int, poses: Poses) -> Floats:
        """Distance of each box of a sheet from the view of the sensor, below 0 where it is in it [mm],
        (boxes,); `poses` of that sheet's boxes."""
        seen = self._seen(poses)
        middle, half = self.middle[sheet], self.half[sheet]
        one, two = seen.first - middle, seen.second - middle
        apart = np.maximum(np.minimum(one, two) - half, -np.maximum(one, two) - half).max(axis=1)
        if self._wide:
            along = two - one
            length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-12)
            across = np.stack([-along[:, 1], along[:, 0]], axis=1) / length[:, None]
            beside = np.abs((across * one).sum(axis=1)) - (np.abs(across) * half).sum(axis=1)
            apart = np.maximum(apart, beside)
        low, high = np.minimum(*seen.part), np.maximum(*seen.part)
        apart = np.maximum(apart, self._reach * np.maximum(low - 1.0, -high))
        return np.where(seen.flat, apart, FAR)

    def passing(self, sheet: int, poses: Poses) -> Passing:
        """Motion of a sheet as its edge is at the sensor."""
        box = int(self.off(sheet, poses).argmin())
        turn = poses.r[box].reshape(3, 3)
        normal, way = turn[:, 2], self.way / self._reach
        sees = 0.5 * (self.ends[0] + self.ends[1])
        # the sheet moves as a whole in its plane, even if it is bent and its boxes tremble
        axes = poses.r.reshape(-1, 3, 3)[:, :, :2]
        along = self._share[sheet] @ (poses.u[:, None, :] @ axes)[:, 0]
        rate = turn[:, :2] @ along
        if self._wide:
            goes = np.cross(self.ends[1] - self.ends[0], way)
            goes = goes / np.linalg.norm(goes)
            goes = -goes if rate @ goes < 0.0 else goes
            speed = float(rate @ goes)
        else:
            speed = float(np.linalg.norm(rate))
            goes = rate / speed if speed > 0.0 else turn[:, 0]
        flat = goes - normal * float(goes @ normal)
        sides = np.array([turn[:, 0], turn[:, 1], -turn[:, 0], -turn[:, 1]])
        side = sides[int((sides @ flat).argmax())]
        skew = float(np.arctan2(np.cross(flat, side) @ normal, flat @ side))
        centre = self._share[sheet] @ poses.x
        return Passing(speed, skew, float((centre - sees) @ np.cross(way, goes)))

    def _seen(self, poses: Poses) -> _Seen:
        turn = poses.r.reshape(-1, 3, 3)
        normal = turn[:, :, 2]
        lean = normal @ self.way
        flat = np.abs(lean) > EDGE_ON * self._reach
        safe = np.where(flat, lean, self._reach)
        found, part = [], []
        for end in self.ends:
            arm = end - poses.x
            share = -(normal * arm).sum(axis=1) / safe
            arm = arm + share[:, None] * self.way
            found.append((arm[:, None, :] @ turn[:, :, :2])[:, 0])
            part.append(share)
        return _Seen(found[0], found[1], np.array(part), flat)


class _Seen(NamedTuple):
    """Projections of both ends of a sensor's line on the planes of boxes, in their axes [mm], (boxes, 2).
    Also the part of the way up to there, (2, boxes), and a flag, true if a box is seen from its face."""

    first: Floats
    second: Floats
    part: Floats
    flat: NDArray[np.bool_]
