"""One step of the implicit midpoint rule.

With h half of the step, the velocities u at its middle solve m (u - v0) = h f and J w - l0 = h t, with
forces at the middle: positions x0 + h u, rotations exp(h w) R0. Then x1 = x0 + 2 h u, R1 = exp(2 h w) R0,
and velocities and angular momenta are carried to 2 u - v0 and 2 J w - l0. So linear and angular momentum
are conserved to the accuracy of the iteration, whatever the step.

The rule itself damps nothing: what is too fast for a step rings on. So joints are damped by their stiffness
times a part of h that goes with the step, which leaves the rule of second order. That is numerical damping,
and what it takes is counted apart. A joint that has a damping time of its own needs that much less of it.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.lattice.kernels.alone import (
    APART,
    INSIDE,
    PLANES,
    choose,
    columns,
    forget,
    release,
    unsee,
)
from mdlgen.backends.lattice.kernels.band import empty as no_band
from mdlgen.backends.lattice.kernels.band import factor, solve
from mdlgen.backends.lattice.kernels.border import eliminate
from mdlgen.backends.lattice.kernels.coupled import couplings, couplings_in_box_axes, solve_coupled
from mdlgen.backends.lattice.kernels.dense import copy
from mdlgen.backends.lattice.kernels.forces import (
    clutch_torques,
    joint_forces,
    near_pairs,
    other_forces,
    pair_forces,
    pair_forces_again,
    place,
    turn_roller,
)
from mdlgen.backends.lattice.kernels.image import reflect
from mdlgen.backends.lattice.kernels.momentum import keep
from mdlgen.backends.lattice.kernels.sides import crossed, part_of_change
from mdlgen.backends.lattice.kernels.tangent import (
    contacts_into,
    in_box_axes,
    joints_into,
    masses,
    rollers_into,
)
from mdlgen.backends.lattice.kernels.touching import settle
from mdlgen.backends.lattice.kernels.two_sets import deal
from mdlgen.mechanics.arm import moved, torque_of, turn_of, way_of
from mdlgen.mechanics.driven import clutch, prescribed
from mdlgen.mechanics.vector import back, dot, exp_rotation, mat, matmul, rotate, three, vec
from mdlgen.program.kernel import BORROWS, njit

# Rounds of one step before it is given up.
MOST_ROUNDS = 40
FAR = 0.05  # mm: pairs that are closer than this, and what moves in a step, are looked at in it
# A new factor, and columns for each box that touches, cost as much as this many rounds: it is made where more
# of them are still to come at the rate of the last two.
WORTH = 3.0
FREE = 1e-5
# The boxes that touch are settled to this many times the step's own limit in a round.
ROUGH = 100.0
# Damping of joints, as a part of h for 1 ms of a step, and at most.
DAMPED, MOST_DAMPED = 1.0, 0.3
# How much of the chord a factor takes (see slopes.core): little converges fast, much does not cross to the
# other side of what is flat; the latter is taken twice where a round moved more than the one before.
LITTLE, MUCH = 0.05, 0.7
# Counters of a run.
STEPS, ROUNDS, FACTORS, TOUCHING, WORST, STRAIN, THROUGH, CLOSE, COUNTERS = 0, 1, 2, 3, 4, 5, 6, 7, 8


@njit(cache=True, error_model="numpy", **BORROWS)
def _residual(bodies, nodes, gravity, t, h, u, ub, v, l, vb, s, xm, rm, f, res, resb):
    """Residual of the step's equations into res (6 nodes,) and resb (border,); t is in the middle."""
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
            along = dot(vec(f, k), way_of(bodies[k], vec(xm, k)))
            if bodies[k].swings > 0:
                along += dot((f[k, 3], f[k, 4], f[k, 5]), turn_of(bodies[k]))
                along += torque_of(bodies[k], s[slide] + h * ub[slide], three(gravity), t, h)
            spring = p[2] - p[0] * (s[slide] + h * ub[slide]) - p[1] * ub[slide]
            resb[slide] = p[3] * (ub[slide] - vb[slide]) - h * (along + spring)
        if spin_at >= 0:
            axis = bodies[k].axis
            about = f[k, 3] * axis[0] + f[k, 4] * axis[1] + f[k, 5] * axis[2]
            resb[spin_at] = p[4] * (ub[spin_at] - vb[spin_at]) - h * about


