"""Friction that sticks, of a sheet or a roller on another kind of body: one spring for each contact patch.

A patch is the whole contact of a sheet with one roller, or of one body with another body. Along its faces a
spring of stiffness k_t, the bristle, holds the two bodies, for any boxes of the sheet in the patch. Its
stretch is a rigid field, of the first body against the second: z at the middle c of the patch, and a rotation
phi about its normal n,

    z(x) = z + phi n x (x - c).

A point that presses with N_i has the part N_i/N of k_t. In a step of 2 h with the slip velocity v_i in its
middle

    f_i = -k_t N_i/N z_i,    z_i = (z(x_i) + 2 h v_i)/(1 + 2 h r), scaled back to |f_i| <= mu N_i.

As in mechanics.stick this is the return mapping of Coulomb friction, with the force at the end of the step.
After the step the field changes by the rigid motion that fits the changes of all z_i best, with the weights
N_i. The bristle stores k_t (z^2 + phi^2 sum(N_i |x_i - c|^2)/N)/2. A rigid field never stores more than the
z_i together, and the difference is dissipated.

Rolling removes stretch: new material enters the patch without any, at V, the mean speed of both surfaces
through the patch. A force F creeps over a patch of length 2a by Carter's curve (Johnson, Contact Mechanics,
section 8.3),

    xi = 2 mu N/(k_t a) (1 - sqrt(1 - F/(mu N))),

relative to V. Hence r = V xi k_t/F. Two cylinders of one material and width L have his result with
k_t = pi E* L/2, since then N = pi E* L a^2/(4 R) makes it mu a/R (1 - sqrt(...)). A small force creeps by
F/(k_t a), as the bristles of a brush do. a = sqrt(2 R z), for a round of radius R that is pressed in by z.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.laws import held_over_speed
from mdlgen.mechanics.point import (
    AT,
    COUPLE,
    FORCE,
    HOLD,
    KIND,
    MU_STATIC,
    NORMAL,
    OF_NIP,
    OUT,
    POINT,
    POINTS,
    SLIP,
    WAY,
)
from mdlgen.mechanics.vector import add, cross, dot, scale, sub, three, three_from, vec
from mdlgen.program.kernel import BORROWS, njit

BRISTLE = np.dtype(
    [
        ("row", "i8"),  # of the contacts
        ("a", "i8"),  # first body, of a sheet that rolls its first box; and the second
        ("b", "i8"),
        ("k", "f8"),  # k_t [N/mm]
        ("axis", "f8", 3),  # of the roller that a sheet rolls on, 0: none
        ("stretch", "f8", 3),  # z: global, or about a roller along its round and along its axis [mm]
        ("turn", "f8"),  # phi [rad]
        ("centre", "f8", 3),  # c from the centre of the second body, global [mm]
        ("normal", "f8", 3),  # to the first body
        ("force", "f8"),  # N of the last evaluation, 0: nothing touches [N]
        ("eases", "f8"),  # r/V, by the force at the begin of the step [1/mm]
        ("rate", "f8"),  # r of the last evaluation [1/ms]
        ("energy", "f8"),  # [N mm]
        # sums over points: N; N by the change of z; N x; N n; mu N; N v, the speed through the patch; the
        # greatest depth, and 1/R there; then N by the moment of that change, and by the square of the arm
        ("sums", "f8", 16),
    ]
)
N, NZ, NX, NN, MU_N, NV, DEEPEST, CURVED, MOMENT, ARMS = 0, 1, 4, 7, 10, 11, 12, 13, 14, 15

# Input of a pair of bodies from the bristle of its patch; see the columns of mechanics.point.
HELD = np.dtype(
    [
        ("bristle", "i8"),
        ("pair", "i8"),
        ("rate", "f8"),
        ("holds", "f8"),
        ("offset", "f8", 3),
        ("twist", "f8", 3),
        ("about", "f8", 3),
    ]
)


@njit(cache=True, error_model="numpy", **BORROWS)
def lay(held, bristle, motion, a, b, h):
    """Sets the input of the pair of bodies a and b for a step of 2 h [ms]."""
    if bristle.force <= 0.0:
        held.holds = 0.0
        return
    lets = 2.0 * h / (1.0 + 2.0 * h * bristle.rate)
    held.rate = bristle.rate
    held.holds = bristle.k * lets / bristle.force
    z, normal, axis = three(bristle.stretch), three(bristle.normal), three(bristle.axis)
    if dot(axis, axis) > 0.0:
        # each box has the normal of its own face
        r = motion.r
        face = (r[a, 2], r[a, 5], r[a, 8])
        normal = face if dot(face, sub(vec(motion.x, a), vec(motion.x, b))) >= 0.0 else scale(-1.0, face)
        z = add(scale(z[0], cross(axis, normal)), scale(z[1], axis))
    place = add(vec(motion.x, b), three(bristle.centre))
    for i in range(3):
        held.offset[i] = z[i] / (2.0 * h)
        held.twist[i] = bristle.turn * normal[i] / (2.0 * h)
        held.about[i] = place[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def _change(held, out, at, h):
    """Returns the change of the stretch of a point in the step [mm]. The stretch after it is the force over
    the point's part of k_t."""
    slip, hold = three_from(out, at + SLIP), out[at + HOLD]
    if hold <= 0.0:
        return (0.0, 0.0, 0.0)
    square = three_from(out, at + (WAY if out[at + KIND] == OF_NIP else NORMAL))
    arm = sub(three_from(out, at + AT), three(held.about))
    field = add(three(held.offset), cross(three(held.twist), arm))
    field = sub(field, scale(dot(field, square), square))
    part = held_over_speed(math.sqrt(dot(slip, slip)), hold, out[at + MU_STATIC]) / hold
    return scale(2.0 * h, sub(scale(part / (1.0 + 2.0 * h * held.rate), slip), field))


