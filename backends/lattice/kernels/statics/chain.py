"""Chains of boxes: the places of boxes with given rotations at which their joints have given gaps.

Boxes that turn by a finite angle and move along straight lines would stretch their joints, which are 1e5
times stiffer along the sheet than in bending, and more for a stiff membrane. So boxes turn as a step
prescribes, and are placed so that their joints have the gaps that it prescribes.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.linear.band import factor, solve
from mdlgen.backends.lattice.kernels.tuning import HANGS_ON_NOTHING
from mdlgen.mechanics.vector import (
    add,
    cross,
    exp_rotation,
    mat,
    matmul,
    rotate,
    scale,
    sub,
    three,
    vec,
)
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def link(bodies, joints, ground, a):
    """Sets the band to a network of springs of equal stiffness, one per joint, and factors it."""
    a[:] = 0.0
    for n in range(a.shape[0]):
        for i in range(6):
            a[n, i, i] = HANGS_ON_NOTHING
    for j in range(joints.size):
        na, nb = bodies[joints[j].a if joints[j].a >= 0 else ground].node, bodies[joints[j].b].node
        for i in range(3):
            if na >= 0:
                a[na, i, i] += 1.0
            if nb >= 0:
                a[nb, i, i] += 1.0
            if na >= 0 and nb >= 0:
                a[min(na, nb), i, 6 * abs(nb - na) + i] -= 1.0
    factor(a)


@njit(cache=True, error_model="numpy")
def _go(bodies, nodes, part, step, before, place):
    """Turns and moves boxes, and slides rollers, by a part of a step."""
    moves, slides = step
    x0, r0, s0 = before
    x, r, s = place
    for n in range(nodes.size):
        b, k = nodes[n], 6 * n
        m = matmul(exp_rotation(scale(part, three(moves[k + 3 :]))), mat(r0, b))
        for i in range(9):
            r[b, i] = m[i]
        for i in range(3):
            x[b, i] = x0[b, i] + part * moves[k + i]
    for b in range(bodies.size - 1):
        k = bodies[b].slide
        if k >= 0:
            s[k] = s0[k] + part * slides[k]
            for i in range(3):
                x[b, i] = x0[b, i] + part * slides[k] * bodies[b].way[i]


@njit(cache=True, error_model="numpy")
def _gap(joint, one, x, r):
    """Arms of a joint on both bodies, and the gap between their ends [mm]."""
    ra, rb = rotate(mat(r, one), three(joint.ra)), rotate(mat(r, joint.b), three(joint.rb))
    return ra, rb, sub(add(vec(x, joint.b), rb), add(vec(x, one), ra))


@njit(cache=True, error_model="numpy")
def opening(joint, one, x, r):
    """Gap between the ends of a joint on body `one` and on its second one [mm]."""
    _, _, gap = _gap(joint, one, x, r)
    return gap


@njit(cache=True, error_model="numpy")
def follow(tables, links, part, step, before, place, y, gaps):
    """Sets the place (x, r, s) after a part of a step (of boxes, of slides) from the one before.

    Boxes turn by it. Their places give joints the gaps (joints, 3) [mm] that the step prescribes, turned with
    the boxes; in the mean, where not all joints can have these. `y` is scratch.
    """
    bodies, joints, nodes = tables.bodies, tables.joints, tables.nodes
    moves, _slides = step
    x0, r0, _s0 = before
    x, r, _s = place
    _go(bodies, nodes, part, step, before, place)
    y[:] = 0.0
    for j in range(joints.size):
        one = joints[j].a if joints[j].a >= 0 else x.shape[0] - 1
        na, nb = bodies[one].node, bodies[joints[j].b].node
        ra, rb, gap = _gap(joints[j], one, x0, r0)
        opens, turn = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        if na >= 0:
            spin = three(moves[6 * na + 3 :])
            opens = sub(opens, add(three(moves[6 * na :]), cross(spin, ra)))
            turn = scale(0.5, spin)
        if nb >= 0:
            spin = three(moves[6 * nb + 3 :])
            opens = add(opens, add(three(moves[6 * nb :]), cross(spin, rb)))
            turn = add(turn, scale(0.5, spin))
        wanted = add(gap, scale(part, sub(opens, cross(turn, gap))))
        wanted = rotate(exp_rotation(scale(part, turn)), wanted)
        gaps[j, 0], gaps[j, 1], gaps[j, 2] = wanted
        miss = sub(wanted, opening(joints[j], one, x, r))
        for i in range(3):
            if na >= 0:
                y[6 * na + i] -= miss[i]
            if nb >= 0:
                y[6 * nb + i] += miss[i]
    solve(links, y)
    for n in range(nodes.size):
        for i in range(3):
            x[nodes[n], i] += y[6 * n + i]
