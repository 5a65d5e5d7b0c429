"""Contact of a box with a guide: a fixed plate, straight or bent to an arc, touched on one side or on both.

The axes of a guide: z lies across the paper, along its width. A straight guide has x along it, y as its
normal, and the origin in its middle. An arc has the origin on its axis, and angles are counted from x to y.
Where both sides may be touched, a box is on the side of its centre.

A flat or hollow face touches the corners of that part of the box's face that lies over the guide. They share
k by the area that each represents, so that a corner that comes over the guide begins without a force. So a
box over a straight guide has k z^1.5, and one whose corners are all z deep in a hollow has that, too: no
point of a flat face is deeper in a hollow than the deepest corner. A round face acts like a roller that does
not turn (`box_sector`). With `share: width` k is proportional to the part of the box's face, or of its width,
that the guide covers: where a sheet passes from one guide to the next, both together count as one. At free
ends the law passes into that of the edge, see mechanics.edge; the long sides of an arc have no edge.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.contact import box_sector, clip, face_corners, outer
from mdlgen.mechanics.edge import HOLDS, UPPER, hands_over, held, leaning, leaning_growth
from mdlgen.mechanics.frame import ARC_ANGLE, ARC_MIDDLE, ARC_RADIUS, Cylinder, Sector, scaled
from mdlgen.mechanics.plate import UPRIGHT, box_ends, box_flat, corner_areas, facing
from mdlgen.mechanics.point import STORED, Load, push, turn
from mdlgen.mechanics.vector import add, back, cross, dot, rotate, scale, sub
from mdlgen.program.kernel import CALLED, OWNS, njit

INSIDE, OUTSIDE, BOTH = 1, 2, 3  # sides: left of a line or inside an arc; right or outside; both


@njit(cache=True, error_model="numpy", forceinline=True)
def inward(at, radius):
    """Distance of a point (guide's axes) to the left of a straight guide's middle, or inside of an arc."""
    return at[1] if radius == 0.0 else radius - math.sqrt(at[0] * at[0] + at[1] * at[1])


@njit(cache=True, error_model="numpy", forceinline=True)
def upper(side, thick):
    """Place along its normal of the upper face of a guide, left of a line or inside of an arc."""
    return 0.0 if side == INSIDE else thick if side == OUTSIDE else 0.5 * thick


@njit(cache=True, error_model="numpy")
def _covered(points, shape, half):
    """Cuts the box's face to what lies over an arc, in place; returns its number of points."""
    _radius, middle, angle = shape
    count = clip(points, 4, (0.0, 0.0, 1.0), half[1])
    count = clip(points, count, (0.0, 0.0, -1.0), half[1])
    last, first = middle + angle, middle - angle
    count = clip(points, count, (-math.sin(last), math.cos(last), 0.0), 0.0)
    return clip(points, count, (math.sin(first), -math.cos(first), 0.0), 0.0)


@njit(cache=True, error_model="numpy", forceinline=True)
def _beyond(i, shape):
    """Direction out of the end i of an arc, guide's axes."""
    sign = 1.0 if i == 0 else -1.0
    at = shape[ARC_MIDDLE] + sign * shape[ARC_ANGLE]
    return (-sign * math.sin(at), sign * math.cos(at), 0.0)


@njit(cache=True, error_model="numpy")
def arc_side(at, upright, plate):
    """Face of an arc that a box at a place touches: 1.0 the hollow one, -1.0 the round one.

    The side is that of the arc's nearest place relative to the middle plane of the sheet, whose normal is
    `upright` (guide's axes). The radius does not determine it for a box that leaves an arc, whose centre is
    beyond the arc's end. A box perpendicular to the arc touches the face on the side of its centre.
    """
    radius, middle, angle = plate.shape
    turn = math.atan2(at[1], at[0]) - middle
    turn -= 2.0 * math.pi * math.floor(turn / (2.0 * math.pi) + 0.5)
    turn = middle + min(max(turn, -angle), angle)
    inside = plate.top - plate.half[2]
    normal = (-math.cos(turn), -math.sin(turn), 0.0)
    near = scale(inside - radius, normal)
    near = (near[0], near[1], min(max(at[2], -plate.half[1]), plate.half[1]))
    lie = dot(upright, normal)
    if abs(lie) > UPRIGHT:
        return 1.0 if dot(upright, sub(near, at)) * lie < 0.0 else -1.0
    return 1.0 if inward(at, radius) >= inside else -1.0


@njit(cache=True, error_model="numpy", **OWNS, **CALLED)
def box_guide(out, a, box, b, plate, law):
    """Box a on guide b, which does not move. A box touches the face on its own side.

    The guide's `side` determines the place of the plate, see `upper`: radius and line are those of the face
    that may be touched, or of the plate's middle for both. Points deeper than the thickness of the plate do
    not touch.
    """
    zero = (0.0, 0.0, 0.0)
    half, half_b, shape, top, ends = box.half, plate.half, plate.shape, plate.top, plate.ends
    ra, rb = a.r, b.r
    radius, thick = shape[ARC_RADIUS], 2.0 * half_b[2]
    if radius == 0.0:
        box_flat(out, a, box, b, plate, law.shared, law)
        return
    at = back(rb, sub(a.x, b.x))
    reach = math.sqrt(dot(half, half))
    if abs(at[2]) > half_b[1] + reach:
        return
    height = inward(at, radius)
    if height > top + reach or height < top - thick - reach:
        return
    if plate.beside != 0:
        box_ends(out, a, box, b, plate, law)
        return
    away = math.sqrt(at[0] * at[0] + at[1] * at[1])
    if away == 0.0:
        return
    sign = arc_side(at, back(rb, (ra[2], ra[5], ra[8])), plate)
    normal = (-sign * at[0] / away, -sign * at[1] / away, 0.0)
    look = outer(back(ra, rotate(rb, normal)), box.exposed)
    tilted = back(rb, facing(look, ra))
    if sign < 0.0:
        part, slope, stored = 1.0, zero, out[STORED]
        for i in range(2):
            if ends & (1 << i) != 0:
                beyond = _beyond(i, shape)
                lean = dot(tilted, beyond)
                part, slope = part - leaning(lean), sub(slope, scale(leaning_growth(lean), beyond))
        to = rotate(rb, (math.cos(shape[ARC_MIDDLE]), math.sin(shape[ARC_MIDDLE]), 0.0))
        if part > 0.0:
            bend = Cylinder((rb[2], rb[5], rb[8]), radius - top + thick, 2.0 * half_b[1])
            own = scaled(law, part, 1.0, law.beta)
            box_sector(out, a, box, b, bend, Sector(to, shape[ARC_ANGLE], zero, False), own)
            # the part of k on the round changes as the box turns
            turn(out, rotate(rb, scale((stored - out[STORED]) / part, cross(tilted, slope))))
    else:
        _hollow(out, a, box, b, plate, look, tilted, law)
    if ends != 0:
        box_ends(out, a, box, b, plate, law)


@njit(cache=True, error_model="numpy", **OWNS)
def _hollow(out, a, box, b, plate, look, tilted, law):
    """The face of box a that looks at the hollow face of an arc: `look` and its normal `tilted` (into the
    box), in box and guide's axes."""
    shape, half_b, top, ends, edge = plate.shape, plate.half, plate.top, plate.ends, plate.edge
    half, exposed = box
    rb, middle = b.r, back(b.r, sub(a.x, b.x))
    points = np.empty((12, 3))
    area = face_corners(points, a, half, look, b)
    count = _covered(points, shape, half_b)
    if count < 3:
        return
    areas = np.empty(12)
    over = corner_areas(points, count, areas)
    if over <= 0.0:
        return
    share = law.k / (area if law.shared else over)
    for i in range(count):
        point = (points[i, 0], points[i, 1], points[i, 2])
        depth = top - inward(point, shape[ARC_RADIUS])
        if depth <= 0.0 or depth > 2.0 * half_b[2]:
            continue
        away = math.sqrt(point[0] * point[0] + point[1] * point[1])
        normal = (-point[0] / away, -point[1] / away, 0.0)
        weight, way, slope = share * areas[i], normal, (0.0, 0.0, 0.0)
        for j in range(2):
            if ends & (1 << j) == 0:
                continue
            beyond = _beyond(j, shape)
            lean = dot(tilted, beyond)
            over = hands_over(a, exposed, -dot(middle, beyond), rotate(rb, beyond))
            part = over - max(-dot(point, beyond), 0.0) / max(edge[UPPER], 1e-300)
            if lean > 0.0 and part > 0.0:
                left = 1.0 - leaning(lean) * min(part, 1.0)
                more = -weight * leaning_growth(lean) * min(part, 1.0)
                slope = add(scale(left, slope), scale(more, beyond))
                weight *= left
                part = max(part - over + 1.0, 0.0)
                way = add(scale(1.0 - part, way), scale(part, tilted))
        way = scale(1.0 / math.sqrt(dot(way, way)), way)
        depth *= min(1.0, dot(way, normal))
        spring = weight * depth * math.sqrt(depth)
        if spring <= 0.0:
            continue
        way = held(way, normal, edge[HOLDS] * law.mu_static)
        where = add(b.x, rotate(rb, point))
        energy = 0.4 * spring * depth
        push(out, where, rotate(rb, way), Load(spring, depth, energy), a, b, law)
        if ends != 0:  # the part of k on the face decreases as the box turns
            turn(out, rotate(rb, scale(-0.4 * depth * depth * math.sqrt(depth), cross(tilted, slope))))
