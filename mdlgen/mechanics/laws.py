"""Scalar laws of contact: normal force and friction (paper section 3.2)."""

from __future__ import annotations

from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def sign_step(v, v_s):
    """Smooth sign of a speed: -1 below -v_s, +1 above v_s, the cubic STEP of multibody codes between."""
    x = v / v_s
    if x >= 1.0:
        return 1.0
    if x <= -1.0:
        return -1.0
    return 0.5 * x * (3.0 - x * x)


@njit(cache=True, error_model="numpy")
def damping_share(restitution):
    """beta = (1 - c_R^2)/(1 + c_R^2) of Eq. 11."""
    return (1.0 - restitution * restitution) / (1.0 + restitution * restitution)


@njit(cache=True, error_model="numpy")
def damped(spring, rate, beta, v_n):
    """Eqs. 9 and 11: the elastic force times 1 + beta s(rate), rate the growth of the depth.

    Never negative, since beta <= 1.
    """
    return spring * (1.0 + beta * sign_step(rate, v_n))


@njit(cache=True, error_model="numpy", forceinline=True)
def coefficient(v, mu_s, mu_d, v_s, v_d):
    """Coefficient of friction at a speed along the faces: mu_s up to v_s, mu_d from v_d on, the cubic STEP
    between."""
    if v <= v_s:
        return mu_s
    if v >= v_d:
        return mu_d
    x = (v - v_s) / (v_d - v_s)
    return mu_s + (mu_d - mu_s) * x * x * (3.0 - 2.0 * x)


@njit(cache=True, error_model="numpy")
def of_table(v, curve, first, many):
    """A coefficient at a speed by a table, `many` times (speed, coefficient, slope) from curve[first] on: the
    cubic through two points with their slopes, which without slopes is the STEP of `coefficient`; beyond the
    ends as there."""
    last = first + 3 * (many - 1)
    if v >= curve[last]:
        return curve[last + 1]
    at = first
    while at + 3 < last and v >= curve[at + 3]:
        at += 3
    low, high = curve[at], curve[at + 3]
    value = coefficient(v, curve[at + 1], curve[at + 4], low, high)
    if v <= low:
        return value
    x = (v - low) / (high - low)
    return value + (v - low) * (1.0 - x) * ((1.0 - x) * curve[at + 2] - x * curve[at + 5])


@njit(cache=True, error_model="numpy")
def friction_over_speed(v, mu_s, mu_d, v_s, v_d):
    """mu(v)/v of the regularised Coulomb law (Eq. 12), finite at v = 0.

    mu rises to mu_s at v_s by the cubic STEP and goes to mu_d at v_d by another.
    """
    if v <= v_s:
        x = v / v_s
        return mu_s * 0.5 * (3.0 - x * x) / v_s
    return coefficient(v, mu_s, mu_d, v_s, v_d) / v


@njit(cache=True, error_model="numpy", forceinline=True)
def held_over_speed(v, hold, mu):
    """Friction of a spring per normal force and per speed: `hold`, and mu/v above its limit mu (see
    mechanics.bristle)."""
    return hold if hold * v <= mu else mu / v
