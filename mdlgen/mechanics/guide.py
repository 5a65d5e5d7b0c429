"""Contact of a box with a guide: a fixed plate, straight or bent to an arc, touched on one side or on both.

The axes of a guide: z lies across the paper, along its width. Of a straight guide x goes along it and y is
its normal, and the origin is its middle; of an arc the origin lies on its axis, and angles are counted from x
to y. Where both sides may be touched, a box is on the side that its centre is on.

A flat or hollow face meets the corners of that part of the box's face that lies over the guide. They share k,
so that a box over a straight guide gives k z^1.5, and one whose corners are all z deep in a hollow does, too:
no point of a flat face is deeper in a hollow than the deepest corner. A round face is met as a roller that
does not turn (`box_sector`). With `share: width` k goes with the part of the box's face, or of its width,
that the guide covers: where a sheet passes from one guide to the next, both together count as one.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from mdlgen.mechanics.compiling import OWNS
from mdlgen.mechanics.contact import box_sector, clip, face_corners, push
from mdlgen.mechanics.vector import add, back, dot, rotate, sub

INSIDE, OUTSIDE, BOTH = 1, 2, 3  # sides: left of a line or inside an arc; right or outside; both


@njit(cache=True, error_model="numpy", forceinline=True)
def inward(at, radius):
    """How far a point (guide's axes) is left of a straight guide's middle, or inside of an arc's radius."""
    return at[1] if radius == 0.0 else radius - math.sqrt(at[0] * at[0] + at[1] * at[1])


@njit(cache=True, error_model="numpy")
def _covered(points, shape, half):
    """Cuts the box's face to what lies over the guide, in place; returns its number of points."""
    radius, middle, angle = shape
    count = clip(points, 4, (0.0, 0.0, 1.0), half[1])
    count = clip(points, count, (0.0, 0.0, -1.0), half[1])
    if radius == 0.0:
        count = clip(points, count, (1.0, 0.0, 0.0), half[0])
        return clip(points, count, (-1.0, 0.0, 0.0), half[0])
    last, first = middle + angle, middle - angle
    count = clip(points, count, (-math.sin(last), math.cos(last), 0.0), 0.0)
    return clip(points, count, (math.sin(first), -math.cos(first), 0.0), 0.0)


@njit(cache=True, error_model="numpy")
def _area(points, count):
    """Of a flat polygon."""
    x = y = z = 0.0
    for i in range(1, count - 1):
        a, b = points[i] - points[0], points[i + 1] - points[0]
        x += a[1] * b[2] - a[2] * b[1]
        y += a[2] * b[0] - a[0] * b[2]
        z += a[0] * b[1] - a[1] * b[0]
    return 0.5 * math.sqrt(x * x + y * y + z * z)


@njit(cache=True, error_model="numpy", **OWNS)
def box_guide(out, xa, ra, va, wa, half, exposed, xb, rb, shape, half_b, side, k, shared, law):
    """Box a (centre xa, rotation ra, half lengths, exposed sides) on guide b (origin xb, axes rb).

    shape: (radius, middle angle, half angle), the radius 0 for a straight guide; half_b: half of its length,
    width and thickness; side: INSIDE, OUTSIDE or BOTH. Radius and line are those of the face, and of the
    plate's middle where both sides are touched. What is deeper than the plate is thick does not touch.
    """
    zero = (0.0, 0.0, 0.0)
    radius, middle, angle = shape
    at = back(rb, sub(xa, xb))
    reach, thick = math.sqrt(dot(half, half)), 2.0 * half_b[2]
    if abs(at[2]) > half_b[1] + reach or (radius == 0.0 and abs(at[0]) > half_b[0] + reach):
        return
    height = inward(at, radius)
    if abs(height) > reach + thick:
        return
    sign, offset = 1.0 if side == INSIDE else -1.0, 0.0
    if side == BOTH:
        sign, offset = 1.0 if height >= 0.0 else -1.0, half_b[2]
    if radius > 0.0 and sign < 0.0:
        if -height < offset - thick:  # behind the plate
            return
        axis = (rb[2], rb[5], rb[8])
        to = rotate(rb, (math.cos(middle), math.sin(middle), 0.0))
        face, width = radius + offset, 2.0 * half_b[1]
        box_sector(
            out,
            xa,
            ra,
            va,
            wa,
            half,
            exposed,
            xb,
            axis,
            to,
            angle,
            zero,
            zero,
            face,
            width,
            k,
            shared,
            zero,
            law,
        )
        return
    normal = (0.0, sign, 0.0)
    if radius > 0.0:
        away = math.sqrt(at[0] * at[0] + at[1] * at[1])
        if away == 0.0:
            return
        normal = (-at[0] / away, -at[1] / away, 0.0)
    points = np.empty((12, 3))
    area = face_corners(points, xa, ra, half, back(ra, rotate(rb, normal)), xb, rb)
    count = _covered(points, shape, half_b)
    if count < 3:
        return
    share = k / count * (_area(points, count) / area if shared else 1.0)
    for i in range(count):
        point = (points[i, 0], points[i, 1], points[i, 2])
        depth = offset - sign * inward(point, radius)
        if depth <= 0.0 or depth > thick:
            continue
        if radius > 0.0:
            away = math.sqrt(point[0] * point[0] + point[1] * point[1])
            normal = (-point[0] / away, -point[1] / away, 0.0)
        spring = share * depth * math.sqrt(depth)
        where = add(xb, rotate(rb, point))
        energy = 0.4 * spring * depth
        push(out, where, rotate(rb, normal), spring, depth, energy, xa, va, wa, xb, zero, zero, law)
