"""What a step sweeps over: pairs that are too deep, or change sides, between its begin and its end, and the
energy that it makes where it begins before a contact and ends in it."""

from __future__ import annotations

import math

import numpy as np

from backends.lattice.kernels.forces import place_box, place_roller
from mdlgen.mechanics.crossing import above, buried, closing, deepest, unseen
from mdlgen.mechanics.mesh import BLOCK
from mdlgen.mechanics.pair import BOX_CYLINDER, BOX_MESH, pair_force
from mdlgen.mechanics.point import COUPLE, OUT, POINT
from mdlgen.program.kernel import njit

# Pairs that would have to be looked at more often in a step want a smaller one.
MOST_LOOKS = 64
# Contacts of which each makes less than this part of the energy that may be made are not looked at.
LITTLE = 1e-3


@njit(cache=True, error_model="numpy", forceinline=True)
def _place(system, state, b, h, t, xs, rs, us, ws):
    """One body after h of a step from t, whose velocities are those of its middle."""
    bodies = system[0]
    x, r, u, ub = state[0], state[1], state[6], state[7]
    body = bodies[b]
    n = body.node
    if n >= 0:
        place_box(b, h, (u[n, 0], u[n, 1], u[n, 2]), (u[n, 3], u[n, 4], u[n, 5]), x, r, xs, rs, us, ws)
        return
    for i in range(3):
        xs[b, i], us[b, i], ws[b, i] = x[b, i], 0.0, 0.0
    for i in range(9):
        rs[b, i] = r[b, i]
    if body.slide < 0 and body.axis[0] == 0.0 and body.axis[1] == 0.0 and body.axis[2] == 0.0:
        return
    rate = ub[body.slide] if body.slide >= 0 else 0.0
    turning = ub[body.spin] if body.spin >= 0 else 0.0
    place_roller(body, b, h, t + h, rate, turning, x, r, xs, rs, us, ws)


@njit(cache=True, error_model="numpy", forceinline=True)
def _hits(bodies, pair):
    """Whether a pair's contacts are impacts: under a roller the boxes of a sheet take turns, and together
    store what the one before did."""
    return pair.kind != BOX_CYLINDER or bodies[pair.a].exposed == BLOCK


@njit(cache=True, error_model="numpy")
def _made(bodies, pairs, mid, count, dt, rows):
    """Adds to `rows` (contacts,) the energy that contacts store in a step beyond the work done on them.

    The rule takes the force in the middle of a step over all of it. The depth of each point at both ends
    follows from its rate; it has stored 2/5 F z (of z^1.5; other laws are near enough).
    """
    touched, outs = mid[5], mid[6]
    for k in range(count):
        pair = pairs[touched[k]]
        if not _hits(bodies, pair):
            continue
        row = pair.row
        for i in range(int(outs[k, OUT])):
            at = OUT + 1 + POINT * i
            force, growth, moved = outs[k, at + 6], outs[k, at + 7], 0.5 * dt * outs[k, at + 9]
            if growth <= 0.0 or outs[k, at + 16] == COUPLE:
                continue
            depth, energy = 1.5 * force / growth, 0.6 * force * force / growth
            part = moved / depth
            if abs(part) > 0.02:
                ends = max(1.0 + part, 0.0) ** 2.5 - max(1.0 - part, 0.0) ** 2.5
                rows[row] += energy * ends - 2.0 * force * moved


@njit(cache=True, error_model="numpy")
def swept(system, state, mid, counts, t, dt, allowed, rows):
    """What the near pairs do in a step from t, beyond what is known of its middle: (the first that comes
    deeper than it may, or to another side, or -1; the energy that contacts make or lose in it, where
    `allowed` is above zero). `counts`: how many pairs touch in the middle, how many are near.

    The states between are looked at as often as a pair could cross unseen, by the law of the contact: none
    for pairs that are slow for what they could cross, which is nearly all of them.
    """
    bodies, pairs, meshes = system[0], system[2], system[8]
    x, r = state[0], state[1]
    um, wm, touched, near = mid[2], mid[3], mid[5], mid[8]
    count, close = counts
    made = False
    xs, rs, us, ws, out = x, r, um, wm, um[0]
    rows[:] = 0.0
    if allowed > 0.0:
        _made(bodies, pairs, mid, count, dt, rows)
    known = 0
    for at in range(close):
        pair = pairs[near[at]]
        touches = known < count and touched[known] == near[at]
        if touches:
            known += 1
        fast = closing(bodies, pair, meshes, x, r, um, wm, dt)
        way, band = dt * fast, unseen(bodies, pair, meshes)
        side = above(bodies, pair, x, r)
        solid = pair.kind == BOX_MESH and bodies[pair.a].exposed != 0
        enters = False
        if allowed > 0.0 and not touches:
            half = 0.5 * way
            enters = 0.4 * pair.k * half * half * math.sqrt(half) > LITTLE * allowed and _hits(bodies, pair)
        if way <= band and side == 0 and not solid and not enters:
            continue
        if way > MOST_LOOKS * band:
            return near[at], 0.0
        if not made:
            made = True
            xs, rs = np.empty_like(x), np.empty_like(r)
            us, ws, out = np.empty_like(um), np.empty_like(wm), np.zeros(OUT)
        many = max(1, math.ceil(way / band))
        for k in range(1, many + 1):
            h = dt * k / many
            _place(system, state, pair.a, h, t, xs, rs, us, ws)
            _place(system, state, pair.b, h, t, xs, rs, us, ws)
            now = above(bodies, pair, xs, rs)
            if side * now < 0:
                return near[at], 0.0
            side = now
            if solid and buried(bodies, pair, meshes, xs, rs):
                return near[at], 0.0
            if way > band or enters:
                out[:] = 0.0
                pair_force(bodies, pair, meshes, xs, rs, us, ws, out)
                if out[15] > deepest(bodies, pair):
                    return near[at], 0.0
                if enters and k == many:
                    rows[pair.row] += out[13]
    total = 0.0
    for row in range(rows.size):
        total += abs(rows[row])
    return -1, total
