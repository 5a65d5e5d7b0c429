"""Decrease of the force of one contact point per motion of its bodies: the 3 x 3 matrices of a tangent."""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import LAW_SLIDING, LAW_SMOOTHING, LAW_STICTION
from mdlgen.mechanics.laws import coefficient, held_over_speed
from mdlgen.mechanics.point import (
    ALONE,
    BETA,
    FORCE,
    GROWTH,
    HOLD,
    KIND,
    MOST_COUPLE,
    MU_DYNAMIC,
    MU_STATIC,
    OVER,
    RADIUS,
    RATE,
    ROLLING,
    SPRING,
)
from mdlgen.mechanics.vector import add, dot, scale
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", forceinline=True)
def outer(p, q):
    """p q^T, row by row."""
    x, y, z = q
    return (p[0] * x, p[0] * y, p[0] * z, p[1] * x, p[1] * y, p[1] * z, p[2] * x, p[2] * y, p[2] * z)


@njit(cache=True, error_model="numpy", forceinline=True)
def hat_right(t, q):
    """t [q]x, t a matrix row by row."""
    x, y, z = q
    return (
        t[1] * z - t[2] * y,
        t[2] * x - t[0] * z,
        t[0] * y - t[1] * x,
        t[4] * z - t[5] * y,
        t[5] * x - t[3] * z,
        t[3] * y - t[4] * x,
        t[7] * z - t[8] * y,
        t[8] * x - t[6] * z,
        t[6] * y - t[7] * x,
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def hat_left(q, t):
    """[q]x t."""
    x, y, z = q
    return (
        y * t[6] - z * t[3],
        y * t[7] - z * t[4],
        y * t[8] - z * t[5],
        z * t[0] - x * t[6],
        z * t[1] - x * t[7],
        z * t[2] - x * t[8],
        x * t[3] - y * t[0],
        x * t[4] - y * t[1],
        x * t[5] - y * t[2],
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def steepness(y, v_s, chord):
    """Slope, with weight `chord` of the secant, of a force that changes sign over v_s, at v = y v_s.

    Damping and friction grow steeply at small speeds and hardly at all at large ones. A Newton step along the
    tangent of the flat part would overshoot to the other side, and back; a step along the secant through zero
    ends at zero. With enough weight of the secant it converges from both sides.
    """
    if abs(y) < 1.0:
        return max(1.5 * (1.0 - y * y), chord * 0.5 * (3.0 - y * y)) / v_s
    return chord / abs(y * v_s)


@njit(cache=True, error_model="numpy", **BORROWS)
def couple_growth(out, at, h, law, chord):
    """Decrease of the couple of rolling resistance per relative angular velocity, times h."""
    v_n = law[LAW_SMOOTHING]
    return h * out[at + MOST_COUPLE] * out[at + RADIUS] * steepness(out[at + ROLLING] / v_n, v_n, chord)


class Numbers(NamedTuple):
    """Values of one contact point from which its slopes follow. In order: the elastic force; its growth with
    depth; the normal force that limits friction; the rate that damps it; the speed over which it does; the
    share of damping; both coefficients of friction; their speeds; the stiffness of a spring of friction (see
    laws), 0: none; `alone`: true if its own rate damps it."""

    spring: float
    growth: float
    force: float
    rate: float
    over: float
    beta: float
    mu_static: float
    mu_dynamic: float
    stiction: float
    sliding: float
    hold: float
    alone: bool


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def numbers_of(out, at, law):
    """Numbers of a point as a force law leaves it in `out` (see mechanics.point)."""
    return Numbers(
        out[at + SPRING],
        out[at + GROWTH],
        out[at + FORCE],
        out[at + RATE],
        out[at + OVER],
        # a rim may have its own
        out[at + BETA],
        out[at + MU_STATIC],
        out[at + MU_DYNAMIC],
        law[LAW_STICTION],
        law[LAW_SLIDING],
        out[at + HOLD],
        out[at + KIND] == ALONE,
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def rubbing(numbers, speed, h, chord):
    """Growth of a point's friction with the slip velocity, across that and along it, times h."""
    _spring, _growth, force, _rate, _v_n, _beta, mu_static, mu_dynamic, v_s, v_d, hold, _alone = numbers
    secant = tangent = 0.0
    if force > 0.0 and (mu_static > 0.0 or mu_dynamic > 0.0):
        if hold > 0.0:
            secant = held_over_speed(speed, hold, mu_static)
            tangent = hold if secant == hold else 0.0
        elif speed < v_s:
            z = speed / v_s
            secant = 0.5 * mu_static * (3.0 - z * z) / v_s
            tangent = 1.5 * mu_static * (1.0 - z * z) / v_s
        else:
            secant = coefficient(speed, mu_static, mu_dynamic, v_s, v_d) / speed
        secant, tangent = h * force * secant, h * force * max(tangent, chord * secant)
    return secant, tangent


@njit(cache=True, error_model="numpy", **BORROWS)
def core(numbers, n, square, slip, h, chord, whole):
    """Decrease of the force of one contact point per relative velocity, times h.

    Returns a 3 x 3 matrix for the velocity at the point; the decrease of the normal force per closing rate of
    the contact line, where a nip damps it, else 0; friction per slip velocity and per normal force.

    n: the normal; square: the direction that friction is perpendicular to, which is the normal, or a nip's;
    `whole`: with the growth of friction with the normal force, which is not symmetric.
    """
    spring, growth, force, rate, v_n, beta, _s, _d, _v_s, _v_d, _hold, alone = numbers
    y = rate / v_n
    sign = 0.5 * y * (3.0 - y * y) if abs(y) < 1.0 else math.copysign(1.0, y)
    damping = h * spring * beta * steepness(y, v_n, chord)
    normal = h * h * growth * (1.0 + beta * sign)
    if alone:
        normal += damping
        damping = 0.0
    speed = math.sqrt(slip[0] * slip[0] + slip[1] * slip[1] + slip[2] * slip[2])
    secant, tangent = rubbing(numbers, speed, h, chord)
    i = 1.0 / speed if speed > 0.0 else 0.0
    d = (slip[0] * i, slip[1] * i, slip[2] * i)
    less = tangent - secant
    # the force is F (n - phi slip), phi = mu/speed: as F grows with the depth, so does the drag
    phi = secant / (h * force) if whole and force > 0.0 else 0.0
    drag = normal * phi
    p = (normal * n[0] - drag * slip[0], normal * n[1] - drag * slip[1], normal * n[2] - drag * slip[2])
    s = scale(secant, square)
    t = (
        secant + p[0] * n[0] - s[0] * square[0] + less * d[0] * d[0],
        p[0] * n[1] - s[0] * square[1] + less * d[0] * d[1],
        p[0] * n[2] - s[0] * square[2] + less * d[0] * d[2],
        p[1] * n[0] - s[1] * square[0] + less * d[1] * d[0],
        secant + p[1] * n[1] - s[1] * square[1] + less * d[1] * d[1],
        p[1] * n[2] - s[1] * square[2] + less * d[1] * d[2],
        p[2] * n[0] - s[2] * square[0] + less * d[2] * d[0],
        p[2] * n[1] - s[2] * square[1] + less * d[2] * d[1],
        secant + p[2] * n[2] - s[2] * square[2] + less * d[2] * d[2],
    )
    return t, damping, phi


@njit(cache=True, error_model="numpy", **BORROWS)
def holding(t, pulled, limit, k_t, n, h, chord):
    """Adds to t, a 3 x 3 matrix, what friction that sticks loses as velocities grow, times h: a spring k_t
    along the faces that is `pulled` by a force, beyond its limit where it slides. n: the normal; chord: see
    steepness."""
    size = math.sqrt(pulled[0] * pulled[0] + pulled[1] * pulled[1] + pulled[2] * pulled[2])
    growth = less = 2.0 * h * h * k_t
    if size > limit:
        growth *= limit / size
        less = chord * growth
    i = 1.0 / size if size > 0.0 else 0.0
    across, along = outer(scale(growth, n), n), outer(scale((less - growth) * i * i, pulled), pulled)
    return (
        t[0] + growth - across[0] + along[0],
        t[1] - across[1] + along[1],
        t[2] - across[2] + along[2],
        t[3] - across[3] + along[3],
        t[4] + growth - across[4] + along[4],
        t[5] - across[5] + along[5],
        t[6] - across[6] + along[6],
        t[7] - across[7] + along[7],
        t[8] + growth - across[8] + along[8],
    )


@njit(cache=True, error_model="numpy", **BORROWS)
def core_stretched(numbers, n, square, w, g, h, chord, whole):
    """As `core` where friction depends on the direction of the sheet (mechanics.measured): w is the stretched
    slip velocity, and g the stretch along the faces. With f = -phi A w, and A = P + g g^T, the decrease of
    friction per slip velocity is A K A, where K is that per w."""
    speed = math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    secant, tangent = rubbing(numbers, speed, h, chord)
    i = 1.0 / speed if speed > 0.0 else 0.0
    pull = add(w, scale(dot(g, w), g))
    d, more = scale(i, pull), 2.0 + dot(g, g)
    spring, growth, force, rate, over, beta, _s, _d, v_s, v_d, hold, alone = numbers
    smooth = Numbers(spring, growth, force, rate, over, beta, 0.0, 0.0, v_s, v_d, hold, alone)
    t, damping, _ = core(smooth, n, square, w, h, chord, whole)
    phi = secant / (h * force) if whole and force > 0.0 else 0.0
    # without friction core is normal n n^T
    drag = scale(-phi * (t[0] + t[4] + t[8]), pull)
    across, along = outer(scale(secant, square), square), outer(scale(secant * more, g), g)
    less, grows = outer(scale(tangent - secant, d), d), outer(drag, n)
    return (
        (
            t[0] + secant - across[0] + along[0] + less[0] + grows[0],
            t[1] - across[1] + along[1] + less[1] + grows[1],
            t[2] - across[2] + along[2] + less[2] + grows[2],
            t[3] - across[3] + along[3] + less[3] + grows[3],
            t[4] + secant - across[4] + along[4] + less[4] + grows[4],
            t[5] - across[5] + along[5] + less[5] + grows[5],
            t[6] - across[6] + along[6] + less[6] + grows[6],
            t[7] - across[7] + along[7] + less[7] + grows[7],
            t[8] + secant - across[8] + along[8] + less[8] + grows[8],
        ),
        damping,
        phi,
    )