@njit(cache=True, error_model="numpy", **BORROWS)
def _presses(out, at):
    return out[at + KIND] != COUPLE and out[at + FORCE] > 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def _surface(motion, b, place):
    return add(vec(motion.u, b), cross(vec(motion.w, b), sub(place, vec(motion.x, b))))


@njit(cache=True, error_model="numpy", **BORROWS)
def weigh(bristle, out, motion, a, b, roller, axis, curved):
    """Adds normal forces and speeds through the patch of bodies a and b to the sums. roller: the body about
    whose axis it rolls; curved: 1/R of it, 0: it rolls about none."""
    sums = bristle.sums
    sums[CURVED] = curved
    for k in range(int(out[POINTS])):
        at = OUT + 1 + POINT * k
        if not _presses(out, at):
            continue
        sums[N] += out[at + FORCE]
        if curved > 0.0:
            place = three_from(out, at + AT)
            both = add(_surface(motion, a, place), _surface(motion, b, place))
            past = sub(scale(0.5, both), vec(motion.u, roller))
            sums[NV] += out[at + FORCE] * dot(past, cross(axis, three_from(out, at + NORMAL)))


@njit(cache=True, error_model="numpy", **BORROWS)
def weighed(bristle):
    """Updates N and r from the sums."""
    sums = bristle.sums
    bristle.force = sums[N]
    bristle.rate = bristle.eases * abs(sums[NV]) / sums[N] if sums[N] > 0.0 else 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def gather(bristle, held, out, motion, h):
    """Adds the points of a pair, as a step of 2 h ends, to the sums of forces, places and changes."""
    sums, fixed = bristle.sums, three(bristle.axis)
    for k in range(int(out[POINTS])):
        at = OUT + 1 + POINT * k
        if not _presses(out, at):
            continue
        force, normal, place = out[at + FORCE], three_from(out, at + NORMAL), three_from(out, at + AT)
        z = _change(held, out, at, h)
        if dot(fixed, fixed) > 0.0:
            z = (dot(z, cross(fixed, normal)), dot(z, fixed), 0.0)
        arm = sub(place, vec(motion.x, bristle.b))
        sums[N] += force
        for i in range(3):
            sums[NZ + i] += force * z[i]
            sums[NX + i] += force * arm[i]
            sums[NN + i] += force * normal[i]
        sums[MU_N] += force * out[at + MU_STATIC]


