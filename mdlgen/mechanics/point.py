"""The force of one contact point, and the sums of a pair over its points.

Each law adds to `out`, whose columns are named below: forces and torques on both bodies, the normal force,
stored energy and dissipated power; it stores the greatest depth. A longer `out` also gets the number of
contact points and the numbers of each, from which a solver assembles its tangent. A point is ALONE, OF_NIP,
or a COUPLE, whose columns differ.

Damping depends on the rate of one penetration (Eq. 11). The force of a nip under a roller acts at points
before and behind its contact line. Their own rates are those of rolling: the sheet enters at one and leaves
at the other, while the depth of the nip is constant. So all points of a nip are damped by the growth rate of
the depth at its contact line, even where that lies on the next box. A nip that rolls or slides at a constant
depth dissipates nothing. A free edge has one point, and its own rate.

A box that ends in a nip may turn about a place between the contact line and the middle of its pressure. Both
then move in opposite directions, and damping by the rate at the line would drive the box, until the sheet
flutters. So a box is damped by the lesser of both rates, and not at all where they differ in sign. Then its
damping always dissipates energy (mechanics.point.push_in_nip).

Each element of a sheet that passes at v is pressed in and released again at up to v sqrt(2z/R), the slope of
the round where it enters. The sign of their damping follows from that; a slower growth of the depth changes
it only in a part of them. So the damping of a nip is complete over the root of the sum of two squares: the
law's smoothing speed, and that speed (`passing`). Sheets that do not pass are damped over the smoothing speed
alone.

Friction, too, is that of one nip: along the face, against the slip at the distance R from the axis. So a
rolling body moves at omega R and is pulled at a lever of R. Along the round, or at the face, R - z from the
axis, points of a nip would rub against each other, as they enter faster than they pass the contact line, by v
z/R: a web would creep by that much before mu N holds it, and a nip that rolls would lose energy.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import Vector
from mdlgen.mechanics.laws import coefficient, damped, friction_over_speed, held_over_speed, sign_step
from mdlgen.mechanics.measured import END, MEASURED, factor_of, stretched
from mdlgen.mechanics.vector import add, cross, dot, scale, sub, three_from
from mdlgen.program.kernel import BORROWS, CALLED, FUSED, njit

# Columns of the sums of a pair: force and torque on the first body and on the second, three each; the force
# along normals, stored energy, dissipated power, the greatest depth. A longer one has the number of points
# that follow.
FORCE_A, TORQUE_A, FORCE_B, TORQUE_B = 0, 3, 6, 9
PRESSING, STORED, DISSIPATED, DEPTH = 12, 13, 14, 15
# Input of a law in these columns, for a pair that a spring holds along its faces (see mechanics.bristle).
# HOLDS: its force per normal force and speed, 0: none holds. Then the field that is added to the slip: a
# velocity, an angular velocity, and its centre. After these, measured friction (see mechanics.measured).
HOLDS, OFFSET, TWIST, ABOUT = 16, 17, 20, 23
OUT = POINTS = END
# Columns for two faces without points (POINTS is 0): magnitude of friction along them, and its limit.
RUBBING, GRIP, FACES = OUT + 1, OUT + 2, OUT + 3
# Columns of each point, from OUT + 1 on: the place; the normal to the first body; the elastic force and its
# growth with depth; the normal force; the rate that damps it; the slip velocity; the share of damping; both
# coefficients of friction; the kind. Where a spring holds, the slip includes its field, and both coefficients
# are that of the slip alone. Where friction is measured, the slip is w of mechanics.measured, and both
# coefficients include its factors.
AT, NORMAL, SPRING, GROWTH, FORCE, RATE, SLIP, BETA, MU_STATIC, MU_DYNAMIC = 0, 3, 6, 7, 8, 9, 10, 13, 14, 15
KIND = 16
ALONE, OF_NIP, COUPLE = 0.0, 1.0, 2.0
# Further columns of a point OF_NIP: the place whose rate damps it, and the normal there.
LINE, WAY = 17, 20
OVER = 23  # the speed over which its damping is complete
# Columns of a COUPLE: its value at a high speed, its radius, the rolling speed and its axis.
MOST_COUPLE, RADIUS, ROLLING, AXIS = 6, 7, 9, 17
HOLD = 24  # for points that press: as HOLDS of the pair
POINT = 25
NEVER = 1e30  # OVER of a point without damping
MOST_POINTS = 64  # for one pair: an oblique face under a roller has up to 48, a corner more, and a couple


class Load(NamedTuple):
    """The elastic force of a point [N], its depth [mm] and the energy that it stores."""

    force: float
    depth: float
    energy: float


class Nip(NamedTuple):
    """A place on a nip's contact line, the middle of the pressure on the first body, the normal there, to
    that body, and the greatest speed at which a passing sheet is pressed in."""

    line: Vector
    middle: Vector
    way: Vector
    pressed: float


class Losses(NamedTuple):
    """Inputs of the losses at a point: the rate that damps it, the speed over which that damping is complete,
    and the direction to which its friction is perpendicular."""

    rate: float
    over: float
    square: Vector


@njit(cache=True, error_model="numpy", forceinline=True)
def presses(out):
    """True if a pair's columns have a normal force."""
    return out[PRESSING] != 0.0


