"""Sheets stay on the sides of each other that they are on.

The law of two boxes knows where they are, not where they came from: once the middle of a thin sheet is behind
that of the other, it is pushed out at the far side. Newton's method could go there in one round, where faces
that only just touch have no stiffness yet; and a step could end there.
"""

from __future__ import annotations

from numba import njit

from mdlgen.mechanics.pair import BOX_BOX
from mdlgen.mechanics.vector import back, mat, sub, transpose_matmul, vec

# What two boxes may come closer in one round, in half thicknesses of the thinner one.
CLOSER = 0.5


@njit(cache=True, error_model="numpy")
def part_of_change(bodies, pairs, near, close, r, h, change):
    """The part of a change of velocities (6 nodes,), taken off, that moves no box of the pairs near[:close]
    further to another sheet in h than it may in one round; at most 1."""
    worst = 0.0
    for at in range(close):
        pair = pairs[near[at]]
        if pair.kind != BOX_BOX:
            continue
        opens = 0.0
        for end in range(2):
            node = bodies[pair.a if end == 0 else pair.b].node
            if node >= 0:
                for i in range(3):
                    v = r[pair.a, 3 * i + 2] * change[6 * node + i]
                    opens += v if end == 0 else -v
        thin = min(bodies[pair.a].half[2], bodies[pair.b].half[2])
        worst = max(worst, abs(h * opens) / thin)
    return min(1.0, CLOSER / worst) if worst > 0.0 else 1.0


@njit(cache=True, error_model="numpy")
def crossed(bodies, pairs, near, close, x, xm, rm):
    """Whether a step takes a box of the pairs near[:close] through one of another sheet: from x over the
    middle xm, rm as far again."""
    for at in range(close):
        pair = pairs[near[at]]
        if pair.kind != BOX_BOX:
            continue
        one, half, other = mat(rm, pair.a), bodies[pair.a].half, bodies[pair.b].half
        begin = back(one, sub(vec(x, pair.b), vec(x, pair.a)))
        middle = back(one, sub(vec(xm, pair.b), vec(xm, pair.a)))
        if begin[2] * (2.0 * middle[2] - begin[2]) > 0.0:
            continue
        turn = transpose_matmul(one, mat(rm, pair.b))
        over = True
        for q in range(2):
            out = half[q]
            for i in range(3):
                out += other[i] * abs(turn[3 * q + i])
            over = over and abs(middle[q]) < (1.0 - 1e-9) * out
        if over:
            return True
    return False
