"""A box and a guide."""

from __future__ import annotations

import math

from mdlgen.mechanics.bounds import fastest_place, gap_of, rate_of, size, swinging, turning
from mdlgen.mechanics.edge import TAKES, deepest_at
from mdlgen.mechanics.frame import (
    ARC_ANGLE,
    ARC_MIDDLE,
    ARC_RADIUS,
    Plate,
    box_of,
    frame_of,
    held_frame,
    law_of,
)
from mdlgen.mechanics.guide import BOTH, box_guide, inward, upper
from mdlgen.mechanics.point import presses
from mdlgen.mechanics.vector import back, mat, scale, sub, three, vec
from mdlgen.model.tables.contacts import BOX_GUIDE
from mdlgen.program.kernel import BORROWS, njit

KIND, ON_PLATE = BOX_GUIDE, True


@njit(cache=True, error_model="numpy", forceinline=True)
def _plate_of(body, beside):
    """Plate of a guide's record."""
    half = three(body.half)
    top = upper(body.side, 2.0 * half[2])
    return Plate(three(body.arc), half, top, body.ends, three(body.edge), beside)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    a, guide = frame_of(motion, pair.a), _plate_of(bodies[pair.b], pair.beside)
    box_guide(out, a, box_of(bodies[pair.a]), frame_of(motion, pair.b), guide, law_of(pair))
    return presses(out)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def plate(bodies, pair, motion):
    """As it stands."""
    return held_frame(motion, pair.b), _plate_of(bodies[pair.b], pair.beside)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def near(bodies, pair, shapes, motion, margin, ahead):
    """By the box's bounding sphere, in the guide's axes."""
    a, b = pair.a, pair.b
    reached = TAKES * size(bodies[a]) + margin
    fast = fastest_place(size(bodies[a]), rate_of(pair, motion), vec(motion.w, a))
    reached += ahead * (fast + swinging(motion, b, gap_of(pair, motion.x)))
    at, half = back(mat(motion.r, b), scale(-1.0, gap_of(pair, motion.x))), bodies[b].half
    radius = bodies[b].arc[ARC_RADIUS]
    if abs(at[2]) > half[1] + reached or abs(inward(at, radius)) > 2.0 * half[2] + reached:
        return False
    return not (radius == 0.0 and abs(at[0]) > half[0] + reached)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def apart(bodies, pair, shapes, x, r, way):
    """By the height above or below the guide."""
    a, b = pair.a, pair.b
    height = abs(inward(back(mat(r, b), sub(vec(x, a), vec(x, b))), bodies[b].arc[ARC_RADIUS]))
    return height > 2.0 * bodies[b].half[2] + size(bodies[a]) + way


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """Half of the guide's thickness, or more before an end."""
    return deepest_at(bodies[pair.b].half[2], bodies[pair.a].half, pair.beside)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """Along the guide's normal, which in an arc turns on the way."""
    a, b = pair.a, pair.b
    turned, own = turning(bodies[a], motion, a), back(mat(motion.r, b), rate_of(pair, motion))
    turned += swinging(motion, b, gap_of(pair, motion.x))
    radius = bodies[b].arc[ARC_RADIUS]
    if radius == 0.0:
        return abs(own[1]) + turned
    at = back(mat(motion.r, b), sub(vec(motion.x, a), vec(motion.x, b)))
    away = max(math.sqrt(at[0] * at[0] + at[1] * at[1]), 1e-3 * radius)
    bent = ahead * (own[0] * own[0] + own[1] * own[1]) / away
    return abs(own[0] * at[0] + own[1] * at[1]) / away + bent + turned


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def above(bodies, pair, x, r):
    """For a guide with two faces; 0 where the box's centre is not over it."""
    b = pair.b
    if bodies[b].side != BOTH:
        return 0
    at = back(mat(r, b), scale(-1.0, gap_of(pair, x)))
    if abs(at[2]) > bodies[b].half[1]:
        return 0
    radius, middle, angle = bodies[b].arc[ARC_RADIUS], bodies[b].arc[ARC_MIDDLE], bodies[b].arc[ARC_ANGLE]
    if radius == 0.0:
        if abs(at[0]) > bodies[b].half[0]:
            return 0
    else:
        to = at[0] * math.cos(middle) + at[1] * math.sin(middle)
        aside = at[1] * math.cos(middle) - at[0] * math.sin(middle)
        if abs(math.atan2(aside, to)) > angle:
            return 0
    height = inward(at, radius)
    # further away than that it comes round the guide's axis, or its end
    if abs(height) > 2.0 * bodies[b].half[2] + size(bodies[pair.a]):
        return 0
    return 1 if height >= 0.0 else -1
