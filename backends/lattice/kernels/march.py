"""Many steps: their size, what they cost in energy, and what contacts do in them."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.lattice.kernels.damped import overshoot, take_off
from mdlgen.backends.lattice.kernels.dense import copy
from mdlgen.backends.lattice.kernels.search import look, strayed
from mdlgen.backends.lattice.kernels.step import (
    CLOSE,
    ROUNDS,
    STEPS,
    STRAIN,
    TOUCHING,
    WORST,
    carry,
    midpoint,
    spun,
)
from mdlgen.backends.lattice.kernels.swept import swept
from mdlgen.mechanics.arm import speeding
from mdlgen.mechanics.crossing import deepest
from mdlgen.mechanics.curve import overstretched
from mdlgen.mechanics.driven import clutch, prescribed
from mdlgen.mechanics.pair import remember
from mdlgen.program.kernel import BORROWS, njit

DONE, STOPPED, LEFT, DEEP, STRETCHED, CROWDED = 0, 1, 2, 3, 4, 5
# How often a step may be halved.
DEEPEST = 14
# How often at most for accuracy, and how much more than wanted a step may miss before it is taken again.
FINEST, AGAIN = 12, 4.0
# Steps that take more rounds than the one are halved, and doubled again where they take less than the other.
HARD, EASY = 8, 5
# What a round changes is not asked to be less than this part of the speed: it is near round-off.
LEAST = 1e-9
# Two rollers with a sheet between them clear each other by a few micrometres and may graze: a force below
# this part of the greatest is not counted as the nip still acting.
GRAZE = 0.05


@njit(cache=True, error_model="numpy", **BORROWS)
def _deep(bodies, pairs, mid, count):
    """The pair that is deeper than it may be in the middle of a step, or -1."""
    touched, outs = mid[5], mid[6]
    for k in range(count):
        if outs[k, 15] > deepest(bodies, pairs[touched[k]]):
            return touched[k]
    return -1


@njit(cache=True, error_model="numpy", **BORROWS)
def _watch(pairs, mid, count, t, dt, kept):
    """Adds what contacts did in a step to `kept`.

    kept: per row of the contacts (rows, 10) greatest depth, greatest force, sums over time of depth and
    force, time in contact, force and depth now, whether it acts, when it last ended to, force where the first
    step of a run began; and marks of pairs.
    """
    xm, rm, um, wm, f, touched, outs, totals, near = mid
    rows, marks = kept
    for row in range(rows.shape[0]):
        rows[row, 5] = rows[row, 6] = 0.0
    for k in range(count):
        pair = pairs[touched[k]]
        marks[pair.mark] = True
        rows[pair.row, 5] += outs[k, 12]
        rows[pair.row, 6] = max(rows[pair.row, 6], outs[k, 15])
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


@njit(cache=True, error_model="numpy", **BORROWS)
def _begun(rows, part):
    """The force of each row of the contacts where a step begins, a `part` of the way from the middle of the
    step before, whose force stands in the last column, to that of this step."""
    for row in range(rows.shape[0]):
        rows[row, 9] += part * (rows[row, 5] - rows[row, 9])


@njit(cache=True, error_model="numpy", **BORROWS)
def _outside(x, low, high):
    """A body that has left its bounds, or -1."""
    for b in range(low.shape[0]):
        for i in range(3):
            if x[b, i] < low[b, i] or x[b, i] > high[b, i]:
                return b
    return -1


@njit(cache=True, error_model="numpy")
def _missed(bodies, nodes, u, guess):
    """Root mean square over the boxes of what the velocities of a step turned out to be against their guess,
    and of the velocities themselves."""
    missed = fast = mass = 0.0
    for n in range(nodes.size):
        own = bodies[nodes[n]].mass
        mass += own
        for i in range(3):
            missed += own * (u[n, i] - guess[n, i]) ** 2
            fast += own * u[n, i] ** 2
    return (math.sqrt(missed / mass), math.sqrt(fast / mass)) if mass > 0.0 else (0.0, 0.0)


@njit(cache=True, error_model="numpy", **BORROWS)
def _account(system, mid, ub, vb, t, dt, work):
    """Adds what a step dissipated, what drives and loads put in, how much that moved either way, and what
    the numerical damping of joints had of what was dissipated."""
    bodies = system[0]
    totals, f = mid[7], mid[4]
    lost, driving = totals[0], totals[1]
    for b in range(bodies.size - 1):
        if bodies[b].clutch[0] != 0.0:
            spin, before = ub[bodies[b].spin], vb[bodies[b].spin]
            torque, _, shaft = clutch(bodies[b], spin, t + 0.5 * dt)
            lost += torque * (shaft - spin)
            driving += torque * shaft
            ahead, after = 2.0 * spin - before, spun(bodies[b], spin, before, t, dt)
            lost += 0.5 * bodies[b].press[4] * (ahead * ahead - after * after) / dt
        elif bodies[b].corners > 0:
            rate = prescribed(bodies[b], t + 0.5 * dt)
            axis = bodies[b].axis
            driving -= rate * (f[b, 3] * axis[0] + f[b, 4] * axis[1] + f[b, 5] * axis[2])
            if bodies[b].swings == 2:
                driving -= speeding(bodies[b], t + 0.5 * dt, 0.5 * dt) * ub[bodies[b].slide]
        if bodies[b].slide >= 0:
            lost += bodies[b].press[1] * ub[bodies[b].slide] ** 2
    work[0] += dt * lost
    work[1] += dt * driving
    work[2] += dt * abs(driving)
    work[3] += dt * totals[2]


@njit(cache=True, error_model="numpy", nogil=True)
def run(
    system,
    state,
    mid,
    matrix,
    alone,
    free,
    kept,
    bounds,
    search,
    damped,
    t,
    steps,
    tolerance,
    fresh,
    counters,
    work,
    before,
    pace,
):
    """Takes the steps `steps` (n,) [ms] from time t. Returns (status, time reached).

    A step is halved, up to DEEPEST times, where it does not converge, or where the velocities miss their
    guess by more than pace[1] (0: any will do); pace[0] is how often it is halved now. With pace[2] each step
    has a factor of its own. `tolerance` and pace[1] are parts of pace[3], the greatest speed so far [mm/ms].
    Nor may contacts make or lose more in one step than pace[4] (0: any) of the energy that passes through the
    run: the kinetic energy at that speed, what drives moved either way, what was dissipated.

    `work` (4,) adds up energies [N mm]. counters[WORST] names the body, pair or joint of a failure, and
    counters[STRAIN] the strain of a joint beyond its curve. `before` holds
    what a guess is made from: the velocities of the step before the last, the size of the last step, and the
    time from the middle of the one to the middle of the other (0: there is none).
    """
    bodies, joints, pairs, loads, gravity, nodes, points, images, meshes = system
    x, r, v, l, s, vb, u, ub = state
    keep_u, keep_b, guess = u.copy(), ub.copy(), u.copy()
    last_u, last_b, spans = before
    mass, rows, begun = 0.0, np.zeros(kept[0].shape[0]), t
    for row in range(rows.size):
        kept[0][row, 9] = kept[0][row, 5]
    for n in range(nodes.size):
        mass += bodies[nodes[n]].mass
    for whole in steps:
        done = 0
        while done < 1 << DEEPEST:
            level = int(pace[0])
            size = 1 << (DEEPEST - level)
            dt = whole / (1 << level)
            copy(keep_u, u)
            copy(keep_b, ub)
            if spans[1] > 0.0:
                ahead = 0.5 * (dt + spans[0]) / spans[1]
                for n in range(u.shape[0]):
                    for i in range(6):
                        u[n, i] += ahead * (u[n, i] - last_u[n, i])
                for i in range(ub.size):
                    ub[i] += ahead * (ub[i] - last_b[i])
            copy(guess, u)
            if pace[2] != 0.0:
                fresh[1] = 1.0
            if search.regions.size > 0 and strayed(bodies, search, x, u, dt) and not look(pairs, search, x):
                return CROWDED, t
            rounds = counters[ROUNDS]
            # a halved step's guess is the better, and what it may leave must fall as fast; where sheets lie
            # on each other rounds do not come as far
            least = LEAST if search.regions.size == 0 else tolerance
            limit = pace[3] * max(tolerance * 0.25**level, least)
            solved = midpoint(system, state, mid, matrix, alone, free, t, dt, limit, fresh, counters)
            missed, fast = _missed(bodies, nodes, u, guess) if solved else (0.0, 0.0)
            most = pace[1] * max(fast, pace[3]) if pace[1] > 0.0 else 1e300
            if solved and search.regions.size > 0:
                solved = not strayed(bodies, search, x, u, dt)
            deep = _deep(bodies, pairs, mid, int(counters[TOUCHING])) if solved else -1
            through = max(work[2], abs(work[0]), 0.5 * mass * max(fast, pace[3]) ** 2)
            made, allowed = 0.0, pace[4] * through
            if solved and deep < 0:
                counts = int(counters[TOUCHING]), int(counters[CLOSE])
                # of the way from the middle of the step before, what is in this step
                inside = dt / (dt + spans[0]) if spans[0] > 0.0 else 0.0
                slower = keep_u, keep_b, inside
                deep, made = swept(system, state, mid, counts, t, dt, allowed, slower, kept[0][:, 5], rows)
            coarse = missed > AGAIN * most or made > AGAIN * allowed
            if not solved or ((coarse or deep >= 0) and level < FINEST):
                copy(u, keep_u)
                copy(ub, keep_b)
                if level == DEEPEST:
                    return STOPPED, t
                # what is made of energy goes with the step to the power of 5/2, or 3
                halvings = math.ceil(math.log2(made / allowed) / 2.5) if made > AGAIN * allowed else 1
                pace[0] = min(level + max(1, halvings), DEEPEST if level >= FINEST else FINEST)
                if not solved:
                    spans[1] = 0.0
                continue
            if damped[0].size > 0:
                course = dt / (dt + spans[0]) if spans[0] > 0.0 else 0.0
                overshoot(system, damped, state, mid, free, keep_u, course, dt)
            copy(last_u, keep_u)
            copy(last_b, keep_b)
            _account(system, mid, ub, vb, t, dt, work)
            _watch(pairs, mid, int(counters[TOUCHING]), t, dt, kept)
            if t == begun:
                _begun(kept[0], spans[0] / (spans[0] + dt))
            # between the middles of the two steps
            spans[1] = 0.5 * (spans[0] + dt)
            spans[0] = dt
            carry(system, state, mid, t, dt)
            if damped[0].size > 0:
                work[0] += take_off(bodies, nodes, damped[3], mid[1], r, v, l)
            remember(bodies, pairs, x, r)
            counters[STEPS] += 1
            done += size
            pace[3] = max(pace[3], fast)
            t += dt
            rounds = counters[ROUNDS] - rounds
            quiet = missed <= most / 6.0 and made <= allowed / 10.0
            if (missed > most or made > allowed or rounds > HARD) and level < FINEST:
                pace[0] = level + 1
            elif level > 0 and quiet and rounds < EASY and done % (2 * size) == 0:
                pace[0] = level - 1
            outside = _outside(x, bounds[0], bounds[1])
            if deep >= 0 or outside >= 0:
                counters[WORST] = outside if outside >= 0 else deep
                return (LEFT if outside >= 0 else DEEP), t
            if points.size > 0:
                stretched, strain = overstretched(points, joints, x, r)
                if stretched >= 0:
                    counters[WORST], counters[STRAIN] = stretched, strain
                    return STRETCHED, t
    return DONE, t
