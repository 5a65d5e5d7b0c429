"""Cached overlaps of boxes of two sheets: the check that they still hold, and their forces."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.search import law_of_boxes
from mdlgen.backends.lattice.kernels.tuning import MOVED_UP_TO
from mdlgen.mechanics.overlap import APART, CLEAR, MOVED, OVERLAPS, holds, press
from mdlgen.mechanics.stick import press_sticking
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def is_known(work, k, a, b):
    """True if the cached overlap of the k-th searched pair still holds for its boxes (Frames)."""
    own, kept, looks = work.search.listed[k], work.mid.overlaps[k], work.mid.drift.looks
    if kept.state != OVERLAPS and kept.state != APART:
        return False
    if kept.look == looks[own.region]:
        return True
    if not holds(kept, a, b, 2.0 * MOVED_UP_TO * MOVED * work.search.regions[own.region].least):
        return False
    kept.look = looks[own.region]
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def pressed(work, k, a, b, out):
    """Writes the contact of the k-th searched pair, from its cached overlap, into `out`; returns CLEAR,
    PRESSES or BY_SIDES."""
    search, mid, own, kept = work.search, work.mid, work.search.listed[k], work.mid.overlaps[k]
    if kept.state != OVERLAPS:
        return CLEAR
    law, ratio = law_of_boxes(search, own), search.regions[own.region].sticking
    if mid.sticks.pairs.size > 0 and ratio > 0.0:
        return press_sticking(out, kept, mid.sticks.pairs[k], a, b, law, ratio, mid.sticks.half[0])
    return press(out, kept, a, b, law)