@njit(cache=True, error_model="numpy", **BORROWS)
def _weights(bodies, gravity, f):
    """Weight of what slides, and of rollers on arms, on top of the forces on them."""
    for k in range(bodies.size - 1):
        if bodies[k].slide >= 0:
            mass = bodies[k].press[3] if bodies[k].swings == 0 else bodies[k].mass
            for i in range(3):
                f[k, i] += mass * gravity[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def _turn(nodes, r, res, inward):
    """Turns a vector of the nodes into box axes, or back."""
    for n in range(nodes.size):
        m = mat(r, nodes[n])
        for k in range(6 * n, 6 * n + 6, 3):
            part = (res[k], res[k + 1], res[k + 2])
            part = back(m, part) if inward else rotate(m, part)
            res[k], res[k + 1], res[k + 2] = part


@njit(cache=True, error_model="numpy")
def midpoint(system, state, mid, matrix, alone, free, t, dt, tolerance, fresh, counters):
    """Solves for the velocities at the middle of a step. Returns whether it converged.

    `fresh` (3,): the step that the factor was made for (0: none), whether it should be made anew, and where
    contacts stand (see alone.APART). counters[THROUGH] is the pair of two sheets that a step would take
    through each other, or -1; counters[CLOSE] is how many pairs are near.
    """
    bodies, joints, pairs, loads, gravity, nodes, points, images, meshes = system
    x, r, v, l, s, vb, u, ub = state
    xm, rm, um, wm, f, touched, outs, totals, near = mid
    a, b, d, y, corner, res, resb, direction, index, couplings = matrix
    most = alone.chosen.size
    h = 0.5 * dt
    lag = min(DAMPED * dt, MOST_DAMPED) * h
    before = 1e300
    careful = 0
    counters[THROUGH] = -1.0
    close, where, m = 0, int(fresh[2]), 0
    margin, moved = FAR, 0.0
    for rounds in range(MOST_ROUNDS):
        place(bodies, nodes, images, h, t + h, u, ub, x, r, xm, rm, um, wm)
        if rounds == 0 or margin < dt * moved:
            # what the guess did not know of may move further than it said
            margin = FAR + 2.0 * dt * moved
            close = near_pairs(bodies, pairs, meshes, x, r, um, wm, margin, dt, near)
            unsee(alone)
        f[:] = 0.0
        _stored, lost, numerical = joint_forces(joints, points, xm, rm, um, wm, f, lag)
        if rounds > 0 and where == APART and alone.state[1] == 1:
            again = (alone.touched, alone.outs, alone.state[0], alone.seen)
            count, _pressed, rubbed = pair_forces_again(
                bodies, pairs, meshes, near, close, again, xm, rm, um, wm, f, touched, outs
            )
        else:
            count, _pressed, rubbed = pair_forces(
                bodies, pairs, meshes, near, close, xm, rm, um, wm, f, touched, outs
            )
        power = other_forces(bodies, loads, gravity, 1.0, rm, um, wm, f)
        _weights(bodies, gravity, f)
        clutch_torques(bodies, t + h, ub, f)
        _residual(bodies, nodes, gravity, t + h, h, u, ub, v, l, vb, s, xm, rm, f, res, resb)
        if rounds == 0:
            for fewer in range(where):
                m = choose(bodies, pairs, touched, count, fewer, alone, 0, most // 2)
                if m >= 0:
                    where = fewer
                    break
                m = 0
        m = choose(bodies, pairs, touched, count, where, alone, m, most)
        while m < 0:
            where += 1
            m = choose(bodies, pairs, touched, count, where, alone, 0, most)
        if fresh[0] != dt or fresh[1] != 0.0 or fresh[2] != where:
            counters[FACTORS] += 1
            masses(bodies, nodes, rm, a)
            joints_into(bodies, joints, points, images, h, lag, xm, rm, a)
            rollers_into(bodies, h, t + h, ub, b, d)
            if where != APART:
                chord = MUCH if careful > 0 else LITTLE
                careful -= 1
                planes = where == PLANES
                room = (direction, index, couplings)
                contacts_into(bodies, pairs, h, xm, touched, outs, count, chord, planes, a, b, d, *room)
                couplings_in_box_axes(nodes, rm, couplings)
            in_box_axes(nodes, rm, a, b)
            forget(alone)
            if not factor(a) or (where == INSIDE and not eliminate(a, b, d, y, corner)):
                fresh[0] = 0.0
                release(alone, m)
                return False
            if where == INSIDE:
                deal(couplings.sets, couplings.ends, couplings.many[0], b, d, y)
            fresh[0], fresh[1], fresh[2] = dt, 0.0, where
        counters[ROUNDS] += 1
        # what is free converges fast, and keeps its angular momentum as well as the rounds end
        limit = tolerance if count > 0 else FREE * tolerance
        copy(free[3], res)
        # the axes of the boxes as they stand now: half a step before, what is stiff in a box points elsewhere
        copy(alone.axes, rm)
        _turn(nodes, alone.axes, res, True)
        if where == INSIDE:
            solve_coupled(a, b, y, corner, couplings, res, resb)
        else:
            solve(a, res)
            columns(a, alone, m)
            places, moving = (x, r, u, ub), (xm, rm, um, wm)
            known, rest = (touched, outs, count), (res, resb)
            limits = (ROUGH * limit, 0.3 * limit)
            if not settle(
                system, alone, m, where, h, t + h, places, moving, near[:close], known, rest, limits
            ):
                fresh[0] = 0.0
                release(alone, m)
                return False
        _turn(nodes, alone.axes, res, False)
        keep(bodies, pairs, nodes, touched, count, free, xm, rm, res)
        change, part = 0.0, part_of_change(bodies, pairs, near, close, rm, h, res)
        if part < 1.0:
            res *= part
            resb *= part
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
        for k in range(bodies.size - 1):
            if bodies[k].swings > 0:
                way = way_of(bodies[k], vec(xm, k))
                change = max(change, math.sqrt(dot(way, way)) * abs(resb[bodies[k].slide]))
        if not change < 1e30:
            fresh[0] = 0.0
            release(alone, m)
            return False
        rate = change / before
        falls = before < 1e299 and rate < 0.5
        moved += change
        if dt * moved <= margin and (change <= limit or (falls and change * rate / (1.0 - rate) <= limit)):
            # forces change much with what the last round changed: friction, over its smoothing speed
            place(bodies, nodes, images, h, t + h, u, ub, x, r, xm, rm, um, wm)
            f[:] = 0.0
            count, _pressed, rubbed = pair_forces(
                bodies, pairs, meshes, near, close, xm, rm, um, wm, f, touched, outs
            )
            totals[0], totals[1], totals[2] = lost + rubbed, power, numerical
            counters[TOUCHING], counters[CLOSE] = count, close
            release(alone, m)
            counters[THROUGH] = crossed(bodies, pairs, near, close, x, r, xm, rm)
            return counters[THROUGH] < 0.0
        if before < 1e299 and (rate >= 1.0 or math.log(limit / change) < (WORTH + m) * math.log(rate)):
            fresh[1] = 1.0
        if before < 1e299 and rate > 0.9:
            careful = 2
        before = change
    fresh[0] = 0.0
    release(alone, m)
    return False


@njit(cache=True, error_model="numpy", **BORROWS)
def spun(body, u, v, t, dt):
    """Spin of a roller at the end of a step from t, from those at its middle and its beginning: 2 u - v, but
    for a clutch that is stiff for the step.

    The rule would let it ring about what it takes. What a step adds against the shaft is left out there, in
    the measure of how much stiffer than the roller's inertia the clutch is.
    """
    h = 0.5 * dt
    stiff = h * clutch(body, u, t + h)[1] / body.press[4]
    if stiff == 0.0:
        return 2.0 * u - v
    added = u - prescribed(body, t + h) - v + prescribed(body, t)
    return 2.0 * u - v - added * stiff * stiff / (1.0 + stiff * stiff)


@njit(cache=True, error_model="numpy", **BORROWS)
def carry(system, state, mid, t, dt):
    """From the middle to the end of a step."""
    bodies, joints, pairs, loads, gravity, nodes, points, images, meshes = system
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
    reflect(images, x, r)
    for k in range(bodies.size - 1):
        slide, spin_at = bodies[k].slide, bodies[k].spin
        if bodies[k].rims > 0 or bodies[k].carries != 0:
            turning = ub[spin_at] if spin_at >= 0 else ub[slide] if bodies[k].swings == 2 else 0.0
            turn_roller(bodies[k], k, dt, t + dt, turning, r, r)
        if slide >= 0:
            s[slide] += dt * ub[slide]
            at = moved(bodies[k], vec(x, k), dt * ub[slide])
            for i in range(3):
                x[k, i] = at[i]
            vb[slide] = 2.0 * ub[slide] - vb[slide]
        if spin_at >= 0:
            vb[spin_at] = spun(bodies[k], ub[spin_at], vb[spin_at], t, dt)


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
        np.zeros(3),
        np.zeros(len(system.pairs), np.int64),
    )
    matrix = (
        no_band(nodes, system.reach),
        np.zeros((border, 6 * nodes)),
        np.zeros((border, border)),
        np.zeros((border, 6 * nodes)),
        np.zeros((border, border)),
        np.zeros(6 * nodes),
        np.zeros(border),
        np.zeros((4, 3)),
        np.zeros(4, np.int64),
        couplings(len(system.pairs) - system.search.first, system.sheets, border),
    )
    return state, mid, matrix
