"""Places and velocities of all bodies at the solver's coordinates; the body of each coordinate; generalised
forces of forces at bodies."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.exudyn_local.system import EULER, System
from mdlgen.mechanics.arm import (
    moved,
    turn_of,
    way_of,
)
from mdlgen.mechanics.driven import prescribed, turned
from mdlgen.mechanics.gate import GATE, gate_at
from mdlgen.mechanics.records import ALONE
from mdlgen.mechanics.vector import (
    dot,
    exp_rotation,
    mat,
    matmul,
    scale,
    three,
    vec,
)
from mdlgen.model.tables import Ints
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy", forceinline=True)
def place_body(bodies, body, at, motion):
    """Position, rotation, velocity and angular velocity (global) of one body at some Coordinates."""
    q, v, t = at
    x, r, u, w = motion
    ref = bodies[body].reference
    for i in range(3):
        x[body, i] = ref[i]
        u[body, i] = 0.0
        w[body, i] = 0.0
    e0, e1, e2, e3 = ref[EULER], ref[EULER + 1], ref[EULER + 2], ref[EULER + 3]
    n = bodies[body].first
    if n >= 0:
        for i in range(3):
            x[body, i] += q[n + i]
            u[body, i] = v[n + i]
        e0 += q[n + EULER]
        e1 += q[n + EULER + 1]
        e2 += q[n + EULER + 2]
        e3 += q[n + EULER + 3]
        d0, d1, d2, d3 = v[n + EULER], v[n + EULER + 1], v[n + EULER + 2], v[n + EULER + 3]
        w[body, 0] = 2 * (-e1 * d0 + e0 * d1 - e3 * d2 + e2 * d3)
        w[body, 1] = 2 * (-e2 * d0 + e3 * d1 + e0 * d2 - e1 * d3)
        w[body, 2] = 2 * (-e3 * d0 - e2 * d1 + e1 * d2 + e0 * d3)
    r[body, 0] = 1 - 2 * (e2 * e2 + e3 * e3)
    r[body, 1] = 2 * (e1 * e2 - e0 * e3)
    r[body, 2] = 2 * (e1 * e3 + e0 * e2)
    r[body, 3] = 2 * (e1 * e2 + e0 * e3)
    r[body, 4] = 1 - 2 * (e1 * e1 + e3 * e3)
    r[body, 5] = 2 * (e2 * e3 - e0 * e1)
    r[body, 6] = 2 * (e1 * e3 - e0 * e2)
    r[body, 7] = 2 * (e2 * e3 + e0 * e1)
    r[body, 8] = 1 - 2 * (e1 * e1 + e2 * e2)
    if bodies[body].swings >= GATE:
        gate_at(bodies[body], body, 0.0, t, x, r, motion)
        return
    k = bodies[body].slide
    if k >= 0:
        place = moved(bodies[body], vec(x, body), q[k])
        way = way_of(bodies[body], place)
        for i in range(3):
            x[body, i] = place[i]
            u[body, i] += v[k] * way[i]
    spin, ratio = bodies[body].spin, bodies[body].ratio
    if bodies[body].rims > 0:
        angle = ratio * q[spin] if spin >= 0 else turned(bodies[body], t)
        if bodies[body].swings == 2:
            angle += q[k]
        m = matmul(exp_rotation(scale(angle, three(bodies[body].axis))), mat(r, body))
        for i in range(9):
            r[body, i] = m[i]
    rate = ratio * v[spin] if spin >= 0 else prescribed(bodies[body], t)
    if bodies[body].swings == 2:
        rate += v[k]
    for i in range(3):
        w[body, i] += rate * bodies[body].axis[i]
    if bodies[body].carries != 0:  # the rotation matters for a roller with a mesh, and for a plate that turns
        angle = ratio * q[spin] if spin >= 0 else turned(bodies[body], t)
        if bodies[body].swings == 2:
            angle += q[k]
        m = matmul(exp_rotation(scale(angle, three(bodies[body].axis))), mat(r, body))
        for i in range(9):
            r[body, i] = m[i]


@njit(cache=True, error_model="numpy")
def place_owner(bodies, body, at, motion):
    """As place_body; for a roller on a shaft, also all rollers that turn with it."""
    place_body(bodies, body, at, motion)
    if bodies[body].coupled != ALONE:
        for other in range(bodies.size - 1):
            if other != body and bodies[other].spin == bodies[body].spin:
                place_body(bodies, other, at, motion)


@njit(cache=True, error_model="numpy")
def place_all(bodies, at, motion):
    """The Motion of all bodies at some Coordinates."""
    for body in range(bodies.size):
        place_body(bodies, body, at, motion)


@njit(cache=True, error_model="numpy", forceinline=True)
def spread(bodies, body, q, force, torque, f):
    """Adds a force and a torque at a body's centre to the generalised forces."""
    n = bodies[body].first
    if n >= 0:
        ref = bodies[body].reference
        e0, e1, e2, e3 = (
            ref[EULER] + q[n + EULER],
            ref[EULER + 1] + q[n + EULER + 1],
            ref[EULER + 2] + q[n + EULER + 2],
            ref[EULER + 3] + q[n + EULER + 3],
        )
        for i in range(3):
            f[n + i] += force[i]
        a, b, c = torque
        f[n + EULER] += 2 * (-e1 * a - e2 * b - e3 * c)
        f[n + EULER + 1] += 2 * (e0 * a + e3 * b - e2 * c)
        f[n + EULER + 2] += 2 * (-e3 * a + e0 * b + e1 * c)
        f[n + EULER + 3] += 2 * (e2 * a - e1 * b + e0 * c)
        return
    if bodies[body].slide >= 0:
        ref = bodies[body].reference
        at = moved(bodies[body], (ref[0], ref[1], ref[2]), q[bodies[body].slide])
        f[bodies[body].slide] += dot(force, way_of(bodies[body], at)) + dot(torque, turn_of(bodies[body]))
    if bodies[body].spin >= 0:
        f[bodies[body].spin] += bodies[body].ratio * dot(torque, three(bodies[body].axis))


@njit(cache=True, error_model="numpy")
def set_owners(bodies, owner):
    """Body of each coordinate."""
    for body in range(bodies.size):
        n = bodies[body].first
        if n >= 0:
            for i in range(7):
                owner[n + i] = body
        if bodies[body].slide >= 0:
            owner[bodies[body].slide] = body
        if bodies[body].spin >= 0:
            owner[bodies[body].spin] = body


def owners(system: System) -> Ints:
    """Body of each coordinate."""
    # coordinates of patches and of air belong to no body; the ground, the last one, does not move
    owner = np.full(system.free, len(system.bodies) - 1, np.int64)
    set_owners(system.bodies, owner)
    return owner
