"""Two rollers, round or with rims in sectors."""

from __future__ import annotations

import math

from mdlgen.mechanics.bounds import gap_of, rate_of, round_size
from mdlgen.mechanics.contact import cylinder_cylinder
from mdlgen.mechanics.frame import RADIUS, WIDTH, cylinder_of, frame_of, law_of
from mdlgen.mechanics.nip import EASE
from mdlgen.mechanics.point import presses
from mdlgen.mechanics.rim import rim_rim
from mdlgen.mechanics.vector import dot, sub, three, vec
from mdlgen.model.tables.contacts import CYLINDER_CYLINDER
from mdlgen.program.kernel import BORROWS, njit

KIND = CYLINDER_CYLINDER


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    one, two = bodies[pair.a], bodies[pair.b]
    a, b, law = frame_of(motion, pair.a), frame_of(motion, pair.b), law_of(pair)
    if one.rims + two.rims > 0:
        rim_rim(out, a, one, b, two, shapes.rims, law)
    else:
        cylinder_cylinder(out, a, cylinder_of(one), b, cylinder_of(two), law)
    return presses(out)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def rolling(bodies, pair, shapes, motion):
    """Both are round."""
    one, two = bodies[pair.a], bodies[pair.b]
    return three(two.axis), 1.0 / one.size[RADIUS] + 1.0 / two.size[RADIUS]


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def near(bodies, pair, shapes, motion, margin, ahead):
    """Along the second one's axis and across it."""
    b, own = pair.b, bodies[pair.a]
    gap, rate = gap_of(pair, motion.x), rate_of(pair, motion)
    reach = own.size[RADIUS] + (margin + ahead * math.sqrt(dot(rate, rate)))
    axis = bodies[b].axis
    along = gap[0] * axis[0] + gap[1] * axis[1] + gap[2] * axis[2]
    across = gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2] - along * along
    radius, width = bodies[b].size[RADIUS], (0.5 + EASE) * bodies[b].size[WIDTH] + 0.5 * own.size[WIDTH]
    return not (abs(along) > width + reach or across > (radius + reach) * (radius + reach))


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def apart(bodies, pair, shapes, x, r, way):
    """By their bounding spheres."""
    gap = sub(vec(x, pair.a), vec(x, pair.b))
    return math.sqrt(dot(gap, gap)) > round_size(bodies[pair.a]) + round_size(bodies[pair.b]) + way


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """The smaller one's radius."""
    return min(bodies[pair.a].size[RADIUS], bodies[pair.b].size[RADIUS])


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """Across the second one's axis."""
    rate, axis = rate_of(pair, motion), bodies[pair.b].axis
    along = rate[0] * axis[0] + rate[1] * axis[1] + rate[2] * axis[2]
    return math.sqrt(max(dot(rate, rate) - along * along, 0.0))
