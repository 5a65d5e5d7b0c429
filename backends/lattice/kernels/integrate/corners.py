"""Part of Poisson's effect in the matrix of a step: couplings of the joints around corners."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.integrate.tangent import blocks
from mdlgen.mechanics.corner import axes_of, standing
from mdlgen.mechanics.vector import add, scale, sub
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def _outer(times, a, b):
    """Matrix `times` a b^T (9), row by row."""
    x, y, z = scale(times, a)
    return (x * b[0], x * b[1], x * b[2], y * b[0], y * b[1], y * b[2], z * b[0], z * b[1], z * b[2])


@njit(cache=True, error_model="numpy")
def _couple(a, slots, one, two, stretch, bend):
    """Adds the coupling block of an end of one joint and an end of another one; where both are the same node,
    its transpose, too. Each end is (node, arm, sign, bending axis, stretching axis)."""
    n, p, s, m, e = one
    k, q, t, o, d = two
    if n < 0 or k < 0:
        return
    if k >= n:
        blocks(a, n, 6 * slots[k - n], s * t, _outer(stretch, d, e), q, p, _outer(bend, o, m))
    if n >= k:
        blocks(a, k, 6 * slots[n - k], s * t, _outer(stretch, e, d), p, q, _outer(bend, m, o))


@njit(cache=True, error_model="numpy")
def _ends(joint, bodies, x, r, along_x):
    """Both ends of a joint, in the form that `_couple` takes."""
    middle, _theta, gap, ra, rb = standing(joint, x, r)
    about, along = axes_of(middle, along_x)
    a = bodies[joint.a].node if joint.a >= 0 else -1
    first = (a, add(ra, scale(0.5, gap)), -1.0, about, along)
    return first, (bodies[joint.b].node, sub(rb, scale(0.5, gap)), 1.0, about, along)


@njit(cache=True, error_model="numpy")
def corners_into(tables, h, x, r, a, slots):
    """Adds h C + h^2 K of all corners to the band a. `slots`: see state.Matrix."""
    bodies, joints, corners = tables.bodies, tables.joints, tables.corners
    for c in range(corners.size):
        corner = corners[c]
        for i in range(2):
            for j in range(2):
                one, two = corner.joint[i], corner.joint[2 + j]
                if one < 0 or two < 0:
                    continue
                k = 2 * i + j
                stretch = h * corner.stretch_damping[k] + h * h * corner.stretch[k]
                bend = h * corner.bend_damping[k] + h * h * corner.bend[k]
                begin, end = _ends(joints[one], bodies, x, r, True)
                start, stop = _ends(joints[two], bodies, x, r, False)
                _couple(a, slots, begin, start, stretch, bend)
                _couple(a, slots, begin, stop, stretch, bend)
                _couple(a, slots, end, start, stretch, bend)
                _couple(a, slots, end, stop, stretch, bend)
