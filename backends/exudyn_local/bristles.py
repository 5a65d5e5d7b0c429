"""Friction that sticks: each contact patch has coordinates whose rates are the stretch of its spring.

The spring and its field are those of mechanics.bristle: k_t for the patch, and z(x) = z + phi n x (x - c).
There a step maps the stretch back to the limit. Here the stretch has a rate, since the solver asks for the
forces of a state. For each point, by Dupont, Hayward, Armstrong and Altpeter (IEEE Trans. Automatic Control
47(5), 2002),

    dz_i/dt = v_i - r z_i - alpha(x) max(0, v_i.z_i/|z_i|) z_i/|z_i|,    x = |z_i|/z_m,  z_m = mu N/k_t.

alpha is 0 up to the limit, x = 1, so a patch that holds does not creep, however its load changes. Beyond
the limit alpha is (x - 1)/BEYOND, so a patch that slides has x = 1 + BEYOND. In that paper alpha rises
smoothly to 1 and stays there. Where a step slides by many limits, as when a sheet has just touched, Newton's
method then alternates between the two sides of the rise. An unbounded rise is convex in x, and Newton's
method converges to the solution from above. The force has the limit mu N:

    f_i = -N_i min(k_t |s|/N, mu) s/|s|,    s = z_i + h (v_i - r z_i),

with h the step. As in lattice this is the spring with a damper k_t h. Without it a sheet that sticks would
keep oscillating, since the integrator damps almost nothing that it resolves. A patch that creeps steadily,
v_i = r z_i, has the force of its spring alone. The part of the rate due to alpha is omitted from s: it
would reverse the force where a step has slid far. A stretch beyond the limit, after the motion turns back
or N falls, decays with the time constant h; so does all of it if nothing presses. Both vanish with the step.

The field changes by the rigid rate that fits the rates of the points best, with the weights N_i. Its
coordinates are those at the centre of the second body, so the middle of the patch may move. N, c and r are
those of the state itself: all normal forces are evaluated first, then friction at the same points.
"""

from __future__ import annotations

import math

from mdlgen.backends.exudyn_local.patches import FIELD, FINE, WEIGHT
from mdlgen.backends.exudyn_local.place import spread
from mdlgen.mechanics.bristle import (
    CURVED,
    DEEPEST,
    MU_N,
    NN,
    NV,
    NX,
    N,
    weigh,
)
from mdlgen.mechanics.laws import held_over_speed
from mdlgen.mechanics.pair import pair_force, rolls
from mdlgen.mechanics.point import (
    AT,
    COUPLE,
    DEPTH,
    DISSIPATED,
    FORCE,
    FORCE_A,
    FORCE_B,
    HOLD,
    HOLDS,
    KIND,
    MU_STATIC,
    NORMAL,
    OF_NIP,
    OUT,
    POINT,
    POINTS,
    SLIP,
    TORQUE_A,
    TORQUE_B,
    WAY,
)
from mdlgen.mechanics.vector import add, cross, dot, scale, sub, three, three_from, vec
from mdlgen.program.kernel import njit

# Stretch beyond the limit of a patch that slides, relative to the limit. A smaller part has stiffer
# rates; a larger part loses more energy when the motion turns back.
BEYOND = 0.1
# Least stretch at the limit [m]: without normal force the rate would have no bound.
SHORTEST = 1e-9
# Value of HOLDS [s/m] with which a pair is evaluated without friction.
NOTHING = 1e-200


@njit(cache=True, error_model="numpy")
def press(tables, p, motion, out):
    """One pair without its friction into `out`, with its points; returns whether it touches."""
    for i in range(OUT + 1):
        out[i] = 0.0
    out[HOLDS] = NOTHING
    return pair_force(tables.bodies, tables.pairs[p], tables.shapes, motion, out)


@njit(cache=True, error_model="numpy")
def _field(patch, own, arm, square):
    """The stretch by the coordinates `own` of a patch at a place `arm` from the centre of its second body,
    square to a direction."""
    z, axis = scale(FINE, (own[0], own[1], own[2])), three(patch.axis)
    if dot(axis, axis) > 0.0:
        z = add(scale(z[0], cross(axis, square)), scale(z[1], axis))
    z = add(z, scale(FINE * own[3], cross(three(patch.normal), arm)))
    return sub(z, scale(dot(z, square), square))


@njit(cache=True, error_model="numpy")
def _own(tables, k, v):
    """The coordinates of a patch."""
    at = tables.stick.first[0] + FIELD * k
    return v[at], v[at + 1], v[at + 2], v[at + 3]


