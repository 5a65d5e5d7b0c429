"""Joints that yield in bending, in the steps of the midpoint rule: see mechanics.plastic.

A step begins with the plastic rotations of the last accepted step. Iterations, and steps that are repeated,
do not change them.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.integrate.tangent import blocks
from mdlgen.backends.lattice.kernels.state import DISSIPATED, ELASTIC, SHEET
from mdlgen.mechanics.plastic import accept, bending, couple, in_the_middle, stored, yields
from mdlgen.mechanics.vector import dot, mat, matmul, nine, scale, sub, three
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _frames(joint, r):
    """Bodies of a joint, and its frames on them."""
    a = joint.a if joint.a >= 0 else r.shape[0] - 1
    return a, joint.b, matmul(mat(r, a), nine(joint.fa)), matmul(mat(r, joint.b), nine(joint.fb))


@njit(cache=True, error_model="numpy", **BORROWS)
def begin_hinges(tables, r):
    """Stores the rotations at the beginning of a step; r: rotations of the bodies (bodies, 9)."""
    for k in range(tables.hinges.size):
        hinge = tables.hinges[k]
        _, _, fa, fb = _frames(tables.joints[hinge.joint], r)
        hinge.begun = bending(fa, fb, hinge.axis)


@njit(cache=True, error_model="numpy", **BORROWS)
def _couples(f, a, b, torque):
    for i in range(3):
        f[a, 3 + i] -= torque[i]
        f[b, 3 + i] += torque[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def hinge_forces(tables, r, f):
    """Adds the contribution of hinges to the forces f (bodies, 6), at the rotations r in the middle of a
    step."""
    for k in range(tables.hinges.size):
        hinge = tables.hinges[k]
        a, b, fa, fb = _frames(tables.joints[hinge.joint], r)
        p = in_the_middle(hinge, bending(fa, fb, hinge.axis))
        if p != 0.0:
            _couples(f, a, b, couple(fa, fb, hinge.axis, hinge.k * p))


@njit(cache=True, error_model="numpy", **BORROWS)
def _sheet_of(runs, joint):
    """The sheet of a joint, by its number."""
    for k in range(runs.shape[0]):
        if runs[k, 0] <= joint < runs[k, 1]:
            return runs[k, SHEET]
    return 0


@njit(cache=True, error_model="numpy", **BORROWS)
def end_hinges(work, energies):
    """Ends an accepted step: updates plastic rotations, and adds the energy that they dissipate to energies
    (groups, 4)."""
    tables, group = work.tables, work.islands.group
    for k in range(tables.hinges.size):
        hinge = tables.hinges[k]
        _, _, fa, fb = _frames(tables.joints[hinge.joint], work.mid.motion.r)
        lost = accept(hinge, hinge.begun, 2.0 * bending(fa, fb, hinge.axis) - hinge.begun)
        if lost != 0.0:
            part = 1.0 if tables.joints[hinge.joint].mirrored == 0 else 0.5
            energies[group[_sheet_of(tables.runs, hinge.joint)], DISSIPATED] += part * lost


@njit(cache=True, error_model="numpy", **BORROWS)
def hinge_energies(tables, group, r, energies):
    """Adds the stored energy of hinges to the energies (groups, 3), less that of their joints without them,
    at the rotations r at the end of a step; `group`: group of each part."""
    for k in range(tables.hinges.size):
        hinge = tables.hinges[k]
        _, _, fa, fb = _frames(tables.joints[hinge.joint], r)
        part = 1.0 if tables.joints[hinge.joint].mirrored == 0 else 0.5
        more = stored(hinge, bending(fa, fb, hinge.axis), hinge.plastic)
        energies[group[_sheet_of(tables.runs, hinge.joint)], ELASTIC] += part * more


@njit(cache=True, error_model="numpy", **BORROWS)
def hinges_into(tables, h, r, a, slots):
    """Reduces the band by h^2 times the decrease of stiffness due to yielding. Then it has the derivative of
    the moments of the step: k H/(k + H) where a hinge yields. r: rotations in the middle of the step;
    `slots`: see state.Matrix."""
    bodies, images = tables.bodies, tables.images
    none = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for k in range(tables.hinges.size):
        hinge = tables.hinges[k]
        joint = tables.joints[hinge.joint]
        one, two, fa, fb = _frames(joint, r)
        t = bending(fa, fb, hinge.axis)
        if not yields(hinge, 2.0 * t - hinge.begun):
            continue
        axis = couple(fa, fb, hinge.axis, 1.0)
        less = h * h * hinge.k * hinge.k / (hinge.k + hinge.hardening)
        if joint.mirrored != 0:
            # the far end turns as the mirror image of this one, see tangent.joints_into
            n = three(images[0].normal)
            axis = sub(axis, scale(dot(n, axis), n))
            less *= 2.0
        m = axis
        g = (
            m[0] * m[0],
            m[0] * m[1],
            m[0] * m[2],
            m[1] * m[0],
            m[1] * m[1],
            m[1] * m[2],
            m[2] * m[0],
            m[2] * m[1],
            m[2] * m[2],
        )
        na, nb = bodies[one].node, bodies[two].node
        p = (0.0, 0.0, 0.0)  # a couple has no arm
        if na >= 0:
            blocks(a, na, 0, -less, none, p, p, g)
        if nb >= 0:
            blocks(a, nb, 0, -less, none, p, p, g)
        if na >= 0 and nb >= 0:
            if nb > na:
                blocks(a, na, 6 * slots[nb - na], less, none, p, p, g)
            else:
                blocks(a, nb, 6 * slots[na - nb], less, none, p, p, g)
