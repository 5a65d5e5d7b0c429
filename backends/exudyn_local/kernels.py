"""Compiled forces, jacobian and energy of a System in the solver's coordinates."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.exudyn_local.state import DRIVING, ELASTIC, KINETIC, LOST, POTENTIAL, Work
from mdlgen.backends.exudyn_local.system import System
from mdlgen.mechanics.arm import (
    AXIAL,
    DAMPING,
    FORCE_0,
    INERTIA,
    STIFFNESS,
    hung,
    moved,
    speeding,
    torque_of,
    turn_of,
    way_of,
)
from mdlgen.mechanics.bushing import bushing
from mdlgen.mechanics.curve import curve_excess, middle_and_gap
from mdlgen.mechanics.driven import clutch, prescribed, turned
from mdlgen.mechanics.frame import Frame, Motion
from mdlgen.mechanics.pair import pair_force
from mdlgen.mechanics.point import (
    DISSIPATED,
    FORCE_A,
    FORCE_B,
    MOST_POINTS,
    OUT,
    POINT,
    STORED,
    TORQUE_A,
    TORQUE_B,
)
from mdlgen.mechanics.turning import TURNING, turning
from mdlgen.mechanics.vector import (
    add,
    back,
    cross,
    dot,
    exp_rotation,
    mat,
    matmul,
    nine,
    rotate,
    scale,
    three,
    three_from,
    vec,
)
from mdlgen.model.tables import Ints
from mdlgen.program.kernel import njit

# What is seen of a pair at a state: what it does, and what it turns; and with its points.
SEEN, WIDE = OUT + TURNING, OUT + 1 + POINT * MOST_POINTS
# Perturbations of the difference quotients: positions and Euler parameters, velocities [SI]. A static run
# takes central quotients: a joint bends 1e5 times easier than it stretches, and a one-sided quotient of the
# stretching part would hide the bending; in a transient run the mass stands in between.
_E_POSITION, _E_VELOCITY = 1e-9, 1e-6
_E_CENTRAL = 1e-7
# Either way of a time the speed of a drive is taken for its growth [s].
_INSTANT = 1e-7


@njit(cache=True, error_model="numpy", forceinline=True)
def place_body(bodies, body, at, motion):
    """Position, rotation, velocity and angular velocity (global) of one body at some Coordinates."""
    q, v, t = at
    x, r, u, w = motion
    ref = bodies[body].reference
    for i in range(3):
        x[body, i] = ref[i]
        u[body, i] = 0.0
        w[body, i] = 0.0
    e0, e1, e2, e3 = ref[3], ref[4], ref[5], ref[6]
    n = bodies[body].first
    if n >= 0:
        for i in range(3):
            x[body, i] += q[n + i]
            u[body, i] = v[n + i]
        e0 += q[n + 3]
        e1 += q[n + 4]
        e2 += q[n + 5]
        e3 += q[n + 6]
        d0, d1, d2, d3 = v[n + 3], v[n + 4], v[n + 5], v[n + 6]
        w[body, 0] = 2 * (-e1 * d0 + e0 * d1 - e3 * d2 + e2 * d3)
        w[body, 1] = 2 * (-e2 * d0 + e3 * d1 + e0 * d2 - e1 * d3)
        w[body, 2] = 2 * (-e3 * d0 - e2 * d1 + e1 * d2 + e0 * d3)
    r[body, 0] = 1 - 2 * (e2 * e2 + e3 * e3)
    r[body, 1] = 2 * (e1 * e2 - e0 * e3)
    r[body, 2] = 2 * (e1 * e3 + e0 * e2)
    r[body, 3] = 2 * (e1 * e2 + e0 * e3)
    r[body, 4] = 1 - 2 * (e1 * e1 + e3 * e3)
    r[body, 5] = 2 * (e2 * e3 - e0 * e1)
    r[body, 6] = 2 * (e1 * e3 - e0 * e2)
    r[body, 7] = 2 * (e2 * e3 + e0 * e1)
    r[body, 8] = 1 - 2 * (e1 * e1 + e2 * e2)
    k = bodies[body].slide
    if k >= 0:
        place = moved(bodies[body], vec(x, body), q[k])
        way = way_of(bodies[body], place)
        for i in range(3):
            x[body, i] = place[i]
            u[body, i] += v[k] * way[i]
    spin = bodies[body].spin
    if bodies[body].rims > 0:
        angle = q[spin] if spin >= 0 else turned(bodies[body], t)
        if bodies[body].swings == 2:
            angle += q[k]
        m = matmul(exp_rotation(scale(angle, three(bodies[body].axis))), mat(r, body))
        for i in range(9):
            r[body, i] = m[i]
    rate = v[spin] if spin >= 0 else prescribed(bodies[body], t)
    if bodies[body].swings == 2:
        rate += v[k]
    for i in range(3):
        w[body, i] += rate * bodies[body].axis[i]
    if bodies[body].carries != 0:  # a mesh shows how far the roller has turned
        angle = q[spin] if spin >= 0 else turned(bodies[body], t)
        m = matmul(exp_rotation(scale(angle, three(bodies[body].axis))), mat(r, body))
        for i in range(9):
            r[body, i] = m[i]


@njit(cache=True, error_model="numpy")
def place_all(bodies, at, motion):
    """The Motion of all bodies at some Coordinates."""
    for body in range(bodies.size):
        place_body(bodies, body, at, motion)


@njit(cache=True, error_model="numpy", forceinline=True)
def _spread(bodies, body, q, force, torque, f):
    """Adds a force and a torque at a body's centre to the generalised forces."""
    n = bodies[body].first
    if n >= 0:
        ref = bodies[body].reference
        e0, e1, e2, e3 = ref[3] + q[n + 3], ref[4] + q[n + 4], ref[5] + q[n + 5], ref[6] + q[n + 6]
        for i in range(3):
            f[n + i] += force[i]
        a, b, c = torque
        f[n + 3] += 2 * (-e1 * a - e2 * b - e3 * c)
        f[n + 4] += 2 * (e0 * a + e3 * b - e2 * c)
        f[n + 5] += 2 * (-e3 * a + e0 * b + e1 * c)
        f[n + 6] += 2 * (e2 * a - e1 * b + e0 * c)
        return
    if bodies[body].slide >= 0:
        ref = bodies[body].reference
        at = moved(bodies[body], (ref[0], ref[1], ref[2]), q[bodies[body].slide])
        f[bodies[body].slide] += dot(force, way_of(bodies[body], at)) + dot(torque, turn_of(bodies[body]))
    if bodies[body].spin >= 0:
        f[bodies[body].spin] += dot(torque, three(bodies[body].axis))