@njit(cache=True, error_model="numpy", **BORROWS)
def middle_of(bristle):
    """Moves the field to the middle of the points that were added, and changes z there. Returns False where
    no point presses."""
    sums = bristle.sums
    if sums[N] <= 0.0:
        return False
    size = math.sqrt(sums[NN] * sums[NN] + sums[NN + 1] * sums[NN + 1] + sums[NN + 2] * sums[NN + 2])
    z, axis, before = three(bristle.stretch), three(bristle.axis), three(bristle.centre)
    for i in range(3):
        bristle.centre[i] = sums[NX + i] / sums[N]
        bristle.normal[i] = sums[NN + i] / size if size > 0.0 else 0.0
        sums[NZ + i] /= sums[N]
    normal, change = three(bristle.normal), three_from(sums, NZ)
    aside = scale(bristle.turn, cross(normal, sub(three(bristle.centre), before)))
    if dot(axis, axis) > 0.0:
        aside = (dot(aside, cross(axis, normal)), dot(aside, axis), 0.0)
        z = add(z, add(aside, change))
    else:
        # the stretch stays in the face as that turns
        size = math.sqrt(dot(z, z))
        z = sub(z, scale(dot(z, normal), normal))
        left = math.sqrt(dot(z, z))
        z = add(scale(size / left if left > 0.0 else 0.0, z), add(aside, change))
    for i in range(3):
        bristle.stretch[i] = z[i]
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def turn_of(bristle, held, out, motion, h):
    """Adds the points of a pair to the last two sums, for the turn of the field about its middle."""
    fixed = three(bristle.axis)
    middle = add(vec(motion.x, bristle.b), three(bristle.centre))
    for k in range(int(out[POINTS])):
        at = OUT + 1 + POINT * k
        if not _presses(out, at):
            continue
        force, normal, z = out[at + FORCE], three_from(out, at + NORMAL), three_from(bristle.sums, NZ)
        if dot(fixed, fixed) > 0.0:
            z = add(scale(z[0], cross(fixed, normal)), scale(z[1], fixed))
        arm = sub(three_from(out, at + AT), middle)
        arm = sub(arm, scale(dot(arm, normal), normal))
        more = sub(_change(held, out, at, h), z)
        bristle.sums[MOMENT] += force * dot(normal, cross(arm, more))
        bristle.sums[ARMS] += force * dot(arm, arm)


@njit(cache=True, error_model="numpy", **BORROWS)
def end(bristle):
    """Ends a step: changes phi, and stores energy and r/V. Returns the change of the energy [N mm]."""
    sums, before = bristle.sums, bristle.energy
    z = three(bristle.stretch)
    squares = dot(z, z)
    bristle.turn += sums[MOMENT] / sums[ARMS] if sums[ARMS] > 0.0 else 0.0
    bristle.energy = 0.5 * bristle.k * (squares + bristle.turn * bristle.turn * sums[ARMS] / sums[N])
    bristle.force, bristle.eases = sums[N], 0.0
    if sums[CURVED] > 0.0 and sums[DEEPEST] > 0.0 and sums[MU_N] > 0.0:
        half = math.sqrt(2.0 * sums[DEEPEST] / sums[CURVED])
        x = min(bristle.k * math.sqrt(squares) / sums[MU_N], 1.0)
        # 1 - sqrt(1 - x) over x, finite at x = 0
        bristle.eases = 2.0 / (half * (1.0 + math.sqrt(1.0 - x)))
    return bristle.energy - before


@njit(cache=True, error_model="numpy", **BORROWS)
def release(bristle):
    """Resets the bristle of a patch that no point presses on. Returns the energy that it had [N mm]."""
    energy = bristle.energy
    bristle.force = bristle.energy = bristle.turn = bristle.eases = bristle.rate = 0.0
    for i in range(3):
        bristle.stretch[i] = 0.0
    return energy
