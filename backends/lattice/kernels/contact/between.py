"""Forces of all near pairs in an iteration: boxes of two sheets by the overlaps that are kept of them."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.search import law_of_boxes
from mdlgen.backends.lattice.kernels.forces import onto, touches
from mdlgen.backends.lattice.kernels.state import (
    DEPTH_NOW,
    FACE_DEPTH,
    FACE_FORCE,
    FACE_GRIP,
    FACE_POINTS,
    FACE_RUBBING,
    FORCE_NOW,
    TURNING_NOW,
)
from mdlgen.mechanics.frame import box_of, frame_of, law_of
from mdlgen.mechanics.overlap import OTHER, UNKNOWN, apart, find, holds, press
from mdlgen.mechanics.point import DEPTH, DISSIPATED, GRIP, POINTS, PRESSING, RUBBING, STORED
from mdlgen.mechanics.stick import carry_stretch, press_sticking
from mdlgen.mechanics.turning import ALONG, LIMIT
from mdlgen.model.tables.contacts import BOX_BOX
from mdlgen.program.kernel import BORROWS, njit

# Part of a box by which its overlap may have moved along it since it was found. With 1e-2 within a step the
# error of notes that slide under a pad no longer falls with the step.
MOVED = 1e-5


@njit(cache=True, error_model="numpy", **BORROWS)
def forget_overlaps(pairs, overlaps, first):
    """Pairs from `first` on, which are searched, are others now. Where none are there is room that nothing
    has written to, and that takes no memory."""
    for k in range(overlaps.size):
        if pairs[first + k].kind < 0:
            break
        overlaps[k].state = UNKNOWN


@njit(cache=True, error_model="numpy", **BORROWS)
def _two_boxes(tables, search, mid, p, out):
    """What two boxes of two sheets, pair p, do into `out` and onto the forces. Returns whether they touch."""
    motion, f, k = mid.motion, mid.forces, p - search.first
    own, kept = search.listed[k], mid.overlaps[k]
    a, b = frame_of(motion, own.a), frame_of(motion, own.b)
    if not holds(kept, a, b, MOVED):
        one, two = box_of(tables.bodies[own.a]), box_of(tables.bodies[own.b])
        if apart(a, one.half, b, two.half, 0.0):
            return False
        find(kept, a, one, b, two, law_of_boxes(search, own))
    if kept.state == OTHER:
        return touches(tables, tables.pairs[p], motion, f, out)
    if kept.count == 0 or not press(out, kept, a, b, law_of_boxes(search, own)):
        return False
    out[POINTS] = 0.0
    onto(f, own, out)
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def _sticking(tables, search, mid, p, out):
    """As `_two_boxes` for friction that sticks."""
    motion, f, k = mid.motion, mid.forces, p - search.first
    own, kept, stuck = search.listed[k], mid.overlaps[k], mid.sticks.pairs[k]
    ratio, law = search.regions[own.region].sticking, law_of_boxes(search, own)
    a, b = frame_of(motion, own.a), frame_of(motion, own.b)
    if not holds(kept, a, b, MOVED):
        one, two = box_of(tables.bodies[own.a]), box_of(tables.bodies[own.b])
        if apart(a, one.half, b, two.half, 0.0):
            return False
        find(kept, a, one, b, two, law)
        carry_stretch(stuck, kept, a, b, ratio)
    if kept.state == OTHER:
        return touches(tables, tables.pairs[p], motion, f, out)
    if kept.count == 0 or not press_sticking(out, kept, stuck, a, b, law, ratio, mid.sticks.half[0]):
        return False
    out[POINTS] = 0.0
    onto(f, own, out)
    return True


@njit(cache=True, error_model="numpy", forceinline=True)
def _note(face, out):
    """Keeps what is read later of two boxes that touch; of those with points RUBBING and GRIP are not."""
    face[FACE_FORCE], face[FACE_DEPTH], face[FACE_POINTS] = out[PRESSING], out[DEPTH], out[POINTS]
    face[FACE_RUBBING], face[FACE_GRIP] = out[RUBBING], out[GRIP]


@njit(cache=True, error_model="numpy", **BORROWS)
def faces_into(rows, row, face):
    """Adds what two faces do without points to what a row of the contacts does now."""
    rows[row, FORCE_NOW] += face[FACE_FORCE]
    rows[row, DEPTH_NOW] = max(rows[row, DEPTH_NOW], face[FACE_DEPTH])
    rows[row, TURNING_NOW + ALONG] += face[FACE_RUBBING]
    rows[row, TURNING_NOW + LIMIT] += face[FACE_GRIP]


@njit(cache=True, error_model="numpy", **BORROWS)
def near_forces(work, close):
    """Adds the forces of the near pairs to those of the midpoint, as forces.pair_forces does, but without the
    contact points of two sheets. Returns (how many pairs touch, dissipated power)."""
    tables, mid, search = work.tables, work.mid, work.search
    near, results = mid.near, mid.results
    sticks = mid.sticks.pairs.size > 0
    count = row = 0
    lost = 0.0
    for at in range(close):
        p, out = near[at], results[row]
        faces = p >= search.first
        if not faces:
            touching = touches(tables, tables.pairs[p], mid.motion, mid.forces, out)
        elif sticks and search.regions[search.listed[p - search.first].region].sticking > 0.0:
            touching = _sticking(tables, search, mid, p, out)
        else:
            touching = _two_boxes(tables, search, mid, p, out)
        if touching:
            lost += out[DISSIPATED]
            mid.touched[count], mid.rows[count] = p, row
            if faces:
                _note(mid.faces[count], out)
            # what has no points leaves its row to the next
            if not faces or out[POINTS] > 0.0:
                row += 1
            count += 1
    return count, lost


@njit(cache=True, error_model="numpy", **BORROWS)
def _between_steps(tables, mid, k, pair, motion, out):
    """As `_two_boxes` and `_sticking` for a state between steps; k: of the pair among those that are
    searched. What is kept stays as it is: where it does not hold, it is found in a record of its own."""
    kept, law = mid.overlaps[k], law_of(pair)
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    if holds(kept, a, b, MOVED):
        touching = kept.count > 0
        if touching and mid.sticks.pairs.size > 0 and pair.sticking > 0.0:
            touching = press_sticking(out, kept, mid.sticks.pairs[k], a, b, law, pair.sticking, 0.0)
        elif touching:
            touching = press(out, kept, a, b, law)
    else:
        one, two = box_of(tables.bodies[pair.a]), box_of(tables.bodies[pair.b])
        if apart(a, one.half, b, two.half, 0.0):
            return False
        kept = mid.spare[0]
        find(kept, a, one, b, two, law)
        if kept.state == OTHER:
            return touches(tables, pair, motion, mid.forces, out)
        touching = kept.count > 0 and press(out, kept, a, b, law)
    if touching:
        out[POINTS] = 0.0
        onto(mid.forces, pair, out)
    return touching


@njit(cache=True, error_model="numpy", **BORROWS)
def forces_at(tables, mid, first, motion, close):
    """As `near_forces` for a state between steps, without touching what is kept of overlaps: `first` is the
    first of the pairs that have any. Returns (how many pairs touch, stored energy)."""
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