@njit(cache=True, error_model="numpy", forceinline=True)
def _bush(tables, bush, q, motion, f):
    """One bushing; returns (stored energy, dissipated power)."""
    bodies, points = tables.bodies, tables.points
    x, r, u, w = motion
    a, b = bush.a, bush.b
    ma, mb = mat(r, a), mat(r, b)
    fa, fb = matmul(ma, nine(bush.fa)), matmul(mb, nine(bush.fb))
    ra, rb = rotate(ma, three(bush.ra)), rotate(mb, three(bush.rb))
    k, c = bush.k, bush.c
    force, torque_b, torque_a, energy, power = bushing(
        Frame(vec(x, a), fa, vec(u, a), vec(w, a)),
        ra,
        Frame(vec(x, b), fb, vec(u, b), vec(w, b)),
        rb,
        (k[0], k[1], k[2]),
        (k[3], k[4], k[5]),
        (c[0], c[1], c[2]),
        (c[3], c[4], c[5]),
    )
    _spread(bodies, a, q, (-force[0], -force[1], -force[2]), torque_a, f)
    _spread(bodies, b, q, force, torque_b, f)
    if bush.first >= 0:
        middle, gap = middle_and_gap(vec(x, a), fa, ra, vec(x, b), fb, rb)
        force, torque_b, torque_a, more = curve_excess(points, bush, middle, gap, ra, rb)
        _spread(bodies, a, q, (-force[0], -force[1], -force[2]), torque_a, f)
        _spread(bodies, b, q, force, torque_b, f)
        energy += more
    return energy, power


@njit(cache=True, error_model="numpy")
def _pair(tables, pair, q, motion, f, out):
    """One contact pair into `out`; returns whether it touches."""
    out[:] = 0.0
    if not pair_force(tables.bodies, pair, tables.meshes, motion, out):
        return False
    _spread(tables.bodies, pair.a, q, three_from(out, FORCE_A), three_from(out, TORQUE_A), f)
    _spread(tables.bodies, pair.b, q, three_from(out, FORCE_B), three_from(out, TORQUE_B), f)
    return True


