"""Energies and contacts of a state, outside the stepping."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.between import faces_into, forces_at
from mdlgen.backends.lattice.kernels.contact.sticking import energy_of
from mdlgen.backends.lattice.kernels.forces import joint_forces, near_pairs
from mdlgen.backends.lattice.kernels.state import (
    DEPTH_NOW,
    ELASTIC,
    FACE_POINTS,
    FORCE_NOW,
    KINETIC,
    POTENTIAL,
    TURNING_NOW,
)
from mdlgen.mechanics.arm import AXIAL, FORCE_0, INERTIA, STIFFNESS, hung, way_of
from mdlgen.mechanics.driven import prescribed
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.point import DEPTH, PRESSING
from mdlgen.mechanics.turning import turning
from mdlgen.mechanics.vector import back, dot, mat, rotate, three, vec
from mdlgen.model.tables.contacts import BOX_BOX
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def ledger(tables, state, mid, t, first, energies, rows):
    """Velocities of all bodies at the end of a step, at time t, into those of the midpoint's motion; kinetic,
    elastic and potential energy; adds to each row of the contacts its normal force, FORCE_NOW, and what it
    turns, TURNING_NOW, and has its greatest depth in DEPTH_NOW. `first`: of the pairs that are searched."""
    bodies, gravity, nodes = tables.bodies, tables.gravity, tables.nodes
    x, r, v, l, s, vb = state.x, state.r, state.v, state.l, state.s, state.vb
    u, w, f = mid.motion.u, mid.motion.w, mid.forces
    u[:] = 0.0
    w[:] = 0.0
    f[:] = 0.0
    kinetic = elastic = potential = 0.0
    for n in range(nodes.size):
        b = nodes[n]
        m = mat(r, b)
        j = bodies[b].inertia
        own = back(m, (l[n, 0], l[n, 1], l[n, 2]))
        spin = rotate(m, (own[0] / j[0], own[1] / j[1], own[2] / j[2]))
        mass = bodies[b].mass
        for i in range(3):
            u[b, i], w[b, i] = v[n, i], spin[i]
            kinetic += 0.5 * mass * v[n, i] * v[n, i] + 0.5 * l[n, i] * spin[i]
            potential -= mass * gravity[i] * x[b, i]
    for b in range(bodies.size - 1):
        slide, spin_at, p = bodies[b].slide, bodies[b].spin, bodies[b].press
        rate = 0.0
        if slide >= 0:
            way = way_of(bodies[b], vec(x, b))
            kinetic += 0.5 * p[INERTIA] * vb[slide] * vb[slide]
            elastic += 0.5 * p[STIFFNESS] * s[slide] * s[slide]
            potential -= p[FORCE_0] * s[slide]
            if bodies[b].swings > 0:
                potential += hung(bodies[b], s[slide], three(gravity))
                potential -= bodies[b].mass * dot(vec(x, b), three(gravity))
            else:
                potential -= p[INERTIA] * dot(way, three(gravity)) * s[slide]
            for i in range(3):
                u[b, i] = vb[slide] * way[i]
        if spin_at >= 0:
            rate = vb[spin_at]
            kinetic += 0.5 * p[AXIAL] * rate * rate
        else:
            rate = prescribed(bodies[b], t)
        if bodies[b].swings == 2:
            rate += vb[slide]
        for i in range(3):
            w[b, i] += rate * bodies[b].axis[i]
    motion = Motion(x, r, u, w)
    stored, _, _ = joint_forces(tables.joints, tables.points, motion, f)
    close = near_pairs(tables, motion, 0.0, 0.0, mid.near)
    count, pressed = forces_at(tables, mid, first, motion, close)
    pressed += energy_of(mid.sticks)
    for k in range(count):
        pair = tables.pairs[mid.touched[k]]
        if pair.kind == BOX_BOX and mid.faces[k, FACE_POINTS] == 0.0:
            faces_into(rows, pair.row, mid.faces[k])
            continue
        out = mid.results[mid.rows[k]]
        rows[pair.row, FORCE_NOW] += out[PRESSING]
        rows[pair.row, DEPTH_NOW] = max(rows[pair.row, DEPTH_NOW], out[DEPTH])
        turning(tables.bodies, pair, out, rows, pair.row, TURNING_NOW)
    energies[KINETIC], energies[ELASTIC], energies[POTENTIAL] = kinetic, elastic + stored + pressed, potential
