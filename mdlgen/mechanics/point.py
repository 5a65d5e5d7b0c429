"""The force of one contact point, and what a pair adds up of its points.

Each law adds to `out`, whose columns are named below: forces and torques on both bodies, the normal force,
stored energy and dissipated power; it keeps the greatest depth. An `out` that is longer also gets the number
of contact points and the numbers of each, from which a solver makes its tangent. A point is ALONE, OF_NIP, or
a COUPLE, whose numbers are others.

What damps is the rate of one penetration (Eq. 11). Under a roller the force of one nip stands at points
before and behind its contact line. Their own rates are those of rolling: the sheet comes in at one and
goes out at the other, while the nip is as deep as it was. So all points of a nip are damped by the rate at
which the depth at its contact line grows, also where that lies on the next box, and a nip that rolls or
slides at a constant depth loses nothing. A free edge that is met has one point, and its own rate.

A box that ends in a nip may turn about a place between its contact line and the middle of what presses on it.
There it goes one way at the one and the other way at the other, and damping by the rate at the line would
drive it, until the sheet flutters. So a box is damped by the lesser of both rates, and not at all where they
differ in sign: then its damping takes energy, whatever it does (mechanics.point.push_in_nip).

Of a sheet that passes at v, each element is pressed in and let go again at up to v sqrt(2z/R), the slope of
the round where it comes in. Their damping has that sign already; a depth that grows more slowly turns it in
that part of them only. So the damping of a nip is whole not over the law's smoothing speed alone but over
that speed, too (`passing`): by the root of the sum of both squares. What does not pass is damped as before.

Friction, too, is that of one nip: along the face, against the slip at the distance R from the axis, so that
what rolls goes at omega R and is pulled at a lever of R. Along the round, or at the face, R - z from the
axis, points of a nip would rub against each other, as they come in faster than they pass the contact line by
v z/R: a web would creep by that much before it is held with mu N, and a nip that rolls would lose energy.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import Vector
from mdlgen.mechanics.laws import coefficient, damped, friction_over_speed, held_over_speed, sign_step
from mdlgen.mechanics.measured import END, MEASURED, factor_of, stretched
from mdlgen.mechanics.vector import add, cross, dot, scale, sub, three_from
from mdlgen.program.kernel import BORROWS, CALLED, FUSED, njit

# Columns of what a pair adds up: force and torque on the first body and on the second, three each; the force
# along normals, stored energy, dissipated power, the greatest depth. A longer one has how many points follow.
FORCE_A, TORQUE_A, FORCE_B, TORQUE_B = 0, 3, 6, 9
PRESSING, STORED, DISSIPATED, DEPTH = 12, 13, 14, 15
# What a law is given there, of a pair that a spring holds along its faces (see mechanics.bristle): what it
# holds for 1 of the normal force and of the speed, 0: none does; a velocity and an angular velocity, and the
# place about which: the field that is added to the slip. Then its friction, where that is measured (see
# mechanics.measured).
HOLDS, OFFSET, TWIST, ABOUT = 16, 17, 20, 23
OUT = POINTS = END
# Of two faces without their points (POINTS is 0): friction along them by its size, and the most it can be.
RUBBING, GRIP, FACES = OUT + 1, OUT + 2, OUT + 3
# Of each point, from OUT + 1 on: the place, the normal to the first body, the elastic force and its growth
# with depth, the normal force, the rate that damps it, the slip velocity, the share of damping, both
# coefficients of friction, and what it is. Where a spring holds, the slip has its field added to it, and both
# coefficients are that of the slip alone. Where friction is measured, the slip is w of mechanics.measured,
# and both coefficients have its factors.
AT, NORMAL, SPRING, GROWTH, FORCE, RATE, SLIP, BETA, MU_STATIC, MU_DYNAMIC = 0, 3, 6, 7, 8, 9, 10, 13, 14, 15
KIND = 16
ALONE, OF_NIP, COUPLE = 0.0, 1.0, 2.0
# Of one OF_NIP also the place whose rate damps it, and the normal there.
LINE, WAY = 17, 20
OVER = 23  # the speed over which its damping is whole
# Of a COUPLE: that at a high speed, its radius, the rolling speed and its axis.
MOST_COUPLE, RADIUS, ROLLING, AXIS = 6, 7, 9, 17
HOLD = 24  # of what presses: as HOLDS of its pair
POINT = 25
NEVER = 1e30  # over such a speed nothing is damped
MOST_POINTS = 64  # of one pair: an oblique face under a roller has up to 48, a corner more, and a couple


class Load(NamedTuple):
    """The elastic force of a point [N], its depth [mm] and the energy that it stores."""

    force: float
    depth: float
    energy: float


class Nip(NamedTuple):
    """A place on a nip's contact line, the middle of what presses on the first body, the normal there, to
    that body, and the greatest speed at which what passes is pressed in."""

    line: Vector
    middle: Vector
    way: Vector
    pressed: float


class Losses(NamedTuple):
    """What loses energy at a point: the rate that damps it, the speed over which that damping is whole, and
    the direction that its friction acts square to."""

    rate: float
    over: float
    square: Vector


@njit(cache=True, error_model="numpy", forceinline=True)
def presses(out):
    """Whether a pair's columns have a force that presses."""
    return out[PRESSING] != 0.0


@njit(cache=True, error_model="numpy", forceinline=True)
def closing(point, normal, a, b):
    """How fast two bodies close at a point along a normal that points to the first."""
    slip = sub(add(a.v, cross(a.w, sub(point, a.x))), add(b.v, cross(b.w, sub(point, b.x))))
    return -dot(slip, normal)


@njit(cache=True, error_model="numpy", forceinline=True)
def passing(point, across, slope, a, b):
    """How fast what passes a roller, body b, is pressed in at most: its speed across the contact line, which
    goes with the roller's axis, times the round's slope where its pressure begins."""
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
    """As `push` for one of several points of a nip, whose depth grows as its contact line closes, and as the
    middle of what presses on the box goes the same way."""
    over = math.sqrt(law.smoothing * law.smoothing + nip.pressed * nip.pressed)
    rate, place = closing(nip.line, nip.way, a, b), nip.line
    # a roller's own turning leaves the depth as it is
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
    """Adds the force of a point with its Losses; returns where it stands in `out`, 0: nowhere."""
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
        # after the speed: a slip of two branches has its squares added, and rounded, in another order
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
    # what its own way takes off it: over all points of a nip that is not below zero
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
    """What is added to the slip of a point of a pair that a spring holds, `square` to that direction."""
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
    """Adds an elastic couple that the first body has of the second, whose energy other points count."""
    for i in range(3):
        out[TORQUE_A + i] += torque[i]
        out[TORQUE_B + i] -= torque[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def resist_rolling(out, wa, wb, axis, radius, f, v_s):
    """Adds the couple that resists the turning of two bodies against each other about an axis: f N R, N their
    normal force, over its sign's speed v_s of the rolling speed omega R."""
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
