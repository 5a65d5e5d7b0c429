"""What boxes of two sheets do, worked out by the threads of a run before it is added up."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels import parallel
from mdlgen.backends.lattice.kernels.contact.drift import LEFT
from mdlgen.backends.lattice.kernels.contact.fetch import hint
from mdlgen.backends.lattice.kernels.contact.search import law_of_boxes
from mdlgen.backends.lattice.kernels.parallel import begin, chunks, finish, items_of, take
from mdlgen.mechanics.frame import frame_of
from mdlgen.mechanics.overlap import APART, CLEAR, MOVED, OVERLAPS, holds, press
from mdlgen.mechanics.stick import press_sticking
from mdlgen.program.kernel import BORROWS, njit

# What is known of a pair besides CLEAR, PRESSES and BY_SIDES: that its overlap is yet to be found.
TO_FIND = 3
# How many pairs ahead overlaps are asked for.
AHEAD = 6
# Of Pool.given: the first of the near pairs that is searched, and how many are near.
FIRST_NEAR, NEAR = 6, 7


@njit(cache=True, error_model="numpy", **BORROWS)
def ask_for(work, at, close):
    """Asks for the overlap of a near pair some pairs behind this one."""
    near, first = work.mid.near, work.search.first
    if at + AHEAD < close and near[at + AHEAD] >= first:
        hint(work.mid.overlaps, near[at + AHEAD] - first)


@njit(cache=True, error_model="numpy", **BORROWS)
def is_known(work, k, a, b):
    """Whether what is kept of the k-th pair that is searched is what its boxes (Frames) have."""
    own, kept, looks = work.search.listed[k], work.mid.overlaps[k], work.mid.drift.looks
    if kept.state != OVERLAPS and kept.state != APART:
        return False
    if kept.look == looks[own.region]:
        return True
    if not holds(kept, a, b, 2.0 * LEFT * MOVED * work.search.regions[own.region].least):
        return False
    kept.look = looks[own.region]
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def pressed(work, k, a, b, out):
    """What the overlap that is kept of the k-th pair that is searched does, into `out`: CLEAR, PRESSES or
    BY_SIDES."""
    search, mid, own, kept = work.search, work.mid, work.search.listed[k], work.mid.overlaps[k]
    if kept.state != OVERLAPS:
        return CLEAR
    law, ratio = law_of_boxes(search, own), search.regions[own.region].sticking
    if mid.sticks.pairs.size > 0 and ratio > 0.0:
        return press_sticking(out, kept, mid.sticks.pairs[k], a, b, law, ratio, mid.sticks.half[0])
    return press(out, kept, a, b, law)


@njit(cache=True, error_model="numpy", **BORROWS)
def press_part(work, part):
    """What the pairs of a part do whose overlaps are known, into rows of their own."""
    pool, mid, first = work.pool, work.mid, work.search.first
    begins, close = int(pool.given[FIRST_NEAR]), int(pool.given[NEAR])
    low, high = items_of(part, close - begins)
    for at in range(begins + low, begins + high):
        ask_for(work, at, close)
        k = mid.near[at] - first
        own = work.search.listed[k]
        a, b = frame_of(mid.motion, own.a), frame_of(mid.motion, own.b)
        mid.does[at] = pressed(work, k, a, b, mid.beforehand[at]) if is_known(work, k, a, b) else TO_FIND


@njit(cache=True, error_model="numpy", **BORROWS)
def press_beforehand(work, begins, close):
    """What near pairs that are searched, from `begins` on, do where their overlaps are known."""
    pool, many = work.pool, chunks(close - begins)
    pool.given[FIRST_NEAR], pool.given[NEAR] = begins, close
    begin(pool, parallel.PRESS, many)
    part = take(pool)
    while part >= 0:
        press_part(work, part)
        part = take(pool)
    finish(pool, many)
