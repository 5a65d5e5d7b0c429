"""Friction that sticks: a tangential spring at each corner of the overlap of two sheets' faces.

At a corner (mechanics.overlap) a spring of stiffness k_t holds the two faces. Its stretch z is their motion
along each other since they stuck, in the owner's axes. In a step of 2 h with the velocity v along the faces
in its middle

    z_1 = z_0 + 2 h v, brought back to |k_t z_1| <= mu N where it is beyond,    f = -k_t z_1.

This is the return mapping of Coulomb friction (Simo and Hughes, Computational Inelasticity, section 3.2). The
force is that of the stretch at the end of the step: the spring with a damper k_t h. The midpoint rule itself
damps nothing, and a stuck sheet would keep ringing. With that damper it is at rest within a step where its
spring is stiff for the step, and loses little energy where it is not. For a given N the force is the slope of
a convex function of v.

k_t is a constant of the pair, shared by its corners as k is. So the spring has its own energy, k_t z^2/2,
which does not change with the normal load, and dissipates the work that it does not store:

    2 h v . k_t z_1 - k_t (z_1^2 - z_0^2)/2 = k_t z_1 . (z_0 + 2 h v - z_1) + k_t (z_1 - z_0)^2/2 >= 0.

mu is the static coefficient up to the stiction velocity and goes to the dynamic one at the friction velocity.
At rest v = 0 and z_1 = z_0: the sheet does not move.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.laws import coefficient, damped
from mdlgen.mechanics.overlap import BY_SIDES, CLEAR, MOST_CORNERS, PRESSES, STIFF, moves, plane_of
from mdlgen.mechanics.point import (
    DEPTH,
    DISSIPATED,
    FORCE_A,
    FORCE_B,
    GRIP,
    PRESSING,
    RUBBING,
    STORED,
    TORQUE_A,
    TORQUE_B,
)
from mdlgen.mechanics.vector import add, back, cross, rotate, scale, sub
from mdlgen.program.kernel import BORROWS, FUSED, njit

STRETCH = np.dtype(
    [
        ("a", "i8"),  # boxes of the pair.
        ("b", "i8"),
        ("count", "i8"),  # corners with a stretch as the step begins, 0: the pair is new.
        ("first", "i8"),  # 1 if the first box owned the contact there.
        ("energy", "f8"),  # energy stored there [N mm].
        ("after", "f8"),  # energy as the step ends [N mm].
        ("corners", "f8", (MOST_CORNERS, 2)),  # in the owner's axes as the step begins [mm].
        ("begun", "f8", (MOST_CORNERS, 2)),  # their stretches: of the owner against the other box [mm].
        ("now", "f8", (MOST_CORNERS, 2)),  # stretches at the present corners (mechanics.overlap).
        ("ended", "f8", (MOST_CORNERS, 2)),  # stretches as the step ends.
    ]
)


@njit(cache=True, error_model="numpy", forceinline=True)
def limit_of(v_p, v_r, law):
    """Limit of friction per normal force, at a velocity along the faces."""
    speed = math.sqrt(v_p * v_p + v_r * v_r)
    return coefficient(speed, law.mu_static, law.mu_dynamic, law.stiction, law.sliding)


@njit(cache=True, error_model="numpy", **BORROWS)
def _seen_from(owner, other, p, r, z_p, z_r):
    """Place and stretch of a corner of one face, in the axes of the other box, whose stretch has the other
    sign."""
    at = back(other.r, sub(add(owner.x, rotate(owner.r, (p, r, 0.0))), other.x))
    z = back(other.r, rotate(owner.r, (-z_p, -z_r, 0.0)))
    return at[0], at[1], z[0], z[1]


@njit(cache=True, error_model="numpy", **BORROWS)
def carry_stretch(stuck, kept, a, b, ratio):
    """Carries the stretches at the beginning of the step to the new corners of two boxes (Frames): each takes
    that of the nearest old corner. All are reduced where they would store more energy. ratio: k_t/k
    [mm^0.5]."""
    energy = 0.0
    turned = stuck.first != kept.first
    was, becomes = (a, b) if stuck.first != 0 else (b, a)
    for corner in range(kept.count):
        nearest, least, z_p, z_r = -1, 1e300, 0.0, 0.0
        for k in range(stuck.count):
            p, r, s_p, s_r = stuck.corners[k, 0], stuck.corners[k, 1], stuck.begun[k, 0], stuck.begun[k, 1]
            if turned:  # the other face owns the contact now
                p, r, s_p, s_r = _seen_from(was, becomes, p, r, s_p, s_r)
            far = (p - kept.corners[corner, 0]) ** 2 + (r - kept.corners[corner, 1]) ** 2
            if far < least:
                nearest, least, z_p, z_r = k, far, s_p, s_r
        stuck.now[corner, 0], stuck.now[corner, 1] = z_p, z_r
        if nearest >= 0:
            energy += 0.5 * ratio * kept.corners[corner, STIFF] * (z_p * z_p + z_r * z_r)
    if energy > stuck.energy:
        less = math.sqrt(stuck.energy / energy)
        for corner in range(kept.count):
            stuck.now[corner, 0] *= less
            stuck.now[corner, 1] *= less


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def press_sticking(out, kept, stuck, a, b, law, ratio, h):
    """As overlap.press with friction that sticks, in the middle of a step of 2 h; 0: between steps. Writes
    the stretches at the end of the step into `stuck`. ratio: k_t/k [mm^0.5]."""
    first = kept.first != 0
    owner, other = (a, b) if first else (b, a)
    place, level, lean_p, lean_r = plane_of(kept, owner, other)
    deepest = 0.0
    for corner in range(kept.count):
        deepest = max(deepest, level + lean_p * kept.corners[corner, 0] + lean_r * kept.corners[corner, 1])
    if deepest <= 0.0:
        return CLEAR
    if deepest > kept.most:
        return BY_SIDES
    way = -kept.side  # of the owner's normal, from the other box to it
    rate, spin = moves(owner, other, place)
    force, torque = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    pressing = stored = lost = rubbing = after = taken = 0.0
    for corner in range(kept.count):
        p, r = kept.corners[corner, 0], kept.corners[corner, 1]
        depth = level + lean_p * p + lean_r * r
        stuck.ended[corner, 0] = stuck.ended[corner, 1] = 0.0
        if depth <= 0.0:
            continue
        at = (p, r, kept.side * (kept.thick - 0.5 * depth))
        spring = kept.corners[corner, STIFF] * depth * math.sqrt(depth)
        v = add(rate, cross(spin, at))
        closes = -way * v[2]
        normal = damped(spring, closes, law.beta, law.smoothing)
        k_t = ratio * kept.corners[corner, STIFF]
        z_p, z_r = stuck.now[corner, 0] + 2.0 * h * v[0], stuck.now[corner, 1] + 2.0 * h * v[1]
        size = math.sqrt(z_p * z_p + z_r * z_r)
        limit = limit_of(v[0], v[1], law) * normal
        if k_t * size > limit:
            part = limit / (k_t * size)
            z_p, z_r, size = part * z_p, part * z_r, part * size
        stuck.ended[corner, 0], stuck.ended[corner, 1] = z_p, z_r
        f = (-k_t * z_p, -k_t * z_r, way * normal)
        force, torque = add(force, f), add(torque, cross(at, f))
        pressing += normal
        stored += 0.4 * spring * depth
        lost += (normal - spring) * closes
        rubbing += k_t * size
        after += 0.5 * k_t * size * size
        taken += k_t * (z_p * v[0] + z_r * v[1])
    stuck.after = after
    if h > 0.0:
        lost += taken - (after - stuck.energy) / (2.0 * h)
    back_on = sub(cross(place, force), torque)  # on the other box, about its own centre
    force, torque, back_on = rotate(owner.r, force), rotate(owner.r, torque), rotate(owner.r, back_on)
    sign = 1.0 if first else -1.0
    on_a, on_b = (torque, back_on) if first else (back_on, torque)
    for i in range(3):
        out[FORCE_A + i], out[FORCE_B + i] = sign * force[i], -sign * force[i]
        out[TORQUE_A + i], out[TORQUE_B + i] = on_a[i], on_b[i]
    out[PRESSING], out[STORED], out[DISSIPATED], out[DEPTH] = pressing, stored, lost, deepest
    out[RUBBING], out[GRIP] = rubbing, law.mu_static * pressing
    return PRESSES if pressing != 0.0 else CLEAR


@njit(cache=True, error_model="numpy", **BORROWS)
def stretch_of(stuck, kept, owner, corner):
    """Stretch of a corner as the step begins, of the first box against the second, global [mm]."""
    z = rotate(owner.r, (stuck.now[corner, 0], stuck.now[corner, 1], 0.0))
    return z if kept.first != 0 else scale(-1.0, z)


@njit(cache=True, error_model="numpy", **BORROWS)
def end_step(stuck, kept, a, b):
    """Ends a step: sets the stretches of a pair of bodies a and b to those at its end."""
    stuck.a, stuck.b, stuck.first, stuck.count, stuck.energy = a, b, kept.first, kept.count, stuck.after
    for corner in range(kept.count):
        for i in range(2):
            stuck.corners[corner, i] = kept.corners[corner, i]
            stuck.begun[corner, i] = stuck.now[corner, i] = stuck.ended[corner, i]


@njit(cache=True, error_model="numpy", **BORROWS)
def let_go(stuck):
    """Resets a pair that has come apart. Returns the energy that its springs had."""
    energy = stuck.energy
    stuck.count, stuck.energy = 0, 0.0
    for corner in range(MOST_CORNERS):
        for i in range(2):
            stuck.begun[corner, i] = stuck.now[corner, i] = 0.0
    return energy
