"""Forces on all bodies at one state, and the contact points from which a tangent is assembled."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.image import reflect, reflect_rates
from mdlgen.backends.lattice.kernels.state import LOST, NUMERICAL, OWN_MASS
from mdlgen.mechanics.arm import moved, way_of
from mdlgen.mechanics.axle import acting
from mdlgen.mechanics.bushing import bushing_pair
from mdlgen.mechanics.corner import corner_forces
from mdlgen.mechanics.curve import curve_excess
from mdlgen.mechanics.driven import SENSE, prescribed, turned
from mdlgen.mechanics.frame import Frame
from mdlgen.mechanics.gate import GATE, middle_of_gate
from mdlgen.mechanics.pair import near, pair_force
from mdlgen.mechanics.pairs.box_box import near as near_boxes
from mdlgen.mechanics.point import (
    ABOUT,
    DISSIPATED,
    FORCE_A,
    FORCE_B,
    HOLDS,
    MOST_POINTS,
    OFFSET,
    OUT,
    POINT,
    POINTS,
    STORED,
    TWIST,
)
from mdlgen.mechanics.vector import (
    add,
    cross,
    dot,
    exp_rotation,
    mat,
    matmul,
    nine,
    rotate,
    scale,
    three,
    vec,
)
from mdlgen.program.kernel import BORROWS, FUSED, njit

WIDE = OUT + 1 + POINT * MOST_POINTS


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def place_box(b, h, rate, spin, x, r, motion):
    """Places one free box after h at a velocity and an angular velocity, from places x and rotations r."""
    xm, rm, um, wm = motion
    m = matmul(exp_rotation(scale(h, spin)), mat(r, b))
    for i in range(9):
        rm[b, i] = m[i]
    for i in range(3):
        xm[b, i] = x[b, i] + h * rate[i]
        um[b, i] = rate[i]
        wm[b, i] = spin[i]


@njit(cache=True, error_model="numpy", forceinline=True)
def turn_roller(body, b, h, t, turning, r, rm):
    """Turns a roller by h at the rate `turning`, its own or that of its arm, plus the rotation of its drive
    up to the time t."""
    angle = h * turning
    if body.spin < 0:
        angle += turned(body, t) - turned(body, t - h)
    m = matmul(exp_rotation(scale(angle, three(body.axis))), mat(r, b))
    for i in range(9):
        rm[b, i] = m[i]


@njit(cache=True, error_model="numpy", forceinline=True, **FUSED)
def place_roller(body, b, h, t, rate, turning, x, r, motion):
    """Places one roller at time t, after h at the rates of its slide and its spin, where it has them. A round
    roller need not turn. A pressed plate has a slide alone. A body with a prescribed place is put where it is
    in the middle of a step of 2 h."""
    if body.swings >= GATE:
        middle_of_gate(body, b, h, t, x, r, motion)
        return
    xm, rm, um, wm = motion
    if body.swings == 2:
        turning = rate
    if body.rims > 0 or body.carries != 0:
        turn_roller(body, b, h, t, turning, r, rm)
    if body.spin < 0:
        turning += prescribed(body, t)
    at = vec(x, b)
    if body.slide >= 0:
        at = moved(body, at, h * rate)
    way = way_of(body, at)
    for i in range(3):
        if body.slide >= 0:
            xm[b, i] = at[i]
        um[b, i] = rate * way[i]
        wm[b, i] = turning * body.axis[i]


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def place(tables, h, t, state, motion):
    """Sets the Motion of all bodies after h at the velocities state.u and state.ub, at the time t."""
    bodies, nodes, images = tables.bodies, tables.nodes, tables.images
    x, r, u, ub = state.x, state.r, state.u, state.ub
    for n in range(nodes.size):
        place_box(nodes[n], h, (u[n, 0], u[n, 1], u[n, 2]), (u[n, 3], u[n, 4], u[n, 5]), x, r, motion)
    for b in tables.moving:
        body = bodies[b]
        rate = ub[body.slide] if body.slide >= 0 else 0.0
        turning = body.ratio * ub[body.spin] if body.spin >= 0 else 0.0
        place_roller(body, b, h, t, rate, turning, x, r, motion)
    reflect(images, motion.x, motion.r)
    reflect_rates(images, motion.u, motion.w)


@njit(cache=True, error_model="numpy", forceinline=True)
def _add(f, b, force, torque):
    for i in range(3):
        f[b, i] += force[i]
        f[b, 3 + i] += torque[i]


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def joint_forces(joints, points, motion, f, lag=0.0):
    """Adds the forces of all joints to f (bodies, 6). Numerical damping adds the stiffness times `lag` [ms]
    less the damping time of the joint itself. `points`: points of the force curves of joints. Returns (stored
    energy, dissipated power, the part of it due to `lag`); a joint that ends at a mirror image counts
    half."""
    stored = lost = numerical = 0.0
    x, r, u, w = motion
    last = x.shape[0] - 1
    for j in range(joints.size):
        joint = joints[j]
        a, b = joint.a, joint.b
        if a < 0:
            a = last
        ma, mb = mat(r, a), mat(r, b)
        fa, fb = ma, mb
        if joint.plain == 0:
            fa, fb = matmul(ma, nine(joint.fa)), matmul(mb, nine(joint.fb))
        k, c = joint.k, joint.c
        more = max(lag - joint.time, 0.0)
        ra, rb = rotate(ma, three(joint.ra)), rotate(mb, three(joint.rb))
        force, torque_b, torque_a, energy, power, middle, gap, per_time = bushing_pair(
            Frame(vec(x, a), fa, vec(u, a), vec(w, a)),
            ra,
            Frame(vec(x, b), fb, vec(u, b), vec(w, b)),
            rb,
            three(joint.e),
            (k[0], k[1], k[2]),
            (k[3], k[4], k[5]),
            (c[0] + more * k[0], c[1] + more * k[1], c[2] + more * k[2]),
            (c[3] + more * k[3], c[4] + more * k[4], c[5] + more * k[5]),
        )
        _add(f, a, (-force[0], -force[1], -force[2]), torque_a)
        _add(f, b, force, torque_b)
        part = 1.0 if joint.mirrored == 0 else 0.5
        stored += part * energy
        lost += part * power
        numerical += part * more * per_time
        if joint.first >= 0:
            force, torque_b, torque_a, energy = curve_excess(points, joint, middle, gap, ra, rb)
            _add(f, a, (-force[0], -force[1], -force[2]), torque_a)
            _add(f, b, force, torque_b)
            stored += part * energy
    return stored, lost, numerical


@njit(cache=True, error_model="numpy", **BORROWS)
def joint_forces_of_sheets(tables, motion, f, lag, spent):
    """Adds the forces of all joints as joint_forces does, and those of corners. Writes the power that each of
    tables.runs dissipates, and its part due to `lag`, into spent (runs, 2)."""
    runs = tables.runs
    for k in range(runs.shape[0]):
        own = tables.joints[runs[k, 0] : runs[k, 1]]
        _stored, lost, numerical = joint_forces(own, tables.points, motion, f, lag)
        spent[k, LOST], spent[k, NUMERICAL] = lost, numerical
    corners = tables.corners
    for k in range(corners.size):
        _stored, lost = corner_forces(tables.joints, corners[k], motion, f)
        spent[corners[k].run, LOST] += lost


@njit(cache=True, error_model="numpy", **BORROWS)
def near_of_model(tables, motion, margin, ahead, found):
    """Lists the Model's pairs as `near_pairs` does, without those that are searched."""
    bodies, pairs, shapes, count = tables.bodies, tables.pairs, tables.shapes, 0
    for p in range(pairs.size - tables.listed.size):
        if near(bodies, pairs[p], shapes, motion, margin, ahead):
            found[count] = p
            count += 1
    return count


