"""Patches: contacts with frozen geometry in an iteration, where faces of boxes of two sheets lie on each
other.

A patch combines all corners of an overlap, each of which is like a contact point of integrate.points. The
owner of the contact (mechanics.overlap) moves against the other box by a rate and a spin, in its own axes.
The forces of the corners add up to a force and a torque about its middle. So an iteration reads and writes
few numbers for each of many thousand pairs.

A corner keeps its place and its stiffness, and its depth grows with its closing rate. Its friction is limited
by the normal force at the beginning of the iteration, or is a spring up to that limit (mechanics.stick).
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.contact.search import law_of_boxes
from mdlgen.backends.lattice.kernels.contact.slopes import Numbers, core, hat_left, hat_right, holding
from mdlgen.backends.lattice.kernels.integrate.tangent import blocks
from mdlgen.backends.lattice.kernels.linear.colouring import ONE, TWO
from mdlgen.backends.lattice.kernels.state import (
    ACROSS,
    DEPTH_AT_REST,
    GRIP,
    LENGTHWISE,
    OF_DIRECTION,
    STIFF,
)
from mdlgen.backends.lattice.kernels.tuning import REACH
from mdlgen.mechanics.frame import frame_of
from mdlgen.mechanics.laws import damped, friction_over_speed
from mdlgen.mechanics.overlap import OVERLAPS, moves, plane_of
from mdlgen.mechanics.overlap import STIFF as KEPT_STIFF
from mdlgen.mechanics.stick import limit_of
from mdlgen.mechanics.vector import add, back, cross, mat, rotate, scale, sub, three, three_from, vec
from mdlgen.program.kernel import BORROWS, njit

ZERO = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@njit(cache=True, error_model="numpy", forceinline=True)
def _pressed(corner, rate, h):
    """Elastic force of a corner that closes at a rate, and its growth with depth."""
    depth = corner[DEPTH_AT_REST] + h * rate
    if depth <= 0.0:
        return 0.0, 0.0
    growth = corner[STIFF] * math.sqrt(depth)
    return growth * depth, 1.5 * growth


@njit(cache=True, error_model="numpy", **BORROWS)
def _evaluate(q, law, h, far, sticks):
    """Writes the force and torque on the owner of a patch, at the part `far` of the direction, into its
    `does`. sticks: stretches of all pairs that are searched, where any stick."""
    rate = add(three(q.now), scale(far, three(q.along)))
    spin = add(three_from(q.now, 3), scale(far, three_from(q.along, 3)))
    force, torque = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for k in range(q.count):
        corner = q.corners[k]
        at = (corner[LENGTHWISE], corner[ACROSS], q.high)
        v = add(rate, cross(spin, at))
        closes = q.side * v[2]
        spring, _ = _pressed(corner, closes, h)
        normal, x, y = damped(spring, closes, law.beta, law.smoothing), 0.0, 0.0
        if corner[GRIP] > 0.0 and q.ratio > 0.0:
            k_t, stretch = q.ratio * corner[STIFF], sticks[q.pair].now[k]
            x, y = k_t * (stretch[0] + 2.0 * h * v[0]), k_t * (stretch[1] + 2.0 * h * v[1])
            size = math.sqrt(x * x + y * y)
            if size > corner[GRIP]:
                x, y = corner[GRIP] / size * x, corner[GRIP] / size * y
        elif corner[GRIP] > 0.0:
            speed = math.sqrt(v[0] * v[0] + v[1] * v[1])
            over = friction_over_speed(speed, law.mu_static, law.mu_dynamic, law.stiction, law.sliding)
            x, y = corner[GRIP] * over * v[0], corner[GRIP] * over * v[1]
        f = (-x, -y, -q.side * normal)
        force, torque = add(force, f), add(torque, cross(at, f))
    for i in range(3):
        q.does[i], q.does[3 + i] = force[i], torque[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def begin_patch(work, q, k, h):
    """Sets a PATCH from the cached overlap of the k-th searched pair; without corners where its faces are not
    near enough."""
    motion, search, bodies = work.mid.motion, work.search, work.tables.bodies
    own, kept = search.listed[k], work.mid.overlaps[k]
    q.pair, q.count, q.coupled = k, 0, -1
    if kept.state != OVERLAPS:
        return
    first = kept.first != 0
    one, two = (int(own.a), int(own.b)) if first else (int(own.b), int(own.a))
    owner, other = frame_of(motion, one), frame_of(motion, two)
    place, level, lean_p, lean_r = plane_of(kept, owner, other)
    nearest = -REACH
    for i in range(kept.count):
        nearest = max(nearest, level + lean_p * kept.corners[i, 0] + lean_r * kept.corners[i, 1])
    if nearest <= -REACH or nearest > kept.most:
        return
    law, ratio = law_of_boxes(search, own), search.regions[own.region].sticking
    rate, spin = moves(owner, other, place)
    q.a, q.b, q.region = own.a, own.b, own.region
    q.owner, q.other, q.one, q.two = one, two, bodies[one].node, bodies[two].node
    q.count, q.side, q.ratio = kept.count, kept.side, ratio if work.mid.sticks.pairs.size > 0 else 0.0
    q.high = kept.side * (kept.thick - 0.5 * max(nearest, 0.0))
    for i in range(3):
        q.place[i], q.now[i], q.now[3 + i] = place[i], rate[i], spin[i]
        q.along[i] = q.along[3 + i] = 0.0
    for i in range(kept.count):
        corner, p, r = q.corners[i], kept.corners[i, 0], kept.corners[i, 1]
        v = add(rate, cross(spin, (p, r, q.high)))
        closes = q.side * v[2]
        corner[LENGTHWISE], corner[ACROSS], corner[STIFF] = p, r, kept.corners[i, KEPT_STIFF]
        corner[DEPTH_AT_REST] = level + lean_p * p + lean_r * r - h * closes
        spring, _ = _pressed(corner, closes, h)
        corner[GRIP] = damped(spring, closes, law.beta, law.smoothing)
        if q.ratio > 0.0:
            corner[GRIP] *= limit_of(v[0], v[1], law)
    _evaluate(q, law, h, 0.0, work.mid.sticks.pairs)
    for i in range(6):
        q.begun[i] = q.does[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def _slope_of(work, q, h, far):
    """Evaluates a patch; returns its part of the slope."""
    _evaluate(q, law_of_boxes(work.search, q), h, far, work.mid.sticks.pairs)
    total = 0.0
    for i in range(6):
        total += (q.does[i] - q.begun[i]) * q.along[i]
    return total


@njit(cache=True, error_model="numpy", forceinline=True)
def _lying(frozen, at):
    """A patch with corners, by its number among these."""
    return frozen.patches[frozen.lying[at]]


@njit(cache=True, error_model="numpy", **BORROWS)
def patches_along(work, h):
    """Stores the motion of patches with corners along the direction, and evaluates them at its end. Returns
    their part of the slope there, without its factor -h."""
    frozen, r, total = work.frozen, work.mid.motion.r, 0.0
    change = frozen.vectors[OF_DIRECTION]
    for at in range(frozen.many[2]):
        q = _lying(frozen, at)
        axes = mat(r, q.owner)
        v = w = far = (0.0, 0.0, 0.0)
        if q.one >= 0:
            v, w = three_from(change, 6 * q.one), three_from(change, 6 * q.one + 3)
        if q.two >= 0:
            v = sub(v, three_from(change, 6 * q.two))
            far = back(axes, three_from(change, 6 * q.two + 3))
        # the other box has its velocity at its own middle
        rate, spin = add(back(axes, v), cross(far, three(q.place))), sub(back(axes, w), far)
        for i in range(3):
            q.along[i], q.along[3 + i] = rate[i], spin[i]
        total += _slope_of(work, q, h, 1.0)
    return total


@njit(cache=True, error_model="numpy", **BORROWS)
def patches_slope(work, h, far):
    """Part of patches in the slope, at the part `far` of the direction, without its factor -h."""
    total = 0.0
    for at in range(work.frozen.many[2]):
        total += _slope_of(work, _lying(work.frozen, at), h, far)
    return total


@njit(cache=True, error_model="numpy", **BORROWS)
def pull_patches(work, h, part, g):
    """As along.pull, for patches, which were evaluated there last."""
    frozen, r = work.frozen, work.mid.motion.r
    for at in range(frozen.many[2]):
        q = _lying(frozen, at)
        for i in range(6):
            q.now[i] += part * q.along[i]
        force = scale(h, sub(three(q.does), three(q.begun)))
        torque = scale(h, sub(three_from(q.does, 3), three_from(q.begun, 3)))
        axes = mat(r, q.owner)
        on_other = rotate(axes, sub(cross(three(q.place), force), torque))
        force, torque = rotate(axes, force), rotate(axes, torque)
        if q.one >= 0:
            for i in range(3):
                g[6 * q.one + i] -= force[i]
                g[6 * q.one + 3 + i] -= torque[i]
        if q.two >= 0:
            for i in range(3):
                g[6 * q.two + i] += force[i]
                g[6 * q.two + 3 + i] -= on_other[i]


@njit(cache=True, error_model="numpy", forceinline=True)
def _part(block, row, column):
    """Nine numbers of a block, row by row; the block is stored column by column."""
    c0, c1, c2 = block[column], block[column + 1], block[column + 2]
    return (
        *(c0[row], c1[row], c2[row]),
        *(c0[row + 1], c1[row + 1], c2[row + 1]),
        *(c0[row + 2], c1[row + 2], c2[row + 2]),
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def _add_part(block, row, column, sign, t):
    for r in range(3):
        for c in range(3):
            block[column + c, row + r] += sign * t[3 * r + c]


@njit(cache=True, error_model="numpy", forceinline=True)
def _sum(s, t):
    return (
        *(s[0] + t[0], s[1] + t[1], s[2] + t[2]),
        *(s[3] + t[3], s[4] + t[4], s[5] + t[5]),
        *(s[6] + t[6], s[7] + t[7], s[8] + t[8]),
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def _turned(t):
    return (t[0], t[3], t[6], t[1], t[4], t[7], t[2], t[5], t[8])


@njit(cache=True, error_model="numpy", **BORROWS)
def _spread(matrix, q, own, between):
    """Adds the matrix `own` (6, 6), for the motion of the owner of a patch against the other box, to their
    blocks. The other box contributes -(v + w x d), d from its middle to that of the owner."""
    first, band, couplings = q.owner == q.a, matrix.band, matrix.couplings.blocks
    a, c, d = _part(own, 0, 0), _part(own, 0, 3), _part(own, 3, 3)
    right = _sum(hat_right(a, between), c)
    low = _sum(hat_right(_turned(c), between), d)
    if q.one >= 0:
        block = band[q.one]
        _add_part(block, 0, 0, 1.0, a)
        _add_part(block, 0, 3, 1.0, c)
        _add_part(block, 3, 0, 1.0, _turned(c))
        _add_part(block, 3, 3, 1.0, d)
    if q.two >= 0:
        block = band[q.two]
        _add_part(block, 0, 0, 1.0, a)
        _add_part(block, 0, 3, 1.0, right)
        _add_part(block, 3, 0, 1.0, _turned(right))
        _add_part(block, 3, 3, 1.0, low)
        _add_part(block, 3, 3, -1.0, hat_left(between, right))
    if q.coupled >= 0:
        block = couplings[q.coupled]
        _add_part(block, 0, 0, -1.0, a)
        if first:
            _add_part(block, 0, 3, -1.0, right)
            _add_part(block, 3, 0, -1.0, _turned(c))
            _add_part(block, 3, 3, -1.0, low)
        else:
            _add_part(block, 3, 0, -1.0, _turned(right))
            _add_part(block, 0, 3, -1.0, c)
            _add_part(block, 3, 3, -1.0, _turned(low))


@njit(cache=True, error_model="numpy", **BORROWS)
def patches_into(work, h, chord):
    """Adds the decrease of the forces of patches per velocity, times h, to the diagonal blocks of the band
    and to the couplings of their boxes. `chord`: see slopes.steepness."""
    frozen, matrix, motion = work.frozen, work.matrix, work.mid.motion
    couplings, sticks, own = matrix.couplings, work.mid.sticks.pairs, frozen.block
    for number in range(frozen.many[2]):
        q = _lying(frozen, number)
        law = law_of_boxes(work.search, q)
        first, node, other = q.owner == q.a, int(q.one), int(q.two)
        if node >= 0 and other >= 0:
            # as of all points of a pair, rows are of its first box
            q.coupled = couplings.many[0]
            couplings.ends[q.coupled, ONE] = node if first else other
            couplings.ends[q.coupled, TWO] = other if first else node
            couplings.blocks[q.coupled] = 0.0
            couplings.many[0] += 1
        axes = mat(motion.r, q.owner)
        n = scale(-float(q.side), (axes[2], axes[5], axes[8]))
        own[:] = 0.0
        for k in range(q.count):
            corner = q.corners[k]
            at = (corner[LENGTHWISE], corner[ACROSS], q.high)
            v = add(three(q.now), cross(three_from(q.now, 3), at))
            closes = q.side * v[2]
            spring, growth = _pressed(corner, closes, h)
            slip, rubs = rotate(axes, (v[0], v[1], 0.0)), corner[GRIP] if q.ratio == 0.0 else 0.0
            if spring == 0.0 and corner[GRIP] == 0.0:
                continue
            numbers = Numbers(
                spring,
                growth,
                rubs,
                closes,
                law.smoothing,
                law.beta,
                law.mu_static,
                law.mu_dynamic,
                law.stiction,
                law.sliding,
                0.0,
                True,
            )
            t, _, _ = core(numbers, n, n, slip, h, chord, False)
            if q.ratio > 0.0 and corner[GRIP] > 0.0:
                k_t, stretch = q.ratio * corner[STIFF], sticks[q.pair].now[k]
                pulled = (k_t * (stretch[0] + 2.0 * h * v[0]), k_t * (stretch[1] + 2.0 * h * v[1]), 0.0)
                t = holding(t, rotate(axes, pulled), corner[GRIP], k_t, n, h, chord)
            arm = rotate(axes, at)
            blocks(own, 0, 0, 1.0, t, arm, arm, ZERO)
        _spread(matrix, q, own[0], sub(vec(motion.x, q.other), vec(motion.x, q.owner)))
