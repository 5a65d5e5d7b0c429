"""One step of the implicit midpoint rule, and many of them.

With h half of the step, the velocities u at its middle solve m (u - v0) = h f and J w - l0 = h t, with
forces at the middle: positions x0 + h u, rotations exp(h w) R0. Then x1 = x0 + 2 h u, R1 = exp(2 h w) R0,
and velocities and angular momenta are carried to 2 u - v0 and 2 J w - l0. So linear and angular momentum
are conserved to the accuracy of the iteration, whatever the step.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from backends.lattice.band import factor, solve
from backends.lattice.forces import (
    driven,
    joint_forces,
    near_pairs,
    other_forces,
    pair_forces,
    place,
)
from backends.lattice.tangent import contacts_into, joints_into, masses, rollers_into
from mdlgen.mechanics.pair import BOX_PLANE
from mdlgen.mechanics.vector import back, exp_rotation, mat, matmul, rotate

# Rounds of one step before it is given up. A new factor costs as much as this many rounds, and is made where
# more of them are still to come at the rate of the last two.
MOST_ROUNDS = 60
FAR = 0.05  # mm: pairs that are closer than this, and what moves in a step, are looked at in it
WORTH = 3.0
FREE = 1e-5
# How much of the chord a factor takes (see tangent.contacts_into): little converges fast, much does not cross
# to the other side of what is flat; the latter is taken twice where a round moved more than the one before.
LITTLE, MUCH = 0.05, 0.7
DONE, STOPPED, LEFT, DEEP = 0, 1, 2, 3
# Counters of a run.
STEPS, ROUNDS, FACTORS, HALVED, TOUCHING, WORST = 0, 1, 2, 3, 4, 5
# Two rollers with a sheet between them clear each other by a few micrometres and may graze: a force below
# this part of the greatest is not counted as the nip still acting.
GRAZE = 0.05


@njit(cache=True, error_model="numpy")
def _residual(bodies, nodes, h, u, ub, v, l, vb, s, rm, f, res, resb):
    """Residual of the step's equations into res (6 nodes,) and resb (border,)."""
    for n in range(nodes.size):
        b = nodes[n]
        m = mat(rm, b)
        spin = back(m, (u[n, 3], u[n, 4], u[n, 5]))
        j = bodies[b].inertia
        p = rotate(m, (j[0] * spin[0], j[1] * spin[1], j[2] * spin[2]))
        for i in range(3):
            res[6 * n + i] = bodies[b].mass * (u[n, i] - v[n, i]) - h * f[b, i]
            res[6 * n + 3 + i] = p[i] - l[n, i] - h * f[b, 3 + i]
    for k in range(bodies.size - 1):
        p = bodies[k].press
        slide, spin_at = bodies[k].slide, bodies[k].spin
        if slide >= 0:
            way = bodies[k].way
            along = f[k, 0] * way[0] + f[k, 1] * way[1] + f[k, 2] * way[2]
            spring = p[2] - p[0] * (s[slide] + h * ub[slide]) - p[1] * ub[slide]
            resb[slide] = p[3] * (ub[slide] - vb[slide]) - h * (along + spring)
        if spin_at >= 0:
            axis = bodies[k].axis
            about = f[k, 3] * axis[0] + f[k, 4] * axis[1] + f[k, 5] * axis[2]
            resb[spin_at] = p[4] * (ub[spin_at] - vb[spin_at]) - h * about


@njit(cache=True, error_model="numpy")
def _weights(bodies, gravity, f):
    """Weight of what slides, on top of the forces on it."""
    for k in range(bodies.size - 1):
        if bodies[k].slide >= 0:
            for i in range(3):
                f[k, i] += bodies[k].press[3] * gravity[i]


