"""A roller and a plane."""

from __future__ import annotations

import math

from mdlgen.mechanics.bounds import gap_of, rate_of, swinging
from mdlgen.mechanics.frame import RADIUS, frame_of, law_of
from mdlgen.mechanics.point import presses
from mdlgen.mechanics.roller_plate import DEEP_ROLLER, plate_near, roller_plane
from mdlgen.mechanics.vector import back, dot, mat, sub, three, vec
from mdlgen.model.tables.contacts import CYLINDER_PLANE
from mdlgen.program.kernel import BORROWS, njit

KIND = CYLINDER_PLANE


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    a, b, half = frame_of(motion, pair.a), frame_of(motion, pair.b), three(bodies[pair.b].half)
    roller_plane(out, bodies[pair.a], shapes.rims, a, b, half, law_of(pair))
    return presses(out)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def rolling(bodies, pair, shapes, motion):
    """On a flat face."""
    one = bodies[pair.a]
    return three(one.axis), 1.0 / one.size[RADIUS]


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
    return not plate_near(bodies[pair.a], at, rb, bodies[pair.b], way)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """Half of the roller's radius: its axis is soon behind the face."""
    return DEEP_ROLLER * bodies[pair.a].size[RADIUS]


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """In any direction."""
    rate = rate_of(pair, motion)
    return math.sqrt(dot(rate, rate)) + swinging(motion, pair.b, gap_of(pair, motion.x))
