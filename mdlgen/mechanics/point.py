"""The force of one contact point, and what a pair adds up of its points.

Each law adds to `out`: force and torque on the first body (0-5), on the second (6-11), normal force (12),
stored energy (13), dissipated power (14), and keeps the greatest depth (15). An `out` that is longer also
gets the number of contact points (16) and for each of them, in POINT numbers: the point, the normal, the
elastic force and its growth with depth, the normal force, the rate that damps it, the slip velocity, the
share of damping and both coefficients of friction, what it is (ALONE, OF_NIP or COUPLE), and, of a
nip, the place whose rate damps it and the normal there. Of a COUPLE they are: the couple at a high speed (6),
its radius (7), the rolling speed (9) and its axis (17-19). A solver makes its tangent from them.

What damps is the rate of one penetration (Eq. 11). Under a roller the force of one nip stands at points
before and behind the foot of its axis. Their own rates are those of rolling: the sheet comes in at one and
goes out at the other, while the nip is as deep as it was. So all points of a nip are damped by the rate at
which the depth at its foot grows, also where the foot lies on the next box, and a nip that rolls or slides at
a constant depth loses nothing. A free edge that is met has one point, and its own rate.
"""

from __future__ import annotations

import math

from mdlgen.mechanics.laws import damped, friction_over_speed, sign_step
from mdlgen.mechanics.vector import add, cross, dot, scale, sub
from mdlgen.program.kernel import BORROWS, FUSED, njit

OUT = 16
POINT = 23
MOST_POINTS = 25  # of one pair: three parts of a face, two stations, two points; twice for a corner; a couple
ALONE, OF_NIP, COUPLE = 0.0, 1.0, 2.0


@njit(cache=True, error_model="numpy", forceinline=True)
def closing(point, normal, xa, va, wa, xb, vb, wb):
    """How fast two bodies close at a point along a normal that points to the first."""
    slip = sub(add(va, cross(wa, sub(point, xa))), add(vb, cross(wb, sub(point, xb))))
    return -dot(slip, normal)


@njit(cache=True, error_model="numpy", **BORROWS)
def push(out, point, normal, spring, depth, energy, xa, va, wa, xb, vb, wb, law):
    """Adds the force of one contact point; `normal` points to the first body, `spring` is its elastic force.

    law: (beta, mu_static, mu_dynamic, stiction velocity, friction velocity, smoothing velocity).
    """
    rate = closing(point, normal, xa, va, wa, xb, vb, wb)
    at = _push(out, point, normal, rate, spring, depth, energy, xa, va, wa, xb, vb, wb, law)
    if at > 0:
        out[at + 16] = ALONE


@njit(cache=True, error_model="numpy", **BORROWS)
def push_in_nip(out, point, normal, foot, way, spring, depth, energy, xa, va, wa, xb, vb, wb, law):
    """As `push` for one of several points of a nip, whose depth grows as its `foot` closes along `way`."""
    rate = closing(foot, way, xa, va, wa, xb, vb, wb)
    at = _push(out, point, normal, rate, spring, depth, energy, xa, va, wa, xb, vb, wb, law)
    if at > 0:
        out[at + 16] = OF_NIP
        for i in range(3):
            out[at + 17 + i] = foot[i]
            out[at + 20 + i] = way[i]


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def _push(out, point, normal, rate, spring, depth, energy, xa, va, wa, xb, vb, wb, law):
    """Adds the force of a point that is damped by a rate; returns where it stands in `out`, 0: nowhere."""
    ra, rb = sub(point, xa), sub(point, xb)
    slip = sub(add(va, cross(wa, ra)), add(vb, cross(wb, rb)))
    own = -dot(slip, normal)
    slip = add(slip, scale(own, normal))
    speed = math.sqrt(dot(slip, slip))
    force = damped(spring, rate, law[0], law[5])
    drag = force * friction_over_speed(speed, law[1], law[2], law[3], law[4])
    f = sub(scale(force, normal), scale(drag, slip))
    ta, tb = cross(ra, f), cross(rb, f)
    for i in range(3):
        out[i] += f[i]
        out[3 + i] += ta[i]
        out[6 + i] -= f[i]
        out[9 + i] -= tb[i]
    out[12] += force
    out[13] += energy
    # what its own way takes off it: over all points of a nip that is not below zero
    out[14] += (force - spring) * own + drag * speed * speed
    out[15] = max(out[15], depth)
    if out.size <= OUT or out[OUT] >= MOST_POINTS:
        return 0
    at = OUT + 1 + POINT * int(out[OUT])
    out[OUT] += 1.0
    for i in range(3):
        out[at + i] = point[i]
        out[at + 3 + i] = normal[i]
        out[at + 10 + i] = slip[i]
        out[at + 13 + i] = law[i]
    out[at + 6] = spring
    # F z^1.5 has stored 2/5 F z, an elastic foundation 3/5 F z: this is 3/2 F/z, and F/z
    out[at + 7] = 0.6 * spring * spring / energy if energy > 0.0 else 0.0
    out[at + 8] = force
    out[at + 9] = rate
    return at


@njit(cache=True, error_model="numpy", **BORROWS)
def resist_rolling(out, wa, wb, axis, radius, f, v_s):
    """Adds the couple that resists the turning of two bodies against each other about an axis: f N R, N their
    normal force, over its sign's speed v_s of the rolling speed omega R."""
    rate = dot(sub(wa, wb), axis) * radius
    most = f * out[12] * radius
    couple = most * sign_step(rate, v_s)
    for i in range(3):
        out[3 + i] -= couple * axis[i]
        out[9 + i] += couple * axis[i]
    out[14] += couple * rate / radius
    if out.size <= OUT or out[OUT] >= MOST_POINTS:
        return
    at = OUT + 1 + POINT * int(out[OUT])
    out[OUT] += 1.0
    for i in range(POINT):
        out[at + i] = 0.0
    out[at + 6], out[at + 7], out[at + 9], out[at + 16] = most, radius, rate, COUPLE
    for i in range(3):
        out[at + 17 + i] = axis[i]
