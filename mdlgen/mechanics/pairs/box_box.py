"""Two boxes of two sheets."""

from __future__ import annotations

import math

from mdlgen.mechanics.bounds import UNSEEN, gap_of, rate_of, size, turning
from mdlgen.mechanics.facing import box_box
from mdlgen.mechanics.frame import box_of, frame_of, law_of
from mdlgen.mechanics.point import presses
from mdlgen.mechanics.vector import dot, mat, sub, transpose_matmul, vec
from mdlgen.model.tables.contacts import BOX_BOX
from mdlgen.program.kernel import BORROWS, njit

KIND = BOX_BOX
# How deep a corner of a face may be, in half thicknesses of the thinner box. At 2 the law may take the boxes
# to have changed sides, as it looks at the middles of their faces. The corner of a box that tilts is deeper
# than its middle; so it may go half of the way from 1 to 2.
PRESSED = 1.5
# How far two boxes may move towards each other between two looks, in the same measure.
STRIDE = UNSEEN * (2.0 - PRESSED)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    box_box(out, a, box_of(bodies[pair.a]), b, box_of(bodies[pair.b]), law_of(pair))
    return presses(out)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def near(bodies, pair, shapes, motion, margin, ahead):
    """By their bounding spheres, which decide nearly all cases, then by the axes of the first box."""
    a, b, r = pair.a, pair.b, motion.r
    gap, rate, half, other = gap_of(pair, motion.x), rate_of(pair, motion), bodies[a].half, bodies[b].half
    moved = turning(bodies[a], motion, a) + turning(bodies[b], motion, b)
    reached = margin + ahead * (math.sqrt(dot(rate, rate)) + moved)
    reach = size(bodies[a]) + size(bodies[b]) + reached
    if dot(gap, gap) > reach * reach:
        return False
    one = mat(r, a)
    turn = transpose_matmul(one, mat(r, b))
    for q in range(3):
        up = gap[0] * one[q] + gap[1] * one[3 + q] + gap[2] * one[6 + q]
        out = half[q] + reached
        for i in range(3):
            out += other[i] * abs(turn[3 * q + i])
        if abs(up) > out:
            return False
    return True


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def apart(bodies, pair, shapes, x, r, way):
    """By their bounding spheres."""
    gap = sub(vec(x, pair.a), vec(x, pair.b))
    return math.sqrt(dot(gap, gap)) > size(bodies[pair.a]) + size(bodies[pair.b]) + way


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """A part of the thickness of the thinner one."""
    return PRESSED * min(bodies[pair.a].half[2], bodies[pair.b].half[2])


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def unseen(bodies, pair, shapes):
    """Less than the rest of the thickness beyond `deepest`."""
    return STRIDE * min(bodies[pair.a].half[2], bodies[pair.b].half[2])


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """Across either face; along them a sheet may be fast."""
    a, b, r = pair.a, pair.b, motion.r
    rate = rate_of(pair, motion)
    one = abs(dot(rate, (r[a, 2], r[a, 5], r[a, 8])))
    two = abs(dot(rate, (r[b, 2], r[b, 5], r[b, 8])))
    return max(one, two) + turning(bodies[a], motion, a) + turning(bodies[b], motion, b)
