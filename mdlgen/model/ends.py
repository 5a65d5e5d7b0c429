"""Ends of plates: where they are, which of them are free, and how sharp their edges are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mdlgen.model.frames import frame
from mdlgen.model.tables import ON_PLATES, Contacts, Floats, GuidePart, PlanePart

FLUSH = 1e-6  # mm: a face that another one continues within this has no edge there
_STATIONS = np.linspace(-1.0, 1.0, 9) * (1.0 - 1e-9)


class End(NamedTuple):
    """An end of a plate, at the start; see mechanics.edge."""

    number: int
    point: Floats  # middle of the end on the upper face [mm], (3,)
    out: Floats  # away from the plate, (3,)
    up: Floats  # normal of the upper face, (3,)
    along: Floats  # direction of the edge, (3,)
    length: float  # half of its length [mm]


class Slab(NamedTuple):
    """A plate by the axes of a straight guide: x along it, y the normal of its upper face, z its width."""

    part: PlanePart | GuidePart
    center: Floats
    axes: Floats  # in columns, (3, 3)
    radius: float  # 0: flat
    middle: float
    angle: float
    half: tuple[float, float, float]  # of its length, width and thickness [mm]
    top: float  # place of the upper face on the normal
    faces: tuple[float, ...]  # those that are touched, 1.0: the upper one, -1.0: the lower one


def slab(part: PlanePart | GuidePart) -> Slab:
    """The plate of a plane or a guide as the user gave it; a spring may have pushed it since."""
    if isinstance(part, PlanePart):
        own = frame(part.normal)
        axes = np.stack([own[:, 0], own[:, 2], -own[:, 1]], axis=1)
        a, b, c = part.size
        return Slab(part, part.center, axes, 0.0, 0.0, 0.0, (a / 2, b / 2, c / 2), c / 2, (1.0,))
    half = (part.length / 2, part.width / 2, part.thickness / 2)
    top = {1: 0.0, 2: part.thickness, 3: part.thickness / 2}[part.sides]
    faces = {1: (1.0,), 2: (-1.0,), 3: (1.0, -1.0)}[part.sides]
    return Slab(part, part.center, part.axes, part.radius, part.middle, part.half_angle, half, top, faces)


def ends(plate: Slab) -> list[End]:
    """All ends of a plate, free or not: four of a flat one, the two across an arc."""
    found = []
    for number in range(2 if plate.radius > 0.0 else 4):
        sign = 1.0 if number % 2 == 0 else -1.0
        x, y, z = plate.axes.T
        if plate.radius > 0.0:
            at = plate.middle + sign * plate.angle
            away = math.cos(at) * x + math.sin(at) * y
            out = sign * (math.cos(at) * y - math.sin(at) * x)
            found.append(
                End(number, plate.center + (plate.radius - plate.top) * away, out, -away, z, plate.half[1])
            )
            continue
        along, across = (x, z) if number < 2 else (z, x)
        far, length = plate.half[:2] if number < 2 else plate.half[1::-1]
        point = plate.center + plate.top * y + sign * far * along
        found.append(End(number, point, sign * along, y, across, length))
    return found


def with_ends(
    planes: tuple[PlanePart, ...], guides: tuple[GuidePart, ...], contacts: Contacts
) -> tuple[tuple[PlanePart, ...], tuple[GuidePart, ...]]:
    """The parts with their free ends: those that no plate continues which the same sheets touch."""
    touch: dict[str, set[str]] = {}
    for row in np.flatnonzero(np.isin(contacts.kind, ON_PLATES)).tolist():
        touch.setdefault(contacts.part_b[row], set()).add(contacts.part_a[row])
    slabs = [slab(part) for part in (*planes, *guides)]
    return (
        tuple(replace(p, ends=_free(s, slabs, touch)) for p, s in zip(planes, slabs, strict=False)),
        tuple(
            replace(g, ends=_free(s, slabs, touch)) for g, s in zip(guides, slabs[len(planes) :], strict=True)
        ),
    )


def _free(plate: Slab, slabs: Sequence[Slab], touch: dict[str, set[str]]) -> int:
    """The free ends of a plate as a bit mask."""
    mine = touch.get(plate.part.name, set())
    others = [
        other
        for other in slabs
        if other.part is not plate.part
        and mine
        and mine <= touch.get(other.part.name, set())
        and not _pressed(other)
        and not _pressed(plate)
    ]
    return sum(1 << end.number for end in ends(plate) if not _joined(plate, end, others))


def _pressed(plate: Slab) -> bool:
    return isinstance(plate.part, PlanePart) and plate.part.press is not None


def _joined(plate: Slab, end: End, others: Sequence[Slab]) -> bool:
    """True if the faces of other plates continue those of an end over half of its length."""
    for face in plate.faces:
        down = 0.0 if face > 0.0 else 2.0 * plate.half[2]
        points = end.point - down * end.up + np.outer(end.length * _STATIONS, end.along)
        covered = np.zeros(len(points), bool)
        for other in others:
            covered |= _on(other, points, face * end.up)
        if 2 * covered.sum() < len(points):
            return False
    return True


def _on(plate: Slab, points: Floats, normal: Floats) -> np.ndarray:
    """A mask of the points (n, 3) on a touched face of a plate that has the same normal."""
    own, way = (points - plate.center) @ plate.axes, normal @ plate.axes
    on = np.zeros(len(points), bool)
    within = np.abs(own[:, 2]) <= plate.half[1] + FLUSH
    if plate.radius > 0.0:
        height, angle = plate.radius - np.hypot(own[:, 0], own[:, 1]), np.arctan2(own[:, 1], own[:, 0])
        within &= np.cos(angle - plate.middle) >= math.cos(plate.angle + FLUSH / plate.radius)
        looks = -(way[0] * np.cos(angle) + way[1] * np.sin(angle))
    else:
        height, looks = own[:, 1], np.full(len(points), way[1])
        within &= np.abs(own[:, 0]) <= plate.half[0] + FLUSH
    for face in plate.faces:
        at = plate.top if face > 0.0 else plate.top - 2.0 * plate.half[2]
        on |= within & (np.abs(height - at) <= FLUSH) & (face * looks > 0.5)
    return on
