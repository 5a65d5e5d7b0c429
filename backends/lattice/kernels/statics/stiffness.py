"""Stiffness of a state at rest: the derivative of the forces of joints, loads and contacts.

It is exact except for torques out of balance, which make it unsymmetric: its symmetric part is used.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.lattice.kernels.linear.dense import copy
from mdlgen.backends.lattice.kernels.tuning import DIFFERENCE
from mdlgen.mechanics.arm import STIFFNESS
from mdlgen.mechanics.corner import bodies_of, corner_forces
from mdlgen.mechanics.curve import curve_spring
from mdlgen.mechanics.pair import pair_force
from mdlgen.mechanics.point import OUT
from mdlgen.mechanics.vector import (
    add,
    back,
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
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def _hinge(theta, e, k):
    """Couple of a joint rotated by theta, in its middle frame, and its derivative with respect to the
    rotation of one body against the other (row by row); see mechanics.bushing.bushing_pair."""
    t2 = dot(theta, theta)
    # sine and cosine of half the angle, the one over it, and their derivatives by t2 (with a dash: 1)
    if t2 > 1e-4:
        half = 0.5 * math.sqrt(t2)
        s, c = math.sin(half) / half, math.cos(half)
        s1, curl = 0.5 * (c - s) / t2, (1.0 - c) / t2
        curl1 = (0.125 * s - curl) / t2
        beta = (1.0 - 1.0 / s) / t2
        beta1 = (s1 / (s * s) - beta) / t2
    else:
        s, c = 1.0 - t2 / 24, 1.0 - t2 / 8
        s1, curl = t2 / 960 - 1.0 / 24, 0.125 - t2 / 384
        curl1 = t2 / 23040 - 1.0 / 384
        beta, beta1 = -1.0 / 24 - 7.0 * t2 / 5760, -7.0 / 5760
    c1, alpha, alpha1 = -0.125 * s, 1.0 / s, -s1 / (s * s)
    twist = (k[3] * theta[0], k[4] * theta[1], k[5] * theta[2])
    across, te, along = cross(theta, e), dot(theta, e), dot(theta, twist)
    arm = add(scale(c, e), scale(curl * te, theta))
    spread = (k[0] * s * across[0], k[1] * s * across[1], k[2] * s * across[2])
    couple = add(add(scale(alpha, twist), scale(beta * along, theta)), cross(arm, spread))
    growth = np.empty(9)
    for i in range(3):
        b = beta * theta[i]
        turn = (
            b * theta[0] + (alpha if i == 0 else 0.0),
            b * theta[1] + (alpha if i == 1 else 0.0),
            b * theta[2] + (alpha if i == 2 else 0.0),
        )
        t = 2.0 * dot(theta, turn)
        more = (k[3] * turn[0], k[4] * turn[1], k[5] * turn[2])
        much = beta1 * t * along + beta * (dot(turn, twist) + dot(theta, more))
        g = add(scale(alpha, more), scale(alpha1 * t, twist))
        g = add(g, add(scale(much, theta), scale(beta * along, turn)))
        lift = add(scale(s1 * t, across), scale(s, cross(turn, e)))
        lift = (k[0] * lift[0], k[1] * lift[1], k[2] * lift[2])
        bow = add(scale(c1 * t, e), scale(curl1 * t * te + curl * dot(turn, e), theta))
        g = add(g, add(cross(add(bow, scale(curl * te, turn)), spread), cross(arm, lift)))
        for j in range(3):
            growth[3 * j + i] = g[j]
    return couple, nine(growth)


@njit(cache=True, error_model="numpy", forceinline=True)
def _unit(i):
    return (1.0 if i == 0 else 0.0, 1.0 if i == 1 else 0.0, 1.0 if i == 2 else 0.0)


@njit(cache=True, error_model="numpy", forceinline=True)
def _stretch(m, k, gap):
    """Force of springs k in the frame m [N]."""
    d = back(m, gap)
    return rotate(m, (k[0] * d[0], k[1] * d[1], k[2] * d[2]))


@njit(cache=True, error_model="numpy")
def _growth(joint, points, gap, x, r, one, g):
    """Derivative of the forces on both bodies of a joint (6 and 6) with the gap `gap`: a row of g (12, 12)
    for each motion of the bodies."""
    two = joint.b
    ma, mb = mat(r, one), mat(r, two)
    fa = matmul(ma, nine(joint.fa))
    theta = log_rotation(transpose_matmul(fa, matmul(mb, nine(joint.fb))))
    m = matmul(fa, exp_rotation(scale(0.5, theta)))
    ra, rb = rotate(ma, three(joint.ra)), rotate(mb, three(joint.rb))
    apart = sub(vec(x, two), vec(x, one))
    couple, growth = _hinge(theta, three(joint.e), joint.k)
    # on a curve the force is that of the secant, and its growth is the slope
    chord, k = three(joint.k), three(joint.k)
    if joint.first >= 0:
        own = back(m, gap)
        opened = own[0] if joint.way == 0 else own[1]
        spring, slope, _ = curve_spring(points, joint, opened)
        steep = spring / opened if opened != 0.0 else slope
        chord = (steep, k[1], k[2]) if joint.way == 0 else (k[0], steep, k[2])
        k = (slope, k[1], k[2]) if joint.way == 0 else (k[0], slope, k[2])
    force, torque = scale(-1.0, _stretch(m, chord, gap)), scale(-1.0, rotate(m, couple))
    qa, qb = add(ra, scale(0.5, gap)), sub(rb, scale(0.5, gap))
    on_b, on_a = add(torque, cross(qb, force)), scale(-1.0, add(torque, cross(qa, force)))
    # the middle frame turns with the mean of both bodies, and a little across
    angle2 = dot(theta, theta)
    angle = math.sqrt(angle2)
    lag = 0.5 * math.tan(0.25 * angle) / angle if angle > 1e-3 else 0.125 + angle2 / 384
    for i in range(6):
        if i < 3:
            opens = _unit(i)
            more = scale(-1.0, _stretch(m, k, opens))
            change = (0.0, 0.0, 0.0)
        else:
            turn = _unit(i - 3)
            opens = cross(turn, rb)
            eta = back(m, turn)
            swing = rotate(m, sub(scale(0.5, eta), scale(lag, cross(theta, eta))))
            more = sub(cross(swing, force), _stretch(m, k, sub(opens, cross(swing, gap))))
            change = sub(cross(swing, torque), rotate(m, rotate(growth, eta)))
        shift = scale(0.5, cross(opens, force))
        # forces act in the middle of the gap: if it opens, the arm of b changes by -1/2 of that where b
        # moves, by +1/2 where b turns
        tb = add(add(change, scale(-1.0 if i < 3 else 1.0, shift)), cross(qb, more))
        ta = scale(-1.0, add(add(change, shift), cross(qa, more)))
        for l in range(3):
            g[6 + i, l], g[6 + i, 3 + l] = -more[l], ta[l]
            g[6 + i, 6 + l], g[6 + i, 9 + l] = more[l], tb[l]
    # a motion of one body equals one of both and the opposite one of the other; forces turn with both
    for i in range(3):
        turn = _unit(i)
        arm = cross(turn, apart)
        f, ta, tb = cross(turn, force), cross(turn, on_a), cross(turn, on_b)
        for l in range(12):
            both = ta[l - 3] if 2 < l < 6 else tb[l - 9] if l > 8 else -f[l] if l < 3 else f[l - 6]
            g[i, l] = -g[6 + i, l]
            g[3 + i, l] = both - g[9 + i, l] - arm[0] * g[6, l] - arm[1] * g[7, l] - arm[2] * g[8, l]


@njit(cache=True, error_model="numpy")
def sheets_into(bodies, joints, points, loads, level, gaps, x, r, a):
    """Sets the band to minus the derivative of the forces of joints, with `gaps` (joints, 3) [mm], and of
    loads; made symmetric, as it is where torques balance."""
    a[:] = 0.0
    g = np.empty((12, 12))
    for j in range(joints.size):
        one = joints[j].a if joints[j].a >= 0 else x.shape[0] - 1
        _growth(joints[j], points, vec(gaps, j), x, r, one, g)
        na, nb = bodies[one].node, bodies[joints[j].b].node
        for c in range(6):
            for i in range(6):
                if na >= 0:
                    a[na, c, i] -= 0.5 * (g[c, i] + g[i, c])
                if nb >= 0:
                    a[nb, c, i] -= 0.5 * (g[6 + c, 6 + i] + g[6 + i, 6 + c])
                if na >= 0 and nb > na:
                    a[na, c, 6 * (nb - na) + i] -= 0.5 * (g[c, 6 + i] + g[6 + i, c])
                elif nb >= 0 and na > nb:
                    a[nb, c, 6 * (na - nb) + i] -= 0.5 * (g[6 + c, i] + g[i, 6 + c])
    for l in range(loads.size):  # the torque of a dead load changes as its body turns
        b = loads[l].body
        node = bodies[b].node
        if node < 0:
            continue
        arm, force = rotate(mat(r, b), three(loads[l].local)), scale(level, three(loads[l].force))
        for c in range(3):
            more = cross(cross(_unit(c), arm), force)
            for i in range(3):
                a[node, 3 + c, 3 + i] -= 0.5 * more[i]
                a[node, 3 + i, 3 + c] -= 0.5 * more[i]


@njit(cache=True, error_model="numpy")
def rollers_into(bodies, b, d):
    """Sets the border b and its corner d to the springs of slides. Nothing turns spins at rest, so they get
    an arbitrary stiffness."""
    b[:] = 0.0
    d[:] = 0.0
    for k in range(bodies.size - 1):
        slide, spin = bodies[k].slide, bodies[k].spin
        if slide >= 0:
            d[slide, slide] = bodies[k].press[STIFFNESS]
        if spin >= 0:
            d[spin, spin] = 1.0


@njit(cache=True, error_model="numpy")
def _move(x, r, b, way, c, amount):
    """Moves (c 0-2) or turns (3-5) a box, or slides a roller along its way (6)."""
    if c == 6:
        for i in range(3):
            x[b, i] += amount * way[i]
    elif c < 3:
        x[b, c] += amount
    else:
        m = matmul(exp_rotation(scale(amount, _unit(c - 3))), mat(r, b))
        for i in range(9):
            r[b, i] = m[i]


@njit(cache=True, error_model="numpy")
def corners_into(tables, motion, f, a):
    """Adds Poisson's effect to the band a: minus the differences of the forces of corners, made symmetric.
    `motion` is at rest; its places come back as they were. `f` (bodies, 6) is scratch."""
    bodies, joints, corners, (x, r, _u, _w) = tables.bodies, tables.joints, tables.corners, motion
    own, keep, there = np.empty((24, 24)), np.empty(12), np.empty(4, np.int64)
    for k in range(corners.size):
        many = bodies_of(joints, corners[k], there)
        own[:] = 0.0
        for n in range(6 * many):
            body = there[n // 6]
            if bodies[body].node < 0:
                continue
            copy(keep[:3], x[body])
            copy(keep[3:], r[body])
            for side in (1.0, -1.0):
                _move(x, r, body, bodies[body].way, n % 6, side * DIFFERENCE)
                f[:] = 0.0
                corner_forces(joints, corners[k], motion, f)
                copy(x[body], keep[:3])
                copy(r[body], keep[3:])
                for l in range(6 * many):
                    own[n, l] -= side * f[there[l // 6], l % 6] / (2.0 * DIFFERENCE)
        for n in range(6 * many):
            one = bodies[there[n // 6]].node
            for l in range(6 * many):
                two = bodies[there[l // 6]].node
                if one >= 0 and two >= one:
                    a[one, n % 6, 6 * (two - one) + l % 6] += 0.5 * (own[n, l] + own[l, n])


@njit(cache=True, error_model="numpy")
def contacts_into(tables, touched, count, motion, a, b, d):
    """Adds the contacts that touch to the band a, the border b (border, 6 nodes) and its corner d: minus the
    differences of their forces, made symmetric. `motion` is at rest; its places come back as they were."""
    bodies, pairs, shapes = tables.bodies, tables.pairs, tables.shapes
    x, r = motion.x, motion.r
    out, g, keep = np.empty(OUT), np.empty((2, 14)), np.empty(12)
    own, index = np.empty((14, 14)), np.empty(14, np.int64)
    for p in range(count):
        pair = pairs[touched[p]]
        own[:] = 0.0
        for c in range(14):
            body = pair.a if c < 7 else pair.b
            index[c] = -1
            if c % 7 == 6:
                index[c] = bodies[body].slide
            elif c < 6 and bodies[body].node >= 0:
                index[c] = 6 * bodies[body].node + c
            if index[c] < 0:
                continue
            copy(keep[:3], x[body])
            copy(keep[3:], r[body])
            for side in range(2):
                _move(x, r, body, bodies[body].way, c % 7, DIFFERENCE if side == 0 else -DIFFERENCE)
                out[:] = 0.0
                pair_force(bodies, pair, shapes, motion, out)
                copy(x[body], keep[:3])
                copy(r[body], keep[3:])
                for end in range(2):
                    way = bodies[pair.a if end == 0 else pair.b].way
                    copy(g[side, 7 * end : 7 * end + 6], out[6 * end : 6 * end + 6])
                    g[side, 7 * end + 6] = dot(three(out[6 * end :]), three(way))
            for i in range(14):
                own[c, i] = (g[1, i] - g[0, i]) / (2.0 * DIFFERENCE)
        for c in range(14):
            for i in range(14):
                if index[c] < 0 or index[i] < 0:
                    continue
                v = 0.5 * (own[c, i] + own[i, c])
                if c % 7 < 6 and i % 7 < 6:
                    a[index[c] // 6, c, i] += v
                elif c % 7 == 6 and i % 7 == 6:
                    d[index[c], index[i]] += v
                elif c % 7 == 6:
                    b[index[c], index[i]] += v
