"""Energies and contacts of a state, outside the stepping."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.between import faces_into, forces_at
from mdlgen.backends.lattice.kernels.contact.bristles import lay_bristles, patch_energies
from mdlgen.backends.lattice.kernels.contact.sticking import energy_into
from mdlgen.backends.lattice.kernels.forces import joint_forces, near_pairs
from mdlgen.backends.lattice.kernels.integrate.hinges import hinge_energies
from mdlgen.backends.lattice.kernels.state import (
    DEPTH_NOW,
    ELASTIC,
    FACE_POINTS,
    FACE_STORED,
    FORCE_NOW,
    KINETIC,
    POTENTIAL,
    SHEET,
    TURNING_NOW,
)
from mdlgen.backends.lattice.kernels.tuning import EPSILON
from mdlgen.mechanics.arm import AXIAL, FORCE_0, INERTIA, STIFFNESS, hung, way_of
from mdlgen.mechanics.corner import corner_forces
from mdlgen.mechanics.driven import prescribed
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.gate import GATE, course, rate_gate, stop
from mdlgen.mechanics.over_time import weight_changes
from mdlgen.mechanics.point import DEPTH, PRESSING, STORED
from mdlgen.mechanics.turning import turning
from mdlgen.mechanics.vector import back, dot, mat, rotate, three, vec
from mdlgen.model.tables.contacts import BOX_BOX
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def ledger(work, t, energies, rows):
    """Evaluates the state at the end of a step, at time t. Writes the velocities of all bodies into those of
    the midpoint's motion; kinetic, elastic and potential energy into energies (groups, 3); for each row of
    the contacts adds its normal force, FORCE_NOW, and the values of mechanics.turning, TURNING_NOW, and sets
    its greatest depth, DEPTH_NOW."""
    tables, state, mid, islands = work.tables, work.state, work.mid, work.islands
    bodies, gravity, nodes, label = tables.bodies, tables.gravity, tables.nodes, work.free.label
    first, groups, regions = work.search.first, islands.group_of_row, work.search.regions
    x, r, v, l, s, vb = state.x, state.r, state.v, state.l, state.s, state.vb
    u, w, f = mid.motion.u, mid.motion.w, mid.forces
    if weight_changes(tables.changes):
        gravity[:] = 0.0  # until the next step sets it: such a weight has no potential
    u[:] = 0.0
    w[:] = 0.0
    f[:] = 0.0
    energies[:] = 0.0
    for n in range(nodes.size):
        b, group = nodes[n], islands.group[label[n]]
        kinetic = potential = 0.0
        m = mat(r, b)
        j = bodies[b].inertia
        own = back(m, (l[n, 0], l[n, 1], l[n, 2]))
        spin = rotate(m, (own[0] / j[0], own[1] / j[1], own[2] / j[2]))
        mass = bodies[b].mass
        for i in range(3):
            u[b, i], w[b, i] = v[n, i], spin[i]
            kinetic += 0.5 * mass * v[n, i] * v[n, i] + 0.5 * l[n, i] * spin[i]
            potential -= mass * gravity[i] * x[b, i]
        energies[group, KINETIC] += kinetic
        energies[group, POTENTIAL] += potential
    for b in range(bodies.size - 1):
        if bodies[b].swings >= GATE:
            rate_gate(bodies[b], b, course(bodies[b], t).rate, Motion(x, r, u, w))
            continue
        slide, spin_at, p = bodies[b].slide, bodies[b].spin, bodies[b].press
        rate = kinetic = elastic = potential = 0.0
        if slide >= 0:
            way = way_of(bodies[b], vec(x, b))
            kinetic += 0.5 * p[INERTIA] * vb[slide] * vb[slide]
            elastic += 0.5 * p[STIFFNESS] * s[slide] * s[slide] + stop(bodies[b], s[slide], vb[slide]).stored
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
            rate *= bodies[b].ratio
        else:
            rate = prescribed(bodies[b], t)
        if bodies[b].swings == 2:
            rate += vb[slide]
        for i in range(3):
            w[b, i] += rate * bodies[b].axis[i]
        if slide >= 0 or spin_at >= 0:
            own = energies[islands.group[islands.part[b]]]
            own[KINETIC], own[ELASTIC] = own[KINETIC] + kinetic, own[ELASTIC] + elastic
            own[POTENTIAL] += potential
    motion = Motion(x, r, u, w)
    for k in range(tables.runs.shape[0]):
        joints = tables.joints[tables.runs[k, 0] : tables.runs[k, 1]]
        stored, _, _ = joint_forces(joints, tables.points, motion, f)
        energies[islands.group[tables.runs[k, SHEET]], ELASTIC] += stored
    if tables.hinges.size > 0:
        hinge_energies(tables, islands.group, r, energies)
    for k in range(tables.corners.size):
        stored, _ = corner_forces(tables.joints, tables.corners[k], motion, f)
        energies[islands.group[tables.corners[k].sheet], ELASTIC] += stored
    if tables.held.size > 0:
        # as in a step of no length: what holds is the spring as it is, whatever moves now
        lay_bristles(tables, motion, EPSILON)
        patch_energies(tables, groups, energies)
    close = near_pairs(tables, motion, 0.0, 0.0, mid.near)
    count, _ = forces_at(tables, mid, first, motion, close)
    energy_into(mid.sticks, tables.listed, regions, groups, energies)
    for k in range(count):
        pair = tables.pairs[mid.touched[k]]
        if pair.kind == BOX_BOX and mid.faces[k, FACE_POINTS] == 0.0:
            energies[groups[pair.row], ELASTIC] += mid.faces[k, FACE_STORED]
            faces_into(rows, pair.row, mid.faces[k])
            continue
        out = mid.results[mid.rows[k]]
        energies[groups[pair.row], ELASTIC] += out[STORED]
        rows[pair.row, FORCE_NOW] += out[PRESSING]
        rows[pair.row, DEPTH_NOW] = max(rows[pair.row, DEPTH_NOW], out[DEPTH])
        turning(tables.bodies, pair, out, rows, pair.row, TURNING_NOW)
