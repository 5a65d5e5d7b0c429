"""Bounds on the size of the bodies of a pair, and on the speed of their places."""

from __future__ import annotations

import math

from mdlgen.mechanics.frame import RADIUS, WIDTH
from mdlgen.mechanics.vector import dot, sub, vec
from mdlgen.program.kernel import njit

# Part of the band that two bodies must not cross by which they may move between two checks. It is less than
# 1, since speeds are those at the beginning of a step; a convention.
UNSEEN = 0.8


@njit(cache=True, error_model="numpy", forceinline=True)
def size(body):
    """Half of a box's diagonal."""
    return math.sqrt(body.half[0] * body.half[0] + body.half[1] * body.half[1] + body.half[2] * body.half[2])


@njit(cache=True, error_model="numpy", forceinline=True)
def round_size(body):
    """Distance of the farthest place of a roller from its centre."""
    return math.hypot(body.size[RADIUS], 0.5 * body.size[WIDTH])


@njit(cache=True, error_model="numpy", forceinline=True)
def fastest_place(far, rate, spin):
    """Bound on the speed of any place of a box, from its velocity and angular velocity; `far`: its size."""
    return math.sqrt(dot(rate, rate)) + math.sqrt(dot(spin, spin)) * far


@njit(cache=True, error_model="numpy", forceinline=True)
def turning(body, motion, k):
    """Bound on the speed of places of body k, a box, due to its angular velocity alone."""
    spin = vec(motion.w, k)
    return math.sqrt(dot(spin, spin)) * size(body)


@njit(cache=True, error_model="numpy", forceinline=True)
def gap_of(pair, x):
    """Vector from the centre of the first body of a pair to that of the second."""
    return sub(vec(x, pair.b), vec(x, pair.a))


@njit(cache=True, error_model="numpy", forceinline=True)
def rate_of(pair, motion):
    """Velocity of the second body of a pair relative to the first."""
    return sub(vec(motion.u, pair.b), vec(motion.u, pair.a))


@njit(cache=True, error_model="numpy", forceinline=True)
def swinging(motion, k, gap):
    """Bound on the speed of a place of body k, at `gap` from its centre, due to its angular velocity; 0 for
    bodies that do not turn, which are nearly all."""
    w = vec(motion.w, k)
    if w[0] == 0.0 and w[1] == 0.0 and w[2] == 0.0:
        return 0.0
    return math.sqrt(dot(w, w) * dot(gap, gap))
