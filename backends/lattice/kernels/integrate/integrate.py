"""Integration over many steps: their size, their energy balance, and the history of contacts."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.contact.between import faces_into, forget_overlaps
from mdlgen.backends.lattice.kernels.contact.bristles import end_patches
from mdlgen.backends.lattice.kernels.contact.drift import add_step, list_anew
from mdlgen.backends.lattice.kernels.contact.search import look, mark_of, strayed
from mdlgen.backends.lattice.kernels.contact.sticking import end_of_step, put_back, set_aside
from mdlgen.backends.lattice.kernels.contact.swept import Before, swept
from mdlgen.backends.lattice.kernels.integrate.account import account
from mdlgen.backends.lattice.kernels.integrate.air import air_overshoot
from mdlgen.backends.lattice.kernels.integrate.carry import carry
from mdlgen.backends.lattice.kernels.integrate.damped import overshoot, take_off
from mdlgen.backends.lattice.kernels.integrate.guess import add_to_history, forget, guess_velocities
from mdlgen.backends.lattice.kernels.integrate.hinges import end_hinges
from mdlgen.backends.lattice.kernels.integrate.islands import (
    be_strict,
    greatest_scale,
    made_too_much,
    may_make,
    measure,
    missed_guess,
    round_off,
)
from mdlgen.backends.lattice.kernels.integrate.sleeping import disturbed, miss, note_speeds
from mdlgen.backends.lattice.kernels.integrate.step import midpoint
from mdlgen.backends.lattice.kernels.linear.dense import copy
from mdlgen.backends.lattice.kernels.state import (
    ACTS,
    ANEW,
    CLOSE,
    DEPTH_NOW,
    DEPTH_TIME,
    ENDED,
    FACE_DEPTH,
    FACE_POINTS,
    FASTEST,
    FLOOR,
    FORCE_BEGUN,
    FORCE_NOW,
    FORCE_TIME,
    GIVEN_UP,
    ITERATIONS,
    LAST_STEP,
    LEVEL,
    LOOSE,
    MADE,
    MAX_DEPTH,
    MAX_FORCE,
    MISS,
    OWN_MASS,
    STALE,
    STEPS,
    STRAIN,
    TIME,
    TOUCHING,
    TURNING_BEGUN,
    TURNING_NOW,
    WORST,
)
from mdlgen.backends.lattice.kernels.tuning import (
    EASY,
    EASY_WITH_AIR,
    FINEST,
    GRAZE,
    HALVINGS_MOST,
    HARD,
    HARD_WITH_AIR,
    TAKEN_AGAIN,
)
from mdlgen.mechanics.crossing import deepest
from mdlgen.mechanics.curve import overstretched
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.pair import remember
from mdlgen.mechanics.pairs.box_box import deepest as deepest_of_boxes
from mdlgen.mechanics.point import DEPTH, PRESSING
from mdlgen.mechanics.turning import TURNING, turning
from mdlgen.program.kernel import BORROWS, njit

DONE, STOPPED, LEFT, DEEP, STRETCHED, CROWDED, WOKEN = 0, 1, 2, 3, 4, 5, 6


class Last(NamedTuple):
    """Velocities before a step, which are restored where it is repeated."""

    u: np.ndarray  # (nodes, 6).
    ub: np.ndarray  # (border,).


@njit(cache=True, error_model="numpy", **BORROWS)
def _deep(tables, mid, count):
    """Pair that is too deep in the middle of a step, or -1."""
    pairs, listed = tables.pairs, tables.listed
    first = pairs.size - listed.size
    for k in range(count):
        p = mid.touched[k]
        if p >= first:
            depth = mid.faces[k, FACE_DEPTH]
            if depth <= tables.thinnest:
                continue
            far = deepest_of_boxes(tables.bodies, listed[p - first])
        else:
            far, depth = deepest(tables.bodies, pairs[p]), mid.results[mid.rows[k], DEPTH]
        if depth > far:
            return p
    return -1


@njit(cache=True, error_model="numpy", **BORROWS)
def _watch(tables, search, mid, count, t, dt, kept, asleep):
    """Adds the contacts of a step from t to a Kept; those whose sides both sleep hold their values."""
    rows, marks = kept
    pairs, listed, regions = tables.pairs, search.listed, search.regions
    for row in range(rows.shape[0]):
        if asleep.rows[row]:
            continue
        rows[row, FORCE_NOW] = rows[row, DEPTH_NOW] = 0.0
        for i in range(TURNING):
            rows[row, TURNING_NOW + i] = 0.0
    for k in range(count):
        p = mid.touched[k]
        if p >= search.first and mid.faces[k, FACE_POINTS] == 0.0:
            own = listed[p - search.first]
            marks[mark_of(regions[own.region], own.a, own.b)] = True
            faces_into(rows, regions[own.region].row, mid.faces[k])
            continue
        pair, out = pairs[p], mid.results[mid.rows[k]]
        marks[pair.mark] = True
        rows[pair.row, FORCE_NOW] += out[PRESSING]
        rows[pair.row, DEPTH_NOW] = max(rows[pair.row, DEPTH_NOW], out[DEPTH])
        turning(tables.bodies, pair, out, rows, pair.row, TURNING_NOW)
    for row in range(rows.shape[0]):
        force, depth = rows[row, FORCE_NOW], rows[row, DEPTH_NOW]
        acts = force > GRAZE * max(rows[row, MAX_FORCE], force)
        if rows[row, ACTS] != 0.0 and not acts:
            rows[row, ENDED] = t + dt
        rows[row, ACTS] = 1.0 if acts else 0.0
        if force > 0.0:
            rows[row, MAX_DEPTH] = max(rows[row, MAX_DEPTH], depth)
            rows[row, MAX_FORCE] = max(rows[row, MAX_FORCE], force)
            rows[row, DEPTH_TIME] += dt * depth
            rows[row, FORCE_TIME] += dt * force
            rows[row, TIME] += dt


@njit(cache=True, error_model="numpy", **BORROWS)
def _begun(rows, part):
    """Interpolates each row of the contacts at the beginning of a step, at `part` of the time from the middle
    of the step before to that of this one. The columns BEGUN have the values of the former."""
    for row in range(rows.shape[0]):
        rows[row, FORCE_BEGUN] += part * (rows[row, FORCE_NOW] - rows[row, FORCE_BEGUN])
        for i in range(TURNING):
            begun = rows[row, TURNING_BEGUN + i]
            rows[row, TURNING_BEGUN + i] += part * (rows[row, TURNING_NOW + i] - begun)


@njit(cache=True, error_model="numpy", **BORROWS)
def _outside(x, low, high):
    """A body that has left its bounds, or -1."""
    for b in range(low.shape[0]):
        for i in range(3):
            if x[b, i] < low[b, i] or x[b, i] > high[b, i]:
                return b
    return -1


@njit(cache=True, error_model="numpy", **BORROWS)
def _speed(work, mass):
    """Root mean square speed of all sheets; `mass` includes those that sleep. 0 where there is none."""
    boxes, u, moving = work.tables.boxes, work.state.u, 0.0
    for n in range(boxes.shape[0]):
        moving += boxes[n, OWN_MASS] * (u[n, 0] * u[n, 0] + u[n, 1] * u[n, 1] + u[n, 2] * u[n, 2])
    return math.sqrt(moving / mass) if mass > 0.0 else 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def _mass(work):
    """Mass of all sheets, including those that sleep [g]."""
    bodies, mass = work.tables.bodies, 0.0
    for n in work.tables.nodes:
        mass += bodies[n].mass
    for b in work.asleep.bodies:
        mass += bodies[b].mass
    return mass


@njit(cache=True, error_model="numpy", **BORROWS)
def _share(dt, spans):
    """Part of the time from the middle of the step before to that of this one that lies in this step; 0:
    there is no step before."""
    return dt / (dt + spans[LAST_STEP]) if spans[LAST_STEP] > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def _predict(work, dt, control, last):
    """Guesses the velocities of a step from those of steps before, starting from `last`. Searches for near
    boxes where some may have come near since. Returns False if they exceed the capacity."""
    tables, state, mid, search = work.tables, work.state, work.mid, work.search
    copy(last.u, state.u)
    copy(last.ub, state.ub)
    # where the step is chosen by missed guesses, the error of a line measures how fast velocities change
    guess_velocities(work, control.history, dt, control.pace[MISS] == 0.0)
    if control.pace[ANEW] != 0.0:
        control.factored[STALE] = 1.0
    if search.regions.size == 0 or not strayed(tables.bodies, search, state.x, state.u, dt):
        return True
    forget_overlaps(tables.pairs, mid.overlaps, search.first)
    if mid.sticks.pairs.size > 0:
        set_aside(mid.sticks)
    list_anew(mid.drift)
    if not look(tables.pairs, search, state.x):
        return False
    if mid.sticks.pairs.size > 0:
        put_back(tables.pairs, mid.sticks, search.first, work.islands, control.energies)
    return True


@njit(cache=True, error_model="numpy")
def _solve(work, t, dt, tolerance, control, level):
    """Solves for the velocities of a step after `level` halvings. Returns True if it converged."""
    pace = control.pace
    # the guess of a halved step is better, so its limit must fall as fast; where sheets lie on each other
    # iterations cannot converge as far
    finer = 0.25**level if work.search.regions.size == 0 else 1.0
    greatest, pace[FLOOR] = greatest_scale(work.islands), round_off(work, 0.5 * dt)
    pace[LOOSE] = max(greatest * tolerance * finer, pace[FLOOR])
    be_strict(work.islands, greatest, pace[LOOSE] / pace[FLOOR])
    return midpoint(work, t, dt, pace[LOOSE], control)


@njit(cache=True, error_model="numpy")
def _judge(work, t, dt, control, last, stored, allowed):
    """Checks a step that converged. Returns (pair that is too deep, or -1; energy error of contacts relative
    to the allowed one; True if the step is valid, since boxes are within the range of the last search).
    `stored`, `allowed`: scratch of each contact."""
    tables, counters, most = work.tables, control.counters, control.pace[MADE]
    if work.search.regions.size > 0 and strayed(tables.bodies, work.search, work.state.x, work.state.u, dt):
        return -1, 0.0, False
    deep = _deep(tables, work.mid, int(counters[TOUCHING]))
    if deep >= 0:
        return deep, 0.0, True
    least = may_make(work.islands, most, allowed)
    counts = int(counters[TOUCHING]), int(counters[CLOSE])
    before = Before(last.u, last.ub, _share(dt, control.history.spans))
    deep = swept(work, counts, t, dt, (allowed, least), before, stored)
    return deep, made_too_much(work.islands, stored, allowed) if most > 0.0 else 0.0, True


@njit(cache=True, error_model="numpy")
def _accept(work, t, dt, control, last, first, driven):
    """Carries an accepted step to its end, and adds its energies and contacts. `first`: it is the first one
    of a call of `run`, so contacts at its beginning are stored; `driven`: scratch of each group."""
    tables, state, mid, counters = work.tables, work.state, work.mid, control.counters
    energies, spans, sheets = control.energies, control.history.spans, work.search.regions.size > 0
    touching, close = int(counters[TOUCHING]), int(counters[CLOSE])
    if work.damped.joints.size > 0:
        overshoot(work, last.u, _share(dt, spans), dt)
    if work.film.films.size > 0:
        air_overshoot(work, last.u, _share(dt, spans), dt)
    measure(work, t + 0.5 * dt, touching)
    if work.asleep.speeds.size > 0:
        note_speeds(tables.boxes, work.free.label, state.u, work.asleep)
        miss(mid.forces, work.asleep, dt)
    account(work, t, dt, touching, energies, driven)
    if mid.sticks.pairs.size > 0:
        end_of_step(work, touching, close, energies)
    if tables.held.size > 0:
        end_patches(work, touching, 0.5 * dt, energies)
    if tables.hinges.size > 0:
        end_hinges(work, energies)
    _watch(tables, work.search, mid, touching, t, dt, work.kept, work.asleep)
    if first:
        _begun(work.kept.rows, spans[LAST_STEP] / (spans[LAST_STEP] + dt))
    add_to_history(work, control.history, dt, last.u, last.ub)
    if sheets:
        add_step(work, dt)
    carry(tables, state, t, dt)
    if work.damped.joints.size > 0:
        take_off(work, work.damped.off, energies)
    if work.film.films.size > 0:
        take_off(work, work.film.off, energies)
    motion = Motion(state.x, state.r, mid.motion.u, mid.motion.w)
    remember(tables.bodies, tables.pairs[: work.search.first], tables.shapes, motion)
    counters[STEPS] += 1


@njit(cache=True, error_model="numpy", **BORROWS)
def _next_level(work, level, iterations, missed, made, even):
    """Number of halvings of the next step, from the `iterations` of the last one. `missed`, `made`: its
    missed guess and its energy error, relative to their limits; `even`: the next may be twice as long."""
    hard, easy = (HARD_WITH_AIR, EASY_WITH_AIR) if work.film.many[0] > 0 else (HARD, EASY)
    if (missed > 1.0 or made > 1.0 or iterations > hard) and level < FINEST:
        return level + 1
    quiet = missed <= 1.0 / 6.0 and made <= 0.1
    return level - 1 if level > 0 and quiet and iterations < easy and even else level


@njit(cache=True, error_model="numpy", **BORROWS)
def _ends(work, deep, counters):
    """DONE, or the reason why a run ends with its present state; `deep`: see _judge."""
    tables, state = work.tables, work.state
    outside = _outside(state.x, work.bounds.low, work.bounds.high)
    if outside >= 0:
        counters[WORST] = outside
        return LEFT
    if deep >= 0:
        counters[WORST] = deep
        return DEEP
    if tables.points.size > 0:
        stretched, strain = overstretched(tables.points, tables.joints, state.x, state.r)
        if stretched >= 0:
            counters[WORST], counters[STRAIN] = stretched, strain
            return STRETCHED
    return DONE


@njit(cache=True, error_model="numpy", nogil=True)
def run(work, t, steps, tolerance, control):
    """Takes the steps `steps` (n,) [ms] from time t. Returns (status, time reached).

    A step is halved, up to HALVINGS_MOST times, in three cases: it does not converge; velocities miss their
    guess by more than pace[MISS]; the energy error of an island's contacts exceeds pace[MADE] of its energy.
    `tolerance` and pace[MISS] are relative to the speed of each island. See integrate.islands.
    Before a step that would move a box that sleeps the status is WOKEN, and the box is counters[WORST].
    """
    state, rows, counters, pace = work.state, work.kept.rows, control.counters, control.pace
    last, guess, mass, begun = Last(state.u.copy(), state.ub.copy()), state.u.copy(), _mass(work), t
    stored, allowed = np.zeros((rows.shape[0], 2)), np.zeros(rows.shape[0])
    driven = np.zeros(control.energies.shape[0])
    for row in range(rows.shape[0]):
        rows[row, FORCE_BEGUN] = rows[row, FORCE_NOW]
        for i in range(TURNING):
            rows[row, TURNING_BEGUN + i] = rows[row, TURNING_NOW + i]
    if counters[STEPS] == 0.0:
        measure(work, t, 0)
    for whole in steps:
        done = 0
        while done < 1 << HALVINGS_MOST:
            level = int(pace[LEVEL])
            size, dt, iterations = 1 << (HALVINGS_MOST - level), whole / (1 << level), counters[ITERATIONS]
            if not _predict(work, dt, control, last):
                return CROWDED, t
            copy(guess, state.u)
            solved = _solve(work, t, dt, tolerance, control, level)
            woken = disturbed(work.tables.bodies, work.mid.forces, work.asleep, dt) if solved else -1
            if woken >= 0:
                copy(state.u, last.u)
                copy(state.ub, last.ub)
                counters[WORST] = woken
                return WOKEN, t
            missed, deep, made = 0.0, -1, 0.0
            if solved:
                # relative to the limit
                missed = missed_guess(work, guess, pace[FLOOR]) / (pace[MISS] if pace[MISS] > 0.0 else 1e300)
                deep, made, solved = _judge(work, t, dt, control, last, stored, allowed)
            if not solved or ((missed > TAKEN_AGAIN or made > TAKEN_AGAIN or deep >= 0) and level < FINEST):
                copy(state.u, last.u)
                copy(state.ub, last.ub)
                if level == HALVINGS_MOST:
                    return STOPPED, t
                # the energy error scales with the step to the power of 5/2, or 3
                halvings = math.ceil(math.log2(made) / 2.5) if made > TAKEN_AGAIN else 1
                pace[LEVEL] = min(
                    level + max(1, halvings),
                    HALVINGS_MOST if level >= FINEST else FINEST,
                )
                if not solved:
                    counters[GIVEN_UP] += 1
                    forget(control.history)
                    list_anew(work.mid.drift)
                continue
            _accept(work, t, dt, control, last, t == begun, driven)
            done += size
            t += dt
            pace[FASTEST] = max(pace[FASTEST], _speed(work, mass))
            iterations = counters[ITERATIONS] - iterations
            pace[LEVEL] = _next_level(work, level, iterations, missed, made, done % (2 * size) == 0)
            status = _ends(work, deep, counters)
            if status != DONE:
                return status, t
    return DONE, t
