"""Checks between two steps of the solver, where a fast or thin body may have passed through another one."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.exudyn_local.place import place_all, place_body
from mdlgen.backends.exudyn_local.state import Coordinates
from mdlgen.mechanics.crossing import above, apart, buried, closing, deepest, solid, unseen
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.pair import pair_force
from mdlgen.mechanics.point import DEPTH, OUT
from mdlgen.program.kernel import njit

# Most states of a pair that are checked within a step; a pair that needs more requires a smaller step.
MOST_LOOKS = 256


@njit(cache=True, error_model="numpy")
def set_limits(bodies, pairs, depths):
    """Sets the depth of each pair at which a run ends."""
    for p in range(pairs.size):
        depths[p] = deepest(bodies, pairs[p])


@njit(cache=True, error_model="numpy")
def _between(body, before, now, part, into):
    """Coordinates of one body between two states, Euler parameters normalised."""
    n = body.first
    if n >= 0:
        square = 0.0
        for i in range(7):
            into[n + i] = before[n + i] + part * (now[n + i] - before[n + i])
        for i in range(3, 7):
            into[n + i] += body.reference[i]
            square += into[n + i] ** 2
        for i in range(3, 7):
            into[n + i] = into[n + i] / math.sqrt(square) - body.reference[i]
    for k in (body.slide, body.spin):
        if k >= 0:
            into[k] = before[k] + part * (now[k] - before[k])


@njit(cache=True, error_model="numpy")
def passed(bodies, pairs, shapes, before, rates, now, rates_now, t, dt):
    """First pair that was too deep, or changed sides, in a step of dt from t, or -1; the step goes from the
    coordinates `before` at the velocities `rates` to `now`."""
    count = bodies.size
    first = Motion(np.zeros((count, 3)), np.zeros((count, 9)), np.zeros((count, 3)), np.zeros((count, 3)))
    last = Motion(np.zeros((count, 3)), np.zeros((count, 9)), np.zeros((count, 3)), np.zeros((count, 3)))
    out, q = np.zeros(OUT), now.copy()
    place_all(bodies, Coordinates(before, rates, t), first)
    place_all(bodies, Coordinates(now, rates_now, t + dt), last)
    for p in range(pairs.size):
        pair = pairs[p]
        fast = closing(bodies, pair, shapes, first, dt)
        fast = max(fast, closing(bodies, pair, shapes, last, dt))
        way, band = dt * fast, unseen(bodies, pair, shapes)
        side = above(bodies, pair, first.x, first.r)
        inside = solid(bodies, pair)
        if way <= band and side == 0 and not inside:
            continue
        if apart(bodies, pair, shapes, first.x, first.r, way):
            continue
        if way > MOST_LOOKS * band:
            return p
        many = max(1, math.ceil(way / band))
        for k in range(1, many + 1):
            part = k / many
            for body in (pair.a, pair.b):
                _between(bodies[body], before, now, part, q)
                place_body(bodies, body, Coordinates(q, rates_now, t + part * dt), last)
            beyond = above(bodies, pair, last.x, last.r)
            if side * beyond < 0:
                return p
            side = beyond
            if inside and buried(bodies, pair, shapes, last.x, last.r):
                return p
            if way > band:
                out[:] = 0.0
                pair_force(bodies, pair, shapes, last, out)
                if out[DEPTH] > deepest(bodies, pair):
                    return p
    return -1
