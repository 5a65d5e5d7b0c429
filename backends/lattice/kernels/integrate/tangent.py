"""The matrix of a step: the sum of mass, damping and stiffness, symmetric, in band and border.

It is the derivative of the step's equations without two small parts: the rotation of forces (geometric
stiffness), and the growth of friction with the normal force, which is not symmetric. Newton's method takes a
few more iterations without them, and the matrix stays positive.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.slopes import hat_left, hat_right
from mdlgen.mechanics.arm import AXIAL, DAMPING, INERTIA, STIFFNESS
from mdlgen.mechanics.axle import acting
from mdlgen.mechanics.curve import curve_spring
from mdlgen.mechanics.gate import stop
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.mechanics.vector import (
    add,
    back,
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
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", forceinline=True)
def _conjugate(m, d):
    """m diag(d) m^T, row by row."""
    xx, xy, xz, yy, yz, zz = (
        m[0] * d[0] * m[0] + m[1] * d[1] * m[1] + m[2] * d[2] * m[2],
        m[0] * d[0] * m[3] + m[1] * d[1] * m[4] + m[2] * d[2] * m[5],
        m[0] * d[0] * m[6] + m[1] * d[1] * m[7] + m[2] * d[2] * m[8],
        m[3] * d[0] * m[3] + m[4] * d[1] * m[4] + m[5] * d[2] * m[5],
        m[3] * d[0] * m[6] + m[4] * d[1] * m[7] + m[5] * d[2] * m[8],
        m[6] * d[0] * m[6] + m[7] * d[1] * m[7] + m[8] * d[2] * m[8],
    )
    return (xx, xy, xz, xy, yy, yz, xz, yz, zz)


@njit(cache=True, error_model="numpy")
def _along(t, n, times):
    """Part of a symmetric matrix t along its principal axis n, times a factor: times (n t n) n n^T."""
    v = times * dot(n, rotate(t, n))
    x, y, z = n
    return (v * x * x, v * x * y, v * x * z, v * y * x, v * y * y, v * y * z, v * z * x, v * z * y, v * z * z)


@njit(cache=True, error_model="numpy")
def _less(times, a, b):
    """times a - b, matrices row by row."""
    return (
        times * a[0] - b[0],
        times * a[1] - b[1],
        times * a[2] - b[2],
        times * a[3] - b[3],
        times * a[4] - b[4],
        times * a[5] - b[5],
        times * a[6] - b[6],
        times * a[7] - b[7],
        times * a[8] - b[8],
    )


@njit(cache=True, error_model="numpy")
def blocks(a, column, offset, sign, t, q, p, g):
    """Adds sign (P_q^T t P_p + g) with P_q = [1, -[q]x] to the block of `column` whose rows begin at
    `offset`: rows are of the body with arm q, columns of that with arm p."""
    right = hat_right(t, p)
    left = hat_left(q, t)
    both = hat_left(q, right)
    for c in range(3):
        for r in range(3):
            a[column, c, offset + r] += sign * t[3 * r + c]
            a[column, 3 + c, offset + r] -= sign * right[3 * r + c]
            a[column, c, offset + 3 + r] += sign * left[3 * r + c]
            a[column, 3 + c, offset + 3 + r] += sign * (g[3 * r + c] - both[3 * r + c])


@njit(cache=True, error_model="numpy", **BORROWS)
def masses(bodies, nodes, r, a):
    """Sets the band to the mass matrix."""
    a[:] = 0.0
    for n in range(nodes.size):
        b = nodes[n]
        j = _conjugate(mat(r, b), three(bodies[b].inertia))
        for i in range(3):
            a[n, i, i] = bodies[b].mass
            for k in range(3):
                a[n, 3 + i, 3 + k] = j[3 * k + i]


@njit(cache=True, error_model="numpy")
def joints_into(tables, joints, h, lag, x, r, a, slots):
    """Adds h (C + lag K) + h^2 K of all joints, where K of a joint that follows a curve is its slope now, and
    `lag` is less the damping time that a joint has itself. `slots`: see state.Matrix."""
    bodies, points, images = tables.bodies, tables.points, tables.images
    last = x.shape[0] - 1
    for i in range(joints.size):
        joint = joints[i]
        one, two = joint.a, joint.b
        if one < 0:
            one = last
        na, nb = bodies[one].node, bodies[two].node
        ma, mb = mat(r, one), mat(r, two)
        fa = matmul(ma, nine(joint.fa))
        theta = log_rotation(transpose_matmul(fa, matmul(mb, nine(joint.fb))))
        m = matmul(fa, exp_rotation(scale(0.5, theta)))
        ra, rb = rotate(ma, three(joint.ra)), rotate(mb, three(joint.rb))
        half = scale(0.5, sub(add(vec(x, two), rb), add(vec(x, one), ra)))
        qa, qb = add(ra, half), sub(rb, half)
        k, c, e = joint.k, joint.c, joint.e
        hk = h * (max(lag - joint.time, 0.0) + h)
        s = (h * c[0] + hk * k[0], h * c[1] + hk * k[1], h * c[2] + hk * k[2])
        if joint.first >= 0:
            own = back(m, scale(2.0, half))
            _, slope, _ = curve_spring(points, joint, own[0] if joint.way == 0 else own[1])
            more = h * h * (slope - k[joint.way])
            s = (s[0] + (more if joint.way == 0 else 0.0), s[1] + (more if joint.way == 1 else 0.0), s[2])
        # two bushings at e and -e also resist rotation: [e]x^T s [e]x
        ee = (
            s[1] * e[2] * e[2] + s[2] * e[1] * e[1] + h * c[3] + hk * k[3],
            -s[2] * e[0] * e[1],
            -s[1] * e[0] * e[2],
            s[0] * e[2] * e[2] + s[2] * e[0] * e[0] + h * c[4] + hk * k[4],
            -s[0] * e[1] * e[2],
            s[0] * e[1] * e[1] + s[1] * e[0] * e[0] + h * c[5] + hk * k[5],
        )
        t = _conjugate(m, s)
        full = (ee[0], ee[1], ee[2], ee[1], ee[3], ee[4], ee[2], ee[4], ee[5])
        g = matmul(matmul(m, full), (m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]))
        if joint.mirrored != 0:
            # the far end moves as the mirror image of this one: P_b [S, -S] = S P_a with S = 1 - 2 n n^T
            n = three(images[0].normal)
            t = _along(t, n, 2.0)
            g = _less(2.0, g, _along(g, n, 2.0))
        if na >= 0:
            blocks(a, na, 0, 1.0, t, qa, qa, g)
        if nb >= 0:
            blocks(a, nb, 0, 1.0, t, qb, qb, g)
        if na >= 0 and nb >= 0:
            if nb > na:
                blocks(a, na, 6 * slots[nb - na], -1.0, t, qb, qa, g)
            else:
                blocks(a, nb, 6 * slots[na - nb], -1.0, t, qa, qb, g)


@njit(cache=True, error_model="numpy")
def rollers_into(tables, h, t, state, d):
    """Sets the corner to the terms of rollers alone: masses, springs, dampers and stops of slides, clutches
    and motors at t, which is h after the state."""
    bodies, axles, ub, s = tables.bodies, tables.shapes.axles, state.ub, state.s
    d[:] = 0.0
    for k in tables.moving:
        p = bodies[k].press
        if bodies[k].slide >= 0:
            slide = bodies[k].slide
            d[slide, slide] = p[INERTIA] + h * p[DAMPING] + h * h * p[STIFFNESS]
            ends = stop(bodies[k], s[slide] + h * ub[slide], ub[slide])
            d[slide, slide] += h * ends.by_rate + h * h * ends.by_place
        at = bodies[k].spin
        if at >= 0 and bodies[k].coupled != FOLLOWER:
            d[at, at] = p[AXIAL] + h * acting(axles, bodies[k], s[at], ub[at], t, h).growth


@njit(cache=True, error_model="numpy", **BORROWS)
def in_box_axes(nodes, r, a, b, offsets, slots):
    """Turns the band and the border from global axes to those of the boxes; `offsets`, `slots`: see
    state.Matrix."""
    for n in range(nodes.size):
        mine = mat(r, nodes[n])
        for offset in offsets:
            if n + offset >= nodes.size:
                break
            other, slot = mat(r, nodes[n + offset]), slots[offset]
            for p in range(0, 6, 3):
                for q in range(6 * slot, 6 * slot + 6, 3):
                    # stored column by column: a[n, c, r]
                    part = (
                        a[n, p, q],
                        a[n, p + 1, q],
                        a[n, p + 2, q],
                        a[n, p, q + 1],
                        a[n, p + 1, q + 1],
                        a[n, p + 2, q + 1],
                        a[n, p, q + 2],
                        a[n, p + 1, q + 2],
                        a[n, p + 2, q + 2],
                    )
                    turned = transpose_matmul(other, matmul(part, mine))
                    for i in range(3):
                        for j in range(3):
                            a[n, p + j, q + i] = turned[3 * i + j]
        for i in range(b.shape[0]):
            for q in range(6 * n, 6 * n + 6, 3):
                v = back(mine, (b[i, q], b[i, q + 1], b[i, q + 2]))
                for c in range(3):
                    b[i, q + c] = v[c]


@njit(cache=True, error_model="numpy", **BORROWS)
def turn_nodes(nodes, r, vector, inward):
    """Turns a vector of the nodes into box axes, or back."""
    for n in range(nodes.size):
        m = mat(r, nodes[n])
        for k in range(6 * n, 6 * n + 6, 3):
            part = (vector[k], vector[k + 1], vector[k + 2])
            part = back(m, part) if inward else rotate(m, part)
            vector[k], vector[k + 1], vector[k + 2] = part