@njit(cache=True, error_model="numpy")
def _corner(a, b, d, y, corner):
    """Y = A^-1 B (rows of y) and the factored corner D - B Y. Returns False where that is not regular."""
    many = d.shape[0]
    corner[:] = d
    for j in range(many):
        first = 0
        while first < b.shape[1] and b[j, first] == 0.0:
            first += 1
        y[j] = b[j]
        if first < b.shape[1]:
            solve(a, y[j], first // 6)
            for i in range(j, many):
                v = 0.0
                for l in range(b.shape[1]):
                    v += b[i, l] * y[j, l]
                corner[i, j] -= v
    # Cholesky of a small dense matrix
    for j in range(many):
        for k in range(j):
            for i in range(j, many):
                corner[i, j] -= corner[i, k] * corner[j, k]
        if not corner[j, j] > 0.0:
            return False
        pivot = math.sqrt(corner[j, j])
        for i in range(j, many):
            corner[i, j] /= pivot
    return True


@njit(cache=True, error_model="numpy")
def _solve_all(a, b, y, corner, res, resb):
    """Solves band and border in place."""
    solve(a, res)
    m = resb.size
    for j in range(m):
        v = resb[j]
        for l in range(res.size):
            v -= b[j, l] * res[l]
        resb[j] = v
    for j in range(m):
        for k in range(j):
            resb[j] -= corner[j, k] * resb[k]
        resb[j] /= corner[j, j]
    for j in range(m - 1, -1, -1):
        for k in range(j + 1, m):
            resb[j] -= corner[k, j] * resb[k]
        resb[j] /= corner[j, j]
    for j in range(m):
        v = resb[j]
        if v != 0.0:
            for l in range(res.size):
                res[l] -= y[j, l] * v


@njit(cache=True, error_model="numpy")
def midpoint(system, state, mid, matrix, t, dt, tolerance, fresh, counters):
    """Solves for the velocities at the middle of a step. Returns whether it converged.

    `fresh` (2,): the step that the factor was made for (0: none), and whether it should be made anew.
    """
    bodies, joints, pairs, loads, gravity, nodes = system
    x, r, v, l, s, vb, u, ub = state
    xm, rm, um, wm, f, touched, outs, totals, near = mid
    a, b, d, y, corner, res, resb, direction, index = matrix
    h = 0.5 * dt
    before = 1e300
    careful = 0
    fast = 0.0
    for n in range(nodes.size):
        fast = max(fast, abs(u[n, 0]), abs(u[n, 1]), abs(u[n, 2]))
    close = near_pairs(bodies, pairs, x, r, FAR + dt * fast, near)
    for _ in range(MOST_ROUNDS):
        place(bodies, nodes, h, t + h, u, ub, x, r, xm, rm, um, wm)
        f[:] = 0.0
        _stored, lost = joint_forces(joints, xm, rm, um, wm, f)
        count, _pressed, rubbed = pair_forces(bodies, pairs, near, close, xm, rm, um, wm, f, touched, outs)
        power = other_forces(bodies, loads, gravity, 1.0, rm, um, wm, f)
        _weights(bodies, gravity, f)
        _residual(bodies, nodes, h, u, ub, v, l, vb, s, rm, f, res, resb)
        if fresh[0] != dt or fresh[1] != 0.0:
            counters[FACTORS] += 1
            masses(bodies, nodes, rm, a)
            joints_into(bodies, joints, h, xm, rm, a)
            rollers_into(bodies, h, b, d)
            chord = MUCH if careful > 0 else LITTLE
            careful -= 1
            contacts_into(bodies, pairs, h, xm, touched, outs, count, chord, a, b, d, direction, index)
            if not factor(a) or not _corner(a, b, d, y, corner):
                fresh[0] = 0.0
                return False
            fresh[0], fresh[1] = dt, 0.0
        counters[ROUNDS] += 1
        _solve_all(a, b, y, corner, res, resb)
        change = 0.0
        for n in range(nodes.size):
            size = bodies[nodes[n]].half[0] + bodies[nodes[n]].half[1]
            for i in range(6):
                step = res[6 * n + i]
                u[n, i] -= step
                moved = abs(step) if i < 3 else size * abs(step)
                if moved > change:
                    change = moved
                    counters[WORST] = nodes[n]
        for i in range(ub.size):
            ub[i] -= resb[i]
            change = max(change, abs(resb[i]))
        if not change < 1e30:
            fresh[0] = 0.0
            return False
        rate = change / before
        # what is free converges fast, and keeps its angular momentum as well as the rounds end
        limit = tolerance if count > 0 else FREE * tolerance
        known = before < 1e299 and rate < 0.5
        if change <= limit or (known and change * rate / (1.0 - rate) <= 0.3 * limit):
            totals[0], totals[1] = lost + rubbed, power
            counters[TOUCHING] = count
            return True
        if before < 1e299 and (rate >= 1.0 or math.log(limit / change) < WORTH * math.log(rate)):
            fresh[1] = 1.0
        if before < 1e299 and rate > 0.9:
            careful = 2
        before = change
    fresh[0] = 0.0
    return False


@njit(cache=True, error_model="numpy")
def carry(system, state, mid, t, dt):
    """From the middle to the end of a step."""
    bodies, joints, pairs, loads, gravity, nodes = system
    x, r, v, l, s, vb, u, ub = state
    for n in range(nodes.size):
        b = nodes[n]
        m = matmul(exp_rotation((0.5 * dt * u[n, 3], 0.5 * dt * u[n, 4], 0.5 * dt * u[n, 5])), mat(r, b))
        spin = back(m, (u[n, 3], u[n, 4], u[n, 5]))
        j = bodies[b].inertia
        p = rotate(m, (j[0] * spin[0], j[1] * spin[1], j[2] * spin[2]))
        m = matmul(exp_rotation((dt * u[n, 3], dt * u[n, 4], dt * u[n, 5])), mat(r, b))
        for i in range(9):
            r[b, i] = m[i]
        for i in range(3):
            x[b, i] += dt * u[n, i]
            v[n, i] = 2.0 * u[n, i] - v[n, i]
            l[n, i] = 2.0 * p[i] - l[n, i]
    for k in range(bodies.size - 1):
        slide, spin_at = bodies[k].slide, bodies[k].spin
        if slide >= 0:
            s[slide] += dt * ub[slide]
            for i in range(3):
                x[k, i] += dt * ub[slide] * bodies[k].way[i]
            vb[slide] = 2.0 * ub[slide] - vb[slide]
        if spin_at >= 0:
            vb[spin_at] = 2.0 * ub[spin_at] - vb[spin_at]


@njit(cache=True, error_model="numpy")
def _watch(bodies, pairs, mid, count, t, dt, kept):
    """Adds what contacts did in a step to `kept`; returns the pair that is more than half of a plate's
    thickness deep, or -1.

    kept: per row of the contacts (rows, 9) greatest depth, greatest force, sums over time of depth and force,
    time in contact, force and depth now, whether it acts, when it last ended to; and marks of pairs.
    """
    xm, rm, um, wm, f, touched, outs, totals, near = mid
    rows, marks = kept
    deep = -1
    for row in range(rows.shape[0]):
        rows[row, 5] = rows[row, 6] = 0.0
    for k in range(count):
        pair = pairs[touched[k]]
        marks[touched[k]] = True
        rows[pair.row, 5] += outs[k, 12]
        rows[pair.row, 6] = max(rows[pair.row, 6], outs[k, 15])
        if pair.kind == BOX_PLANE and outs[k, 15] > bodies[pair.b].half[2]:
            deep = touched[k]
    for row in range(rows.shape[0]):
        force, depth = rows[row, 5], rows[row, 6]
        acts = force > GRAZE * max(rows[row, 1], force)
        if rows[row, 7] != 0.0 and not acts:
            rows[row, 8] = t + dt
        rows[row, 7] = 1.0 if acts else 0.0
        if force > 0.0:
            rows[row, 0] = max(rows[row, 0], depth)
            rows[row, 1] = max(rows[row, 1], force)
            rows[row, 2] += dt * depth
            rows[row, 3] += dt * force
            rows[row, 4] += dt
    return deep


@njit(cache=True, error_model="numpy")
def _outside(x, low, high):
    """A body that has left its bounds, or -1."""
    for b in range(low.shape[0]):
        for i in range(3):
            if x[b, i] < low[b, i] or x[b, i] > high[b, i]:
                return b
    return -1


@njit(cache=True, error_model="numpy")
def run(
    system, state, mid, matrix, kept, bounds, t, steps, tolerance, smallest, fresh, counters, work, before
):
    """Takes the steps `steps` (n,) [ms] from time t. Returns (status, time reached).

    A step that does not converge is halved, down to `smallest`. `work` (3,) adds up what was dissipated, what
    drives and loads put in, and how much they moved either way [N mm]. counters[WORST] names the body or pair
    of a failure. `before` holds the velocities of the step before and its size, for a guess.
    """
    bodies, joints, pairs, loads, gravity, nodes = system
    x, r, v, l, s, vb, u, ub = state
    keep_u, keep_b = u.copy(), ub.copy()
    last_u, last_b, last_dt = before[0], before[1], before[2][0]
    for k in range(steps.size):
        left, dt = steps[k], steps[k]
        while left > 1e-12 * steps[k]:
            dt = min(dt, left)
            if left - dt < 1e-9 * steps[k]:
                dt = left
            keep_u[:], keep_b[:] = u, ub
            if last_dt > 0.0:
                ahead = 0.5 * (dt + last_dt) / last_dt
                for n in range(u.shape[0]):
                    for i in range(6):
                        u[n, i] += ahead * (u[n, i] - last_u[n, i])
                for i in range(ub.size):
                    ub[i] += ahead * (ub[i] - last_b[i])
            if not midpoint(system, state, mid, matrix, t, dt, tolerance, fresh, counters):
                u[:], ub[:] = keep_u, keep_b
                fresh[0] = last_dt = before[2][0] = 0.0
                dt *= 0.5
                counters[HALVED] += 1
                if dt < smallest:
                    return STOPPED, t
                continue
            last_u[:], last_b[:] = keep_u, keep_b
            last_dt = before[2][0] = dt
            totals = mid[7]
            driving = 0.0
            f = mid[4]
            for b in range(bodies.size - 1):
                if bodies[b].spin < 0 and bodies[b].drive[0] != 0.0:
                    rate = driven(bodies[b], t + 0.5 * dt)
                    axis = bodies[b].axis
                    driving -= rate * (f[b, 3] * axis[0] + f[b, 4] * axis[1] + f[b, 5] * axis[2])
                if bodies[b].slide >= 0:
                    totals[0] += bodies[b].press[1] * ub[bodies[b].slide] ** 2
            driving += totals[1]
            work[0] += dt * totals[0]
            work[1] += dt * driving
            work[2] += dt * abs(driving)
            deep = _watch(bodies, pairs, mid, int(counters[TOUCHING]), t, dt, kept)
            carry(system, state, mid, t, dt)
            counters[STEPS] += 1
            t += dt
            left -= dt
            outside = _outside(x, bounds[0], bounds[1])
            if deep >= 0 or outside >= 0:
                counters[WORST] = outside if outside >= 0 else deep
                return (LEFT if outside >= 0 else DEEP), t
    return DONE, t


def empty(system, wide: int):
    """State, middle and matrix of a System, all zero: (state, mid, matrix)."""
    bodies, nodes, border = len(system.bodies), len(system.nodes), system.border
    state = (
        np.zeros((bodies, 3)),
        np.zeros((bodies, 9)),
        np.zeros((nodes, 3)),
        np.zeros((nodes, 3)),
        np.zeros(border),
        np.zeros(border),
        np.zeros((nodes, 6)),
        np.zeros(border),
    )
    mid = (
        np.zeros((bodies, 3)),
        np.zeros((bodies, 9)),
        np.zeros((bodies, 3)),
        np.zeros((bodies, 3)),
        np.zeros((bodies, 6)),
        np.zeros(len(system.pairs), np.int64),
        np.zeros((max(1, len(system.pairs)), wide)),
        np.zeros(2),
        np.zeros(len(system.pairs), np.int64),
    )
    matrix = (
        np.zeros((nodes, 6, 6 * (system.reach + 1))),
        np.zeros((border, 6 * nodes)),
        np.zeros((border, border)),
        np.zeros((border, 6 * nodes)),
        np.zeros((border, border)),
        np.zeros(6 * nodes),
        np.zeros(border),
        np.zeros((4, 3)),
        np.zeros(4, np.int64),
    )
    return state, mid, matrix
