"""Checks of a step between its beginning and its end: pairs that are too deep, or change sides; and the
energy error of contacts that begin or end within it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.contact.search import law_of_boxes
from mdlgen.backends.lattice.kernels.forces import place_box, place_roller
from mdlgen.backends.lattice.kernels.state import ENDS, FACE_FORCE, FACE_POINTS, FORCE_NOW, MIDDLE, OWN_REACH
from mdlgen.backends.lattice.kernels.tuning import SWEPT_LITTLE, SWEPT_MOST
from mdlgen.mechanics.arm import turn_of, way_of
from mdlgen.mechanics.bounds import fastest_place
from mdlgen.mechanics.crossing import above, buried, closing, deepest, solid, unseen
from mdlgen.mechanics.frame import LAW_SMOOTHING, Frame, Motion, frame_of
from mdlgen.mechanics.gate import GATE, gate_at
from mdlgen.mechanics.impacts import stored_beyond, turning_back
from mdlgen.mechanics.mesh import BLOCK
from mdlgen.mechanics.overlap import impact
from mdlgen.mechanics.pair import pair_force
from mdlgen.mechanics.pairs.box_box import STRIDE
from mdlgen.mechanics.point import (
    AT,
    BETA,
    COUPLE,
    DEPTH,
    GROWTH,
    KIND,
    LINE,
    NORMAL,
    OF_NIP,
    OUT,
    OVER,
    POINT,
    POINTS,
    RATE,
    SPRING,
    STORED,
    WAY,
)
from mdlgen.mechanics.point import closing as closing_at
from mdlgen.mechanics.vector import add, dot, mat, scale, sub, three, three_from, vec
from mdlgen.model.tables import BOX_CYLINDER, BOX_PLANE
from mdlgen.program.kernel import BORROWS, njit

# Energy errors of contacts in a step, beyond the work of its midpoint [N mm]: of the stored energy, of either
# sign, and of the damping. In the end MISSES has both.
STORES, MISSES = 0, 1


class Before(NamedTuple):
    """Velocities of nodes and border in the middle of the step before, and the part of the time from there to
    the middle of this step that lies in this step."""

    u: np.ndarray  # (nodes, 6).
    ub: np.ndarray  # (border,).
    part: float


@njit(cache=True, error_model="numpy", forceinline=True)
def _place(tables, state, b, h, t, motion):
    """Places one body after h of a step from t, at the velocities of its middle."""
    x, r, u, ub = state.x, state.r, state.u, state.ub
    xs, rs, us, ws = motion
    body = tables.bodies[b]
    n = body.node
    if n >= 0:
        place_box(b, h, (u[n, 0], u[n, 1], u[n, 2]), (u[n, 3], u[n, 4], u[n, 5]), x, r, motion)
        return
    if body.swings >= GATE:
        gate_at(body, b, t, t + h, x, r, motion)
        return
    for i in range(3):
        xs[b, i], us[b, i], ws[b, i] = x[b, i], 0.0, 0.0
    for i in range(9):
        rs[b, i] = r[b, i]
    if body.slide < 0 and body.axis[0] == 0.0 and body.axis[1] == 0.0 and body.axis[2] == 0.0:
        return
    rate = ub[body.slide] if body.slide >= 0 else 0.0
    turning = body.ratio * ub[body.spin] if body.spin >= 0 else 0.0
    place_roller(body, b, h, t + h, rate, turning, x, r, motion)


@njit(cache=True, error_model="numpy", forceinline=True)
def _hits(bodies, pair, rows):
    """True if the contacts of a pair are impacts. The boxes of a sheet pass a roller in turn, and together
    store as much as before; so they are impacts only where none touched it. rows: Kept.rows, after the step
    before."""
    return pair.kind != BOX_CYLINDER or bodies[pair.a].exposed == BLOCK or rows[pair.row, FORCE_NOW] == 0.0


@njit(cache=True, error_model="numpy", forceinline=True)
def _clear(bodies, pair, x, r, way):
    """True if the height of a box above a plane exceeds the most approach in a step, `way` [mm]."""
    if pair.kind != BOX_PLANE:
        return False
    a, b = pair.a, pair.b
    normal, half = (r[b, 2], r[b, 5], r[b, 8]), bodies[a].half
    tall = bodies[b].half[2] + way
    for i in range(3):
        tall += half[i] * abs(normal[0] * r[a, i] + normal[1] * r[a, 3 + i] + normal[2] * r[a, 6 + i])
    return dot(sub(vec(x, a), vec(x, b)), normal) > tall


@njit(cache=True, error_model="numpy", **BORROWS)
def _changed(body, b, state, mid, slower):
    """Change of the velocity and the angular velocity of one body, from the middle of the step before to the
    middle of this one; slower: see Before."""
    n = body.node
    if n >= 0:
        u, kept = state.u, slower.u
        rate = (u[n, 0] - kept[n, 0], u[n, 1] - kept[n, 1], u[n, 2] - kept[n, 2])
        return rate, (u[n, 3] - kept[n, 3], u[n, 4] - kept[n, 4], u[n, 5] - kept[n, 5])
    rate = spin = (0.0, 0.0, 0.0)
    if body.slide >= 0:
        faster = state.ub[body.slide] - slower.ub[body.slide]
        rate, spin = scale(faster, way_of(body, vec(mid.motion.x, b))), scale(faster, turn_of(body))
    if body.spin >= 0:
        faster = body.ratio * (state.ub[body.spin] - slower.ub[body.spin])
        spin = add(spin, scale(faster, three(body.axis)))
    return rate, spin


@njit(cache=True, error_model="numpy", **BORROWS)
def _fastest_at_ends(tables, state, slower, fastest):
    """Bound on the speed of any place of a free box at either end of a step, into fastest[ENDS]."""
    u, kept = state.u, slower.u
    for n in range(tables.nodes.size):
        b = tables.nodes[n]
        more = sub((u[n, 0], u[n, 1], u[n, 2]), (kept[n, 0], kept[n, 1], kept[n, 2]))
        spin = sub((u[n, 3], u[n, 4], u[n, 5]), (kept[n, 3], kept[n, 4], kept[n, 5]))
        fastest[ENDS, b] = fastest[MIDDLE, b] + fastest_place(tables.boxes[n, OWN_REACH], more, spin)


@njit(cache=True, error_model="numpy", forceinline=True)
def _little(region, fast, dt, least):
    """True if the energy error of two faces is below `least`, where `fast` bounds their relative speed at
    either end of a step. Below the smoothing speed damping has no error. A depth that changes by z in half of
    the step stores at most 0.46 k z^5/2 beyond the work done on it (the maximum of impacts.stored_beyond over
    the depth)."""
    way = 0.5 * dt * fast
    return fast < region.law[LAW_SMOOTHING] and 0.46 * region.k * way * way * math.sqrt(way) < least


@njit(cache=True, error_model="numpy", **BORROWS)
def _faces_make_little(work, dt, least):
    """True if that holds for any two boxes of two sheets."""
    ends, nodes, regions = work.mid.fastest[ENDS], work.tables.nodes, work.search.regions
    most, little = 0.0, True
    for n in range(nodes.size if regions.size > 0 else 0):
        most = max(most, ends[nodes[n]])
    for k in range(regions.size):
        little = little and _little(regions[k], 2.0 * most, dt, least)
    return little


@njit(cache=True, error_model="numpy", **BORROWS)
def _made(work, count, dt, slower, may, rows):
    """Adds to `rows` (contacts, STORES and MISSES) the energy that contacts store in a step beyond the work
    done on them, and the energy that their damping missed. `slower`: see _changed; `may`: allowed error of
    each contact, and the least. Boxes of two sheets whose errors stay below SWEPT_LITTLE of it are
    omitted."""
    bodies, pairs, state, mid = work.tables.bodies, work.tables.pairs, work.state, work.mid
    touched, motion, ends, search = mid.touched, mid.motion, mid.fastest[ENDS], work.search
    listed, first = work.tables.listed, search.first
    allowed, share = may[0], SWEPT_LITTLE / max(1, count)
    every = _faces_make_little(work, dt, share * may[1])
    for k in range(count):
        faces = touched[k] >= first and mid.faces[k, FACE_POINTS] == 0.0
        if faces and every:
            continue
        if faces:
            own = listed[touched[k] - first]
            region, together = search.regions[own.region], ends[own.a] + ends[own.b]
            least = share * allowed[region.row]
            if 4.0 * dt * mid.faces[k, FACE_FORCE] * together < least or _little(region, together, dt, least):
                continue
            one, two, row = int(own.a), int(own.b), search.regions[own.region].row
        else:
            pair = pairs[touched[k]]
            if not _hits(bodies, pair, work.kept.rows):
                continue
            one, two, row = pair.a, pair.b, pair.row
        rate_one, spin_one = _changed(bodies[one], one, state, mid, slower)
        rate_two, spin_two = _changed(bodies[two], two, state, mid, slower)
        part = slower.part
        if faces:
            faster_one = scale(part, rate_one), scale(part, spin_one)
            faster = faster_one, (scale(part, rate_two), scale(part, spin_two))
            kept, law = mid.overlaps[touched[k] - first], law_of_boxes(search, listed[touched[k] - first])
            made, less = impact(kept, frame_of(motion, one), frame_of(motion, two), faster, law, dt)
            rows[row, STORES] += made
            rows[row, MISSES] += less
            continue
        out, still = mid.results[mid.rows[k]], mat(motion.r, one)
        a = Frame(vec(motion.x, one), still, rate_one, spin_one)
        b = Frame(vec(motion.x, two), still, rate_two, spin_two)
        for i in range(int(out[POINTS])):
            at = OUT + 1 + POINT * i
            point, kind = out[at:], out[at + KIND]
            force, growth = point[SPRING], point[GROWTH]
            if growth <= 0.0 or kind == COUPLE:
                continue
            depth, energy = 1.5 * force / growth, 0.6 * force * force / growth
            rows[row, STORES] += stored_beyond(force, depth, energy, 0.5 * dt * point[RATE])
            place = three_from(point, LINE if kind == OF_NIP else AT)
            normal = three_from(point, WAY if kind == OF_NIP else NORMAL)
            faster = part * closing_at(place, normal, a, b)
            less = turning_back(point[RATE], faster, point[BETA], point[OVER])
            rows[row, MISSES] += force * dt * less


@njit(cache=True, error_model="numpy", forceinline=True)
def _slow(bodies, own, k, fastest, dt, little):
    """True if two boxes of two sheets (`own`: their row of LISTED, k: stiffness) move too little in a step to
    cross each other undetected, and to make an energy error above `little` where they come to touch."""
    way = dt * (fastest[own.a] + fastest[own.b])
    if way > STRIDE * min(bodies[own.a].half[2], bodies[own.b].half[2]):
        return False
    half = 0.5 * way
    return 0.4 * k * half * half * math.sqrt(half) <= little


@njit(cache=True, error_model="numpy", **BORROWS)
def _all_slow(tables, regions, fastest, dt, little):
    """True if _slow holds for any two boxes of two sheets."""
    most, stiffest = 0.0, 0.0
    for k in range(regions.size):
        stiffest = max(stiffest, regions[k].k)
    for b in tables.nodes:
        most = max(most, fastest[b])
    half = dt * most
    return 2.0 * half <= STRIDE * tables.thinnest and 0.4 * stiffest * half * half * math.sqrt(half) <= little


@njit(cache=True, error_model="numpy")
def swept(work, counts, t, dt, may, slower, rows):
    """Checks the near pairs in a step from t, whose middle is known. Returns the first that becomes too deep
    or changes sides, or -1. Writes the energy error of each contact into rows[:, MISSES] (contacts, 2).

    `may`: allowed error of each contact (contacts,), 0 for any, and the least of these. `counts`: numbers of
    pairs that touch in the middle, and that are near. States within the step are checked closely enough for
    the law of the contact to see a pair that crosses; nearly all pairs are too slow to need one.
    """
    tables, state, mid = work.tables, work.state, work.mid
    bodies, pairs, shapes = tables.bodies, tables.pairs, tables.shapes
    x, r, touched, near, listed = state.x, state.r, mid.touched, mid.near, tables.listed
    count, close = counts
    made, (allowed, least) = False, may
    between, out = mid.motion, mid.motion.u[0]
    rows[:] = 0.0
    asked = least > 0.0
    if asked:
        if work.search.regions.size > 0:
            _fastest_at_ends(tables, state, slower, mid.fastest)
        _made(work, count, dt, slower, may, rows)
    known = 0
    little = SWEPT_LITTLE * least if asked else 1e300
    regions, first = work.search.regions, work.search.first
    slow = _all_slow(tables, regions, mid.fastest[MIDDLE], dt, little)
    for at in range(close):
        if slow and near[at] >= first:  # all that follow are slow, too
            break
        touches = known < count and touched[known] == near[at]
        if touches:
            known += 1
        if near[at] >= first:
            own = listed[near[at] - first]
            region = regions[own.region]
            little = SWEPT_LITTLE * allowed[region.row] if asked else 1e300
            if _slow(bodies, own, region.k, mid.fastest[MIDDLE], dt, little):
                continue
        pair = pairs[near[at]]
        began = Motion(x, r, mid.motion.u, mid.motion.w)
        fast = closing(bodies, pair, shapes, began, dt)
        way, band = dt * fast, unseen(bodies, pair, shapes)
        side = above(bodies, pair, x, r)
        inside = solid(bodies, pair)
        enters = False
        if asked and not touches:
            half = 0.5 * way
            enters = 0.4 * pair.k * half * half * math.sqrt(half) > SWEPT_LITTLE * allowed[pair.row]
            enters = enters and _hits(bodies, pair, work.kept.rows)
            enters = enters and not _clear(bodies, pair, x, r, way)
        if way <= band and side == 0 and not inside and not enters:
            continue
        if way > SWEPT_MOST * band:
            return near[at]
        if not made:
            made = True
            um, wm = np.empty_like(x), np.empty_like(x)
            between, out = Motion(np.empty_like(x), np.empty_like(r), um, wm), np.zeros(OUT)
        many = max(1, math.ceil(way / band))
        for k in range(1, many + 1):
            h = dt * k / many
            _place(tables, state, pair.a, h, t, between)
            _place(tables, state, pair.b, h, t, between)
            now = above(bodies, pair, between.x, between.r)
            if side * now < 0:
                return near[at]
            side = now
            if inside and buried(bodies, pair, shapes, between.x, between.r):
                return near[at]
            if way > band or enters:
                out[:] = 0.0
                pair_force(bodies, pair, shapes, between, out)
                if out[DEPTH] > deepest(bodies, pair):
                    return near[at]
                if enters and k == many:
                    rows[pair.row, STORES] += out[STORED]
    for row in range(rows.shape[0]):
        rows[row, MISSES] += abs(rows[row, STORES])
    return -1
