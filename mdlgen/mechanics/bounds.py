"""How large the bodies of a pair are, and how fast their places."""

from __future__ import annotations

import math

from mdlgen.mechanics.frame import RADIUS, WIDTH
from mdlgen.mechanics.vector import dot, sub, vec
from mdlgen.program.kernel import njit

# How far two bodies may move between two looks at them: this part of the band that they must not cross. It is
# less than 1, since speeds are those at the begin of a step; a convention.
UNSEEN = 0.8


@njit(cache=True, error_model="numpy", forceinline=True)
def size(body):
    """Half of a box's diagonal."""
    return math.sqrt(body.half[0] * body.half[0] + body.half[1] * body.half[1] + body.half[2] * body.half[2])


@njit(cache=True, error_model="numpy", forceinline=True)
def round_size(body):
    """How far the farthest place of a roller is from its centre."""
    return math.hypot(body.size[RADIUS], 0.5 * body.size[WIDTH])


@njit(cache=True, error_model="numpy", forceinline=True)
def fastest_place(far, rate, spin):
    """How fast any place of a box is at most, of its velocity and its angular velocity; `far`: its size."""
    return math.sqrt(dot(rate, rate)) + math.sqrt(dot(spin, spin)) * far


@njit(cache=True, error_model="numpy", forceinline=True)
def turning(body, motion, k):
    """How fast body k, a box, moves at most by its angular velocity alone."""
    spin = vec(motion.w, k)
    return math.sqrt(dot(spin, spin)) * size(body)


@njit(cache=True, error_model="numpy", forceinline=True)
def gap_of(pair, x):
    """From the centre of the first body of a pair to that of the second."""
    return sub(vec(x, pair.b), vec(x, pair.a))


@njit(cache=True, error_model="numpy", forceinline=True)
def rate_of(pair, motion):
    """Velocity of the second body of a pair, as the first one has it."""
    return sub(vec(motion.u, pair.b), vec(motion.u, pair.a))


@njit(cache=True, error_model="numpy", forceinline=True)
def swinging(motion, k, gap):
    """How fast a place of body k that is `gap` off its centre moves at most by its angular velocity; 0 of
    what does not turn, as of nearly all."""
    w = vec(motion.w, k)
    if w[0] == 0.0 and w[1] == 0.0 and w[2] == 0.0:
        return 0.0
    return math.sqrt(dot(w, w) * dot(gap, gap))
