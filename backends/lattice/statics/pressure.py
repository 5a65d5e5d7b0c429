"""Pressure of the contacts of a sheet, and the friction that they can hold along a plane.

The law of a box on a plate applies its force at the corners of the overlap. The couple that friction can hold
depends on the distribution of pressure: four corners of a square hold twice the couple of its face. So the
part of the force that all corners share is spread over the face; the excess of the corners of one side, over
that side; and the excess of a single corner stays there. That changes neither the force nor its centre.
"""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.kernels.state import Midpoint
from mdlgen.backends.lattice.kernels.tuning import NORMALS_ALIKE, PLACES, TRIANGLES
from mdlgen.backends.lattice.statics.limit import Grips, cone
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.point import AT, COUPLE, FORCE, KIND, MU_STATIC, NORMAL, OUT, POINT, POINTS
from mdlgen.model.tables import BOX_CYLINDER, Floats, Model, SheetPart


class Press:
    """Contacts at rest: place, normal force and normal of each point [mm, N]."""

    def __init__(self, system: System, x: Floats, r: Floats, mid: Midpoint) -> None:
        from mdlgen.backends.lattice.kernels import entries

        still = np.zeros_like(x)
        mid.forces[:] = 0.0
        count = entries.contacts(system.tables, Motion(x, r, still, still), mid)
        self.pairs = mid.touched[:count].copy()
        self.points: list[Floats] = []  # points of each pair (n, POINT)
        for row in mid.results[:count]:
            many = int(row[POINTS])
            points = row[OUT + 1 : OUT + 1 + POINT * many].reshape(many, POINT)
            self.points.append(points[(points[:, KIND] != COUPLE) & (points[:, FORCE] > 0.0)].copy())


def grips(
    model: Model,
    systems: tuple[System, System],
    sheet: SheetPart,
    frame: tuple[Floats, Floats],
    place: tuple[Floats, Floats],
    mid: Midpoint,
) -> Grips:
    """Forces that friction can hold on a sheet along a plane; `systems`: with the friction at edges, and
    without; `frame`: axes of the plane (3, 3) and the origin (3,); `place`: x (n, 3) and r (n, 9)."""
    turned, plain = (Press(system, *place, mid) for system in systems)
    ends = systems[0].pairs
    mine = [
        k
        for k, pair in enumerate(turned.pairs.tolist())
        if sheet.first <= ends["a"][pair] < sheet.first + sheet.count
    ]
    many = _divided(len(mine))
    idle = {part.body: part.axis for part in model.rollers if part.turns}
    found: list[tuple[Floats, Floats, Floats]] = []
    axes, origin = frame
    for k in mine:
        pair, points = int(turned.pairs[k]), turned.points[k]
        # friction at an edge turns the force there; its cone is about the normal of the edge
        normals = plain.points[k] if _same(turned, plain, k) else points
        free = idle.get(int(ends["b"][pair])) if ends["kind"][pair] == BOX_CYLINDER else None
        for group in _faces(points):
            first, normal = points[group[0]], normals[group[0], NORMAL : NORMAL + 3] @ axes
            local = (points[group, AT : AT + 3] - origin) @ axes[:, :2]
            centre, shape = cone(first[NORMAL : NORMAL + 3] @ axes, normal, float(first[MU_STATIC]))
            if free is not None:  # nothing prevents its rotation
                along = free @ axes[:, :2]
                size = float(np.linalg.norm(along))
                along = along / size if size > 0.0 else along
                centre, shape = np.zeros(2), float(first[MU_STATIC]) * np.outer(along, along) * size
            where, parts = _spread(local, points[group, FORCE], many)
            found.append((where, parts[:, None] * centre, parts[:, None, None] * shape))
    if not found:
        return Grips(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 2, 2)))
    return Grips(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def _divided(pairs: int) -> int:
    """Number of parts of a side of a triangle; a face with four corners has four triangles."""
    return int(np.clip(np.sqrt(PLACES / (4.0 * max(pairs, 1))), 1, TRIANGLES))


def _same(one: Press, two: Press, k: int) -> bool:
    """True if both have the same points of a pair."""
    return (
        k < len(two.pairs) and bool(one.pairs[k] == two.pairs[k]) and len(one.points[k]) == len(two.points[k])
    )


def _faces(points: Floats) -> list[list[int]]:
    """Consecutive points with the same normal: the corners of one face."""
    groups: list[list[int]] = []
    for i, point in enumerate(points):
        before = points[groups[-1][-1]] if groups else None
        if (
            before is not None
            and before[NORMAL : NORMAL + 3] @ point[NORMAL : NORMAL + 3] > 1.0 - NORMALS_ALIKE
        ):
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


def _spread(corners: Floats, forces: Floats, many: int) -> tuple[Floats, Floats]:
    """Places (n, 2) and parts (n,) of the forces at the corners (m, 2) of one face in turn."""
    left, count = forces.astype(float).copy(), len(forces)
    where, parts = [np.zeros((0, 2))], [np.zeros(0)]
    if count >= 3:
        alike = float(left.min())
        left -= alike
        middle = corners.mean(axis=0)
        inside = _triangle(many)
        for i in range(count):
            three = np.stack([middle, corners[i], corners[(i + 1) % count]])
            where.append(inside @ three)
            parts.append(np.full(len(inside), alike / len(inside)))
    steps = (np.arange(many) + 0.5) / many
    for i in range(count if count > 2 else count - 1):
        j = (i + 1) % count
        both = float(min(left[i], left[j]))
        if both > 0.0:
            left[[i, j]] -= both
            where.append(corners[i] + steps[:, None] * (corners[j] - corners[i]))
            parts.append(np.full(many, 2.0 * both / many))
    where.append(corners[left > 0.0])
    parts.append(left[left > 0.0])
    return np.concatenate(where), np.concatenate(parts)


def _triangle(many: int) -> Floats:
    """Weights (many^2, 3) of a triangle's corners, for the centres of equal small triangles."""
    found = []
    for i in range(many):
        for j in range(many - i):
            found.append(((i + 1 / 3) / many, (j + 1 / 3) / many))
            if i + j < many - 1:
                found.append(((i + 2 / 3) / many, (j + 2 / 3) / many))
    one, two = np.array(found).T
    return np.stack([1.0 - one - two, one, two], axis=1)
