"""Static equilibrium of sheets and pressed rollers: Newton's method on forces at rest.

At rest a contact has its elastic force only. Rollers that can turn keep their angle: nothing turns them.

Boxes that turn by a finite angle and move along straight lines would stretch their joints, which are 1e5
times stiffer along the sheet than they are to bend, and more for a hard membrane. So a step turns the boxes
as Newton's method says, and moves them to where their joints have the gaps that it says (`_follow`): a chain
stays a chain. Where not all joints can have theirs, the excess is balanced in the next round, but does not
stiffen it: the stiffness is that of the forces which the last step was to make. Steps end where the force
along them changes its sign.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from backends.lattice.band import factor, solve
from backends.lattice.forces import joint_forces, near_pairs, other_forces, pair_forces
from mdlgen.mechanics.contact import OUT
from mdlgen.mechanics.pair import pair_force
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

MOST_ROUNDS = 100
MOST_TRIES = 12  # of the length of one step
MOST_TURN = 0.3  # rad: what a step may turn one box against the next
REST = 1e-9  # residual that ends the rounds, relative to the load
GOOD = 1e-6  # residual that is good enough where it falls no more
STILL = 1e-8  # rad, and parts of a box: a step that ends the rounds where round-off hides the residual
_EPS = 2.2e-16
_SMALL = 1e-6  # mm, rad: differences of contact forces
_LOOSE = 1e-12  # holds what hangs on nothing, where `_follow` shares what the joints ask for


@njit(cache=True, error_model="numpy")
def _hinge(theta, e, k):
    """Couple of a joint turned by theta, in its middle frame, and the growth of the couple with the turn of
    one body against the other (row by row); see mechanics.bushing.bushing_pair."""
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
    growth = np.empty((3, 3))
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
            growth[j, i] = g[j]
    return couple, nine(growth.ravel())


@njit(cache=True, error_model="numpy", forceinline=True)
def _unit(i):
    return (1.0 if i == 0 else 0.0, 1.0 if i == 1 else 0.0, 1.0 if i == 2 else 0.0)


@njit(cache=True, error_model="numpy", forceinline=True)
def _stretch(m, k, gap):
    """Force of springs k in the frame m [N]."""
    d = back(m, gap)
    return rotate(m, (k[0] * d[0], k[1] * d[1], k[2] * d[2]))


@njit(cache=True, error_model="numpy")
def _growth(joint, gap, x, r, one, g):
    """Change of the forces on both bodies of a joint (6 and 6), were its gap `gap`: a row of g (12, 12) for
    each move of the bodies."""
    two = joint.b
    ma, mb = mat(r, one), mat(r, two)
    fa = matmul(ma, nine(joint.fa))
    theta = log_rotation(transpose_matmul(fa, matmul(mb, nine(joint.fb))))
    m = matmul(fa, exp_rotation(scale(0.5, theta)))
    ra, rb = rotate(ma, three(joint.ra)), rotate(mb, three(joint.rb))
    apart = sub(vec(x, two), vec(x, one))
    k = joint.k
    couple, growth = _hinge(theta, three(joint.e), k)
    force, torque = scale(-1.0, _stretch(m, k, gap)), scale(-1.0, rotate(m, couple))
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
        # the arm of b reaches half of what opens less where b moves, and half more where its own end turns
        tb = add(add(change, scale(-1.0 if i < 3 else 1.0, shift)), cross(qb, more))
        ta = scale(-1.0, add(add(change, shift), cross(qa, more)))
        for l in range(3):
            g[6 + i, l], g[6 + i, 3 + l] = -more[l], ta[l]
            g[6 + i, 6 + l], g[6 + i, 9 + l] = more[l], tb[l]
    # to move one body is to move both and the other back, and forces turn with both
    for i in range(3):
        turn = _unit(i)
        arm = cross(turn, apart)
        f, ta, tb = cross(turn, force), cross(turn, on_a), cross(turn, on_b)
        for l in range(12):
            both = ta[l - 3] if 2 < l < 6 else tb[l - 9] if l > 8 else -f[l] if l < 3 else f[l - 6]
            g[i, l] = -g[6 + i, l]
            g[3 + i, l] = both - g[9 + i, l] - arm[0] * g[6, l] - arm[1] * g[7, l] - arm[2] * g[8, l]


@njit(cache=True, error_model="numpy")
def stiffness(bodies, joints, loads, level, gaps, x, r, a):
    """Sets the band to minus the derivative of the forces of joints, with `gaps` (joints, 3) [mm], and of
    loads; made symmetric, as it is where torques balance."""
    a[:] = 0.0
    g = np.empty((12, 12))
    for j in range(joints.size):
        one = joints[j].a if joints[j].a >= 0 else x.shape[0] - 1
        _growth(joints[j], vec(gaps, j), x, r, one, g)
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
    for l in range(loads.size):  # a dead load turns its body the less the further it has turned
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
def _contacts(bodies, pairs, touched, count, x, r, still, a, b, d):
    """Adds the contacts that touch to the band a, the border b (border, 6 nodes) and its corner d: minus the
    differences of their forces, made symmetric."""
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
            keep[:3], keep[3:] = x[body], r[body]
            for side in range(2):
                _move(x, r, body, bodies[body].way, c % 7, _SMALL if side == 0 else -_SMALL)
                out[:] = 0.0
                pair_force(bodies, pair, x, r, still, still, out)
                x[body], r[body] = keep[:3], keep[3:]
                for end in range(2):
                    way = bodies[pair.a if end == 0 else pair.b].way
                    g[side, 7 * end : 7 * end + 6] = out[6 * end : 6 * end + 6]
                    g[side, 7 * end + 6] = dot(three(out[6 * end :]), three(way))
            for i in range(14):
                own[c, i] = (g[1, i] - g[0, i]) / (2.0 * _SMALL)
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


@njit(cache=True, error_model="numpy")
def _residual(system, level, x, r, s, still, lists, f, res, resb):
    """Forces on the free boxes into res, on slides into resb. Returns the largest [N], with torques over
    half a box, its body, and how many contacts touch."""
    bodies, joints, pairs, loads, gravity, nodes = system
    touched, outs, near = lists
    f[:] = 0.0
    joint_forces(joints, x, r, still, still, f)
    close = near_pairs(bodies, pairs, x, r, 0.0, near)
    count, _, _ = pair_forces(bodies, pairs, near, close, x, r, still, still, f, touched, outs)
    other_forces(bodies, loads, gravity, level, r, still, still, f)
    worst, at = 0.0, -1
    for n in range(nodes.size):
        b = nodes[n]
        size = bodies[b].half[0] + bodies[b].half[1]
        for i in range(6):
            res[6 * n + i] = f[b, i]
            v = abs(f[b, i]) if i < 3 else abs(f[b, i]) / size
            if not v <= worst:
                worst, at = v, b
    for b in range(bodies.size - 1):
        k = bodies[b].slide
        if k < 0:
            continue
        p, force = bodies[b].press, 0.0
        for i in range(3):
            force += bodies[b].way[i] * (f[b, i] + level * p[3] * gravity[i])
        resb[k] = force + p[2] - p[0] * s[k]
        if not abs(resb[k]) <= worst:
            worst, at = abs(resb[k]), b
    return worst, at, count


@njit(cache=True, error_model="numpy")
def _solve_border(a, b, d, res, resb):
    """Solves for boxes and slides in place, with the factor a. Returns False where the rest of the corner is
    not positive."""
    solve(a, res)
    m = resb.size
    if m == 0:
        return True
    y, rest = b.copy(), d.copy()
    for j in range(m):
        solve(a, y[j])
        resb[j] -= np.dot(b[j], res)
        for i in range(m):
            rest[i, j] -= np.dot(b[i], y[j])
    for j in range(m):
        if not rest[j, j] > 0.0:
            return False
        for i in range(j + 1, m):
            v = rest[i, j] / rest[j, j]
            rest[i] -= v * rest[j]
            resb[i] -= v * resb[j]
    for j in range(m - 1, -1, -1):
        for i in range(j + 1, m):
            resb[j] -= rest[j, i] * resb[i]
        resb[j] /= rest[j, j]
        res -= resb[j] * y[j]
    return True


@njit(cache=True, error_model="numpy")
def _links(bodies, joints, ground, a):
    """Sets the band to the joints as springs of one stiffness between points, and factors it."""
    a[:] = 0.0
    for n in range(a.shape[0]):
        for i in range(6):
            a[n, i, i] = _LOOSE
    for j in range(joints.size):
        na, nb = bodies[joints[j].a if joints[j].a >= 0 else ground].node, bodies[joints[j].b].node
        for i in range(3):
            if na >= 0:
                a[na, i, i] += 1.0
            if nb >= 0:
                a[nb, i, i] += 1.0
            if na >= 0 and nb >= 0:
                a[min(na, nb), i, 6 * abs(nb - na) + i] -= 1.0
    factor(a)


@njit(cache=True, error_model="numpy")
def _follow(bodies, joints, nodes, links, part, step, slid, x0, r0, s0, x, r, s, y, gaps):
    """The state after a part of a step from x0, r0, s0: boxes turn by it, and stand where the gaps of their
    joints are what it makes of them, turned with the boxes (`gaps`); in the mean, where not all can be."""
    last = x.shape[0] - 1
    for n in range(nodes.size):
        b, k = nodes[n], 6 * n
        m = matmul(exp_rotation(scale(part, three(step[k + 3 :]))), mat(r0, b))
        for i in range(9):
            r[b, i] = m[i]
        for i in range(3):
            x[b, i] = x0[b, i] + part * step[k + i]
    for b in range(last):
        k = bodies[b].slide
        if k >= 0:
            s[k] = s0[k] + part * slid[k]
            for i in range(3):
                x[b, i] = x0[b, i] + part * slid[k] * bodies[b].way[i]
    y[:] = 0.0
    for j in range(joints.size):
        one, two = joints[j].a if joints[j].a >= 0 else last, joints[j].b
        na, nb = bodies[one].node, bodies[two].node
        ra, rb = three(joints[j].ra), three(joints[j].rb)
        a0, b0 = rotate(mat(r0, one), ra), rotate(mat(r0, two), rb)
        gap = sub(add(vec(x0, two), b0), add(vec(x0, one), a0))
        opens, turn = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        if na >= 0:
            spin = three(step[6 * na + 3 :])
            opens = sub(opens, add(three(step[6 * na :]), cross(spin, a0)))
            turn = scale(0.5, spin)
        if nb >= 0:
            spin = three(step[6 * nb + 3 :])
            opens = add(opens, add(three(step[6 * nb :]), cross(spin, b0)))
            turn = add(turn, scale(0.5, spin))
        wanted = add(gap, scale(part, sub(opens, cross(turn, gap))))
        wanted = rotate(exp_rotation(scale(part, turn)), wanted)
        found = sub(add(vec(x, two), rotate(mat(r, two), rb)), add(vec(x, one), rotate(mat(r, one), ra)))
        miss = sub(wanted, found)
        gaps[j, 0], gaps[j, 1], gaps[j, 2] = wanted
        for i in range(3):
            if na >= 0:
                y[6 * na + i] -= miss[i]
            if nb >= 0:
                y[6 * nb + i] += miss[i]
    solve(links, y)
    for n in range(nodes.size):
        for i in range(3):
            x[nodes[n], i] += y[6 * n + i]


@njit(cache=True, error_model="numpy")
def _longest(bodies, joints, nodes, step, slid, reach):
    """Which part of a step may be taken, and how far it goes [rad, parts of a box]. `reach` [mm] bounds how
    far boxes and slides go where there are contacts to run into."""
    turned = moved = far = 0.0
    for j in range(joints.size):
        na, nb = -1 if joints[j].a < 0 else bodies[joints[j].a].node, bodies[joints[j].b].node
        for i in range(3, 6):
            one = step[6 * na + i] if na >= 0 else 0.0
            two = step[6 * nb + i] if nb >= 0 else 0.0
            turned = max(turned, abs(two - one))
    for n in range(nodes.size):
        half = bodies[nodes[n]].half
        size = half[0] + half[1]
        for i in range(3):
            far = max(far, abs(step[6 * n + i]), size * abs(step[6 * n + 3 + i]))
            moved = max(moved, abs(step[6 * n + i]) / size, abs(step[6 * n + 3 + i]))
    for k in range(slid.size):
        far, moved = max(far, abs(slid[k])), max(moved, abs(slid[k]))
    return min(1.0, MOST_TURN / max(turned, 1e-300), reach / max(far, 1e-300)), moved


@njit(cache=True, error_model="numpy")
def equilibrium(system, border, height, level, load, least, reach, x, r, s, lists):
    """Moves x, r and the slides s to balance at a part of weights and loads; springs press fully.

    `load` [N] is what residuals are measured by, `least` how much of the stiffest is always added to the
    diagonal (for sheets that nothing but contacts holds), `reach` [mm] the longest step. Returns (whether
    balance was found, rounds, the body that is pushed most, and by how much of the load).
    """
    bodies, joints, pairs, loads, gravity, nodes = system
    many = nodes.size
    a, links = np.zeros((many, 6, height)), np.zeros((many, 6, height))
    b, d = np.zeros((border, 6 * many)), np.zeros((border, border))
    res, resb, step, slid, y = (
        np.zeros(6 * many),
        np.zeros(border),
        np.zeros(6 * many),
        np.zeros(border),
        np.zeros(6 * many),
    )
    f, still = np.zeros((x.shape[0], 6)), np.zeros(x.shape)
    plain, flat, corner = np.empty(a.shape), b.copy(), d.copy()
    x0, r0, s0 = x.copy(), r.copy(), s.copy()
    _links(bodies, joints, x.shape[0] - 1, links)
    gaps = np.zeros((joints.size, 3))
    _follow(bodies, joints, nodes, links, 0.0, step, slid, x0, r0, s0, x, r, s, y, gaps)
    hard = 0.0
    for j in range(joints.size):
        hard = max(hard, joints[j].k[0], joints[j].k[1], joints[j].k[2])
    # forces that round-off of the positions alone makes
    noise = 16.0 * _EPS * hard * np.abs(x).max()
    worst, at, count = _residual(system, level, x, r, s, still, lists, f, res, resb)
    best, since, shift = worst, 0, least
    for rounds in range(MOST_ROUNDS):
        if worst <= REST * load:
            return True, rounds, at, worst / load
        if not worst < 1e30:
            break
        stiffness(bodies, joints, loads, level, gaps, x, r, a)
        b[:] = 0.0
        d[:] = 0.0
        for k in range(bodies.size - 1):
            if bodies[k].slide >= 0:
                d[bodies[k].slide, bodies[k].slide] = bodies[k].press[0]
            if bodies[k].spin >= 0:
                d[bodies[k].spin, bodies[k].spin] = 1.0
        _contacts(bodies, pairs, lists[0], count, x, r, still, a, b, d)
        plain[:], flat[:], corner[:] = a, b, d
        ease, twist = load, load
        for n in range(many):
            for i in range(3):
                ease, twist = max(ease, abs(a[n, i, i])), max(twist, abs(a[n, 3 + i, 3 + i]))
        while True:
            for n in range(many):
                for i in range(6):
                    a[n, i, i] += shift * (ease if i < 3 else twist)
            for k in range(border):
                d[k, k] += shift * ease
            step[:], slid[:] = res, resb
            if factor(a) and _solve_border(a, b, d, step, slid):
                break
            a[:], d[:] = plain, corner
            shift = max(10.0 * shift, 1e-10)
            if shift > 1e6:
                return False, rounds, at, worst / load
        part, moved = _longest(bodies, joints, nodes, step, slid, reach)
        if not moved < 1e30:
            break
        x0[:], r0[:], s0[:] = x, r, s
        falls = np.dot(res, step) + np.dot(resb, slid)
        for _ in range(MOST_TRIES):
            _follow(bodies, joints, nodes, links, part, step, slid, x0, r0, s0, x, r, s, y, gaps)
            worst, at, count = _residual(system, level, x, r, s, still, lists, f, res, resb)
            still_falls = np.dot(res, step) + np.dot(resb, slid)
            if part * moved < 1e-6 or still_falls > -0.5 * falls:
                break
            part *= min(0.7, max(0.1, falls / (falls - still_falls)))
        if shift <= least and part * moved <= STILL and worst <= noise:
            return True, rounds + 1, at, worst / load
        shift *= 0.1
        if shift < 1e-12:
            shift = 0.0
        shift = max(shift, least)
        if worst < 0.5 * best:
            best, since = worst, 0
        else:
            since += 1
            if since >= 3 and worst <= GOOD * load:
                return True, rounds + 1, at, worst / load
    return worst <= GOOD * load, MOST_ROUNDS, at, worst / load