@njit(cache=True, error_model="numpy", forceinline=True)
def _slide(tables, body, at, f, level):
    """Spring, damper and weight on a slide or an arm; `level` scales the preload's rest in a static run."""
    bodies, gravity = tables.bodies, tables.gravity
    q, v, t = at
    k = bodies[body].slide
    p = bodies[body].press
    f[k] += p[FORCE_0] - p[STIFFNESS] * q[k] - p[DAMPING] * v[k]
    if bodies[body].swings == 0:
        f[k] += level * p[INERTIA] * dot(three(bodies[body].way), three(gravity))
        return
    ref = bodies[body].reference
    place = moved(bodies[body], (ref[0], ref[1], ref[2]), q[k])
    f[k] += level * bodies[body].mass * dot(way_of(bodies[body], place), three(gravity))
    f[k] += torque_of(bodies[body], q[k], scale(level, three(gravity)), t, _INSTANT)


@njit(cache=True, error_model="numpy", forceinline=True)
def _load(bodies, load, q, r, f, level):
    body = load.body
    force = scale(level, three(load.force))
    arm = rotate(mat(r, body), three(load.local))
    moment = scale(level, three(load.moment))
    _spread(bodies, body, q, force, add(moment, cross(arm, force)), f)


@njit(cache=True, error_model="numpy")
def forces(tables, at, level, work):
    """Generalised forces into those of `work`; `level` scales gravity and loads. Returns the number of
    touching pairs."""
    bodies, pairs, loads, gravity = tables.bodies, tables.pairs, tables.loads, tables.gravity
    motion, out, f = work
    q, v, t = at
    place_all(bodies, at, motion)
    f[:] = 0.0
    for body in range(bodies.size - 1):
        n = bodies[body].first
        if n >= 0:
            for i in range(3):
                f[n + i] += level * bodies[body].mass * gravity[i]
        if bodies[body].slide >= 0:
            _slide(tables, body, at, f, level)
        if bodies[body].clutch[0] != 0.0:
            f[bodies[body].spin] += clutch(bodies[body], v[bodies[body].spin], t)[0]
    for i in range(tables.bushings.size):
        _bush(tables, tables.bushings[i], q, motion, f)
    touching = 0
    for i in range(pairs.size):
        if _pair(tables, pairs[i], q, motion, f, out):
            touching += 1
    for i in range(loads.size):
        _load(bodies, loads[i], q, motion.r, f, level)
    return touching


@njit(cache=True, error_model="numpy")
def _element(tables, block_start, element, at, level, work):
    """Generalised forces of one element, added to those of `work`. Returns False where a pair does not
    touch."""
    bodies, pairs = tables.bodies, tables.pairs
    motion, out, f = work
    q, v, t = at
    blocks = block_start.size - 1
    if element < blocks:
        for i in range(block_start[element], block_start[element + 1]):
            _bush(tables, tables.bushings[i], q, motion, f)
        return True
    element -= blocks
    if element < pairs.size:
        return _pair(tables, pairs[element], q, motion, f, out)
    element -= pairs.size
    for body in range(bodies.size - 1):
        if bodies[body].slide >= 0:
            if element == 0:
                _slide(tables, body, at, f, level)
                return True
            element -= 1
    for body in range(bodies.size - 1):
        if bodies[body].clutch[0] != 0.0:
            if element == 0:
                f[bodies[body].spin] += clutch(bodies[body], v[bodies[body].spin], t)[0]
                return True
            element -= 1
    _load(bodies, tables.loads[element], q, motion.r, f, level)
    return True


@njit(cache=True, error_model="numpy")
def set_owners(bodies, owner):
    """Body of each coordinate."""
    for body in range(bodies.size):
        n = bodies[body].first
        if n >= 0:
            for i in range(7):
                owner[n + i] = body
        if bodies[body].slide >= 0:
            owner[bodies[body].slide] = body
        if bodies[body].spin >= 0:
            owner[bodies[body].spin] = body


