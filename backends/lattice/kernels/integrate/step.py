"""One step of the implicit midpoint rule.

With h half of the step, the velocities u at its middle solve m (u - v0) = h f and J w - l0 = h t, with
forces at the middle: positions x0 + h u, rotations exp(h w) R0. Then x1 = x0 + 2 h u, R1 = exp(2 h w) R0,
and velocities and angular momenta are carried to 2 u - v0 and 2 J w - l0. So linear and angular momentum
are conserved to the accuracy of the iteration, whatever the step.

The rule itself damps nothing: modes that are too fast for a step keep ringing. So joints are damped by their
stiffness times a time that is a part of h, proportional to the step, which keeps the rule of second order.
This is numerical damping, and its dissipation is counted separately. A damping time of the joint itself is
subtracted from it.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.contact.between import near_forces
from mdlgen.backends.lattice.kernels.contact.bristles import lay_bristles, weigh_patches
from mdlgen.backends.lattice.kernels.contact.condensed import (
    APART,
    INSIDE,
    PLANES,
    TOUCHED,
    UP_TO_DATE,
    choose,
    columns,
    forget,
    release,
    unsee,
)
from mdlgen.backends.lattice.kernels.contact.contact_solve import solve_contacts
from mdlgen.backends.lattice.kernels.contact.drift import list_near
from mdlgen.backends.lattice.kernels.contact.sides import crossed, part_of_change
from mdlgen.backends.lattice.kernels.forces import (
    clutch_torques,
    joint_forces_of_sheets,
    other_forces,
    pair_forces,
    pair_forces_again,
    place,
)
from mdlgen.backends.lattice.kernels.integrate.air import air_forces, lay
from mdlgen.backends.lattice.kernels.integrate.change import (
    fastest,
    greatest,
    greatest_of_free,
    take_off,
)
from mdlgen.backends.lattice.kernels.integrate.convex import solve_convex
from mdlgen.backends.lattice.kernels.integrate.corners import corners_into
from mdlgen.backends.lattice.kernels.integrate.hinges import begin_hinges, hinge_forces, hinges_into
from mdlgen.backends.lattice.kernels.integrate.mixing import mix
from mdlgen.backends.lattice.kernels.integrate.momentum import keep
from mdlgen.backends.lattice.kernels.integrate.points import gather
from mdlgen.backends.lattice.kernels.integrate.points_matrix import points_into
from mdlgen.backends.lattice.kernels.integrate.tangent import in_box_axes, joints_into, masses, turn_nodes
from mdlgen.backends.lattice.kernels.linear.band import solve
from mdlgen.backends.lattice.kernels.linear.dense import copy
from mdlgen.backends.lattice.kernels.linear.sheets import factor_sheets
from mdlgen.backends.lattice.kernels.state import (
    CLOSE,
    FACTORS,
    FLOOR,
    ITERATIONS,
    LOOSE,
    LOST,
    MADE_FOR,
    MIDDLE,
    OWN_INERTIA,
    OWN_MASS,
    POWER,
    STALE,
    THROUGH,
    TOUCHING,
    TOUGH,
    WHERE,
)
from mdlgen.backends.lattice.kernels.tuning import (
    CAREFUL_ABOVE,
    CONTACT_ROUGH,
    CONVEX_AFTER,
    CONVEX_FOR,
    FACTOR_WORTH,
    FAR,
    FREE,
    LAG,
    LAG_MOST,
    MIXED,
    NEWTON_MOST,
    PLATE_CHORD,
    PLATE_CHORD_CAREFUL,
    SAME_FORCES,
)
from mdlgen.mechanics.arm import (
    AXIAL,
    DAMPING,
    FORCE_0,
    INERTIA,
    STIFFNESS,
    torque_of,
    turn_of,
    way_of,
)
from mdlgen.mechanics.gate import stop
from mdlgen.mechanics.over_time import set_to
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.mechanics.vector import back, dot, mat, rotate, three, three_from, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _residual(tables, t, h, state, mid, res, resb):
    """Residual of the step's equations into res (6 nodes,) and resb (border,); t is in the middle."""
    bodies, boxes, nodes, gravity = tables.bodies, tables.boxes, tables.nodes, tables.gravity
    v, l, s, vb, u, ub = state.v, state.l, state.s, state.vb, state.u, state.ub
    xm, rm, f = mid.motion.x, mid.motion.r, mid.forces
    for n in range(nodes.size):
        b = nodes[n]
        m = mat(rm, b)
        spin = back(m, (u[n, 3], u[n, 4], u[n, 5]))
        j = three_from(boxes[n], OWN_INERTIA)
        p = rotate(m, (j[0] * spin[0], j[1] * spin[1], j[2] * spin[2]))
        for i in range(3):
            res[6 * n + i] = boxes[n, OWN_MASS] * (u[n, i] - v[n, i]) - h * f[b, i]
            res[6 * n + 3 + i] = p[i] - l[n, i] - h * f[b, 3 + i]
    for k in tables.moving:
        p = bodies[k].press
        slide, spin_at = bodies[k].slide, bodies[k].spin
        if slide >= 0:
            along = dot(vec(f, k), way_of(bodies[k], vec(xm, k)))
            if bodies[k].swings > 0:
                along += dot((f[k, 3], f[k, 4], f[k, 5]), turn_of(bodies[k]))
                along += torque_of(bodies[k], s[slide] + h * ub[slide], three(gravity), t, h)
            spring = p[FORCE_0] - p[STIFFNESS] * (s[slide] + h * ub[slide]) - p[DAMPING] * ub[slide]
            spring += stop(bodies[k], s[slide] + h * ub[slide], ub[slide]).force
            resb[slide] = p[INERTIA] * (ub[slide] - vb[slide]) - h * (along + spring)
        if spin_at >= 0:
            axis = bodies[k].axis
            about = f[k, 3] * axis[0] + f[k, 4] * axis[1] + f[k, 5] * axis[2]
            if bodies[k].coupled != FOLLOWER:  # a leader precedes its followers in the list
                resb[spin_at] = p[AXIAL] * (ub[spin_at] - vb[spin_at]) - h * about
            else:
                resb[spin_at] -= h * bodies[k].ratio * about