@njit(cache=True, error_model="numpy", forceinline=True)
def closing(point, normal, a, b):
    """Closing rate of two bodies at a point along a normal that points to the first."""
    slip = sub(add(a.v, cross(a.w, sub(point, a.x))), add(b.v, cross(b.w, sub(point, b.x))))
    return -dot(slip, normal)


@njit(cache=True, error_model="numpy", forceinline=True)
def passing(point, across, slope, a, b):
    """Greatest speed at which a sheet that passes a roller, body b, is pressed in: its speed across the
    contact line, relative to the roller's axis, times the slope of the round where its pressure begins."""
    return slope * dot(sub(add(a.v, cross(a.w, sub(point, a.x))), b.v), across)


@njit(cache=True, error_model="numpy", **BORROWS, **CALLED)
def push(out, point, normal, load, a, b, law):
    """Adds the force of one contact point of bodies a and b (Frames); `normal` points to a."""
    losses = Losses(closing(point, normal, a, b), law.smoothing, normal)
    at = _push(out, point, normal, losses, load, a, b, law)
    if at > 0:
        out[at + KIND] = ALONE


@njit(cache=True, error_model="numpy", **BORROWS)
def push_in_nip(out, point, normal, nip, load, a, b, law):
    """As `push` for one of several points of a nip. It is damped by the lesser of the closing rates at its
    contact line and at the middle of the pressure, if these have the same sign."""
    over = math.sqrt(law.smoothing * law.smoothing + nip.pressed * nip.pressed)
    rate, place = closing(nip.line, nip.way, a, b), nip.line
    # a roller's own rotation does not change the depth
    own = dot(sub(b.v, add(a.v, cross(a.w, sub(nip.middle, a.x)))), nip.way)
    if rate * own <= 0.0:
        rate, over = 0.0, NEVER
    elif abs(own) < abs(rate):
        rate, place = own, nip.middle
    at = _push(out, point, normal, Losses(rate, over, nip.way), load, a, b, law)
    if at > 0:
        out[at + KIND] = OF_NIP
        for i in range(3):
            out[at + LINE + i] = place[i]
            out[at + WAY + i] = nip.way[i]


