"""Energy balance of a step for each group of parts: dissipation, and the work of drives and loads.

A group has all parts that may ever touch each other. No energy passes between groups, so each has its own
balance: a loss in one group cannot hide a gain in another one.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.integrate.carry import spun
from mdlgen.backends.lattice.kernels.state import (
    DAMPED_NUMERICALLY,
    DISSIPATED,
    DRIVEN,
    FACE_LOST,
    FACE_POINTS,
    LOST,
    NUMERICAL,
    OWN_MASS,
    POWER,
    SHEET,
    THROUGH_DRIVES,
)
from mdlgen.mechanics.arm import AXIAL, DAMPING, INERTIA, speeding, torque_of
from mdlgen.mechanics.axle import acting
from mdlgen.mechanics.driven import SENSE, prescribed
from mdlgen.mechanics.gate import GATE, power_of, stop
from mdlgen.mechanics.over_time import weight_changes
from mdlgen.mechanics.point import DISSIPATED as OF_PAIR
from mdlgen.mechanics.point import FORCE_B, TORQUE_A, TORQUE_B
from mdlgen.mechanics.vector import add, cross, dot, mat, rotate, three, three_from, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _loads(work, driven):
    """Power of the loads, by groups [N mm/ms]."""
    loads, motion, islands = work.tables.loads, work.mid.motion, work.islands
    for k in range(loads.size):
        b, force, moment = loads[k].body, three(loads[k].force), three(loads[k].moment)
        arm, w = rotate(mat(motion.r, b), three(loads[k].local)), vec(motion.w, b)
        power = dot(force, add(vec(motion.u, b), cross(w, arm))) + dot(moment, w)
        driven[islands.group[max(islands.part[b], 0)]] += power


@njit(cache=True, error_model="numpy", **BORROWS)
def _weights(work, t, h, driven):
    """Power of the weights, by groups [N mm/ms], where gravity changes; t: the middle of the step, h: half of
    it [ms]."""
    tables, state, motion, islands = work.tables, work.state, work.mid.motion, work.islands
    gravity, bodies, label = three(tables.gravity), tables.bodies, work.free.label
    for n in range(tables.nodes.size):
        rate = vec(motion.u, tables.nodes[n])
        driven[islands.group[label[n]]] += tables.boxes[n, OWN_MASS] * dot(gravity, rate)
    for b in tables.moving:
        slide = bodies[b].slide
        if slide < 0:
            continue
        mass = bodies[b].press[INERTIA] if bodies[b].swings == 0 else bodies[b].mass
        power = mass * dot(gravity, vec(motion.u, b))
        if bodies[b].swings > 0:
            angle = state.s[slide] + h * state.ub[slide]
            torque = torque_of(bodies[b], angle, gravity, t, h) + speeding(bodies[b], t, h)
            power += torque * state.ub[slide]
        driven[islands.group[islands.part[b]]] += power


@njit(cache=True, error_model="numpy", **BORROWS)
def _contacts(work, t, dt, count, energies, driven):
    """Adds the dissipation of contacts and air, and the power that they take from prescribed drives. t: the
    middle of the step [ms]."""
    tables, mid, film, islands = work.tables, work.mid, work.film, work.islands
    bodies, pairs, listed = tables.bodies, tables.pairs, tables.listed
    first = pairs.size - listed.size
    for k in range(count):
        p = mid.touched[k]
        if p >= first and mid.faces[k, FACE_POINTS] == 0.0:
            group = islands.group_of_row[work.search.regions[listed[p - first].region].row]
            energies[group, DISSIPATED] += dt * mid.faces[k, FACE_LOST]
            continue
        out, group = mid.results[mid.rows[k]], islands.group_of_row[pairs[p].row]
        energies[group, DISSIPATED] += dt * out[OF_PAIR]
        for b, torque in ((pairs[p].a, TORQUE_A), (pairs[p].b, TORQUE_B)):
            if islands.part[b] >= 0 and not islands.answers[islands.part[b]]:
                about = dot(three_from(out, torque), three(bodies[b].axis))
                driven[group] -= prescribed(bodies[b], t) * about
        b = pairs[p].b
        if bodies[b].swings >= GATE:
            driven[group] -= power_of(mid.motion, b, three_from(out, FORCE_B), three_from(out, TORQUE_B))
    for k in range(film.many[0]):
        group, i = islands.group_of_row[pairs[film.listed[k]].row], film.head[film.listed[k]]
        while i >= 0:
            own = film.cells[i]
            energies[group, DISSIPATED] += dt * own.area * own.pressure * own.rate
            i = own.following


@njit(cache=True, error_model="numpy", **BORROWS)
def account(work, t, dt, count, energies, driven):
    """Adds a step from t to the energies (groups, 4): dissipation; work of drives and loads; the magnitude of
    that work; the part of the dissipation due to numerical damping of joints. `count`: how many pairs touch;
    driven (groups,): scratch."""
    tables, mid, state, islands = work.tables, work.mid, work.state, work.islands
    bodies, axles, f, ub, vb = tables.bodies, tables.shapes.axles, mid.forces, state.ub, state.vb
    driven[:] = 0.0
    for k in range(tables.runs.shape[0]):
        group = islands.group[tables.runs[k, SHEET]]
        energies[group, DISSIPATED] += dt * mid.spent[k, LOST]
        energies[group, DAMPED_NUMERICALLY] += dt * mid.spent[k, NUMERICAL]
    several = energies.shape[0] > 1
    if several:
        _loads(work, driven)
        _contacts(work, t + 0.5 * dt, dt, count, energies, driven)
    else:
        energies[0, DISSIPATED] += dt * mid.totals[LOST]
        driven[0] += mid.totals[POWER]
    if weight_changes(tables.changes):
        _weights(work, t + 0.5 * dt, 0.5 * dt, driven)
    for b in tables.moving:
        group = islands.group[islands.part[b]]
        if bodies[b].swings >= GATE:
            if not several:
                driven[group] -= power_of(mid.motion, b, vec(f, b), (f[b, 3], f[b, 4], f[b, 5]))
            continue
        lost = 0.0
        if bodies[b].clutch[SENSE] != 0.0:
            at = bodies[b].spin
            spin, before = ub[at], vb[at]
            does = acting(axles, bodies[b], state.s[at], spin, t + 0.5 * dt, 0.5 * dt)
            lost += does.lost
            driven[group] += does.given
            ahead, after = 2.0 * spin - before, spun(axles, bodies[b], state.s[at], spin, before, t, dt)
            lost += 0.5 * bodies[b].press[AXIAL] * (ahead * ahead - after * after) / dt
        elif bodies[b].corners > 0 and (islands.answers[islands.part[b]] or not several):
            rate, axis = prescribed(bodies[b], t + 0.5 * dt), bodies[b].axis
            driven[group] -= rate * (f[b, 3] * axis[0] + f[b, 4] * axis[1] + f[b, 5] * axis[2])
            if bodies[b].swings == 2:
                driven[group] -= speeding(bodies[b], t + 0.5 * dt, 0.5 * dt) * ub[bodies[b].slide]
        if bodies[b].slide >= 0:
            slide = bodies[b].slide
            lost += bodies[b].press[DAMPING] * ub[slide] ** 2
            lost += stop(bodies[b], state.s[slide] + 0.5 * dt * ub[slide], ub[slide]).lost
        energies[group, DISSIPATED] += dt * lost
    for group in range(driven.size):
        energies[group, DRIVEN] += dt * driven[group]
        energies[group, THROUGH_DRIVES] += dt * abs(driven[group])
