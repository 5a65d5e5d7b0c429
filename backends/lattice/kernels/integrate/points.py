"""Contact points with frozen geometry, which an iteration of a step uses while it solves for the velocities.

Within an iteration boxes move by little. So a point keeps its normal, its arms and its part of the stiffness;
its depth grows with its closing rate, and its friction is limited by the normal force at the beginning of the
iteration. Such forces are the slope of a convex function of the velocities. It has one minimum, which a line
search along descent directions finds (see integrate.convex). Contacts of boxes of two sheets face on face are
patches (integrate.patches).

These approximations cost iterations, not accuracy: each iteration begins with the forces of the exact laws,
and adds the response of the points to the change.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.contact.between import look_at
from mdlgen.backends.lattice.kernels.contact.overlaps import is_known
from mdlgen.backends.lattice.kernels.integrate.air import damping_of
from mdlgen.backends.lattice.kernels.integrate.patches import begin_patch
from mdlgen.backends.lattice.kernels.state import (
    A_COUPLE,
    A_DAMPER,
    A_PRESSURE,
    AIR,
    ALONG,
    ARM_A,
    ARM_B,
    BETA,
    FIELD,
    GROWTH,
    HOLD,
    KIND,
    MU_DYNAMIC,
    MU_STATIC,
    NORMAL,
    NOW,
    OVER,
    PRESSING,
    RATE,
    SLIDING,
    SPRING,
    SQUARE,
    START,
    STICTION,
    STRETCHED,
)
from mdlgen.backends.lattice.kernels.tuning import REACH
from mdlgen.mechanics import point as law_point
from mdlgen.mechanics.frame import LAW_SMOOTHING, frame_of, law_of
from mdlgen.mechanics.laws import damped, friction_over_speed, held_over_speed, sign_step
from mdlgen.mechanics.measured import STRETCH, is_stretched
from mdlgen.mechanics.overlap import BY_SIDES
from mdlgen.mechanics.pair import on_fixed_plate
from mdlgen.mechanics.vector import add, cross, dot, scale, sub, three, three_from
from mdlgen.program.kernel import BORROWS, njit

# Value of a patch's number of corners while its overlap has not been computed.
TO_FIND_CORNERS = -1


@njit(cache=True, error_model="numpy", **BORROWS)
def law_at(q, v, h):
    """Evaluates a point at the velocity v of the first body against the second. Returns the elastic force,
    its growth with depth, the normal force, the closing rate, and the slip velocity. The last includes the
    part of a bristle, or the stretch of STRETCHED friction."""
    n, square = three_from(q, NORMAL), three_from(q, SQUARE)
    rate = -dot(v, n)
    spring = max(q[SPRING] + q[GROWTH] * h * (rate - q[RATE]), 0.0)
    normal = damped(spring, rate, q[BETA], q[OVER])
    slip, field = sub(v, scale(dot(v, square), square)), three_from(q, FIELD)
    if q[HOLD] < 0.0:
        field = scale(dot(field, slip), field)
    return spring, q[GROWTH], normal, rate, add(slip, field)


@njit(cache=True, error_model="numpy", **BORROWS)
def force_of(q, v, h):
    """Force of a point on the first body at the velocity v; for A_COUPLE, the couple."""
    n = three_from(q, NORMAL)
    if q[KIND] == A_DAMPER:
        return scale(q[SPRING] * q[BETA] * sign_step(-dot(v, n), q[OVER]), n)
    if q[KIND] == A_COUPLE:
        return scale(-q[SPRING] * sign_step(q[GROWTH] * dot(v, n), q[OVER]), n)
    if q[KIND] == AIR:
        return scale(q[SPRING], n)
    _spring, _growth, normal, _rate, slip = law_at(q, v, h)
    if q[PRESSING] <= 0.0:
        return scale(normal, n)
    speed = math.sqrt(dot(slip, slip))
    if q[HOLD] > 0.0:
        over = held_over_speed(speed, q[HOLD], q[MU_STATIC])
    else:
        over = friction_over_speed(speed, q[MU_STATIC], q[MU_DYNAMIC], q[STICTION], q[SLIDING])
    if q[HOLD] < 0.0:
        stretch = three_from(q, FIELD)
        slip = add(slip, scale(dot(stretch, slip), stretch))
    return sub(scale(normal, n), scale(q[PRESSING] * over, slip))


@njit(cache=True, error_model="numpy", **BORROWS)
def _begin(frozen, p, where, normal, a, b):
    """Adds a point of a pair, whose bodies are Frames; returns its number, -1: the array is full."""
    many = frozen.many[0]
    if many == frozen.pair.size:
        return -1
    q = frozen.points[many]
    arm, far = sub(where, a.x), sub(where, b.x)
    v = sub(add(a.v, cross(a.w, arm)), add(b.v, cross(b.w, far)))
    for i in range(3):
        q[NORMAL + i] = q[SQUARE + i] = normal[i]
        q[ARM_A + i], q[ARM_B + i], q[NOW + i], q[ALONG + i], q[FIELD + i] = arm[i], far[i], v[i], 0.0, 0.0
    q[RATE] = -dot(v, normal)
    q[SPRING] = q[GROWTH] = q[PRESSING] = 0.0
    q[KIND], q[BETA], q[OVER] = A_PRESSURE, 0.0, 1.0
    q[MU_STATIC] = q[MU_DYNAMIC] = q[HOLD] = 0.0
    q[STICTION] = q[SLIDING] = 1.0
    frozen.pair[many] = p
    frozen.many[0] = many + 1
    return many


@njit(cache=True, error_model="numpy", **BORROWS)
def _started(q, h):
    """Stores the force of a point at the beginning of the iteration."""
    f = force_of(q, three_from(q, NOW), h)
    for i in range(3):
        q[START + i] = f[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def _of_law(frozen, p, pair, out, h, motion):
    """Adds the points of a pair that its law has written into `out` (see mechanics.point)."""
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    law = law_of(pair)
    for k in range(int(out[law_point.POINTS])):
        at = law_point.OUT + 1 + law_point.POINT * k
        kind = out[at + law_point.KIND]
        if kind == law_point.COUPLE:
            axis = three_from(out, at + law_point.AXIS)
            many = _begin(frozen, p, a.x, axis, a, b)
            if many < 0:
                return
            q = frozen.points[many]
            turning = sub(a.w, b.w)
            for i in range(3):
                q[NOW + i] = turning[i]
            q[KIND], q[SPRING] = A_COUPLE, out[at + law_point.MOST_COUPLE]
            q[GROWTH], q[OVER] = out[at + law_point.RADIUS], pair.law[LAW_SMOOTHING]
            _started(q, h)
            continue
        spring, force = out[at + law_point.SPRING], out[at + law_point.FORCE]
        normal = three_from(out, at + law_point.NORMAL)
        many = _begin(frozen, p, three_from(out, at + law_point.AT), normal, a, b)
        if many < 0:
            return
        q = frozen.points[many]
        alone = kind == law_point.ALONE
        # the damper of the points of a nip is on its contact line
        times = 1.0 if alone or spring == 0.0 else force / spring
        q[SPRING], q[GROWTH] = times * spring, times * out[at + law_point.GROWTH]
        if alone:
            q[BETA], q[OVER] = out[at + law_point.BETA], out[at + law_point.OVER]
        else:
            for i in range(3):
                q[SQUARE + i] = out[at + law_point.WAY + i]
        q[MU_STATIC], q[MU_DYNAMIC] = out[at + law_point.MU_STATIC], out[at + law_point.MU_DYNAMIC]
        q[STICTION], q[SLIDING], q[PRESSING] = law.stiction, law.sliding, force
        q[HOLD] = out[at + law_point.HOLD]
        if is_stretched(out):
            square = three_from(q, SQUARE)
            stretch = three_from(out, STRETCH)
            stretch = sub(stretch, scale(dot(stretch, square), square))
            q[HOLD] = STRETCHED
            for i in range(3):
                q[FIELD + i] = stretch[i]
        if q[HOLD] > 0.0:
            _, _, _, _, slip = law_at(q, three_from(q, NOW), h)
            for i in range(3):
                q[FIELD + i] = out[at + law_point.SLIP + i] - slip[i]
        _started(q, h)
        if alone or out[at + law_point.BETA] == 0.0 or out[at + law_point.OVER] == law_point.NEVER:
            continue
        line, way = three_from(out, at + law_point.LINE), three_from(out, at + law_point.WAY)
        many = _begin(frozen, p, line, way, a, b)
        if many < 0:
            return
        q = frozen.points[many]
        q[KIND], q[SPRING] = A_DAMPER, spring
        q[BETA], q[OVER] = out[at + law_point.BETA], out[at + law_point.OVER]
        _started(q, h)


@njit(cache=True, error_model="numpy", **BORROWS)
def _of_air(frozen, film, pair, p, motion):
    """Adds those cells of air of a pair that are not yet points."""
    cells, i = film.cells, film.head[p]
    if i < 0 or cells[i].point >= 0:
        return
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    while i >= 0:
        own = cells[i]
        many = _begin(frozen, p, three(own.at), three(own.normal), a, b)
        own.point = many
        if many >= 0:
            q = frozen.points[many]
            q[KIND], q[OVER] = AIR, damping_of(film, i)
            for k in range(3):
                q[START + k] = 0.0
        i = own.following


@njit(cache=True, error_model="numpy", **BORROWS)
def _note_ends(tables, frozen):
    """Stores the bodies and nodes of each point."""
    bodies, pairs, listed, last = tables.bodies, tables.pairs, tables.listed, -1
    first, a, b, one, two = pairs.size - listed.size, 0, 0, -1, -1
    for k in range(frozen.many[0]):
        p, ends = frozen.pair[k], frozen.ends[k]
        if p != last:
            if p >= first:
                a, b = int(listed[p - first].a), int(listed[p - first].b)
            else:
                a, b = pairs[p].a, pairs[p].b
            one, two, last = bodies[a].node, bodies[b].node, p
        ends.a, ends.b, ends.one, ends.two = a, b, one, two


@njit(cache=True, error_model="numpy", **BORROWS)
def _patches(work, begins, close, h):
    """Sets up patches of the near pairs from `begins` on, which are searched, where overlaps are known."""
    mid, first, frozen = work.mid, work.search.first, work.frozen
    for slot in range(close - begins):
        at = begins + slot
        k, q = mid.near[at] - first, frozen.patches[slot]
        own = work.search.listed[k]
        q.pair, q.count = k, 0
        if mid.does[at] == BY_SIDES:
            continue
        if is_known(work, k, frame_of(mid.motion, own.a), frame_of(mid.motion, own.b)):
            begin_patch(work, q, k, h)
        else:
            q.count = TO_FIND_CORNERS


@njit(cache=True, error_model="numpy")
def gather(work, counts, h, plates):
    """Collects the points and the patches of the near pairs at the midpoint, and points of air; `counts`: how
    many touch, how many are near; `plates`: only contacts with fixed plates."""
    tables, mid, frozen, film = work.tables, work.mid, work.frozen, work.film
    bodies, pairs, near, motion = tables.bodies, tables.pairs, mid.near, mid.motion
    count, close = counts
    first, air = work.search.first, film.many[0]
    frozen.many[:] = 0
    known = begins = 0
    while begins < close and near[begins] < first:
        begins += 1
    if not plates:
        frozen.many[1] = close - begins
        _patches(work, begins, close, h)
    for k in range(air):
        film.cells[film.head[film.listed[k]]].point = -1
    for at in range(close):
        p, row = near[at], known
        touching = known < count and mid.touched[known] == p
        if touching:
            known += 1
        if plates and (p >= first or not on_fixed_plate(pairs[p], bodies[pairs[p].b])):
            continue
        if air > 0:
            _of_air(frozen, film, pairs[p], p, motion)
        if p >= first:
            patch = frozen.patches[at - begins]
            if patch.count == TO_FIND_CORNERS:
                own = work.search.listed[p - first]
                a, b = frame_of(motion, own.a), frame_of(motion, own.b)
                if look_at(work, p - first, a, b, REACH):
                    begin_patch(work, patch, p - first, h)
                else:
                    patch.count = 0
            if patch.count > 0:
                frozen.lying[frozen.many[2]] = at - begins
                frozen.many[2] += 1
        if touching and (p < first or mid.does[at] == BY_SIDES):
            _of_law(frozen, p, pairs[p], mid.results[mid.rows[row]], h, motion)
    for k in range(air):
        _of_air(frozen, film, pairs[film.listed[k]], film.listed[k], motion)
    _note_ends(tables, frozen)
