"""A box and a roller, round or with a rim in sectors."""

from __future__ import annotations

import math

from mdlgen.mechanics.bounds import fastest_place, gap_of, rate_of, round_size, size, turning
from mdlgen.mechanics.contact import box_cylinder
from mdlgen.mechanics.frame import RADIUS, WIDTH, box_of, cylinder_of, frame_of, law_of
from mdlgen.mechanics.nip import EASE
from mdlgen.mechanics.point import FORCE_A, presses
from mdlgen.mechanics.rim import box_rim
from mdlgen.mechanics.vector import dot, sub, three, vec
from mdlgen.model.tables.contacts import BOX_CYLINDER
from mdlgen.program.kernel import BORROWS, njit

KIND = BOX_CYLINDER


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    one, two = bodies[pair.a], bodies[pair.b]
    a, b, law = frame_of(motion, pair.a), frame_of(motion, pair.b), law_of(pair)
    if two.rims > 0:
        box_rim(out, a, box_of(one), b, two, shapes.rims, law)
    else:
        box_cylinder(out, a, box_of(one), b, cylinder_of(two), law)
    # a box just beyond the end of a roller has a part of what that does, and nothing presses on it
    return presses(out) or out[FORCE_A] != 0.0 or out[FORCE_A + 1] != 0.0 or out[FORCE_A + 2] != 0.0


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def rolling(bodies, pair, shapes, motion):
    """The box is flat."""
    two = bodies[pair.b]
    return three(two.axis), 1.0 / two.size[RADIUS]


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def near(bodies, pair, shapes, motion, margin, ahead):
    """Along the roller's axis, across it, and whether the axis is above or below the face."""
    a, b, r, own = pair.a, pair.b, motion.r, bodies[pair.a]
    gap = gap_of(pair, motion.x)
    reached = margin + ahead * fastest_place(size(own), rate_of(pair, motion), vec(motion.w, a))
    reach = size(own) + reached
    axis = bodies[b].axis
    along = gap[0] * axis[0] + gap[1] * axis[1] + gap[2] * axis[2]
    across = gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2] - along * along
    radius, width = bodies[b].size[RADIUS], (0.5 + EASE) * bodies[b].size[WIDTH]
    if abs(along) > width + reach or across > (radius + reach) * (radius + reach):
        return False
    up = gap[0] * r[a, 2] + gap[1] * r[a, 5] + gap[2] * r[a, 8]
    lean = abs(axis[0] * r[a, 2] + axis[1] * r[a, 5] + axis[2] * r[a, 8])
    return not abs(up) > own.half[2] + radius + width * lean + reached


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def apart(bodies, pair, shapes, x, r, way):
    """By their bounding spheres."""
    gap = sub(vec(x, pair.a), vec(x, pair.b))
    return math.sqrt(dot(gap, gap)) > size(bodies[pair.a]) + round_size(bodies[pair.b]) + way


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """Half of the roller's radius."""
    return 0.5 * bodies[pair.b].size[RADIUS]


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """Across the roller; along its axis a sheet may be fast."""
    rate, axis = rate_of(pair, motion), bodies[pair.b].axis
    along = rate[0] * axis[0] + rate[1] * axis[1] + rate[2] * axis[2]
    across = math.sqrt(max(dot(rate, rate) - along * along, 0.0))
    return across + turning(bodies[pair.a], motion, pair.a)