@njit(cache=True, error_model="numpy", **BORROWS, **CALLED, **FUSED)
def _push(out, point, normal, losses, load, a, b, law):
    """Adds the force of a point with its Losses; returns its first column in `out`, 0: it has none."""
    spring, depth, energy = load
    rate, over, square = losses
    ra, rb = sub(point, a.x), sub(point, b.x)
    slip = sub(add(a.v, cross(a.w, ra)), add(b.v, cross(b.w, rb)))
    own = -dot(slip, normal)
    slip = sub(slip, scale(dot(slip, square), square))
    speed = math.sqrt(dot(slip, slip))
    force = damped(spring, rate, law.beta, over)
    mu_static, mu_dynamic, hold = law.mu_static, law.mu_dynamic, out[HOLDS]
    measured = out[MEASURED] > 0.0
    if measured:
        # after the speed is computed: otherwise the compiler adds the squares in another order
        slip = stretched(out, slip, square)
        speed = math.sqrt(dot(slip, slip))
        factor = factor_of(out, speed, normal, (a.r[2], a.r[5], a.r[8]))
        mu_static, mu_dynamic = factor * mu_static, factor * mu_dynamic
    if hold > 0.0:
        mu_static = mu_dynamic = coefficient(speed, mu_static, mu_dynamic, law.stiction, law.sliding)
        moves, slip = slip, add(slip, _field(out, point, square))
        drag = force * held_over_speed(math.sqrt(dot(slip, slip)), hold, mu_static)
        taken = drag * dot(moves, slip)
    else:
        drag = force * friction_over_speed(speed, mu_static, mu_dynamic, law.stiction, law.sliding)
        taken = drag * speed * speed
    pull = stretched(out, slip, square) if measured else slip
    f = sub(scale(force, normal), scale(drag, pull))
    ta, tb = cross(ra, f), cross(rb, f)
    for i in range(3):
        out[FORCE_A + i] += f[i]
        out[TORQUE_A + i] += ta[i]
        out[FORCE_B + i] -= f[i]
        out[TORQUE_B + i] -= tb[i]
    out[PRESSING] += force
    out[STORED] += energy
    # power by its own rate: summed over all points of a nip it is not below zero
    out[DISSIPATED] += (force - spring) * own + taken
    out[DEPTH] = max(out[DEPTH], depth)
    if out.size <= OUT or out[POINTS] >= MOST_POINTS:
        return 0
    at = OUT + 1 + POINT * int(out[POINTS])
    out[POINTS] += 1.0
    for i in range(3):
        out[at + AT + i] = point[i]
        out[at + NORMAL + i] = normal[i]
        out[at + SLIP + i] = slip[i]
    out[at + BETA], out[at + MU_STATIC], out[at + MU_DYNAMIC] = law.beta, mu_static, mu_dynamic
    out[at + HOLD] = hold
    out[at + SPRING] = spring
    # F z^1.5 has stored 2/5 F z, an elastic foundation 3/5 F z: this is 3/2 F/z, and F/z
    out[at + GROWTH] = 0.6 * spring * spring / energy if energy > 0.0 else 0.0
    out[at + FORCE] = force
    out[at + RATE], out[at + OVER] = rate, over
    return at


@njit(cache=True, error_model="numpy", **BORROWS)
def _field(out, point, square):
    """Field that is added to the slip of a point of a pair that a spring holds, perpendicular to `square`."""
    arm = sub(point, three_from(out, ABOUT))
    field = add(three_from(out, OFFSET), cross(three_from(out, TWIST), arm))
    return sub(field, scale(dot(field, square), square))


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def push_without_friction(out, point, normal, spring, force, a, b):
    """Adds a force along a normal that points to a, `spring` of it elastic, where another point of the pair
    presses and counts the energy."""
    ra, rb = sub(point, a.x), sub(point, b.x)
    own = dot(sub(add(b.v, cross(b.w, rb)), add(a.v, cross(a.w, ra))), normal)
    f = scale(force, normal)
    ta, tb = cross(ra, f), cross(rb, f)
    for i in range(3):
        out[FORCE_A + i] += f[i]
        out[TORQUE_A + i] += ta[i]
        out[FORCE_B + i] -= f[i]
        out[TORQUE_B + i] -= tb[i]
    out[DISSIPATED] += (force - spring) * own


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def turn(out, torque):
    """Adds an elastic couple of the second body on the first, whose energy other points count."""
    for i in range(3):
        out[TORQUE_A + i] += torque[i]
        out[TORQUE_B + i] -= torque[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def resist_rolling(out, wa, wb, axis, radius, f, v_s):
    """Adds the couple that resists the relative rotation of two bodies about an axis: f N R, N their normal
    force. Its sign is smoothed over the speed v_s of the rolling speed omega R."""
    rate = dot(sub(wa, wb), axis) * radius
    most = f * out[PRESSING] * radius
    couple = most * sign_step(rate, v_s)
    for i in range(3):
        out[TORQUE_A + i] -= couple * axis[i]
        out[TORQUE_B + i] += couple * axis[i]
    out[DISSIPATED] += couple * rate / radius
    if out.size <= OUT or out[POINTS] >= MOST_POINTS:
        return
    at = OUT + 1 + POINT * int(out[POINTS])
    out[POINTS] += 1.0
    for i in range(POINT):
        out[at + i] = 0.0
    out[at + MOST_COUPLE], out[at + RADIUS], out[at + ROLLING], out[at + KIND] = most, radius, rate, COUPLE
    for i in range(3):
        out[at + AXIS + i] = axis[i]
