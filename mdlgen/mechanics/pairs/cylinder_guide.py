"""A roller and a guide."""

from __future__ import annotations

import math

from mdlgen.mechanics.bounds import gap_of, rate_of, swinging
from mdlgen.mechanics.frame import ARC_RADIUS, RADIUS, frame_of, law_of
from mdlgen.mechanics.point import presses
from mdlgen.mechanics.roller_plate import DEEP_ROLLER, guide_near, roller_guide
from mdlgen.mechanics.vector import back, dot, mat, sub, three, vec
from mdlgen.model.tables.contacts import CYLINDER_GUIDE
from mdlgen.program.kernel import BORROWS, njit

KIND = CYLINDER_GUIDE


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    one, two = bodies[pair.a], bodies[pair.b]
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    roller_guide(out, one, shapes.rims, a, b, three(two.arc), three(two.half), two.side, law_of(pair))
    return presses(out)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def rolling(bodies, pair, shapes, motion):
    """On a flat face, in the hollow of an arc, or on its round."""
    one, arc = bodies[pair.a], bodies[pair.b].arc[ARC_RADIUS]
    curved = 1.0 / one.size[RADIUS]
    if arc > 0.0:
        at = back(mat(motion.r, pair.b), sub(vec(motion.x, pair.a), vec(motion.x, pair.b)))
        hollow = at[0] * at[0] + at[1] * at[1] < arc * arc
        curved += -1.0 / arc if hollow else 1.0 / arc
    return three(one.axis), curved


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def near(bodies, pair, shapes, motion, margin, ahead):
    """As far as their bounds tell."""
    rate = rate_of(pair, motion)
    fast = math.sqrt(dot(rate, rate)) + swinging(motion, pair.b, gap_of(pair, motion.x))
    return not apart(bodies, pair, shapes, motion.x, motion.r, margin + ahead * fast)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def apart(bodies, pair, shapes, x, r, way):
    """As far as their bounds tell."""
    rb = mat(r, pair.b)
    at = back(rb, sub(vec(x, pair.a), vec(x, pair.b)))
    return not guide_near(bodies[pair.a], at, rb, bodies[pair.b], way)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """Half of the roller's radius: its axis is soon behind the face."""
    return DEEP_ROLLER * bodies[pair.a].size[RADIUS]


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """In any direction."""
    rate = rate_of(pair, motion)
    return math.sqrt(dot(rate, rate)) + swinging(motion, pair.b, gap_of(pair, motion.x))