@njit(cache=True, error_model="numpy", **BORROWS)
def near_of_search(tables, motion, margin, ahead, found):
    """Lists the near pairs among those that are searched."""
    bodies, listed, shapes, count = tables.bodies, tables.listed, tables.shapes, 0
    first = tables.pairs.size - listed.size
    for k in range(listed.size):
        if listed[k].a < 0:  # the rest is unused capacity
            break
        if near_boxes(bodies, listed[k], shapes, motion, margin, ahead):
            found[count] = first + k
            count += 1
    return count


@njit(cache=True, error_model="numpy", **BORROWS)
def near_pairs(tables, motion, margin, ahead, found):
    """Lists pairs in `found` whose gap is below `margin` [mm] plus their relative motion in `ahead` [ms];
    returns how many."""
    count = near_of_model(tables, motion, margin, ahead, found)
    return count + near_of_search(tables, motion, margin, ahead, found[count:])


@njit(cache=True, error_model="numpy", **BORROWS)
def onto(f, pair, out):
    """Adds the forces of a pair to those on its bodies."""
    for i in range(6):
        f[pair.a, i] += out[FORCE_A + i]
        f[pair.b, i] += out[FORCE_B + i]


@njit(cache=True, error_model="numpy", **BORROWS)
def touches(tables, pair, motion, f, out):
    """Writes the result of one pair into `out` and adds its forces to f. Returns True if it touches."""
    for i in range(HOLDS + 1):
        out[i] = 0.0
    out[POINTS] = 0.0
    if pair.held > 0:
        own = tables.held[pair.held - 1]
        out[HOLDS] = own.holds
        for i in range(3):
            out[OFFSET + i], out[TWIST + i], out[ABOUT + i] = own.offset[i], own.twist[i], own.about[i]
    if not pair_force(tables.bodies, pair, tables.shapes, motion, out):
        return False
    onto(f, pair, out)
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def pair_forces(tables, near, close, motion, f, touched, results):
    """Adds the forces of the pairs near[:close] to f. Those that touch are listed in `touched`, each with its
    row of results (pairs, WIDE). Returns (how many, stored energy, dissipated power)."""
    count = 0
    stored = lost = 0.0
    for at in range(close):
        out = results[count]
        if touches(tables, tables.pairs[near[at]], motion, f, out):
            stored += out[STORED]
            lost += out[DISSIPATED]
            touched[count] = near[at]
            count += 1
    return count, stored, lost


