"""Generalised forces of a System, part by part and in all."""

from __future__ import annotations

from mdlgen.backends.exudyn_local.air import air_forces
from mdlgen.backends.exudyn_local.bristles import held_forces
from mdlgen.backends.exudyn_local.place import place_all, spread
from mdlgen.mechanics.arm import (
    DAMPING,
    FORCE_0,
    INERTIA,
    STIFFNESS,
    moved,
    torque_of,
    way_of,
)
from mdlgen.mechanics.axle import AXLE, acting
from mdlgen.mechanics.bushing import bushing
from mdlgen.mechanics.corner import bodies_of, corner_forces
from mdlgen.mechanics.curve import curve_excess, middle_and_gap
from mdlgen.mechanics.driven import SENSE, TORQUE, turned
from mdlgen.mechanics.frame import Frame
from mdlgen.mechanics.gate import stop
from mdlgen.mechanics.over_time import set_to
from mdlgen.mechanics.pair import pair_force
from mdlgen.mechanics.plastic import accept, bending, couple, flowed, stored
from mdlgen.mechanics.point import (
    FORCE_A,
    FORCE_B,
    TORQUE_A,
    TORQUE_B,
)
from mdlgen.mechanics.vector import (
    add,
    cross,
    dot,
    mat,
    matmul,
    nine,
    rotate,
    scale,
    three,
    three_from,
    vec,
)
from mdlgen.program.kernel import njit

# Half of the time span over which the growth of the speed of a drive is evaluated [s].
INSTANT = 1e-7


@njit(cache=True, error_model="numpy", forceinline=True)
def bush_forces(tables, bush, q, motion, f):
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
    spread(bodies, a, q, (-force[0], -force[1], -force[2]), torque_a, f)
    spread(bodies, b, q, force, torque_b, f)
    if bush.first >= 0:
        middle, gap = middle_and_gap(vec(x, a), fa, ra, vec(x, b), fb, rb)
        force, torque_b, torque_a, more = curve_excess(points, bush, middle, gap, ra, rb)
        spread(bodies, a, q, (-force[0], -force[1], -force[2]), torque_a, f)
        spread(bodies, b, q, force, torque_b, f)
        energy += more
    if bush.hinge >= 0:
        energy += _hinge_force(tables, tables.hinges[bush.hinge], (a, fa), (b, fb), q, f)
    return energy, power


@njit(cache=True, error_model="numpy")
def _hinge_force(tables, hinge, one, two, q, f):
    """Adds the force of a hinge to that of its bushing between two (body, frame), as a step ends; returns the
    energy."""
    t = bending(one[1], two[1], hinge.axis)
    p = flowed(hinge, t)
    torque = couple(one[1], two[1], hinge.axis, hinge.k * p)
    none = (0.0, 0.0, 0.0)
    spread(tables.bodies, one[0], q, none, scale(-1.0, torque), f)
    spread(tables.bodies, two[0], q, none, torque, f)
    return stored(hinge, t, p)


@njit(cache=True, error_model="numpy")
def end_hinges(tables, at, motion, starts):
    """Updates the plastic rotations of all hinges as a step ends at a state; `starts`: a run starts, nothing
    has changed yet. Returns the dissipated energy [J]."""
    place_all(tables.bodies, at, motion)
    lost = 0.0
    for k in range(tables.hinges.size):
        hinge = tables.hinges[k]
        bush = tables.bushings[hinge.joint]
        fa = matmul(mat(motion.r, bush.a), nine(bush.fa))
        fb = matmul(mat(motion.r, bush.b), nine(bush.fb))
        t = bending(fa, fb, hinge.axis)
        if not starts:
            lost += accept(hinge, hinge.begun, t)
        hinge.begun = t
    return lost


@njit(cache=True, error_model="numpy")
def corner_at(tables, corner, q, work):
    """One corner; returns (stored energy, dissipated power)."""
    wrench, there = work.wrench, work.there
    energy, power = corner_forces(tables.bushings, corner, work.motion, wrench)
    wrench[-1] = 0.0  # the ground
    for k in range(bodies_of(tables.bushings, corner, there)):
        own = wrench[there[k]]
        spread(tables.bodies, there[k], q, (own[0], own[1], own[2]), (own[3], own[4], own[5]), work.forces)
        own[:] = 0.0
    return energy, power


