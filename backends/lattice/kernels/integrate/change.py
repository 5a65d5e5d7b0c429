"""Changes of the velocities of all bodies: the greatest of an iteration, and what moves most."""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.state import OWN_REACH, OWN_SIZE, WORST
from mdlgen.mechanics.arm import way_of
from mdlgen.mechanics.bounds import fastest_place
from mdlgen.mechanics.vector import dot, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def greatest(work, res, resb, counters):
    """The greatest change of a velocity [mm/ms], of turning times a box's size; that of a sheet of which a
    step may leave less counts that many times."""
    bodies, nodes, motion = work.tables.bodies, work.tables.nodes, work.mid.motion
    boxes = work.tables.boxes
    label, strict = work.free.label, work.asleep.strict
    change = 0.0
    for n in range(nodes.size):
        size = boxes[n, OWN_SIZE]
        times = strict[label[n]]
        for i in range(6):
            moved = times * (abs(res[6 * n + i]) if i < 3 else size * abs(res[6 * n + i]))
            if moved > change:
                change = moved
                counters[WORST] = nodes[n]
    for i in range(resb.size):
        change = max(change, abs(resb[i]))
    for k in work.tables.moving:
        if bodies[k].swings > 0:
            way = way_of(bodies[k], vec(motion.x, k))
            change = max(change, math.sqrt(dot(way, way)) * abs(resb[bodies[k].slide]))
    return change


@njit(cache=True, error_model="numpy", **BORROWS)
def greatest_of_free(tables, free, res):
    """The same of boxes whose sheets hang on nothing and touch nothing (see momentum.keep) alone."""
    change = 0.0
    for n in range(tables.nodes.size):
        if free.busy[free.one_with[free.label[n]]]:
            continue
        size = tables.boxes[n, OWN_SIZE]
        for i in range(6):
            change = max(change, abs(res[6 * n + i]) if i < 3 else size * abs(res[6 * n + i]))
    return change


@njit(cache=True, error_model="numpy", **BORROWS)
def fastest(tables, u, found):
    """How fast any place of a free box is at most (bodies,)."""
    for n in range(tables.nodes.size):
        b = tables.nodes[n]
        rate, spin = (u[n, 0], u[n, 1], u[n, 2]), (u[n, 3], u[n, 4], u[n, 5])
        found[b] = fastest_place(tables.boxes[n, OWN_REACH], rate, spin)


@njit(cache=True, error_model="numpy", **BORROWS)
def take_off(state, res, resb):
    """Takes a change off the velocities."""
    u, ub = state.u, state.ub
    for n in range(u.shape[0]):
        for i in range(6):
            u[n, i] -= res[6 * n + i]
    for i in range(ub.size):
        ub[i] -= resb[i]