@njit(cache=True, error_model="numpy", **BORROWS)
def pair_forces_again(tables, near, close, known, motion, f, touched, results):
    """As pair_forces where some pairs are `known`: (those that touch, their results, how many, true for each
    pair that was evaluated)."""
    had, done, many, seen = known
    count = 0
    stored = lost = 0.0
    for k in range(many):
        for i in range(OUT + 1 + POINT * int(done[k, POINTS])):
            results[count, i] = done[k, i]
        onto(f, tables.pairs[had[k]], done[k])
        stored += done[k, STORED]
        lost += done[k, DISSIPATED]
        touched[count] = had[k]
        count += 1
    for at in range(close):
        out = results[count]
        if not seen[near[at]] and touches(tables, tables.pairs[near[at]], motion, f, out):
            stored += out[STORED]
            lost += out[DISSIPATED]
            touched[count] = near[at]
            count += 1
    return count, stored, lost


@njit(cache=True, error_model="numpy", **BORROWS)
def clutch_torques(tables, t, h, state, f):
    """Adds the torques of clutches, motors, limiters and bearings on rollers at the rates of a state, at a
    time h after it."""
    bodies, axles = tables.bodies, tables.shapes.axles
    s, ub = state.s, state.ub
    for b in tables.moving:
        if bodies[b].clutch[SENSE] != 0.0:
            at = bodies[b].spin
            torque = acting(axles, bodies[b], s[at], ub[at], t, h).torque
            for i in range(3):
                f[b, 3 + i] += torque * bodies[b].axis[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def other_forces(tables, level, motion, f):
    """Adds weights and loads, both times `level`. Returns the power of the loads."""
    loads, nodes, gravity = tables.loads, tables.nodes, tables.gravity
    r, u, w = motion.r, motion.u, motion.w
    power = 0.0
    for n in range(nodes.size):
        for i in range(3):
            f[nodes[n], i] += level * tables.boxes[n, OWN_MASS] * gravity[i]
    for k in range(loads.size):
        b = loads[k].body
        force, moment = scale(level, three(loads[k].force)), scale(level, three(loads[k].moment))
        arm = rotate(mat(r, b), three(loads[k].local))
        _add(f, b, force, add(moment, cross(arm, force)))
        power += dot(force, add(vec(u, b), cross(vec(w, b), arm))) + dot(moment, vec(w, b))
    return power
