"""Poisson's effect of a plate: the coupling of the bushings around a corner where four boxes meet.

Up to two bushings along x and two along y lie around a corner, each for a quarter of the boxes there. Let a,
b be their rotations about y and x, and d, e their elongations along x and y. The corner then stores

    U = sum over i, j: bend_ij a_i b_j + stretch_ij d_i e_j

in addition to the energies of the bushings; i counts those along x, j those along y. Rotations and
elongations are those of `bushing`, in its middle frame, and so are forces and torques. U does not change
under a rigid motion of all bodies, and momentum is conserved.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.pack import OWN, Units
from mdlgen.mechanics.vector import (
    add,
    cross,
    dot,
    exp_rotation,
    log_rotation,
    mat,
    matmul,
    nine,
    rotate,
    scale,
    sub,
    three,
    transpose_matmul,
    vec,
)
from mdlgen.model.tables import Ints, Model
from mdlgen.program.kernel import BORROWS, FUSED, njit

# Coefficients of bushing i along x (0, 1) and j along y (2, 3) are in column 2 i + j - 2.
CORNER = np.dtype(
    [
        ("joint", "i8", 4),  # rows of the joints: two along x, two along y; -1: none
        ("bend", "f8", 4),
        ("stretch", "f8", 4),
        ("bend_damping", "f8", 4),
        ("stretch_damping", "f8", 4),
        ("sheet", "i8"),
        ("run", "i8"),  # number of the run of consecutive joints in a solver
    ]
)


@njit(cache=True, error_model="numpy", **BORROWS)
def axes_of(m, along_x):
    """Axis about which a bushing along x, or along y, bends, and the one along which it stretches, in m."""
    one, two = (m[0], m[3], m[6]), (m[1], m[4], m[7])
    return (two, one) if along_x else (one, two)


@njit(cache=True, error_model="numpy", **BORROWS)
def standing(joint, x, r):
    """Middle frame of a joint, its turn there, its gap, and both arms (global); see `bushing`."""
    a, b = joint.a, joint.b
    if a < 0:
        a = x.shape[0] - 1
    ma, mb = mat(r, a), mat(r, b)
    fa = matmul(ma, nine(joint.fa))
    theta = log_rotation(transpose_matmul(fa, matmul(mb, nine(joint.fb))))
    middle = matmul(fa, exp_rotation(scale(0.5, theta)))
    ra, rb = rotate(ma, three(joint.ra)), rotate(mb, three(joint.rb))
    return middle, theta, sub(add(vec(x, b), rb), add(vec(x, a), ra)), ra, rb


@njit(cache=True, error_model="numpy", **BORROWS)
def measured(joint, motion, along_x):
    """Turn, elongation, and their rates, of one joint."""
    x, r, u, w = motion
    middle, theta, gap, ra, rb = standing(joint, x, r)
    a, b = joint.a, joint.b
    if a < 0:
        a = x.shape[0] - 1
    about, along = axes_of(middle, along_x)
    wa, wb = vec(w, a), vec(w, b)
    rate = sub(add(vec(u, b), cross(wb, rb)), add(vec(u, a), cross(wa, ra)))
    rate = sub(rate, cross(scale(0.5, add(wa, wb)), gap))
    turn = theta[1] if along_x else theta[0]
    return turn, dot(gap, along), dot(sub(wb, wa), about), dot(rate, along)


@njit(cache=True, error_model="numpy", **BORROWS)
def pushed(joint, x, r, along_x, moment, brake, pull, f):
    """Adds to f (bodies, 6) the forces of a joint due to these: `moment` of springs and `brake` of dampers
    about its axis of bending, `pull` along its elongation."""
    middle, theta, gap, ra, rb = standing(joint, x, r)
    about, along = axes_of(middle, along_x)
    twist = (0.0, moment, 0.0) if along_x else (moment, 0.0, 0.0)
    angle2 = dot(theta, theta)
    if angle2 > 1e-12:
        # the gradient by the rotation vector, as in `bushing`
        half = 0.5 * math.sqrt(angle2)
        own = scale(dot(twist, theta) / angle2, theta)
        twist = add(own, scale(half / math.sin(half), sub(twist, own)))
    force = scale(-pull, along)
    torque = scale(-1.0, add(rotate(middle, twist), scale(brake, about)))
    on_b = add(torque, cross(sub(rb, scale(0.5, gap)), force))
    on_a = scale(-1.0, add(torque, cross(add(ra, scale(0.5, gap)), force)))
    a, b = joint.a, joint.b
    if a < 0:
        a = x.shape[0] - 1
    for i in range(3):
        f[a, i] -= force[i]
        f[b, i] += force[i]
        f[a, 3 + i] += on_a[i]
        f[b, 3 + i] += on_b[i]


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def corner_forces(joints, corner, motion, f):
    """Adds the forces of a corner to f (bodies, 6; the last row is the ground). Returns (stored energy,
    dissipated power)."""
    around = corner.joint
    none = (0.0, 0.0, 0.0, 0.0)
    x1 = measured(joints[around[0]], motion, True) if around[0] >= 0 else none
    x2 = measured(joints[around[1]], motion, True) if around[1] >= 0 else none
    y1 = measured(joints[around[2]], motion, False) if around[2] >= 0 else none
    y2 = measured(joints[around[3]], motion, False) if around[3] >= 0 else none
    stored = lost = 0.0
    for n in range(4):
        if around[n] < 0:
            continue
        if n < 2:
            k, l, own, one, two = 2 * n, 2 * n + 1, x1 if n == 0 else x2, y1, y2
        else:
            k, l, own, one, two = n - 2, n, y1 if n == 2 else y2, x1, x2
        moment = corner.bend[k] * one[0] + corner.bend[l] * two[0]
        brake = corner.bend_damping[k] * one[2] + corner.bend_damping[l] * two[2]
        spring = corner.stretch[k] * one[1] + corner.stretch[l] * two[1]
        drag = corner.stretch_damping[k] * one[3] + corner.stretch_damping[l] * two[3]
        stored += 0.5 * (moment * own[0] + spring * own[1])
        lost += brake * own[2] + drag * own[3]
        pushed(joints[around[n]], motion.x, motion.r, n < 2, moment, brake, spring + drag, f)
    return stored, lost


@njit(cache=True, error_model="numpy", **BORROWS)
def bodies_of(joints, corner, there):
    """Lists the bodies on which a corner acts, except the ground, in `there` (4,). Returns their number."""
    many = 0
    for row in corner.joint:
        if row < 0:
            continue
        for body in (joints[row].a, joints[row].b):
            new = body >= 0
            for k in range(many):
                new = new and there[k] != body
            if new:
                there[many] = body
                many += 1
    return many


def corners_of(model: Model, rows: Ints, units: Units = OWN) -> np.ndarray:
    """Corners of a Model for joints that are the bushings `rows` (joints,)."""
    table = model.corners
    place = np.full(len(model.bushings) + 1, -1)  # -1 stays none
    place[rows] = np.arange(len(rows))
    place[-1] = -1
    corners = np.zeros(len(table), CORNER)
    corners["joint"], corners["sheet"] = place[table.joint], table.sheet
    corners["bend"], corners["stretch"] = table.bend * units.mm, table.stretch * units.per_mm
    corners["bend_damping"] = table.bend_damping * units.mm * units.ms
    corners["stretch_damping"] = table.stretch_damping * units.per_mm * units.ms
    return corners


def renumbered(corners: np.ndarray, place: Ints) -> np.ndarray:
    """Corners whose joints have the new numbers `place` (joints,)."""
    new = corners.copy()
    joint = corners["joint"]
    new["joint"] = np.where(joint >= 0, place[joint], -1)
    return new
