"""Many steps: their size, what they cost in energy, and what contacts do in them."""

from __future__ import annotations

import math

from numba import njit

from backends.lattice.forces import driven
from backends.lattice.step import HALVED, ROUNDS, STEPS, TOUCHING, WORST, carry, midpoint
from mdlgen.mechanics.pair import BOX_PLANE

DONE, STOPPED, LEFT, DEEP = 0, 1, 2, 3
# How often a step may be halved.
DEEPEST = 14
# How often at most for accuracy, and how much more than wanted a step may miss before it is taken again.
FINEST, AGAIN = 7, 4.0
# Steps that take more rounds than the one are halved, and doubled again where they take less than the other.
HARD, EASY = 8, 5
# Two rollers with a sheet between them clear each other by a few micrometres and may graze: a force below
# this part of the greatest is not counted as the nip still acting.
GRAZE = 0.05


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
def _missed(bodies, nodes, u, guess):
    """Root mean square of what the velocities of a step turned out to be against their guess."""
    total = mass = 0.0
    for n in range(nodes.size):
        own = bodies[nodes[n]].mass
        mass += own
        for i in range(3):
            total += own * (u[n, i] - guess[n, i]) ** 2
    return math.sqrt(total / mass) if mass > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def _account(system, mid, ub, t, dt, work):
    """Adds what a step dissipated, what drives and loads put in, and how much that moved either way."""
    bodies = system[0]
    totals, f = mid[7], mid[4]
    lost, driving = totals[0], totals[1]
    for b in range(bodies.size - 1):
        if bodies[b].spin < 0 and bodies[b].drive[0] != 0.0:
            rate = driven(bodies[b], t + 0.5 * dt)
            axis = bodies[b].axis
            driving -= rate * (f[b, 3] * axis[0] + f[b, 4] * axis[1] + f[b, 5] * axis[2])
        if bodies[b].slide >= 0:
            lost += bodies[b].press[1] * ub[bodies[b].slide] ** 2
    work[0] += dt * lost
    work[1] += dt * driving
    work[2] += dt * abs(driving)


@njit(cache=True, error_model="numpy")
def run(
    system, state, mid, matrix, alone, kept, bounds, t, steps, tolerance, fresh, counters, work, before, pace
):
    """Takes the steps `steps` (n,) [ms] from time t. Returns (status, time reached).

    A step is halved, up to DEEPEST times, where it does not converge, or where the velocities miss their
    guess by more than pace[1] [mm/ms] (0: any will do); pace[0] is how often it is halved now. With
    pace[2] each step has a factor of its own. `work` (3,)
    adds up energies [N mm]. counters[WORST] names the body or pair of a failure. `before` holds the
    velocities of the step before and its size, for a guess.
    """
    bodies, joints, pairs, loads, gravity, nodes = system
    x, r, v, l, s, vb, u, ub = state
    keep_u, keep_b, guess = u.copy(), ub.copy(), u.copy()
    last_u, last_b, last_dt = before[0], before[1], before[2][0]
    for whole in steps:
        done = 0
        while done < 1 << DEEPEST:
            level = int(pace[0])
            size = 1 << (DEEPEST - level)
            dt = whole / (1 << level)
            keep_u[:], keep_b[:] = u, ub
            if last_dt > 0.0:
                ahead = 0.5 * (dt + last_dt) / last_dt
                for n in range(u.shape[0]):
                    for i in range(6):
                        u[n, i] += ahead * (u[n, i] - last_u[n, i])
                for i in range(ub.size):
                    ub[i] += ahead * (ub[i] - last_b[i])
            guess[:] = u
            if pace[2] != 0.0:
                fresh[1] = 1.0
            rounds = counters[ROUNDS]
            solved = midpoint(system, state, mid, matrix, alone, t, dt, tolerance, fresh, counters)
            missed = _missed(bodies, nodes, u, guess) if solved and pace[1] > 0.0 else 0.0
            if not solved or (missed > AGAIN * pace[1] and level < FINEST):
                u[:], ub[:] = keep_u, keep_b
                counters[HALVED] += 1
                if level == DEEPEST:
                    return STOPPED, t
                pace[0] = level + 1
                if not solved:
                    last_dt = 0.0
                continue
            last_u[:], last_b[:] = keep_u, keep_b
            last_dt = before[2][0] = dt
            _account(system, mid, ub, t, dt, work)
            deep = _watch(bodies, pairs, mid, int(counters[TOUCHING]), t, dt, kept)
            carry(system, state, mid, t, dt)
            counters[STEPS] += 1
            done += size
            t += dt
            rounds = counters[ROUNDS] - rounds
            if (missed > pace[1] or rounds > HARD) and level < FINEST:
                pace[0] = level + 1
            elif level > 0 and missed <= pace[1] / 6.0 and rounds < EASY and done % (2 * size) == 0:
                pace[0] = level - 1
            outside = _outside(x, bounds[0], bounds[1])
            if deep >= 0 or outside >= 0:
                counters[WORST] = outside if outside >= 0 else deep
                return (LEFT if outside >= 0 else DEEP), t
    return DONE, t
