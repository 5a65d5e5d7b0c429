"""Response of contact points and patches with frozen geometry to a change of the velocities: their rates
along it, their forces, and the slope of the minimised function."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.integrate.air import air_along
from mdlgen.backends.lattice.kernels.integrate.patches import patches_along, patches_slope, pull_patches
from mdlgen.backends.lattice.kernels.integrate.points import force_of
from mdlgen.backends.lattice.kernels.integrate.unknowns import moving, turning_of
from mdlgen.backends.lattice.kernels.state import (
    A_COUPLE,
    AIR,
    ALONG,
    ARM_A,
    ARM_B,
    DIRECTION,
    GROWTH,
    KIND,
    NORMAL,
    NOW,
    OF_DIRECTION,
    SPRING,
    START,
)
from mdlgen.mechanics.vector import add, cross, dot, scale, sub, three_from, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _rate_of(bodies, ends, q, x, change, changeb, matrix):
    """Change of the velocity of a point for a change of the velocities of nodes and border."""
    one, two = ends.one, ends.two
    v = (0.0, 0.0, 0.0)
    if q[KIND] == A_COUPLE:
        n = three_from(q, NORMAL)
        turning = 0.0
        if one >= 0:
            turning += dot(three_from(change, 6 * one + 3), n)
        if two >= 0:
            turning -= dot(three_from(change, 6 * two + 3), n)
        for which in range(4):
            unknown, part = turning_of(bodies, ends, which, n)
            if unknown >= 0:
                turning += part * changeb[unknown]
        return scale(turning, n)
    direction, index = matrix.direction, matrix.unknowns
    arm, far, many = three_from(q, ARM_A), three_from(q, ARM_B), 0
    if one >= 0:
        v = add(three_from(change, 6 * one), cross(three_from(change, 6 * one + 3), arm))
    else:
        many = moving(bodies[ends.a], arm, vec(x, ends.a), 1.0, direction, index, many)
    if two >= 0:
        v = sub(v, add(three_from(change, 6 * two), cross(three_from(change, 6 * two + 3), far)))
    else:
        many = moving(bodies[ends.b], far, vec(x, ends.b), -1.0, direction, index, many)
    for i in range(many):
        v = add(v, scale(changeb[index[i]], three_from(direction[i], 0)))
    return v


@njit(cache=True, error_model="numpy", **BORROWS)
def _along(work, k):
    """Stores the change of the velocity of a point along the direction, in global axes."""
    tables, frozen, x = work.tables, work.frozen, work.mid.motion.x
    q, ends = frozen.points[k], frozen.ends[k]
    change, changeb = frozen.vectors[OF_DIRECTION], frozen.border[DIRECTION]
    v = _rate_of(tables.bodies, ends, q, x, change, changeb, work.matrix)
    for i in range(3):
        q[ALONG + i] = v[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def look_along(work, h):
    """Stores the changes of the velocities of all points and patches along the direction, which is in global
    axes in the vectors' OF_DIRECTION. Evaluates the part of patches in the slope at its end."""
    frozen = work.frozen
    for k in range(frozen.many[0]):
        _along(work, k)
    frozen.of_patches[0] = patches_along(work, h)
    if work.film.many[0] > 0:
        air_along(work.film, frozen)


@njit(cache=True, error_model="numpy", **BORROWS)
def pull(work, h, part, g, gb):
    """Changes the velocities of all points and patches by a part of the direction, at which the slope was
    evaluated last. Subtracts the changes of their forces since the iteration began from g (6 nodes,), in
    global axes, and from gb."""
    tables, frozen, matrix, x = work.tables, work.frozen, work.matrix, work.mid.motion.x
    bodies, direction, index = tables.bodies, matrix.direction, matrix.unknowns
    pull_patches(work, h, part, g)
    for k in range(frozen.many[0]):
        q = frozen.points[k]
        for i in range(3):
            q[NOW + i] += part * q[ALONG + i]
        if q[KIND] == AIR:
            q[SPRING] += part * q[GROWTH]
        f = scale(h, sub(force_of(q, three_from(q, NOW), h), three_from(q, START)))
        if f[0] == 0.0 and f[1] == 0.0 and f[2] == 0.0:
            continue
        ends = frozen.ends[k]
        one, two = ends.one, ends.two
        if q[KIND] == A_COUPLE:
            for i in range(3):
                if one >= 0:
                    g[6 * one + 3 + i] -= f[i]
                if two >= 0:
                    g[6 * two + 3 + i] += f[i]
            n = three_from(q, NORMAL)
            for which in range(4):
                unknown, turning = turning_of(bodies, ends, which, n)
                if unknown >= 0:
                    gb[unknown] -= turning * dot(f, n)
            continue
        arm, far, many = three_from(q, ARM_A), three_from(q, ARM_B), 0
        if one >= 0:
            t = cross(arm, f)
            for i in range(3):
                g[6 * one + i] -= f[i]
                g[6 * one + 3 + i] -= t[i]
        else:
            many = moving(bodies[ends.a], arm, vec(x, ends.a), 1.0, direction, index, many)
        if two >= 0:
            t = cross(far, f)
            for i in range(3):
                g[6 * two + i] += f[i]
                g[6 * two + 3 + i] += t[i]
        else:
            many = moving(bodies[ends.b], far, vec(x, ends.b), -1.0, direction, index, many)
        for i in range(many):
            gb[index[i]] -= dot(three_from(direction[i], 0), f)


@njit(cache=True, error_model="numpy", **BORROWS)
def _points_slope(frozen, h, far):
    """Part of points in the slope, without its factor -h."""
    total = 0.0
    for k in range(frozen.many[0]):
        q = frozen.points[k]
        way = three_from(q, ALONG)
        if q[KIND] == AIR:
            total += (q[SPRING] + far * q[GROWTH]) * dot(three_from(q, NORMAL), way)
            continue
        f = force_of(q, add(three_from(q, NOW), scale(far, way)), h)
        total += dot(sub(f, three_from(q, START)), way)
    return total


@njit(cache=True, error_model="numpy", **BORROWS)
def slope(work, h, far, looked):
    """Part of points and patches in the slope of the minimised function, at the part `far` of the direction;
    `looked`: at its end, where look_along has just evaluated the patches."""
    frozen = work.frozen
    if not looked:
        frozen.of_patches[0] = patches_slope(work, h, far)
    return -h * (_points_slope(frozen, h, far) + frozen.of_patches[0])
