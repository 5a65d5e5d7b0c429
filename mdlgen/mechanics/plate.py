"""Contact of a box with a flat plate: a plane, or a straight guide.

The corners of the part of the box's face that lies over the plate share k, so a flat box gives k z^1.5. With
`share: width` a guide has the part of k that it covers of the box's face; a plane has all of it wherever the
box lies. A plate is a slab: a box touches the face on its own side of the plate. At a free end the law of a
box that slopes down beyond it passes from that of the face to that of the edge, see mechanics.edge.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.contact import clip, face_corner, face_corners, looking, outer
from mdlgen.mechanics.edge import (
    HOLDS,
    LOWER,
    UPPER,
    end_of,
    hands_over,
    held,
    leaning,
    leaning_growth,
    line,
    stub,
)
from mdlgen.mechanics.frame import ARC_RADIUS, Frame
from mdlgen.mechanics.point import Load, push, turn
from mdlgen.mechanics.vector import add, back, cross, dot, rotate, scale, sub, vec
from mdlgen.program.kernel import BORROWS, CALLED, OWNS, njit

STRAIGHT = (0.0, 0.0, 0.0)
# Cosine of the angle of a sheet to a plate beyond which the sheet's middle plane does not tell the side.
UPRIGHT = 0.3


@njit(cache=True, error_model="numpy", forceinline=True)
def as_guide(rb):
    """The axes of a plane as those of a straight guide: x, normal, width."""
    return (rb[0], rb[2], -rb[1], rb[3], rb[5], -rb[4], rb[6], rb[8], -rb[7])


@njit(cache=True, error_model="numpy", forceinline=True)
def _triangle(a, b, c):
    """Area of a triangle."""
    turn = cross(sub(b, a), sub(c, a))
    return 0.5 * math.sqrt(dot(turn, turn))


@njit(cache=True, error_model="numpy", **BORROWS)
def corner_areas(points, count, areas):
    """Area of a flat polygon; writes the part of it that each corner represents into `areas` (count).

    A corner represents half of the two triangles that its edges make with the centroid. A corner that a cut
    adds begins with no area, so that no corner of a box on a plate begins or ends with a force.
    """
    whole, center, first = 0.0, (0.0, 0.0, 0.0), vec(points, 0)
    for i in range(1, count - 1):
        one, two = vec(points, i), vec(points, i + 1)
        part = _triangle(first, one, two)
        whole += part
        center = add(center, scale(part / 3.0, add(first, add(one, two))))
    for i in range(count):
        areas[i] = 0.0
    if whole <= 0.0:
        return 0.0
    center = scale(1.0 / whole, center)
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        part = 0.5 * _triangle(center, vec(points, i), vec(points, j))
        areas[i] += part
        areas[j] += part
    return whole


@njit(cache=True, error_model="numpy", forceinline=True)
def facing(facing, ra):
    """Normal, into the box, of its face that looks along -`facing` (box axes); global."""
    q = looking(facing)
    return scale(1.0 if facing[q] > 0.0 else -1.0, (ra[q], ra[3 + q], ra[6 + q]))


@njit(cache=True, error_model="numpy", **BORROWS)
def box_ends(out, a, box, b, plate, law):
    """The edges of a plate's free ends in the faces of a box, or its sides that stand before them."""
    if plate.beside != 0:
        for side in range(4):
            known = (plate.beside >> (3 * side)) & 7
            if known > 0:
                sign = 1.0 if side % 2 == 1 else -1.0
                stub(out, a, box.half, side // 2, sign, end_of(known - 1, b, plate), plate, b, law)
        return
    for i in range(4 if plate.shape[ARC_RADIUS] == 0.0 else 2):
        if plate.ends & (1 << i) != 0:
            line(out, a, box, end_of(i, b, plate), plate, b, law)


@njit(cache=True, error_model="numpy", forceinline=True)
def flat_side(at, upright, plate):
    """Which face of a flat plate a box at a place meets, 1.0 the upper and -1.0 the lower one: that on which
    the middle plane of the sheet is, whose normal is `upright` (guide's axes); of a box that is upright to
    the plate that on which its centre is."""
    half, top = plate.half, plate.top
    near = (
        min(max(at[0], -half[0]), half[0]),
        0.5 * (top + (top - 2.0 * half[2])),
        min(max(at[2], -half[1]), half[1]),
    )
    if abs(upright[1]) > UPRIGHT:
        return 1.0 if dot(upright, sub(near, at)) * upright[1] < 0.0 else -1.0
    return 1.0 if at[1] >= near[1] else -1.0


@njit(cache=True, error_model="numpy", **OWNS)
def box_flat(out, a, box, b, plate, covered, law):
    """Box a on a flat plate b, whose axes are those of a guide.

    covered: true if k is proportional to the part of the box's face that the plate covers.
    """
    half, half_b, top = box.half, plate.half, plate.top
    ends, edge = plate.ends, plate.edge
    ra, rb = a.r, b.r
    at = back(rb, sub(a.x, b.x))
    reach, thick = math.sqrt(dot(half, half)), 2.0 * half_b[2]
    bottom = top - thick
    if abs(at[0]) > half_b[0] + reach or abs(at[2]) > half_b[1] + reach:
        return
    if at[1] > top + reach or at[1] < bottom - reach:
        return
    blunt = 2.0 * max(edge[UPPER], edge[LOWER])
    inside = abs(at[0]) + reach <= half_b[0] - blunt and abs(at[2]) + reach <= half_b[1] - blunt
    if plate.beside != 0 and not inside:
        box_ends(out, a, box, b, plate, law)
        return
    sign = flat_side(at, back(rb, (ra[2], ra[5], ra[8])), plate)
    normal, radius = (0.0, sign, 0.0), edge[UPPER] if sign > 0.0 else edge[LOWER]
    look = outer(back(ra, rotate(rb, normal)), box.exposed)
    if inside:
        for corner in range(4):
            at = face_corner(corner, a, half, look, b)
            depth = sign * (top - at[1]) if sign > 0.0 else at[1] - bottom
            if depth <= 0.0 or depth > thick:
                continue
            spring = 0.25 * law.k * depth * math.sqrt(depth)
            energy, way = 0.4 * spring * depth, rotate(rb, normal)
            push(out, add(b.x, rotate(rb, at)), way, Load(spring, depth, energy), a, b, law)
        return
    points = np.empty((12, 3))
    area = face_corners(points, a, half, look, b)
    count = 4
    for axis in range(2):
        way = (1.0, 0.0, 0.0) if axis == 0 else (0.0, 0.0, 1.0)
        count = clip(points, count, way, half_b[axis])
        count = clip(points, count, scale(-1.0, way), half_b[axis])
    if count >= 3:
        areas = np.empty(12)
        over = corner_areas(points, count, areas)
        if over <= 0.0:
            count = 0
        share = law.k / (area if covered else over)
        inward = back(rb, facing(look, ra))
        x, z = (rb[0], rb[3], rb[6]), (rb[2], rb[5], rb[8])
        overs = (
            hands_over(a, box.exposed, half_b[0] - at[0], x),
            hands_over(a, box.exposed, half_b[0] + at[0], scale(-1.0, x)),
            hands_over(a, box.exposed, half_b[1] - at[2], z),
            hands_over(a, box.exposed, half_b[1] + at[2], scale(-1.0, z)),
        )
        if not covered and ends != 0:
            share *= _drawn(points, count, half_b, ends, radius)
        for i in range(count):
            depth = sign * (top - points[i, 1]) if sign > 0.0 else points[i, 1] - bottom
            if depth <= 0.0 or depth > thick:
                continue
            weight, way, slope = share * areas[i], normal, (0.0, 0.0, 0.0)
            if ends != 0:
                weight, way, slope = _near_end(points[i], half_b, ends, overs, radius, inward, normal, weight)
                depth *= sign * way[1]
                way = held(way, normal, edge[HOLDS] * law.mu_static)
            spring = weight * depth * math.sqrt(depth)
            if spring <= 0.0:
                continue
            point = add(b.x, rotate(rb, (points[i, 0], points[i, 1], points[i, 2])))
            push(out, point, rotate(rb, way), Load(spring, depth, 0.4 * spring * depth), a, b, law)
            if ends != 0:  # the part of k on the face decreases as the box turns
                turn(out, rotate(rb, scale(-0.4 * depth * depth * math.sqrt(depth), cross(inward, slope))))
    if ends != 0:
        box_ends(out, a, box, b, plate, law)


@njit(cache=True, error_model="numpy", forceinline=True)
def _inset(point, i, half_b):
    """Distance of a point inside of the end i of a straight plate."""
    sign = 1.0 if i % 2 == 0 else -1.0
    return half_b[0] - sign * point[0] if i < 2 else half_b[1] - sign * point[2]


@njit(cache=True, error_model="numpy")
def _drawn(points, count, half_b, ends, radius):
    """Factor of k for a narrow overlap at a free end, of a plate whose k does not depend on the covered
    part."""
    left = 1.0
    for i in range(4):
        if ends & (1 << i) != 0:
            most = 0.0
            for j in range(count):
                most = max(most, _inset(points[j], i, half_b))
            left *= min(1.0, most / max(radius, 1e-300))
    return left


@njit(cache=True, error_model="numpy")
def _near_end(point, half_b, ends, overs, radius, inward, normal, share):
    """(part of k, normal, growth of the part with the normal of the box's face) of a corner of the overlap.
    At a free end beyond which the box slopes down the law passes to the edge, with the normal of the box's
    face. overs: see edge.hands_over, for each end."""
    weight, way, slope = share, normal, (0.0, 0.0, 0.0)
    for i in range(4):
        if ends & (1 << i) == 0:
            continue
        sign = 1.0 if i % 2 == 0 else -1.0
        lean = sign * (inward[0] if i < 2 else inward[2])
        if lean <= 0.0:
            continue
        over = overs[i]
        part = over - max(_inset(point, i, half_b), 0.0) / max(radius, 1e-300)
        if part <= 0.0:
            continue
        left = 1.0 - leaning(lean) * min(part, 1.0)
        more = -weight * leaning_growth(lean) * min(part, 1.0) * sign
        slope = add(scale(left, slope), (more, 0.0, 0.0) if i < 2 else (0.0, 0.0, more))
        weight *= left
        part = max(part - over + 1.0, 0.0)
        way = add(scale(1.0 - part, way), scale(part, inward))
    size = math.sqrt(dot(way, way))
    return weight, scale(1.0 / size, way), slope


@njit(cache=True, error_model="numpy", **CALLED)
def box_plane(out, a, box, b, plate, law):
    """Box a on plane b, whose frame has the plane's own axes, z its normal; see `box_flat`."""
    box_flat(out, a, box, Frame(b.x, as_guide(b.r), b.v, b.w), plate, False, law)