@njit(cache=True, error_model="numpy")
def jacobian(tables, elements, at, level, by, central, owner, work, data):
    """data = -(by[0] dF/dq + by[1] dF/dv) in the slots of the pattern, by difference quotients.

    One quotient per coordinate gives both parts: q and v are moved together in the ratio wanted.
    """
    block_start, dofs, dof_start, slots, slot_start = elements
    bodies, (motion, _out, f), (by_q, by_v) = tables.bodies, work, by
    q, v = at.q, at.v
    place_all(bodies, at, motion)
    data[:] = 0.0
    step = 1e30
    if by_q != 0.0:
        step = (_E_CENTRAL if central else _E_POSITION) / abs(by_q)
    if by_v != 0.0:
        step = min(step, _E_VELOCITY / abs(by_v))
    base = np.empty(32)
    for element in range(dof_start.size - 1):
        begin, end = dof_start[element], dof_start[element + 1]
        if begin == end:
            continue
        count = end - begin
        for i in range(begin, end):
            f[dofs[i]] = 0.0
        if not _element(tables, block_start, element, at, level, work):
            continue
        for i in range(count):
            base[i] = f[dofs[begin + i]]
        slot = slot_start[element]
        width = 2.0 * step if central else step
        for j in range(count):
            dof = dofs[begin + j]
            body = owner[dof]
            kept_q, kept_v = q[dof], v[dof]
            if central:
                q[dof] -= step * by_q
                v[dof] -= step * by_v
                place_body(bodies, body, at, motion)
                for i in range(begin, end):
                    f[dofs[i]] = 0.0
                _element(tables, block_start, element, at, level, work)
                for i in range(count):
                    base[i] = f[dofs[begin + i]]
                q[dof], v[dof] = kept_q, kept_v
            q[dof] += step * by_q
            v[dof] += step * by_v
            place_body(bodies, body, at, motion)
            for i in range(begin, end):
                f[dofs[i]] = 0.0
            _element(tables, block_start, element, at, level, work)
            q[dof], v[dof] = kept_q, kept_v
            place_body(bodies, body, at, motion)
            for i in range(count):
                data[slots[slot + i * count + j]] -= (f[dofs[begin + i]] - base[i]) / width


@njit(cache=True, error_model="numpy")
def ledger(tables, at, work, pair_out, totals):
    """Energies and powers at a state into `totals` (columns KINETIC, ELASTIC, ... of state.py).

    Also leaves the result of each pair in `pair_out` (p, SEEN) and the bodies' motion in `work`.
    """
    bodies, pairs, loads, gravity = tables.bodies, tables.pairs, tables.loads, tables.gravity
    motion, f = work.motion, work.forces
    x, r, u, w = motion
    q, v, t = at
    place_all(bodies, at, motion)
    kinetic = elastic = potential = lost = driven = 0.0
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
                driven -= speeding(bodies[body], t, _INSTANT) * v[k]
            else:
                potential -= p[INERTIA] * dot(three(gravity), three(bodies[body].way)) * q[k]
            elastic += 0.5 * p[STIFFNESS] * q[k] * q[k]
            lost += p[DAMPING] * v[k] * v[k]
        if bodies[body].spin >= 0:
            spun = v[bodies[body].spin]
            kinetic += 0.5 * bodies[body].press[AXIAL] * spun**2
            torque, _, shaft = clutch(bodies[body], spun, t)
            lost += torque * (shaft - spun)
            driven += torque * shaft
    for i in range(tables.bushings.size):
        energy, power = _bush(tables, tables.bushings[i], q, motion, f)
        elastic += energy
        lost += power
    whole = np.zeros(WIDE)
    for i in range(pairs.size):
        if not _pair(tables, pairs[i], q, motion, f, whole):
            continue
        row = pair_out[i]
        for k in range(OUT):
            row[k] = whole[k]
        turning(bodies, pairs[i], whole, pair_out, i, OUT)
        elastic += row[STORED]
        lost += row[DISSIPATED]
        for body, torque_at in ((pairs[i].a, TORQUE_A), (pairs[i].b, TORQUE_B)):
            if bodies[body].first < 0 and bodies[body].spin < 0:
                about = dot(three_from(row, torque_at), three(bodies[body].axis))
                driven -= about * prescribed(bodies[body], t)
    for i in range(loads.size):
        load = loads[i]
        body = load.body
        arm = rotate(mat(r, body), three(load.local))
        rate = add(vec(u, body), cross(vec(w, body), arm))
        driven += dot(three(load.force), rate) + dot(three(load.moment), vec(w, body))
    totals[KINETIC], totals[ELASTIC], totals[POTENTIAL] = kinetic, elastic, potential
    totals[LOST], totals[DRIVING] = lost, driven


def owners(system: System) -> Ints:
    """Body of each coordinate."""
    owner = np.empty(system.free, np.int64)
    set_owners(system.bodies, owner)
    return owner


def workspace(system: System) -> Work:
    """What the functions above write into."""
    n = len(system.bodies)
    motion = Motion(np.zeros((n, 3)), np.zeros((n, 9)), np.zeros((n, 3)), np.zeros((n, 3)))
    return Work(motion, np.zeros(OUT), np.zeros(max(1, system.free)))