@njit(cache=True, error_model="numpy", **BORROWS)
def _weights(tables, f):
    """Adds the weights of sliding bodies, and of rollers on arms, to the forces on them."""
    bodies, gravity = tables.bodies, tables.gravity
    for k in tables.moving:
        if bodies[k].slide >= 0:
            mass = bodies[k].press[INERTIA] if bodies[k].swings == 0 else bodies[k].mass
            for i in range(3):
                f[k, i] += mass * gravity[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def _contact_forces(work, close, h, known):
    """Adds the forces of contacts and of air to those of the midpoint, h [ms] after the state. Where `known`,
    the results of the last contact solve are reused. Returns (how many pairs touch, dissipated power)."""
    mid, condensed = work.mid, work.condensed
    if known:
        again = (condensed.touched, condensed.results, condensed.looked[TOUCHED], condensed.seen)
        count, _stored, rubbed = pair_forces_again(
            work.tables, mid.near, close, again, mid.motion, mid.forces, mid.touched, mid.results
        )
    elif work.search.regions.size > 0:
        count, rubbed = near_forces(work, close, h)
    else:
        count, _stored, rubbed = pair_forces(
            work.tables, mid.near, close, mid.motion, mid.forces, mid.touched, mid.results
        )
    if work.film.many[0] > 0:
        rubbed += air_forces(work)
    return count, rubbed


@njit(cache=True, error_model="numpy")
def _make_factor(work, counts, h, lag, where, chord):
    """Factors the tangent of a step in box axes. Returns False where it is singular."""
    tables, matrix, motion = work.tables, work.matrix, work.mid.motion
    a = matrix.band
    masses(tables.bodies, tables.nodes, motion.r, a)
    joints_into(tables, tables.joints, h, lag, motion.x, motion.r, a, matrix.slots)
    if tables.hinges.size > 0:
        hinges_into(tables, h, motion.r, a, matrix.slots)
    corners_into(tables, h, motion.x, motion.r, a, matrix.slots)
    if where == PLANES:
        gather(work, counts, h, True)
        points_into(work, h, chord)
    in_box_axes(tables.nodes, motion.r, a, matrix.border, matrix.offsets, matrix.slots)
    forget(work.condensed)
    return factor_sheets(matrix, False)


@njit(cache=True, error_model="numpy")
def _factor_for(work, counts, h, lag, where, chord, control):
    """Refactors the matrix unless its factor is one of this step with the same treatment of contacts,
    `where`. Returns 1 if it was factored, 0 if the old factor serves, -1 if it is singular."""
    factored = control.factored
    if factored[MADE_FOR] == 2.0 * h and factored[STALE] == 0.0 and factored[WHERE] == where:
        return 0
    control.counters[FACTORS] += 1
    if not _make_factor(work, counts, h, lag, where, chord):
        return -1
    factored[MADE_FOR], factored[STALE], factored[WHERE] = 2.0 * h, 0.0, where
    return 1


@njit(cache=True, error_model="numpy", **BORROWS)
def _treatment(work, count, where, m, air, begins, late, tough):
    """Chooses the treatment of contacts in an iteration. Returns it, and the number of boxes whose contacts
    are condensed. It is that of the iteration before, `where` with m boxes; where a step `begins`, as few
    contacts as possible are in the matrix. All are in it with air, where iterations get `late` or recently
    did (`tough`), and where boxes of two sheets touch."""
    tables, condensed, touched = work.tables, work.condensed, work.mid.touched
    bodies, pairs, most = tables.bodies, tables.pairs, condensed.chosen.size
    if air:
        where = INSIDE
    elif where != INSIDE and (late or (begins and tough > 0.0)):
        release(condensed, m)
        where = INSIDE
    if begins and not air and tough == 0.0:
        for fewer in range(where):
            m = choose(bodies, pairs, touched, count, fewer, condensed, 0, most // 2)
            if m >= 0:
                where = fewer
                break
            m = 0
    m = choose(bodies, pairs, touched, count, where, condensed, m, most)
    while m < 0:
        where += 1
        m = choose(bodies, pairs, touched, count, where, condensed, 0, most)
    return where, m


@njit(cache=True, error_model="numpy", **BORROWS)
def _done(work, h, counts, totals, counters):
    """Ends a step whose velocities are found; `counts`: how many pairs touch, how many are near. Returns
    False if a sheet went through another."""
    mid, search = work.mid, work.search
    mid.totals[LOST], mid.totals[POWER] = totals
    counters[TOUCHING], counters[CLOSE] = counts
    if search.regions.size > 0:
        fastest(work.tables, work.state.u, mid.fastest[MIDDLE])
    counters[THROUGH] = crossed(work.tables, mid, counts, work.state, search.first, h)
    return counters[THROUGH] < 0.0


@njit(cache=True, error_model="numpy")
def midpoint(work, t, dt, tolerance, control):
    """Solves for the velocities at the middle of a step. Returns True if it converged."""
    tables, state, mid, matrix, condensed = work.tables, work.state, work.mid, work.matrix, work.condensed
    nodes = tables.nodes
    factored, counters = control.factored, control.counters
    res, resb = matrix.res, matrix.resb
    h = 0.5 * dt
    lag = min(LAG * dt, LAG_MOST) * h
    before = 1e300
    careful, last = 0, CONVEX_AFTER if work.search.regions.size > 0 else NEWTON_MOST
    counters[THROUGH] = -1.0
    close, where, m = 0, int(factored[WHERE]), 0
    margin, moved, sheets = FAR, 0.0, work.search.regions.size > 0
    # `lasting`: the last contact forces may serve for the end of the step. Not with loads, which would be in
    # the power of drives; not with friction that sticks, whose stretch is that of the last velocities
    sticks = tables.held.size > 0
    lasting = sheets and tables.loads.size == 0 and mid.sticks.pairs.size == 0 and not sticks
    mid.sticks.half[0] = h
    inner, alike, air = 0, 0, False
    if tables.hinges.size > 0:
        begin_hinges(tables, state.r)
    set_to(tables.changes, tables.loads, tables.gravity, t, t + dt)
    for iteration in range(NEWTON_MOST):
        place(tables, h, t + h, state, mid.motion)
        if iteration == 0 or margin < dt * moved:
            # bodies may move further than the guess predicted
            margin = FAR + 2.0 * dt * moved
            close = list_near(work, margin, h, mid.near)
            unsee(condensed)
        if iteration == 0 and work.film.films.size > 0:
            air = lay(work, h)
        mid.forces[:] = 0.0
        joint_forces_of_sheets(tables, mid.motion, mid.forces, lag, mid.spent)
        if tables.hinges.size > 0:
            hinge_forces(tables, mid.motion.r, mid.forces)
        known = iteration > 0 and where == APART and condensed.looked[UP_TO_DATE] == 1
        known = known and not sheets and not sticks
        if sticks:
            lay_bristles(tables, mid.motion, h)
        count, rubbed = _contact_forces(work, close, h, known)
        if sticks:
            weigh_patches(tables, mid, count)
        power = other_forces(tables, 1.0, mid.motion, mid.forces)
        _weights(tables, mid.forces)
        clutch_torques(tables, t + h, h, state, mid.forces)
        _residual(tables, t + h, h, state, mid, res, resb)
        # free sheets converge fast, and the error of their angular momentum is that of the last iteration
        limit = tolerance if count > 0 or air else FREE * tolerance
        where, m = _treatment(work, count, where, m, air, iteration == 0, iteration == last, factored[TOUGH])
        counters[ITERATIONS] += 1
        copy(work.free.residual, res)
        # present axes of the boxes: those of half a step before have other stiff directions
        copy(condensed.axes, mid.motion.r)
        if where == INSIDE:
            turn_nodes(nodes, condensed.axes, res, True)
            renew = iteration == 0 or factored[WHERE] != INSIDE
            whole = air or iteration >= CONVEX_AFTER
            inner = solve_convex(work, t + h, h, lag, (count, close), limit, control, renew, whole)
            if inner == 0:
                break
        else:
            made = _factor_for(
                work,
                (count, close),
                h,
                lag,
                where,
                PLATE_CHORD_CAREFUL if careful > 0 else PLATE_CHORD,
                control,
            )
            if made < 0:
                break
            if made > 0 and where == PLANES:
                careful -= 1
            turn_nodes(nodes, condensed.axes, res, True)
            solve(matrix.band, res)
            columns(matrix.band, condensed, m)
            if not solve_contacts(
                work, m, where, h, t + h, (close, count), (CONTACT_ROUGH * limit, 0.3 * limit)
            ):
                if not sheets:
                    break
                # as a convex problem, with all contacts in the matrix, the iteration has a solution
                release(condensed, m)
                where, last = INSIDE, iteration
                continue
        turn_nodes(nodes, condensed.axes, res, False)
        found = 0.0
        if where == INSIDE:
            # the change before mixing counts, too: the mixed one may be small while the residual is not
            found = greatest(work, res, resb, control)
            if inner < 0:
                found = max(found, 2.0 * limit)
            # without air one is mixed: with more, steps that do not resolve contacts would converge instead
            # of being halved. More are mixed late, where a step oscillates between states wedged by friction
            mix(matrix, state, alike, MIXED if air or alike > CONVEX_AFTER else 1 if alike > 1 else 0)
            alike += 1
        keep(tables, mid.touched, count, work.film, work.free, (mid.motion.x, mid.motion.r), res)
        part = part_of_change(tables, mid.near, close, mid.motion.r, h, res)
        if part < 1.0:
            res *= part
            resb *= part
        change = max(found, greatest(work, res, resb, control))
        take_off(state, res, resb)
        if not change < 1e30:
            break
        moved += change
        if count > 0:
            # free sheets in a scene with contacts converge as far as without them
            change = max(change, greatest_of_free(work, res, control.pace[FLOOR]) / FREE)
        rate = change / before
        falls = before < 1e299 and rate < 0.5
        if dt * moved <= margin and (change <= limit or (falls and change * rate / (1.0 - rate) <= limit)):
            # forces are evaluated again: friction changes fully within its smoothing speed
            place(tables, h, t + h, state, mid.motion)
            if not lasting or change > SAME_FORCES * control.pace[LOOSE]:
                # the input of bristles is not set again, so that they act as in the solved equations
                mid.forces[:] = 0.0
                count, rubbed = _contact_forces(work, close, h, False)
            release(condensed, m)
            factored[TOUGH] = CONVEX_FOR if iteration >= last else max(factored[TOUGH] - 1.0, 0.0)
            return _done(work, h, (count, close), (rubbed, power), counters)
        slow = before < 1e299 and (
            rate >= 1.0 or math.log(limit / change) < (FACTOR_WORTH + m) * math.log(rate)
        )
        if slow and (where != INSIDE or inner == 1):
            factored[STALE] = 1.0
        if before < 1e299 and rate > CAREFUL_ABOVE:
            careful = 2
        before = change
    factored[MADE_FOR], factored[TOUGH] = 0.0, CONVEX_FOR if sheets else 0.0
    release(condensed, m)
    return False
