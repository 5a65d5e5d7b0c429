"""Forces of all near pairs in an iteration; those of boxes of two sheets follow from cached overlaps."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.drift import look_ahead
from mdlgen.backends.lattice.kernels.contact.overlaps import is_known, pressed
from mdlgen.backends.lattice.kernels.contact.search import law_of_boxes
from mdlgen.backends.lattice.kernels.forces import onto, touches
from mdlgen.backends.lattice.kernels.state import (
    DEPTH_NOW,
    FACE_DEPTH,
    FACE_FORCE,
    FACE_GRIP,
    FACE_LOST,
    FACE_POINTS,
    FACE_RUBBING,
    FACE_STORED,
    FORCE_NOW,
    TURNING_NOW,
)
from mdlgen.mechanics.frame import box_of, frame_of, law_of
from mdlgen.mechanics.overlap import (
    BY_SIDES,
    CLEAR,
    OTHER,
    OVERLAPS,
    PRESSES,
    UNKNOWN,
    apart,
    find,
    holds,
    press,
)
from mdlgen.mechanics.point import DEPTH, DISSIPATED, GRIP, POINTS, PRESSING, RUBBING, STORED
from mdlgen.mechanics.stick import carry_stretch, press_sticking
from mdlgen.mechanics.turning import ALONG, LIMIT
from mdlgen.model.tables.contacts import BOX_BOX
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def forget_overlaps(pairs, overlaps, first):
    """Invalidates the overlaps of the pairs from `first` on, which were searched again. The unused rows
    behind them are not written to, so that they take no memory."""
    for k in range(overlaps.size):
        if pairs[first + k].kind < 0:
            break
        overlaps[k].state = UNKNOWN


@njit(cache=True, error_model="numpy", **BORROWS)
def look_at(work, k, a, b, gap):
    """Updates the cached overlap of the k-th searched pair where it no longer holds for its boxes (Frames).
    Returns False where it is not updated, since the boxes are more than `gap` [mm] apart."""
    if is_known(work, k, a, b):
        return True
    tables, search, mid = work.tables, work.search, work.mid
    own, kept = search.listed[k], mid.overlaps[k]
    one, two = box_of(tables.bodies[own.a]), box_of(tables.bodies[own.b])
    if apart(a, one.half, b, two.half, gap):
        return False
    find(kept, a, one, b, two, law_of_boxes(search, own))
    ratio = search.regions[own.region].sticking
    if mid.sticks.pairs.size > 0 and ratio > 0.0:
        carry_stretch(mid.sticks.pairs[k], kept, a, b, ratio)
    kept.look = mid.drift.looks[own.region]
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def _two_boxes(work, at, out):
    """Writes the contact of two boxes of two sheets, a near pair, into `out` and adds its forces. Returns
    CLEAR, PRESSES, or BY_SIDES where `out` has their points."""
    tables, mid, p = work.tables, work.mid, work.mid.near[at]
    k = p - work.search.first
    own = work.search.listed[k]
    a, b = frame_of(mid.motion, own.a), frame_of(mid.motion, own.b)
    if not look_at(work, k, a, b, 0.0):
        return CLEAR
    does = BY_SIDES if mid.overlaps[k].state == OTHER else pressed(work, k, a, b, out)
    if does == BY_SIDES:
        mid.overlaps[k].state = OTHER
        return BY_SIDES if touches(tables, tables.pairs[p], mid.motion, mid.forces, out) else CLEAR
    if does == PRESSES:
        out[POINTS] = 0.0
        onto(mid.forces, own, out)
    return does


@njit(cache=True, error_model="numpy", forceinline=True)
def _note(face, out):
    """Stores the results of two boxes that touch; RUBBING and GRIP are not read where they have points."""
    face[FACE_FORCE], face[FACE_DEPTH], face[FACE_POINTS] = out[PRESSING], out[DEPTH], out[POINTS]
    face[FACE_RUBBING], face[FACE_GRIP] = out[RUBBING], out[GRIP]
    face[FACE_STORED], face[FACE_LOST] = out[STORED], out[DISSIPATED]


@njit(cache=True, error_model="numpy", **BORROWS)
def faces_into(rows, row, face):
    """Adds the results of two faces without points to the present ones of a row of the contacts."""
    rows[row, FORCE_NOW] += face[FACE_FORCE]
    rows[row, DEPTH_NOW] = max(rows[row, DEPTH_NOW], face[FACE_DEPTH])
    rows[row, TURNING_NOW + ALONG] += face[FACE_RUBBING]
    rows[row, TURNING_NOW + LIMIT] += face[FACE_GRIP]


@njit(cache=True, error_model="numpy", **BORROWS)
def near_forces(work, close, h):
    """Adds the forces of the near pairs to those of the midpoint, h [ms] after the state, as
    forces.pair_forces does, but without the contact points of two sheets. Returns (how many pairs touch,
    dissipated power)."""
    tables, mid, first = work.tables, work.mid, work.search.first
    near, results = mid.near, mid.results
    count = row = 0
    lost = 0.0
    look_ahead(work, h)
    for at in range(close):
        p, out = near[at], results[row]
        if p < first:
            touching = touches(tables, tables.pairs[p], mid.motion, mid.forces, out)
        else:
            mid.does[at] = _two_boxes(work, at, out)
            mid.lies[at] = mid.overlaps[p - first].state == OVERLAPS
            touching = mid.does[at] != CLEAR
        if touching:
            lost += out[DISSIPATED]
            mid.touched[count], mid.rows[count] = p, row
            if p >= first:
                _note(mid.faces[count], out)
            # a pair without points leaves its row to the next
            if p < first or out[POINTS] > 0.0:
                row += 1
            count += 1
    return count, lost


@njit(cache=True, error_model="numpy", **BORROWS)
def _between_steps(tables, mid, k, pair, motion, out):
    """As `_two_boxes` for a state between steps; k: number of the pair among those that are searched. Cached
    overlaps are not changed: one that no longer holds is computed in a separate record."""
    kept, law, kept_on = mid.overlaps[k], law_of(pair), True
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    if not holds(kept, a, b, 0.0):
        one, two = box_of(tables.bodies[pair.a]), box_of(tables.bodies[pair.b])
        if apart(a, one.half, b, two.half, 0.0):
            return False
        kept, kept_on = mid.spare[0], False
        find(kept, a, one, b, two, law)
    does = BY_SIDES if kept.state == OTHER else CLEAR
    if kept.state == OVERLAPS and kept_on and mid.sticks.pairs.size > 0 and pair.sticking > 0.0:
        does = press_sticking(out, kept, mid.sticks.pairs[k], a, b, law, pair.sticking, 0.0)
    elif kept.state == OVERLAPS:
        does = press(out, kept, a, b, law)
    if does == BY_SIDES:
        return touches(tables, pair, motion, mid.forces, out)
    if does == PRESSES:
        out[POINTS] = 0.0
        onto(mid.forces, pair, out)
    return does == PRESSES


@njit(cache=True, error_model="numpy", **BORROWS)
def forces_at(tables, mid, first, motion, close):
    """As `near_forces` for a state between steps, without changing cached overlaps: `first` is the first of
    the pairs that have any. Returns (how many pairs touch, stored energy)."""
    near, f, results = mid.near, mid.forces, mid.results
    count = row = 0
    stored = 0.0
    for at in range(close):
        pair, out = tables.pairs[near[at]], results[row]
        if pair.kind == BOX_BOX:
            touching = _between_steps(tables, mid, near[at] - first, pair, motion, out)
        else:
            touching = touches(tables, pair, motion, f, out)
        if touching:
            stored += out[STORED]
            mid.touched[count], mid.rows[count] = near[at], row
            if pair.kind == BOX_BOX:
                _note(mid.faces[count], out)
            if pair.kind != BOX_BOX or out[POINTS] > 0.0:
                row += 1
            count += 1
    return count, stored