@njit(cache=True, error_model="numpy")
def _add_up(tables, p, motion, out):
    """Adds the points of a pair to the sums of its patch."""
    bodies, pair, stick = tables.bodies, tables.pairs[p], tables.stick
    patch = stick.patches[stick.patch_of[p]]
    sums, own_axis = patch.sums, three(bodies[pair.a].axis)
    axis, curved = rolls(bodies, pair, tables.shapes, motion)
    roller = pair.a if dot(own_axis, own_axis) > 0.0 else pair.b
    weigh(patch, out, motion, pair.a, pair.b, roller, axis, curved)
    sums[DEEPEST] = max(sums[DEEPEST], out[DEPTH])
    for k in range(int(out[POINTS])):
        at = OUT + 1 + POINT * k
        if out[at + KIND] == COUPLE or out[at + FORCE] <= 0.0:
            continue
        force, arm = out[at + FORCE], sub(three_from(out, at + AT), vec(motion.x, pair.b))
        for i in range(3):
            sums[NX + i] += force * arm[i]
            sums[NN + i] += force * out[at + NORMAL + i]
        sums[MU_N] += force * out[at + MU_STATIC]


@njit(cache=True, error_model="numpy")
def _middle(patch, own):
    """N, c, n and r of the points that were added; `own`: the coordinates of the patch."""
    sums = patch.sums
    patch.force, patch.rate, patch.arms = sums[N], 0.0, 0.0
    if sums[N] <= 0.0:
        return
    size = math.sqrt(sums[NN] * sums[NN] + sums[NN + 1] * sums[NN + 1] + sums[NN + 2] * sums[NN + 2])
    for i in range(3):
        patch.centre[i] = sums[NX + i] / sums[N]
        patch.normal[i] = sums[NN + i] / size if size > 0.0 else 0.0
    if sums[CURVED] > 0.0 and sums[DEEPEST] > 0.0 and sums[MU_N] > 0.0:
        z = _field(patch, own, three(patch.centre), three(patch.normal))
        half = math.sqrt(2.0 * sums[DEEPEST] / sums[CURVED])
        x = min(patch.k * math.sqrt(dot(z, z)) / sums[MU_N], 1.0)
        patch.rate = 2.0 / (half * (1.0 + math.sqrt(1.0 - x))) * abs(sums[NV]) / sums[N]


@njit(cache=True, error_model="numpy")
def _arm(patch, out, at, motion):
    """Vector from the middle of a patch to a point, along the faces."""
    arm = sub(three_from(out, at + AT), add(vec(motion.x, patch.b), three(patch.centre)))
    normal = three(patch.normal)
    return sub(arm, scale(dot(arm, normal), normal))


@njit(cache=True, error_model="numpy")
def _add_arms(patch, out, motion):
    """Adds the points of a pair to the mean square of the arms of its patch."""
    for k in range(int(out[POINTS])):
        point = OUT + 1 + POINT * k
        if out[point + KIND] != COUPLE and out[point + FORCE] > 0.0:
            arm = _arm(patch, out, point, motion)
            patch.arms += out[point + FORCE] * dot(arm, arm) / patch.force


@njit(cache=True, error_model="numpy")
def weigh_patches(tables, at, motion):
    """Evaluates all pairs in patches at Coordinates, without friction: those that touch into the rows of
    Sticking, and what friction needs of all points of a patch into its record."""
    stick, count = tables.stick, 0
    patches = stick.patches
    for k in range(patches.size):
        patches[k].sums[:] = 0.0
    for p in stick.pairs:
        if press(tables, p, motion, stick.rows[count]):
            _add_up(tables, p, motion, stick.rows[count])
            stick.touched[count] = p
            count += 1
    stick.many[0] = count
    for k in range(patches.size):
        _middle(patches[k], _own(tables, k, at.v))
    for row in range(count):
        _add_arms(patches[stick.patch_of[stick.touched[row]]], stick.rows[row], motion)


@njit(cache=True, error_model="numpy")
def _weigh_alone(tables, p, at, motion, out):
    """The same for the one pair of a patch."""
    number = tables.stick.patch_of[p]
    patch = tables.stick.patches[number]
    patch.sums[:] = 0.0
    _add_up(tables, p, motion, out)
    _middle(patch, _own(tables, number, at.v))
    _add_arms(patch, out, motion)


@njit(cache=True, error_model="numpy")
def _beyond(patch, z, moves, mu, lag):
    """Rate at which a point loses its stretch since that is beyond the limit [1/s]."""
    size, most = math.sqrt(dot(z, z)), max(mu * patch.force / patch.k, SHORTEST)
    if size <= most:
        return 0.0
    slides = (size / most - 1.0) / BEYOND * max(0.0, dot(moves, z)) / (size * size)
    return slides + (1.0 - most / size) / lag


@njit(cache=True, error_model="numpy")
def _hold(out, place, drag, slip, xa, xb):
    """Adds friction at a place to the columns of a pair."""
    force = scale(-drag, slip)
    one, two = cross(sub(place, xa), force), cross(sub(place, xb), force)
    for i in range(3):
        out[FORCE_A + i] += force[i]
        out[TORQUE_A + i] += one[i]
        out[FORCE_B + i] -= force[i]
        out[TORQUE_B + i] -= two[i]


