"""Prevents sheets from passing through each other.

The law of two boxes depends on where they are, not on where they came from: once the middle of a thin sheet
is behind that of the other, it is pushed out at the far side. A Newton iteration could move it there, since
faces that only just touch have no stiffness yet; so could a step.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.state import FACE_DEPTH, FACE_POINTS, MIDDLE
from mdlgen.backends.lattice.kernels.tuning import CLOSER
from mdlgen.mechanics.vector import back, mat, sub, transpose_matmul, vec
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def part_of_change(tables, near, close, r, h, change):
    """Part, at most 1, of a change of velocities (6 nodes,) that may be subtracted. With it no box of the
    pairs near[:close] approaches another sheet, in h, by more than one iteration allows."""
    bodies, listed, most = tables.bodies, tables.listed, 0.0
    for n in range(tables.nodes.size):
        most = max(most, change[6 * n] ** 2 + change[6 * n + 1] ** 2 + change[6 * n + 2] ** 2)
    if 2.0 * h * math.sqrt(most) <= CLOSER * tables.thinnest:  # no pair needs a check
        return 1.0
    worst, first = 0.0, tables.pairs.size - listed.size
    for at in range(close):
        if near[at] < first:
            continue
        pair = listed[near[at] - first]
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
def _height(bodies, pair, x, r):
    """Height of the middle of the second box over that of the first, and True if their outlines overlap.

    The height is along the normal of the first, at the middle of the common outline. The centres would not
    do: those of inclined boxes that overlap only in part may pass each other's plane.
    """
    one, half, other = mat(r, pair.a), bodies[pair.a].half, bodies[pair.b].half
    place = back(one, sub(vec(x, pair.b), vec(x, pair.a)))
    turn = transpose_matmul(one, mat(r, pair.b))
    over, leans = True, 0.0
    for q in range(2):
        out = 0.0
        for i in range(3):
            out += other[i] * abs(turn[3 * q + i])
        low, high = max(-half[q], place[q] - out), min(half[q], place[q] + out)
        over = over and high - low > 1e-9 * half[q]
        leans += turn[3 * q + 2] * (0.5 * (low + high) - place[q])
    if abs(turn[8]) < 0.5:  # it stands on its edge
        return place[2], over
    return place[2] - leans / turn[8], over


@njit(cache=True, error_model="numpy")
def crossed(tables, mid, counts, state, first, h):
    """First near pair of which a step takes a box through one of another sheet, or -1. The step goes from
    `state` to the middle, h later, and as far again.

    counts: how many pairs touch in the middle, how many are near; first: the pair of the first cached
    overlap. Faces that lie on each other in the middle, no deeper than half of the thinner box, can have
    changed sides only if they moved by a quarter of it.
    """
    bodies, listed, near, motion = tables.bodies, tables.listed, mid.near, mid.motion
    fast, known = mid.fastest[MIDDLE], 0
    count, close = counts
    most, thinnest = 0.0, tables.thinnest
    for b in tables.nodes:
        most = max(most, fast[b])
    calm = 2.0 * h * most < CLOSER * thinnest  # then every pair is slow
    for at in range(close):
        touches = known < count and mid.touched[known] == near[at]
        deep, lie = 0.0, False
        if touches:
            deep, lie = mid.faces[known, FACE_DEPTH], mid.faces[known, FACE_POINTS] == 0.0
            known += 1
        if near[at] < first:
            continue
        lie = lie or mid.lies[at]
        if calm and lie and deep <= thinnest:
            continue
        pair = listed[near[at] - first]
        thin = min(bodies[pair.a].half[2], bodies[pair.b].half[2])
        slow = h * (fast[pair.a] + fast[pair.b]) < CLOSER * thin and deep <= thin
        if slow and lie:
            continue
        begin, _ = _height(bodies, pair, state.x, state.r)
        middle, over = _height(bodies, pair, motion.x, motion.r)
        if over and begin * (2.0 * middle - begin) <= 0.0:
            return near[at]
    return -1
