"""Energies and powers of a System at a state."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.exudyn_local.air import air_forces
from mdlgen.backends.exudyn_local.bristles import held_energy, held_forces
from mdlgen.backends.exudyn_local.forces import INSTANT, behind, bush_forces, corner_at, pair_forces
from mdlgen.backends.exudyn_local.place import place_all
from mdlgen.backends.exudyn_local.state import DRIVING, ELASTIC, HELD, KINETIC, LOST, POTENTIAL, WIDE
from mdlgen.mechanics.arm import (
    AXIAL,
    DAMPING,
    FORCE_0,
    INERTIA,
    STIFFNESS,
    hung,
    speeding,
    torque_of,
)
from mdlgen.mechanics.axle import acting
from mdlgen.mechanics.driven import prescribed
from mdlgen.mechanics.gate import GATE, power_of, stop
from mdlgen.mechanics.over_time import set_to, weight_changes
from mdlgen.mechanics.point import (
    DISSIPATED,
    FORCE_B,
    OUT,
    STORED,
    TORQUE_A,
    TORQUE_B,
)
from mdlgen.mechanics.turning import turning
from mdlgen.mechanics.vector import (
    add,
    back,
    cross,
    dot,
    mat,
    rotate,
    three,
    three_from,
    vec,
)
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def _seen(bodies, pair, motion, t, out, pair_out, i):
    """Copies the result of a pair, in `out` with its points, into its row of `pair_out`; returns the power
    that it takes from prescribed rotations."""
    row, power = pair_out[i], 0.0
    for k in range(OUT):
        row[k] = out[k]
    turning(bodies, pair, out, pair_out, i, OUT)
    for body, torque_at in ((pair.a, TORQUE_A), (pair.b, TORQUE_B)):
        if bodies[body].first < 0 and bodies[body].spin < 0:
            about = dot(three_from(row, torque_at), three(bodies[body].axis))
            power += about * prescribed(bodies[body], t)
    if bodies[pair.b].swings >= GATE:
        power += power_of(motion, pair.b, three_from(row, FORCE_B), three_from(row, TORQUE_B))
    return power


@njit(cache=True, error_model="numpy")
def _weights(tables, at, motion):
    """Power of all weights [W]."""
    bodies, gravity, power = tables.bodies, three(tables.gravity), 0.0
    for body in range(bodies.size - 1):
        slide, rate = bodies[body].slide, dot(gravity, vec(motion.u, body))
        if bodies[body].first >= 0:
            power += bodies[body].mass * rate
        elif slide >= 0 and bodies[body].swings == 0:
            power += bodies[body].press[INERTIA] * rate
        elif slide >= 0:
            torque = torque_of(bodies[body], at.q[slide], gravity, at.t, INSTANT)
            torque += speeding(bodies[body], at.t, INSTANT)
            power += bodies[body].mass * rate + torque * at.v[slide]
    return power


@njit(cache=True, error_model="numpy")
def ledger(tables, at, work, pair_out, totals):
    """Energies and powers at a state into `totals` (columns KINETIC, ELASTIC, ... of state.py).

    Also leaves the result of each pair in `pair_out` (p, SEEN) and the bodies' motion in `work`.
    """
    bodies, pairs, loads, gravity = tables.bodies, tables.pairs, tables.loads, tables.gravity
    motion, f = work.motion, work.forces
    x, r, u, w = motion
    q, v, t = at
    set_to(tables.changes, loads, gravity, t, t)
    place_all(bodies, at, motion)
    kinetic = elastic = potential = lost = driven = 0.0
    if weight_changes(tables.changes):
        driven += _weights(tables, at, motion)
        gravity[:] = 0.0  # until it is set again: such a weight has no potential
    for body in range(bodies.size - 1):
        if bodies[body].first >= 0:
            spin = back(mat(r, body), vec(w, body))
            kinetic += 0.5 * bodies[body].mass * dot(vec(u, body), vec(u, body))
            for i in range(3):
                kinetic += 0.5 * bodies[body].inertia[i] * spin[i] * spin[i]
            potential -= bodies[body].mass * dot(three(gravity), vec(x, body))
        k = bodies[body].slide
        if k >= 0:
            p = bodies[body].press
            kinetic += 0.5 * p[INERTIA] * v[k] * v[k]
            potential -= p[FORCE_0] * q[k]
            if bodies[body].swings > 0:
                potential += hung(bodies[body], q[k], three(gravity))
                potential -= bodies[body].mass * dot(three(gravity), vec(x, body))
                driven -= speeding(bodies[body], t, INSTANT) * v[k]
            else:
                potential -= p[INERTIA] * dot(three(gravity), three(bodies[body].way)) * q[k]
            ends = stop(bodies[body], q[k], v[k])
            elastic += 0.5 * p[STIFFNESS] * q[k] * q[k] + ends.stored
            lost += p[DAMPING] * v[k] * v[k] + ends.lost
        if bodies[body].spin >= 0:
            spun = v[bodies[body].spin]
            kinetic += 0.5 * bodies[body].press[AXIAL] * spun**2
            lag = behind(tables, bodies[body], at)
            does = acting(tables.shapes.axles, bodies[body], lag, spun, t, 0.0)
            lost += does.lost
            driven += does.given
    for i in range(tables.bushings.size):
        energy, power = bush_forces(tables, tables.bushings[i], q, motion, f)
        elastic += energy
        lost += power
    for i in range(tables.corners.size):
        energy, power = corner_at(tables, tables.corners[i], q, work)
        elastic += energy
        lost += power
    whole = np.zeros(WIDE)
    for i in range(pairs.size):
        if tables.stick.patch_of[i] < 0 and pair_forces(tables, pairs[i], q, motion, f, whole):
            driven -= _seen(bodies, pairs[i], motion, t, whole, pair_out, i)
            elastic += whole[STORED]
            lost += whole[DISSIPATED]
    held = 0.0
    if tables.stick.pairs.size > 0:
        for row in range(held_forces(tables, at, motion, f)):
            i, out = tables.stick.touched[row], tables.stick.rows[row]
            driven -= _seen(bodies, pairs[i], motion, t, out, pair_out, i)
            elastic += out[STORED]
            lost += out[DISSIPATED]
        held = held_energy(tables, v)
    for i in range(loads.size):
        load = loads[i]
        body = load.body
        arm = rotate(mat(r, body), three(load.local))
        rate = add(vec(u, body), cross(vec(w, body), arm))
        driven += dot(three(load.force), rate) + dot(three(load.moment), vec(w, body))
    lost += air_forces(tables, at, motion, f)
    totals[KINETIC], totals[ELASTIC], totals[POTENTIAL] = kinetic, elastic + held, potential
    totals[LOST], totals[DRIVING], totals[HELD] = lost, driven, held
