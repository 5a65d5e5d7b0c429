"""The bushing: six springs and dampers between two bodies, right for any rotation.

Displacement and rotation are measured in the frame halfway between the two bodies' frames, and the force
acts at the point halfway between the two attachment points. So the law does not depend on which body is
called the first, is unchanged when the world is rotated, and conserves linear and angular momentum.
"""

from __future__ import annotations

import math

from mdlgen.mechanics.vector import (
    add,
    back,
    cross,
    dot,
    exp_rotation,
    log_rotation,
    matmul,
    rotate,
    scale,
    sines,
    sub,
    transpose_matmul,
    turned,
)
from mdlgen.program.kernel import FUSED, njit


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def bushing(a, ra, b, rb, k, kt, c, ct):
    """Force and torque that a bushing puts on body b at its centre, and the torque on body a.

    Args: a and b, Frames of the bodies' centres with the bushing's axes on each body in place of the body's;
    ra and rb, arms from the centres to the attachments (global); k, kt, c, ct: tuples along the bushing's
    axes.

    Returns (force on b, torque on b, torque on a, stored energy, dissipated power); the force on a is
    minus the force on b. Stored energy is 1/2 d.K d + 1/2 theta.K_t theta with theta the rotation vector;
    the torque is its exact gradient in theta.
    """
    relative = transpose_matmul(a.r, b.r)
    theta = log_rotation(relative)
    middle = matmul(a.r, exp_rotation(scale(0.5, theta)))
    gap = sub(add(b.x, rb), add(a.x, ra))
    rate = sub(add(b.v, cross(b.w, rb)), add(a.v, cross(a.w, ra)))
    # the rate of the gap as seen from the middle frame, which turns with the mean of the two
    rate = sub(rate, cross(scale(0.5, add(a.w, b.w)), gap))
    d, v = back(middle, gap), back(middle, rate)
    w = back(middle, sub(b.w, a.w))
    spring = (k[0] * d[0], k[1] * d[1], k[2] * d[2])
    damper = (c[0] * v[0], c[1] * v[1], c[2] * v[2])
    twist = (kt[0] * theta[0], kt[1] * theta[1], kt[2] * theta[2])
    brake = (ct[0] * w[0], ct[1] * w[1], ct[2] * w[2])
    energy = 0.5 * (dot(d, spring) + dot(theta, twist))
    power = dot(v, damper) + dot(w, brake)
    angle2 = dot(theta, theta)
    if angle2 > 1e-12:
        # gradient of 1/2 theta.K theta in the middle frame: across theta it grows as (t/2)/sin(t/2)
        half = 0.5 * math.sqrt(angle2)
        along = scale(dot(twist, theta) / angle2, theta)
        twist = add(along, scale(half / math.sin(half), sub(twist, along)))
    force = scale(-1.0, rotate(middle, add(spring, damper)))
    torque = scale(-1.0, rotate(middle, add(twist, brake)))
    torque_b = add(torque, cross(sub(rb, scale(0.5, gap)), force))
    torque_a = scale(-1.0, add(torque, cross(add(ra, scale(0.5, gap)), force)))
    return force, torque_b, torque_a, energy, power


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def bushing_pair(a, ra, b, rb, e, k, kt, c, ct):
    """Two equal bushings side by side, at e and -e (bushing axes) from the ends of the arms ra and rb.

    Args and result as of `bushing`, with k, kt, c, ct the sums of both; the same forces as the two have,
    since their rotation is the same and their gaps are d + D and d - D, D = (Q - Q^T) e, with Q half of the
    relative rotation. With e = 0 it is one bushing. Also returns the middle frame, the gap, and the power of
    dampers that have the stiffness for a damping, over 1 ms.
    """
    relative = transpose_matmul(a.r, b.r)
    theta = log_rotation(relative)
    angle2 = dot(theta, theta)
    # of half the angle: its sine and its versine over it
    sine, versine = sines(0.25 * angle2)
    middle = matmul(a.r, turned(scale(0.5, theta), sine, versine))
    gap = sub(add(b.x, rb), add(a.x, ra))
    rate = sub(add(b.v, cross(b.w, rb)), add(a.v, cross(a.w, ra)))
    rate = sub(rate, cross(scale(0.5, add(a.w, b.w)), gap))
    d, v = back(middle, gap), back(middle, rate)
    w = back(middle, sub(b.w, a.w))
    apart = scale(sine, cross(theta, e))
    arm = add(scale(1.0 - 0.25 * angle2 * versine, e), scale(0.25 * versine * dot(theta, e), theta))
    parting = cross(w, arm)
    spring = (k[0] * d[0], k[1] * d[1], k[2] * d[2])
    damper = (c[0] * v[0], c[1] * v[1], c[2] * v[2])
    spread = (k[0] * apart[0], k[1] * apart[1], k[2] * apart[2])
    drag = (c[0] * parting[0], c[1] * parting[1], c[2] * parting[2])
    twist = (kt[0] * theta[0], kt[1] * theta[1], kt[2] * theta[2])
    brake = (ct[0] * w[0], ct[1] * w[1], ct[2] * w[2])
    energy = 0.5 * (dot(d, spring) + dot(apart, spread) + dot(theta, twist))
    power = dot(v, damper) + dot(parting, drag) + dot(w, brake)
    per_time = 0.0
    for i in range(3):
        per_time += k[i] * (v[i] * v[i] + parting[i] * parting[i]) + kt[i] * w[i] * w[i]
    if angle2 > 1e-12:
        along = scale(dot(twist, theta) / angle2, theta)
        twist = add(along, scale(1.0 / sine, sub(twist, along)))
    force = scale(-1.0, rotate(middle, add(spring, damper)))
    couple = add(add(twist, brake), cross(arm, add(spread, drag)))
    torque = scale(-1.0, rotate(middle, couple))
    torque_b = add(torque, cross(sub(rb, scale(0.5, gap)), force))
    torque_a = scale(-1.0, add(torque, cross(add(ra, scale(0.5, gap)), force)))
    return force, torque_b, torque_a, energy, power, middle, gap, per_time