@njit(cache=True, error_model="numpy")
def grip(tables, p, at, motion, out, f):
    """Adds the friction of a pair to `out`, as `press` left it, and the rates of its patch to the generalised
    forces. The patch must have been weighed."""
    stick, pair = tables.stick, tables.pairs[p]
    number, lag = stick.patch_of[p], stick.lag[0]
    patch, own = stick.patches[number], _own(tables, number, at.v)
    if patch.force <= 0.0:
        return
    xa, xb = vec(motion.x, pair.a), vec(motion.x, pair.b)
    hold, axis, normal = patch.k * lag / patch.force, three(patch.axis), three(patch.normal)
    rates, turns = (0.0, 0.0, 0.0), 0.0
    for k in range(int(out[POINTS])):
        point = OUT + 1 + POINT * k
        force, mu = out[point + FORCE], out[point + MU_STATIC]
        if out[point + KIND] == COUPLE or force <= 0.0:
            continue
        square = three_from(out, point + (WAY if out[point + KIND] == OF_NIP else NORMAL))
        place, moves = three_from(out, point + AT), three_from(out, point + SLIP)
        z = _field(patch, own, sub(place, xb), square)
        held = sub(moves, scale(patch.rate, z))
        rate = sub(held, scale(_beyond(patch, z, moves, mu, lag), z))
        slip = add(held, scale(1.0 / lag, z))
        drag = force * held_over_speed(math.sqrt(dot(slip, slip)), hold, mu)
        _hold(out, place, drag, slip, xa, xb)
        out[DISSIPATED] += drag * dot(moves, slip)
        for i in range(3):
            out[point + SLIP + i] = slip[i]
        out[point + HOLD] = hold
        rate = scale(force / patch.force, rate)
        if patch.arms > SHORTEST * SHORTEST:
            turns += dot(normal, cross(_arm(patch, out, point, motion), rate)) / patch.arms
        if dot(axis, axis) > 0.0:
            rate = (dot(rate, cross(axis, square)), dot(rate, axis), 0.0)
        rates = add(rates, rate)
    aside = scale(turns, cross(normal, three(patch.centre)))
    if dot(axis, axis) > 0.0:
        aside = (dot(aside, cross(axis, normal)), dot(aside, axis), 0.0)
    first, weight = stick.first[0] + FIELD * number, patch.k * WEIGHT
    for i in range(3):
        f[first + i] += weight * (rates[i] - aside[i])
    f[first + 3] += weight * turns


@njit(cache=True, error_model="numpy")
def release(tables, k, v, f):
    """Adds the decay of the coordinates of a patch that no point presses on."""
    stick = tables.stick
    patch, first = stick.patches[k], stick.first[0] + FIELD * k
    if patch.force <= 0.0:
        for i in range(FIELD):
            f[first + i] -= patch.k * WEIGHT * FINE / stick.lag[0] * v[first + i]


@njit(cache=True, error_model="numpy")
def onto(tables, p, q, out, f):
    """Adds the forces of a pair to the generalised forces."""
    pair = tables.pairs[p]
    spread(tables.bodies, pair.a, q, three_from(out, FORCE_A), three_from(out, TORQUE_A), f)
    spread(tables.bodies, pair.b, q, three_from(out, FORCE_B), three_from(out, TORQUE_B), f)


@njit(cache=True, error_model="numpy")
def held_forces(tables, at, motion, f):
    """Adds all pairs in patches to the generalised forces; they are left in the rows of Sticking. Returns how
    many touch."""
    stick = tables.stick
    weigh_patches(tables, at, motion)
    for row in range(stick.many[0]):
        p, out = stick.touched[row], stick.rows[row]
        grip(tables, p, at, motion, out, f)
        onto(tables, p, at.q, out, f)
    for k in range(stick.patches.size):
        release(tables, k, at.v, f)
    return stick.many[0]


@njit(cache=True, error_model="numpy")
def held_element(tables, p, at, motion, f):
    """One pair in a patch. N, c and r of a patch of several pairs stay as they were weighed.

    Returns whether it touches.
    """
    stick = tables.stick
    out = stick.rows[stick.pairs.size]
    if not press(tables, p, motion, out):
        return False
    if stick.patches[stick.patch_of[p]].alone:
        _weigh_alone(tables, p, at, motion, out)
    grip(tables, p, at, motion, out, f)
    onto(tables, p, at.q, out, f)
    return True


@njit(cache=True, error_model="numpy")
def held_energy(tables, v):
    """Returns the energy of all springs at the state that was weighed last [J]."""
    stick, energy = tables.stick, 0.0
    for k in range(stick.patches.size):
        patch, own = stick.patches[k], _own(tables, k, v)
        if patch.force > 0.0:
            z, turn = _field(patch, own, three(patch.centre), three(patch.normal)), FINE * own[3]
            energy += 0.5 * patch.k * (dot(z, z) + turn * turn * patch.arms)
    return energy
