"""Bending of a joint beyond its yield moment: a plastic hinge with kinematic hardening.

The rotation vector theta of a joint has one component t that bends the sheet. Its part p is plastic:

    M = k (t - p),    |M - H p| <= M_y,    dp has the sign of M - H p.

k: the elastic stiffness of the bushing, M_y: its yield moment, H: growth of the moment with p. From M_y on
the moment grows with t by k H/(k + H); it unloads by k. H p is the back moment: reversed yielding begins
where the moment has changed by 2 M_y. This is the law of Prager with linear hardening, in one dimension (Simo
and Hughes, Computational Inelasticity, sections 1.2 and 1.4; the return mapping is Box 1.5 there).

A step that ends at t maps back to

    p' = p + sign(x) (|x| - M_y)/(k + H),    x = k (t - p) - H p,    where |x| > M_y, else p' = p.

A rule that has its forces in the middle of a step (lattice) takes M = k (t_m - (p + p')/2) with p' of
t = 2 t_m - t_0: the moment is exact where nothing yields, and its growth with t_m is k H/(k + H). The work
M (t - t_0) of the step is the growth of k (t - p)^2/2 + H p^2/2, and (x_0 + x')/2 (p' - p), which is
dissipated. It is not negative, since x' = M_y sign(p' - p) and |x_0| <= M_y.

The torque of the bushing is k theta (mechanics.bushing). This module adds the torque of -k p.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.vector import (
    dot,
    exp_rotation,
    log_rotation,
    matmul,
    rotate,
    scale,
    sub,
    transpose_matmul,
)
from mdlgen.program.kernel import BORROWS, njit

HINGE = np.dtype(
    [
        ("joint", "i8"),  # number of it
        ("axis", "i8"),  # axis of its frame about which the sheet bends, 0: x, 1: y
        ("k", "f8"),  # [N mm/rad]
        ("moment", "f8"),  # M_y [N mm]
        ("hardening", "f8"),  # H [N mm/rad]
        ("plastic", "f8"),  # p, as the last accepted step left it [rad]
        ("begun", "f8"),  # t where the step begins [rad]
        ("lost", "f8"),  # dissipated so far [N mm]
    ]
)


@njit(cache=True, error_model="numpy", **BORROWS)
def bending(fa, fb, axis):
    """The component t [rad] of the rotation vector of frame fb against fa (row by row)."""
    theta = log_rotation(transpose_matmul(fa, fb))
    return theta[0] if axis == 0 else theta[1]


@njit(cache=True, error_model="numpy", **BORROWS)
def over(hinge, t, p):
    """M - H p at the rotation t with the plastic part p [N mm]."""
    return hinge.k * (t - p) - hinge.hardening * p


@njit(cache=True, error_model="numpy", **BORROWS)
def flowed(hinge, t):
    """The plastic part p' [rad] where a step ends at the rotation t [rad]."""
    x = over(hinge, t, hinge.plastic)
    if abs(x) <= hinge.moment:
        return hinge.plastic
    return hinge.plastic + math.copysign(abs(x) - hinge.moment, x) / (hinge.k + hinge.hardening)


@njit(cache=True, error_model="numpy", **BORROWS)
def in_the_middle(hinge, t):
    """(p + p')/2 of a step with the rotation t in its middle [rad]."""
    return 0.5 * (hinge.plastic + flowed(hinge, 2.0 * t - hinge.begun))


@njit(cache=True, error_model="numpy", **BORROWS)
def yields(hinge, t):
    """Tests whether a step that ends at the rotation t changes p."""
    return abs(over(hinge, t, hinge.plastic)) > hinge.moment


@njit(cache=True, error_model="numpy", **BORROWS)
def accept(hinge, begun, t):
    """Ends a step from the rotation `begun` to t: changes p. Returns the dissipated energy [N mm]."""
    after = flowed(hinge, t)
    change = after - hinge.plastic
    if change == 0.0:
        return 0.0
    lost = 0.5 * (over(hinge, begun, hinge.plastic) + over(hinge, t, after)) * change
    hinge.plastic = after
    hinge.lost += lost
    return lost


@njit(cache=True, error_model="numpy", **BORROWS)
def stored(hinge, t, p):
    """Energy of the hinge less that of its bushing without it, k t^2/2 [N mm]."""
    return hinge.k * p * (0.5 * p - t) + 0.5 * hinge.hardening * p * p


@njit(cache=True, error_model="numpy", **BORROWS)
def couple(fa, fb, axis, moment):
    """The torque on b, global axes [N mm], of a `moment` [N mm] that acts on the component t of the rotation
    vector; that on a is minus this. It is the gradient of moment t, as that of mechanics.bushing is."""
    theta = log_rotation(transpose_matmul(fa, fb))
    middle = matmul(fa, exp_rotation(scale(0.5, theta)))
    twist = (moment, 0.0, 0.0) if axis == 0 else (0.0, moment, 0.0)
    angle2 = dot(theta, theta)
    if angle2 > 1e-12:
        half = 0.5 * math.sqrt(angle2)
        along = scale(dot(twist, theta) / angle2, theta)
        sideways = scale(half / math.sin(half), sub(twist, along))
        twist = (along[0] + sideways[0], along[1] + sideways[1], along[2] + sideways[2])
    return rotate(middle, twist)
