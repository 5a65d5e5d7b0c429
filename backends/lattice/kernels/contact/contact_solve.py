"""The contact solve: the condensed system of the boxes that touch something and of the rollers.

Contacts change with every step, the lattice hardly does. So the factored matrix has masses and bushings only,
in axes that turn with each box, and its factor serves many steps. A small dense matrix relates the impulses p
of contacts to the velocities of the boxes that they act on. It is the compliance W of these boxes: their rows
and columns of the inverse. With z the change of their velocities, in box axes,

    z = z0 + W (p(z) - p(0)),

where z0 is the change due to the residual alone. Rollers enter the same system with their inverse masses.
Newton's method solves it with the whole derivative of the contact forces, friction's growth with the normal
force included.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.contact.condensed import (
    ACTIVE,
    MINE,
    PLANES,
    REUSE,
    TOUCHED,
    UP_TO_DATE,
    unsee,
)
from mdlgen.backends.lattice.kernels.contact.jacobian import (
    activate,
    clutches,
    gradient,
    newton,
    newton_matrix,
)
from mdlgen.backends.lattice.kernels.forces import pair_forces, place_box, place_roller
from mdlgen.backends.lattice.kernels.linear.dense import lu
from mdlgen.backends.lattice.kernels.tuning import (
    APART_HALVED,
    APART_MOST,
    CHORD,
    CHORD_CAREFUL,
    NEARLY,
    USED_AGAIN,
)
from mdlgen.mechanics.arm import AXIAL, DAMPING, INERTIA, STIFFNESS, turn_of, way_of
from mdlgen.mechanics.axle import acting
from mdlgen.mechanics.frame import RADIUS
from mdlgen.mechanics.gate import stop
from mdlgen.mechanics.pair import on_fixed_plate
from mdlgen.mechanics.point import FORCE_A, FORCE_B, OUT, POINT, POINTS
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.mechanics.vector import back, dot, mat, rotate, vec
from mdlgen.model.tables.contacts import BOX_BOX
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _mine(bodies, pairs, near, where, condensed):
    """Lists the near pairs of the chosen boxes and those between rollers."""
    unsee(condensed)
    count = 0
    for k in range(near.size):
        pair = pairs[near[k]]
        if pair.kind == BOX_BOX:  # where these touch, all contacts are in the matrix
            continue
        node = bodies[pair.a].node
        inside = where == PLANES and on_fixed_plate(pair, bodies[pair.b])
        if node < 0 or (condensed.place_of[node] >= 0 and not inside):
            condensed.mine[count] = near[k]
            condensed.seen[near[k]] = True
            count += 1
    condensed.looked[MINE] = count


@njit(cache=True, error_model="numpy", **BORROWS)
def _take(tables, mid, many, condensed, m):
    """Copies the results of its pairs from the `many` that touch at the midpoint; returns how many touch."""
    pairs, nodes, touched = tables.pairs, tables.nodes, mid.touched
    forces, count = condensed.forces, 0
    for i in range(m):
        forces[nodes[condensed.chosen[i]]] = 0.0
    for b in condensed.rollers:
        forces[b] = 0.0
    for k in range(many):
        pair, out = pairs[touched[k]], mid.results[mid.rows[k]]
        if condensed.seen[touched[k]]:
            condensed.touched[count] = touched[k]
            for i in range(OUT + 1 + POINT * int(out[POINTS])):
                condensed.results[count, i] = out[i]
            for i in range(6):
                forces[pair.a, i] += out[FORCE_A + i]
                forces[pair.b, i] += out[FORCE_B + i]
            count += 1
    return count


@njit(cache=True, error_model="numpy", **BORROWS)
def _impulses(tables, xm, h, t, state, condensed, m, p):
    """Forces times h, in box axes and along the freedoms of rollers at xm, into p; of clutches and motors at
    t and the rates ub + z."""
    bodies, nodes, f, axles = tables.bodies, tables.nodes, condensed.forces, tables.shapes.axles
    for i in range(m):
        b = nodes[condensed.chosen[i]]
        axes = mat(condensed.axes, b)
        force, torque = back(axes, (f[b, 0], f[b, 1], f[b, 2])), back(axes, (f[b, 3], f[b, 4], f[b, 5]))
        for c in range(3):
            p[6 * i + c], p[6 * i + 3 + c] = h * force[c], h * torque[c]
    for b in condensed.rollers:
        slide, spin = bodies[b].slide, bodies[b].spin
        if slide >= 0:
            along = dot(vec(f, b), way_of(bodies[b], vec(xm, b)))
            torque = (f[b, 3], f[b, 4], f[b, 5])
            p[6 * m + slide] = h * (along + dot(torque, turn_of(bodies[b])))
        if spin >= 0:
            axis = bodies[b].axis
            about = f[b, 3] * axis[0] + f[b, 4] * axis[1] + f[b, 5] * axis[2]
            if bodies[b].coupled == FOLLOWER:  # its leader precedes it
                p[6 * m + spin] += h * bodies[b].ratio * about
                continue
            rate = state.ub[spin] + condensed.z[6 * m + spin]
            p[6 * m + spin] = h * (about + acting(axles, bodies[b], state.s[spin], rate, t, h).torque)


@njit(cache=True, error_model="numpy", **BORROWS)
def _begin(work, h, m):
    """Sets z to zero, z0 to the change due to the residual, and the measures of both."""
    bodies, nodes, x, ub = work.tables.bodies, work.tables.nodes, work.state.x, work.state.ub
    s = work.state.s
    condensed, islands, res, resb = work.condensed, work.islands, work.matrix.res, work.matrix.resb
    strict, label = islands.strict, work.free.label
    z, z0, own, measure = condensed.z, condensed.z0, condensed.own, condensed.measure
    for i in range(m):
        n = condensed.chosen[i]
        size = bodies[nodes[n]].half[0] + bodies[nodes[n]].half[1]
        for c in range(6):
            z[6 * i + c] = 0.0
            z0[6 * i + c] = -res[6 * n + c]
            measure[6 * i + c] = strict[label[n]] * (1.0 if c < 3 else size)
    for b in condensed.rollers:
        slide, spin, p = bodies[b].slide, bodies[b].spin, bodies[b].press
        times = strict[islands.part[b]]
        if slide >= 0:
            ends = stop(bodies[b], s[slide] + h * ub[slide], ub[slide])
            stiff, damps = p[STIFFNESS] + ends.by_place, p[DAMPING] + ends.by_rate
            own[slide] = 1.0 / (p[INERTIA] + h * damps + h * h * stiff)
            way = way_of(bodies[b], vec(x, b))
            measure[6 * m + slide] = times * math.sqrt(dot(way, way))
        if spin >= 0 and bodies[b].coupled != FOLLOWER:
            own[spin] = 1.0 / p[AXIAL]
            measure[6 * m + spin] = times * bodies[b].size[RADIUS]
    for i in range(ub.size):
        z[6 * m + i] = 0.0
        z0[6 * m + i] = -own[i] * resb[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def _evaluate(tables, h, t, state, motion, condensed, m):
    """Contact forces on the chosen boxes and the rollers, with their velocities changed by z; returns how
    many pairs touch."""
    bodies, nodes = tables.bodies, tables.nodes
    x, r, u, ub = state.x, state.r, state.u, state.ub
    forces, z = condensed.forces, condensed.z
    for i in range(m):
        n = condensed.chosen[i]
        b = nodes[n]
        for c in range(6):
            forces[b, c] = 0.0
        axes = mat(condensed.axes, b)
        v = rotate(axes, (z[6 * i], z[6 * i + 1], z[6 * i + 2]))
        w = rotate(axes, (z[6 * i + 3], z[6 * i + 4], z[6 * i + 5]))
        rate = (u[n, 0] + v[0], u[n, 1] + v[1], u[n, 2] + v[2])
        spin = (u[n, 3] + w[0], u[n, 4] + w[1], u[n, 5] + w[2])
        place_box(b, h, rate, spin, x, r, motion)
    for b in condensed.rollers:
        for c in range(6):
            forces[b, c] = 0.0
        rate = turning = 0.0
        if bodies[b].slide >= 0:
            rate = ub[bodies[b].slide] + z[6 * m + bodies[b].slide]
        if bodies[b].spin >= 0:
            turning = bodies[b].ratio * (ub[bodies[b].spin] + z[6 * m + bodies[b].spin])
        place_roller(bodies[b], b, h, t, rate, turning, x, r, motion)
    count, _stored, _lost = pair_forces(
        tables,
        condensed.mine,
        condensed.looked[MINE],
        motion,
        forces,
        condensed.touched,
        condensed.results,
    )
    return count


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, **BORROWS)
def _gap(condensed, m, many):
    """Writes the residual of the system into `gap`; returns its square, in velocities."""
    w, p, p0, push = condensed.w, condensed.p, condensed.p0, condensed.push
    boxes = 6 * m
    for i in range(many):
        push[i] = p[i] - p0[i]
    total = 0.0
    for i in range(many):
        v = condensed.z[i] - condensed.z0[i]
        if i < boxes:
            row = w[i]
            for j in range(boxes):
                v -= row[j] * push[j]
        else:
            v -= condensed.own[i - boxes] * push[i]
        condensed.gap[i] = v
        total += (condensed.measure[i] * v) ** 2
    return total


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False, **BORROWS)
def _apply(condensed, m, res, resb):
    """Adds the effect of the contacts to the change of velocities that is to be subtracted."""
    used, p0 = condensed.used, condensed.p0
    for j in range(m):
        cols, k = condensed.cols[condensed.slot_of[condensed.chosen[j]]], 6 * j
        a0, a1, a2 = used[k] - p0[k], used[k + 1] - p0[k + 1], used[k + 2] - p0[k + 2]
        a3, a4, a5 = used[k + 3] - p0[k + 3], used[k + 4] - p0[k + 4], used[k + 5] - p0[k + 5]
        c0, c1, c2, c3, c4, c5 = cols[0], cols[1], cols[2], cols[3], cols[4], cols[5]
        for l in range(res.size):
            res[l] -= a0 * c0[l] + a1 * c1[l] + a2 * c2[l] + a3 * c3[l] + a4 * c4[l] + a5 * c5[l]
    for i in range(resb.size):
        resb[i] = -condensed.z[6 * m + i]


@njit(cache=True, error_model="numpy", **BORROWS)
def solve_contacts(work, m, where, h, t, seen, limits):
    """Solves for the velocities of the m chosen boxes and of the rollers. Returns True if it converged: the
    residual is below the first of `limits`, or an iteration changed them by less than the second.

    The midpoint is that after h, at time t; `seen`: how many pairs are near there, and how many touch. The
    matrix's `res` is the decrease of velocities due to the lattice alone, in box axes, and `resb` the
    residual of the rollers. Both become the change that is to be subtracted.
    """
    tables, state, mid, condensed = work.tables, work.state, work.mid, work.condensed
    bodies, pairs, ub, xm = tables.bodies, tables.pairs, state.ub, mid.motion.x
    res, resb = work.matrix.res, work.matrix.resb
    limit, strict = limits
    near, touching = seen
    z, step, p, used = condensed.z, condensed.step, condensed.p, condensed.used
    boxes = 6 * m
    many = boxes + ub.size
    if many == 0:
        return True
    _mine(bodies, pairs, mid.near[:near], where, condensed)
    _begin(work, h, m)
    count = _take(tables, mid, touching, condensed, m)
    _impulses(tables, xm, h, t, state, condensed, m, condensed.p0)
    for i in range(many):
        p[i] = used[i] = condensed.p0[i]
    merit = _gap(condensed, m, many)
    if merit <= 1e-2 * strict * strict:
        _apply(condensed, m, res, resb)
        return True
    chord = CHORD
    for _ in range(APART_MOST):
        same = activate(bodies, pairs, count, condensed)
        active = condensed.kept[ACTIVE]
        short = 6 * active + ub.size
        if not (same and condensed.kept[REUSE] == 1):
            gradient(tables, h, mid.motion, count, condensed, active, short, chord)
            clutches(tables, h, t, state, condensed, m, active)
            newton_matrix(condensed, active, short)
            if not lu(condensed.jac, condensed.swaps, short):
                return False
        condensed.kept[REUSE] = 1
        newton(condensed, m, active, short)
        # impulses linearised by this step: with them the whole sheet moves consistently with the chosen boxes
        for i in range(boxes):
            used[i] = p[i] - condensed.push[i]
        change = 0.0
        for i in range(many):
            change = max(change, abs(condensed.measure[i] * step[i]))
            z[i] += step[i]
        if not change < 1e30:
            return False
        done = change <= NEARLY * strict
        before, part = merit, 1.0
        for halved in range(APART_HALVED + 1):
            if done:
                break
            count = _evaluate(tables, h, t, state, mid.motion, condensed, m)
            _impulses(tables, xm, h, t, state, condensed, m, p)
            merit = _gap(condensed, m, many)
            if merit <= before * (1.0 - 0.1 * part) or merit <= strict * strict or halved == APART_HALVED:
                break
            part *= 0.5
            for i in range(many):
                z[i] -= part * step[i]
        chord = CHORD_CAREFUL if part < 0.2 else CHORD
        if merit > USED_AGAIN * before:
            condensed.kept[REUSE] = 0
        if done or (part == 1.0 and merit <= limit * limit):
            _apply(condensed, m, res, resb)
            condensed.looked[TOUCHED], condensed.looked[UP_TO_DATE] = count, 0 if done else 1
            return True
    return False
