"""Forces of all near pairs in an iteration: boxes of two sheets by the overlaps that are kept of them."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.forces import onto, touches
from mdlgen.mechanics.frame import box_of, frame_of, law_of
from mdlgen.mechanics.overlap import OTHER, UNKNOWN, apart, find, holds, points, press
from mdlgen.mechanics.pair import BOX_BOX
from mdlgen.mechanics.point import DISSIPATED, OUT, POINTS, STORED
from mdlgen.program.kernel import BORROWS, njit

# Part of a box by which its overlap may have moved along it since it was found. With 1e-2 within a step the
# error of notes that slide under a pad no longer falls with the step.
MOVED = 1e-5


@njit(cache=True, error_model="numpy", **BORROWS)
def forget_overlaps(overlaps):
    """Pairs are others now."""
    for k in range(overlaps.size):
        overlaps[k].state = UNKNOWN


@njit(cache=True, error_model="numpy", **BORROWS)
def _two_boxes(tables, pair, kept, motion, f, out):
    """What two boxes of two sheets do, into `out`, without contact points, and onto f. Returns whether they
    touch."""
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    if not holds(kept, a, b, MOVED):
        one, two = box_of(tables.bodies[pair.a]), box_of(tables.bodies[pair.b])
        if apart(a, one.half, b, two.half):
            return False
        find(kept, a, one, b, two, law_of(pair))
    if kept.state == OTHER:
        return touches(tables, pair, motion, f, out)
    if kept.count == 0:
        return False
    out[POINTS] = 0.0
    if not press(out, kept, a, b, law_of(pair)):
        return False
    onto(f, pair, out)
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def near_forces(work, close):
    """Adds the forces of the near pairs to those of the midpoint, as forces.pair_forces does, but without the
    contact points of two sheets. Returns (how many pairs touch, dissipated power)."""
    tables, mid, first = work.tables, work.mid, work.search.first
    near, motion, f, results, overlaps = mid.near, mid.motion, mid.forces, mid.results, mid.overlaps
    count = 0
    lost = 0.0
    for at in range(close):
        pair, out = tables.pairs[near[at]], results[count]
        if pair.kind == BOX_BOX:
            touching = _two_boxes(tables, pair, overlaps[near[at] - first], motion, f, out)
        else:
            touching = touches(tables, pair, motion, f, out)
        if touching:
            lost += out[DISSIPATED]
            mid.touched[count] = near[at]
            count += 1
    return count, lost


@njit(cache=True, error_model="numpy", **BORROWS)
def contact_points(work, count):
    """Adds the contact points of two sheets to what `near_forces` left without them."""
    tables, mid, first = work.tables, work.mid, work.search.first
    for k in range(count):
        pair, out = tables.pairs[mid.touched[k]], mid.results[k]
        if pair.kind == BOX_BOX and out[POINTS] == 0.0:
            for i in range(OUT):
                out[i] = 0.0
            a, b = frame_of(mid.motion, pair.a), frame_of(mid.motion, pair.b)
            points(out, mid.overlaps[mid.touched[k] - first], a, b, law_of(pair))


@njit(cache=True, error_model="numpy", **BORROWS)
def forces_at(tables, mid, first, motion, close):
    """As `near_forces` for a state between steps, without touching what is kept of overlaps: `first` is the
    first of the pairs that have any. Returns (how many pairs touch, stored energy)."""
    near, f, results, overlaps = mid.near, mid.forces, mid.results, mid.overlaps
    count = 0
    stored = 0.0
    for at in range(close):
        pair, out = tables.pairs[near[at]], results[count]
        known, touching = False, False
        if pair.kind == BOX_BOX and near[at] >= first:
            kept, a, b = overlaps[near[at] - first], frame_of(motion, pair.a), frame_of(motion, pair.b)
            known = holds(kept, a, b, MOVED)
            if known and kept.count > 0:
                out[POINTS] = 0.0
                touching = press(out, kept, a, b, law_of(pair))
                if touching:
                    onto(f, pair, out)
        if not known:
            touching = touches(tables, pair, motion, f, out)
        if touching:
            stored += out[STORED]
            mid.touched[count] = near[at]
            count += 1
    return count, stored
