"""Forces of all near pairs in an iteration: boxes of two sheets by the overlaps that are kept of them."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.forces import onto, touches
from mdlgen.mechanics.frame import box_of, frame_of, law_of
from mdlgen.mechanics.overlap import OTHER, UNKNOWN, apart, find, holds, press
from mdlgen.mechanics.point import DISSIPATED, OUT, POINTS, STORED
from mdlgen.mechanics.stick import carry_stretch, press_sticking
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
def _by_sides(tables, pair, motion, f, out, short):
    """What two boxes do that are not face on face, into `out`, with its sums into `short`, too."""
    if not touches(tables, pair, motion, f, out):
        return False
    for i in range(OUT + 1):
        short[i] = out[i]
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def _two_boxes(tables, pair, kept, motion, f, out, short):
    """What two boxes of two sheets do into `short`, and onto f; of sides with points into `out`. Returns
    whether they touch."""
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    if not holds(kept, a, b, MOVED):
        one, two = box_of(tables.bodies[pair.a]), box_of(tables.bodies[pair.b])
        if apart(a, one.half, b, two.half, 0.0):
            return False
        find(kept, a, one, b, two, law_of(pair))
    if kept.state == OTHER:
        return _by_sides(tables, pair, motion, f, out, short)
    if kept.count == 0 or not press(short, kept, a, b, law_of(pair)):
        return False
    short[POINTS] = 0.0
    onto(f, pair, short)
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def _sticking(tables, mid, k, pair, out, short):
    """As `_two_boxes` for friction that sticks; k: of the pair among those that are searched."""
    motion, f, kept, stuck = mid.motion, mid.forces, mid.overlaps[k], mid.sticks.pairs[k]
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    if not holds(kept, a, b, MOVED):
        one, two = box_of(tables.bodies[pair.a]), box_of(tables.bodies[pair.b])
        if apart(a, one.half, b, two.half, 0.0):
            return False
        find(kept, a, one, b, two, law_of(pair))
        carry_stretch(stuck, kept, a, b, pair.sticking)
    if kept.state == OTHER:
        return _by_sides(tables, pair, motion, f, out, short)
    if kept.count == 0:
        return False
    if not press_sticking(short, kept, stuck, a, b, law_of(pair), pair.sticking, mid.sticks.half[0]):
        return False
    short[POINTS] = 0.0
    onto(f, pair, short)
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def near_forces(work, close):
    """Adds the forces of the near pairs to those of the midpoint, as forces.pair_forces does, but without the
    contact points of two sheets. Returns (how many pairs touch, dissipated power)."""
    tables, mid, first = work.tables, work.mid, work.search.first
    near, motion, f, results, overlaps = mid.near, mid.motion, mid.forces, mid.results, mid.overlaps
    sticks = mid.sticks.pairs.size > 0
    count = row = 0
    lost = 0.0
    for at in range(close):
        pair, out, short = tables.pairs[near[at]], results[row], mid.faces[count]
        if sticks and pair.kind == BOX_BOX and pair.sticking > 0.0:
            touching = _sticking(tables, mid, near[at] - first, pair, out, short)
        elif pair.kind == BOX_BOX:
            touching = _two_boxes(tables, pair, overlaps[near[at] - first], motion, f, out, short)
        else:
            touching = touches(tables, pair, motion, f, out)
        if touching:
            lost += short[DISSIPATED] if pair.kind == BOX_BOX else out[DISSIPATED]
            mid.touched[count], mid.rows[count] = near[at], row
            if pair.kind != BOX_BOX or short[POINTS] > 0.0:
                row += 1
            count += 1
    return count, lost


@njit(cache=True, error_model="numpy", **BORROWS)
def _between_steps(tables, mid, k, pair, motion, out, short):
    """As `_two_boxes` and `_sticking` for a state between steps; k: of the pair among those that are
    searched. What is kept stays as it is: where it does not hold, it is found in a record of its own."""
    kept, f, law = mid.overlaps[k], mid.forces, law_of(pair)
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    if holds(kept, a, b, MOVED):
        if mid.sticks.pairs.size > 0 and pair.sticking > 0.0:
            touching = kept.count > 0
            touching = touching and press_sticking(
                short, kept, mid.sticks.pairs[k], a, b, law, pair.sticking, 0.0
            )
        else:
            touching = kept.count > 0 and press(short, kept, a, b, law)
    else:
        one, two = box_of(tables.bodies[pair.a]), box_of(tables.bodies[pair.b])
        if apart(a, one.half, b, two.half, 0.0):
            return False
        kept = mid.spare[0]
        find(kept, a, one, b, two, law)
        if kept.state == OTHER:
            return _by_sides(tables, pair, motion, f, out, short)
        touching = kept.count > 0 and press(short, kept, a, b, law)
    if touching:
        short[POINTS] = 0.0
        onto(f, pair, short)
    return touching


@njit(cache=True, error_model="numpy", **BORROWS)
def forces_at(tables, mid, first, motion, close):
    """As `near_forces` for a state between steps, without touching what is kept of overlaps: `first` is the
    first of the pairs that have any. Returns (how many pairs touch, stored energy)."""
    near, f, results = mid.near, mid.forces, mid.results
    count = row = 0
    stored = 0.0
    for at in range(close):
        pair, out, short = tables.pairs[near[at]], results[row], mid.faces[count]
        if pair.kind == BOX_BOX:
            touching = _between_steps(tables, mid, near[at] - first, pair, motion, out, short)
        else:
            touching = touches(tables, pair, motion, f, out)
        if touching:
            stored += short[STORED] if pair.kind == BOX_BOX else out[STORED]
            mid.touched[count], mid.rows[count] = near[at], row
            if pair.kind != BOX_BOX or short[POINTS] > 0.0:
                row += 1
            count += 1
    return count, stored
