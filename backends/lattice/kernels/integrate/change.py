"""Changes of the velocities of all bodies: the greatest of an iteration, and the body that moves most."""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.state import FLOOR, OWN_REACH, OWN_SIZE, WORST
from mdlgen.mechanics.arm import way_of
from mdlgen.mechanics.bounds import fastest_place
from mdlgen.mechanics.frame import RADIUS
from mdlgen.mechanics.vector import dot, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def greatest(work, res, resb, control):
    """Greatest change of a velocity [mm/ms], times `strict` of its part. Angular velocities count times the
    size of a box or the radius of a roller. Changes below pace[FLOOR] are round-off and count as zero."""
    bodies, nodes, motion = work.tables.bodies, work.tables.nodes, work.mid.motion
    boxes, islands, floor = work.tables.boxes, work.islands, control.pace[FLOOR]
    label, strict = work.free.label, islands.strict
    change = 0.0
    for n in range(nodes.size):
        size = boxes[n, OWN_SIZE]
        times = strict[label[n]]
        for i in range(6):
            moved = abs(res[6 * n + i]) if i < 3 else size * abs(res[6 * n + i])
            if times * moved > change and moved > floor:
                change = times * moved
                control.counters[WORST] = nodes[n]
    for k in work.tables.moving:
        body, moved = bodies[k], 0.0
        if body.slide >= 0:
            way = way_of(body, vec(motion.x, k))
            moved = math.sqrt(dot(way, way)) * abs(resb[body.slide])
        if body.spin >= 0:
            moved = max(moved, body.size[RADIUS] * abs(body.ratio * resb[body.spin]))
        if moved > floor:
            change = max(change, strict[islands.part[k]] * moved)
    return change


@njit(cache=True, error_model="numpy", **BORROWS)
def greatest_of_free(work, res, floor):
    """The same for boxes of sheets that are free and touch nothing. Sheets that touch cannot converge as far,
    since the contact solve ends at the limit of the step."""
    tables, free, strict = work.tables, work.free, work.islands.strict
    change = 0.0
    for n in range(tables.nodes.size):
        if not free.alone[free.label[n]]:
            continue
        size = tables.boxes[n, OWN_SIZE]
        for i in range(6):
            moved = abs(res[6 * n + i]) if i < 3 else size * abs(res[6 * n + i])
            if moved > floor:
                change = max(change, strict[free.label[n]] * moved)
    return change


@njit(cache=True, error_model="numpy", **BORROWS)
def fastest(tables, u, found):
    """Sets found (bodies,) to a bound on the speed of any place of each free box [mm/ms]."""
    for n in range(tables.nodes.size):
        b = tables.nodes[n]
        rate, spin = (u[n, 0], u[n, 1], u[n, 2]), (u[n, 3], u[n, 4], u[n, 5])
        found[b] = fastest_place(tables.boxes[n, OWN_REACH], rate, spin)


@njit(cache=True, error_model="numpy", **BORROWS)
def take_off(state, res, resb):
    """Subtracts a change from the velocities."""
    u, ub = state.u, state.ub
    for n in range(u.shape[0]):
        for i in range(6):
            u[n, i] -= res[6 * n + i]
    for i in range(ub.size):
        ub[i] -= resb[i]