@njit(cache=True, error_model="numpy")
def pair_forces(tables, pair, q, motion, f, out):
    """One contact pair into `out`; returns whether it touches."""
    out[:] = 0.0
    if not pair_force(tables.bodies, pair, tables.shapes, motion, out):
        return False
    spread(tables.bodies, pair.a, q, three_from(out, FORCE_A), three_from(out, TORQUE_A), f)
    spread(tables.bodies, pair.b, q, three_from(out, FORCE_B), three_from(out, TORQUE_B), f)
    return True


@njit(cache=True, error_model="numpy", forceinline=True)
def slide_force(tables, body, at, f, level):
    """Spring, damper and weight on a slide or an arm; `level` scales the preload's rest in a static run."""
    bodies, gravity = tables.bodies, tables.gravity
    q, v, t = at
    k = bodies[body].slide
    p = bodies[body].press
    f[k] += p[FORCE_0] - p[STIFFNESS] * q[k] - p[DAMPING] * v[k] + stop(bodies[body], q[k], v[k]).force
    if bodies[body].swings == 0:
        f[k] += level * p[INERTIA] * dot(three(bodies[body].way), three(gravity))
        return
    ref = bodies[body].reference
    place = moved(bodies[body], (ref[0], ref[1], ref[2]), q[k])
    f[k] += level * bodies[body].mass * dot(way_of(bodies[body], place), three(gravity))
    f[k] += torque_of(bodies[body], q[k], scale(level, three(gravity)), t, INSTANT)


@njit(cache=True, error_model="numpy", forceinline=True)
def load_forces(bodies, load, q, r, f, level):
    body = load.body
    force = scale(level, three(load.force))
    arm = rotate(mat(r, body), three(load.local))
    moment = scale(level, three(load.moment))
    spread(bodies, body, q, force, add(moment, cross(arm, force)), f)


@njit(cache=True, error_model="numpy")
def axle_force(tables, body, at):
    """Torque of a clutch, a motor, a limiter or a bearing on a roller."""
    k, own = tables.bodies[body].spin, tables.bodies[body]
    return acting(tables.shapes.axles, own, behind(tables, own, at), at.v[k], at.t, 0.0).torque


@njit(cache=True, error_model="numpy")
def behind(tables, body, at):
    """By what angle a roller is behind its shaft, or what speed control has for that [rad]."""
    angle = turned(body, at.t) - at.q[body.spin]
    if body.clutch[SENSE] == AXLE:
        angle -= tables.given_up[int(body.clutch[TORQUE])]
    return angle


@njit(cache=True, error_model="numpy")
def forces(tables, at, level, work):
    """Generalised forces into those of `work`; `level` scales gravity and loads. Returns the number of
    touching pairs."""
    bodies, pairs, loads, gravity = tables.bodies, tables.pairs, tables.loads, tables.gravity
    motion, out, f = work.motion, work.out, work.forces
    q = at.q
    set_to(tables.changes, loads, gravity, at.t, at.t)
    place_all(bodies, at, motion)
    f[:] = 0.0
    for body in range(bodies.size - 1):
        n = bodies[body].first
        if n >= 0:
            for i in range(3):
                f[n + i] += level * bodies[body].mass * gravity[i]
        if bodies[body].slide >= 0:
            slide_force(tables, body, at, f, level)
        if bodies[body].clutch[SENSE] != 0.0:
            f[bodies[body].spin] += axle_force(tables, body, at)
    for i in range(tables.bushings.size):
        bush_forces(tables, tables.bushings[i], q, motion, f)
    for i in range(tables.corners.size):
        corner_at(tables, tables.corners[i], q, work)
    touching = 0
    for i in range(pairs.size):
        if tables.stick.patch_of[i] < 0 and pair_forces(tables, pairs[i], q, motion, f, out):
            touching += 1
    if tables.stick.pairs.size > 0:
        touching += held_forces(tables, at, motion, f)
    for i in range(loads.size):
        load_forces(bodies, loads[i], q, motion.r, f, level)
    air_forces(tables, at, motion, f)
    return touching
