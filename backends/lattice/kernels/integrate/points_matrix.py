"""Part of points and patches in the matrix of an iteration: the decrease of their forces per velocity."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.slopes import Numbers, core, core_stretched, outer, steepness
from mdlgen.backends.lattice.kernels.integrate.patches import ZERO, patches_into
from mdlgen.backends.lattice.kernels.integrate.points import law_at
from mdlgen.backends.lattice.kernels.integrate.tangent import blocks
from mdlgen.backends.lattice.kernels.integrate.unknowns import moving, turning_of
from mdlgen.backends.lattice.kernels.linear.colouring import ONE, TWO
from mdlgen.backends.lattice.kernels.state import (
    A_COUPLE,
    A_DAMPER,
    AIR,
    ARM_A,
    ARM_B,
    BETA,
    FIELD,
    GROWTH,
    HOLD,
    KIND,
    MU_DYNAMIC,
    MU_STATIC,
    NORMAL,
    NOW,
    OVER,
    PRESSING,
    SLIDING,
    SPRING,
    SQUARE,
    STICTION,
)
from mdlgen.mechanics.vector import cross, dot, rotate, scale, three_from, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _point_into(bodies, ends, q, x, t, coupled, matrix):
    """Adds a matrix of the velocity at one point to band, border and corner, and to the couplings."""
    a, b, d = matrix.band, matrix.border, matrix.corner
    direction, index = matrix.direction, matrix.unknowns
    node, other = ends.one, ends.two
    arm, far, many = three_from(q, ARM_A), three_from(q, ARM_B), 0
    if node >= 0:
        blocks(a, node, 0, 1.0, t, arm, arm, ZERO)
    else:
        many = moving(bodies[ends.a], arm, vec(x, ends.a), 1.0, direction, index, many)
    if other >= 0:
        blocks(a, other, 0, 1.0, t, far, far, ZERO)
        if node >= 0:
            blocks(matrix.couplings.blocks, coupled, 0, -1.0, t, arm, far, ZERO)
    else:
        many = moving(bodies[ends.b], far, vec(x, ends.b), -1.0, direction, index, many)
    for i in range(many):
        v = rotate(t, three_from(direction[i], 0))
        for j in range(many):
            d[index[i], index[j]] += dot(v, three_from(direction[j], 0))
        if node >= 0:
            torque = cross(arm, v)
            for l in range(3):
                b[index[i], 6 * node + l] += v[l]
                b[index[i], 6 * node + 3 + l] += torque[l]


@njit(cache=True, error_model="numpy", **BORROWS)
def _couple_into(bodies, ends, axis, growth, matrix):
    """Adds the couple of rolling resistance of a box, or a roller, against a roller or a part that does not
    turn."""
    a, b, d = matrix.band, matrix.border, matrix.corner
    node = ends.one
    if node >= 0:
        for c in range(3):
            for k in range(3):
                a[node, 3 + c, 3 + k] += growth * axis[c] * axis[k]
    for one in range(4):
        i, turning = turning_of(bodies, ends, one, axis)
        if i < 0:
            continue
        for two in range(4):
            j, other = turning_of(bodies, ends, two, axis)
            if j >= 0:
                d[i, j] += growth * turning * other
        if node >= 0:
            for c in range(3):
                b[i, 6 * node + 3 + c] += growth * turning * axis[c]


@njit(cache=True, error_model="numpy", **BORROWS)
def points_into(work, h, chord):
    """Adds the decrease of the forces of all points and patches per velocity, times h, to band, border and
    corner, and to the couplings between boxes of two sheets. `chord`: see slopes.steepness."""
    tables, frozen, matrix, x = work.tables, work.frozen, work.matrix, work.mid.motion.x
    bodies, couplings, first = tables.bodies, matrix.couplings, work.search.first
    couplings.many[0] = 0
    patches_into(work, h, chord)
    last, coupled, at = -1, -1, 0
    for k in range(frozen.many[0]):
        q, p, ends = frozen.points[k], frozen.pair[k], frozen.ends[k]
        node, other = ends.one, ends.two
        if p != last:
            # of all points, only cells of air may belong to a pair that has a patch
            while at < frozen.many[1] and frozen.patches[at].pair + first < p:
                at += 1
            patch = (
                at < frozen.many[1] and frozen.patches[at].pair + first == p and frozen.patches[at].count > 0
            )
            if patch:
                coupled = frozen.patches[at].coupled
            elif node >= 0 and other >= 0:
                coupled = couplings.many[0]
                couplings.ends[coupled, ONE], couplings.ends[coupled, TWO] = node, other
                couplings.blocks[coupled] = 0.0
                couplings.many[0] = coupled + 1
        last = p
        n = three_from(q, NORMAL)
        if q[KIND] == A_COUPLE:
            y = q[GROWTH] * dot(three_from(q, NOW), n) / q[OVER]
            growth = h * q[SPRING] * q[GROWTH] * steepness(y, q[OVER], chord)
            _couple_into(bodies, ends, n, growth, matrix)
        elif q[KIND] == AIR:
            _point_into(bodies, ends, q, x, outer(scale(h * q[OVER], n), n), coupled, matrix)
        elif q[KIND] == A_DAMPER:
            y = -dot(three_from(q, NOW), n) / q[OVER]
            damping = h * q[SPRING] * q[BETA] * steepness(y, q[OVER], chord)
            _point_into(bodies, ends, q, x, outer(scale(damping, n), n), coupled, matrix)
        else:
            spring, growth, _normal, rate, slip = law_at(q, three_from(q, NOW), h)
            numbers = Numbers(
                spring,
                growth,
                q[PRESSING],
                rate,
                q[OVER],
                q[BETA],
                q[MU_STATIC],
                q[MU_DYNAMIC],
                q[STICTION],
                q[SLIDING],
                q[HOLD],
                True,
            )
            square = three_from(q, SQUARE)
            if q[HOLD] < 0.0:
                t, _, _ = core_stretched(numbers, n, square, slip, three_from(q, FIELD), h, chord, False)
            else:
                t, _, _ = core(numbers, n, square, slip, h, chord, False)
            _point_into(bodies, ends, q, x, t, coupled, matrix)
