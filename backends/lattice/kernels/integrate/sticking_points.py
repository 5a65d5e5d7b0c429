"""Corners whose friction sticks as points of an iteration with frozen contacts (see integrate.points).

Along the faces such a point has a spring and a damper, whose force ends where the limit of friction was as
the iteration began (mechanics.stick). That is the slope of a function like Huber's: a square, and from the
limit on a cone, which is convex.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.contact.slopes import outer
from mdlgen.backends.lattice.kernels.state import ELONGATION, HOLDING, KIND, NORMAL, NOW, PRESSING, STICKS
from mdlgen.mechanics.stick import coefficient
from mdlgen.mechanics.vector import add, dot, scale, sub, three_from
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def stick(q, stretch, k_t, law):
    """Makes of a corner that presses one that sticks, too: `stretch` [mm] is that of the first body against
    the second as the step begins, k_t the stiffness along the faces [N/mm]."""
    v, n = three_from(q, NOW), three_from(q, NORMAL)
    slip = sub(v, scale(dot(v, n), n))
    q[PRESSING] *= coefficient(math.sqrt(dot(slip, slip)), law)
    q[KIND], q[HOLDING] = STICKS, k_t
    for i in range(3):
        q[ELONGATION + i] = stretch[i]


@njit(cache=True, error_model="numpy", forceinline=True)
def _pulled(q, slip, h):
    """What the spring would hold back with, were there no limit."""
    return scale(q[HOLDING], add(three_from(q, ELONGATION), scale(2.0 * h, slip)))


@njit(cache=True, error_model="numpy", **BORROWS)
def held_back(q, slip, h):
    """Force along the faces against the first body, at a slip velocity in the middle of a step of 2 h."""
    force = _pulled(q, slip, h)
    size = math.sqrt(dot(force, force))
    return force if size <= q[PRESSING] else scale(q[PRESSING] / size, force)


@njit(cache=True, error_model="numpy", **BORROWS)
def holding(t, q, n, slip, h, chord):
    """Adds to t, a 3 x 3 matrix, what that loses as velocities grow, times h. n: the normal; chord: see
    slopes.steepness."""
    force = _pulled(q, slip, h)
    size = math.sqrt(dot(force, force))
    growth = less = 2.0 * h * h * q[HOLDING]
    if size > q[PRESSING]:
        growth *= q[PRESSING] / size
        less = chord * growth
    i = 1.0 / size if size > 0.0 else 0.0
    across, along = outer(scale(growth, n), n), outer(scale((less - growth) * i * i, force), force)
    return (
        t[0] + growth - across[0] + along[0],
        t[1] - across[1] + along[1],
        t[2] - across[2] + along[2],
        t[3] - across[3] + along[3],
        t[4] + growth - across[4] + along[4],
        t[5] - across[5] + along[5],
        t[6] - across[6] + along[6],
        t[7] - across[7] + along[7],
        t[8] + growth - across[8] + along[8],
    )
