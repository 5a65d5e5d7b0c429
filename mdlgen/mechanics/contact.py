"""Contact between a box and a cylinder or a part of one, and two parallel cylinders. See nip.py for the
pressure of a round on a face, plate.py for a box and a plate, facing.py for two boxes."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.frame import Sector
from mdlgen.mechanics.nip import WHOLE, press
from mdlgen.mechanics.point import Load, push
from mdlgen.mechanics.vector import add, back, dot, local, rotate, scale, sub
from mdlgen.program.kernel import BORROWS, CALLED, OWNS, njit


@njit(cache=True, error_model="numpy", **BORROWS, **CALLED)
def box_cylinder(out, a, box, b, roller, law):
    """Box a against a Cylinder b; out: see mechanics.point."""
    nowhere = (0.0, 0.0, 0.0)
    box_sector(out, a, box, b, roller, Sector(roller.axis, WHOLE, nowhere, True), law)


@njit(cache=True, error_model="numpy", **BORROWS)
def box_sector(out, a, box, b, roller, sector, law):
    """As box_cylinder for a Sector of the round.

    Boxes share k by the part of the sector that each covers, so that a box over all of it has k z^1.5.
    """
    half, exposed = box
    gap = sub(b.x, a.x)
    near = math.sqrt(dot(half, half)) + math.sqrt(
        roller.radius * roller.radius + 0.25 * roller.width * roller.width
    )
    if dot(gap, gap) > near * near:
        return
    l0, al = back(a.r, gap), back(a.r, roller.axis)
    seen, width = Sector(back(a.r, sector.middle), sector.angle, sector.aside, sector.turns), roller.width
    within = (l0, al, roller.radius, width)
    sign = 1.0 if l0[2] >= 0.0 else -1.0
    upright = abs(al[2]) > 0.98  # a roller that stands across the sheet meets its sides only
    if abs(l0[2]) > half[2] and not upright:
        press(out, (0, 1, 2, sign, exposed), a, half, b, within, seen, law)
        return
    # the axis lies within the thickness, or crosses it: the roller meets a side
    if upright:
        along = min(max(-l0[2] / al[2], -0.5 * width), 0.5 * width)
        if abs(l0[2] + along * al[2]) > half[2]:
            return
    sign = 1.0 if l0[0] >= 0.0 else -1.0
    if exposed & (2 if sign > 0 else 1) and abs(l0[0]) > half[0]:
        free = ((exposed >> 2) & 3) + 12  # y_min, y_max, and both faces
        press(out, (1, 2, 0, sign, free), a, half, b, within, seen, law)
    sign = 1.0 if l0[1] >= 0.0 else -1.0
    if exposed & (8 if sign > 0 else 4) and abs(l0[1]) > half[1]:
        free = 3 + ((exposed & 3) << 2)
        press(out, (2, 0, 1, sign, free), a, half, b, within, seen, law)


@njit(cache=True, error_model="numpy", **OWNS)
def clip(points, count, way, limit):
    """Cuts a polygon by way . point <= limit, in place; returns its number of points."""
    kept = np.empty((12, 3))
    found = 0
    for i in range(count):
        one, two = points[i], points[(i + 1) % count]
        d1, d2 = limit - dot(way, one), limit - dot(way, two)
        if d1 >= 0.0:
            for c in range(3):
                kept[found, c] = one[c]
            found += 1
        if (d1 > 0.0 and d2 < 0.0) or (d1 < 0.0 and d2 > 0.0):
            for c in range(3):
                kept[found, c] = one[c] + (two[c] - one[c]) * (d1 / (d1 - d2))
            found += 1
    for k in range(found):
        for c in range(3):
            points[k, c] = kept[k, c]
    return found


@njit(cache=True, error_model="numpy", **BORROWS)
def face_corners(points, a, half, facing, b):
    """Corners of the face of box a that looks along -`facing` (box axes) into `points`, in the axes of b.

    Returns the area of the face.
    """
    q = looking(facing)
    for corner in range(4):
        at = face_corner(corner, a, half, facing, b)
        for i in range(3):
            points[corner, i] = at[i]
    return 4.0 * half[(q + 1) % 3] * half[(q + 2) % 3]


@njit(cache=True, error_model="numpy", forceinline=True)
def outer(facing, exposed):
    """A direction in the axes of a box, without components for which the box has no free face. The face that
    looks against a positive component is on the negative side. A side with a neighbour is no face."""
    x = facing[0] if exposed & (1 if facing[0] > 0.0 else 2) != 0 else 0.0
    y = facing[1] if exposed & (4 if facing[1] > 0.0 else 8) != 0 else 0.0
    return (x, y, facing[2])


@njit(cache=True, error_model="numpy", forceinline=True)
def looking(facing):
    """The axis of a box that is closest to a direction in box axes."""
    if abs(facing[2]) >= max(abs(facing[0]), abs(facing[1])):
        return 2
    return 0 if abs(facing[0]) > abs(facing[1]) else 1


@njit(cache=True, error_model="numpy", forceinline=True)
def face_corner(corner, a, half, facing, b):
    """One of the four `face_corners`, in the axes of b."""
    q = looking(facing)
    p, r = (q + 1) % 3, (q + 2) % 3
    side = -half[q] if facing[q] > 0.0 else half[q]
    sp = half[p] if corner == 0 or corner == 3 else -half[p]
    sr = half[r] if corner < 2 else -half[r]
    return back(b.r, sub(add(a.x, rotate(a.r, local(p, r, q, sp, sr, side))), b.x))


@njit(cache=True, error_model="numpy", **BORROWS, **CALLED)
def cylinder_cylinder(out, a, one, b, two, law):
    """Two parallel Cylinders; k is multiplied by the part of the narrower one's width on which they touch.
    The force acts in the middle of the overlap, or is displaced from it by a cover that changes the speed of
    a roller (model.covers)."""
    gap = sub(a.x, b.x)
    offset = dot(gap, two.axis)
    across = sub(gap, scale(offset, two.axis))
    distance = math.sqrt(dot(across, across))
    depth = one.radius + two.radius - distance
    low = max(offset - 0.5 * one.width, -0.5 * two.width)
    high = min(offset + 0.5 * one.width, 0.5 * two.width)
    if depth <= 0.0 or distance <= 0.0 or high <= low:
        return
    share = (high - low) / min(one.width, two.width)
    normal = scale(1.0 / distance, across)
    spring = share * law.k * depth * math.sqrt(depth)
    point = add(
        b.x,
        add(
            scale(0.5 * (low + high), two.axis),
            scale(two.radius - (0.5 + law.lever + law.bend * depth) * depth, normal),
        ),
    )
    push(out, point, normal, Load(spring, depth, 0.4 * spring * depth), a, b, law)
