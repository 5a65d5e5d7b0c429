"""Bounds on the motion of sheets, within which cached overlaps and lists of near pairs need no check.

Checking that a cached overlap is still valid costs half as much as evaluating the contact force; the search
for near pairs costs as much again. Sheets that hardly move need neither: no place of a sheet moves by more
than its greatest speed times the time. So a check of two sheets leaves a margin for which their overlaps hold
(overlap.holds), and the next one follows when both together may have moved by it. Likewise the list of near
pairs has an extra margin.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.forces import near_of_model, near_of_search
from mdlgen.backends.lattice.kernels.state import MANY, MARGIN, SLACK
from mdlgen.backends.lattice.kernels.tuning import MOVED_UP_TO, SPARE, SPARE_PART
from mdlgen.mechanics.overlap import MOVED
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _rates(work):
    """Updates the bound on the speed of each sheet, at all places that its neighbours' boxes may reach."""
    nodes, u, label, drift = work.tables.nodes, work.state.u, work.free.label, work.mid.drift
    far = 2.0 * work.search.size  # from the middle of a box to the far corner of another one
    drift.rates[:] = 0.0
    for n in range(nodes.size):
        rate = math.sqrt(u[n, 0] * u[n, 0] + u[n, 1] * u[n, 1] + u[n, 2] * u[n, 2])
        rate += far * math.sqrt(u[n, 3] * u[n, 3] + u[n, 4] * u[n, 4] + u[n, 5] * u[n, 5])
        drift.rates[label[n]] = max(drift.rates[label[n]], rate)


@njit(cache=True, error_model="numpy", **BORROWS)
def look_ahead(work, h):
    """Marks the regions whose overlaps must be checked, h [ms] after the state at its velocities."""
    drift, regions = work.mid.drift, work.search.regions
    _rates(work)
    for k in range(regions.size):
        was = now = 0.0
        for end in range(2):
            sheet = drift.ends[k, end]
            if sheet >= 0:
                was, now = was + drift.moved[sheet], now + h * drift.rates[sheet]
        if not was + now - drift.looked[k] <= MOVED_UP_TO * MOVED * regions[k].least:
            drift.looked[k] = was - now
            drift.looks[k] += 1


@njit(cache=True, error_model="numpy", **BORROWS)
def list_near(work, margin, h, found):
    """Lists the pairs that are near in the middle of a step, h [ms] after the state, as forces.near_pairs
    does with `margin` [mm]; may list some more of those that are searched. Returns how many."""
    tables, motion, drift, regions = work.tables, work.mid.motion, work.mid.drift, work.search.regions
    count = near_of_model(tables, motion, margin, 2.0 * h, found)
    if regions.size == 0:
        return count
    _rates(work)
    fastest, was, may = 0.0, 0.0, drift.list_holds
    for k in range(regions.size):
        moved = rate = 0.0
        for end in range(2):
            sheet = drift.ends[k, end]
            if sheet >= 0:
                moved, rate = moved + drift.moved[sheet], rate + drift.rates[sheet]
        fastest = max(fastest, rate)
        # from the middle to the end of the step it moves as far again
        was = max(was, moved + 3.0 * h * rate - drift.list_moved[k])
    if not was <= may[SLACK] or margin > may[MARGIN]:
        spare = SPARE if 3.0 * h * fastest <= SPARE_PART * SPARE else 0.0
        may[MARGIN], may[SLACK] = margin, spare if spare > 0.0 else -1.0
        may[MANY] = near_of_search(tables, motion, margin + spare, 2.0 * h, drift.listed)
        for k in range(regions.size):
            drift.list_moved[k] = 0.0
            for end in range(2):
                sheet = drift.ends[k, end]
                if sheet >= 0:
                    drift.list_moved[k] += drift.moved[sheet] - h * drift.rates[sheet]
    many = int(may[MANY])
    for k in range(many):
        found[count + k] = drift.listed[k]
    return count + many


@njit(cache=True, error_model="numpy", **BORROWS)
def list_anew(drift):
    """Invalidates the list and all overlaps: after a search, or after a step that failed."""
    drift.list_holds[SLACK] = -1.0
    drift.looked[:] = -math.inf


@njit(cache=True, error_model="numpy", **BORROWS)
def add_step(work, dt):
    """Adds the motion of a step of dt [ms]."""
    drift = work.mid.drift
    _rates(work)
    for sheet in range(drift.moved.size):
        drift.moved[sheet] += dt * drift.rates[sheet]
