"""How far sheets have moved at most, by which what is known of pairs of their boxes stays known without a
look.

Whether an overlap that is kept still is what two boxes have takes as long as half of their force, and which
pairs are near as long as the other half. Sheets that hardly move need no such look: places of a sheet, and
places that it would have were it larger, move by no more than its speed times the time. So a look at two
sheets makes sure that their overlaps hold for a while longer (overlap.holds), and none follows until both may
have moved as far together. Likewise pairs are listed that are near by some more than they need be.
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
    """How fast places of each sheet, and of its boxes' neighbours on other sheets, are at most."""
    nodes, u, label, drift = work.tables.nodes, work.state.u, work.free.label, work.mid.drift
    far = 2.0 * work.search.size  # from the middle of a box to the far corner of another one
    drift.rates[:] = 0.0
    for n in range(nodes.size):
        rate = math.sqrt(u[n, 0] * u[n, 0] + u[n, 1] * u[n, 1] + u[n, 2] * u[n, 2])
        rate += far * math.sqrt(u[n, 3] * u[n, 3] + u[n, 4] * u[n, 4] + u[n, 5] * u[n, 5])
        drift.rates[label[n]] = max(drift.rates[label[n]], rate)


@njit(cache=True, error_model="numpy", **BORROWS)
def look_ahead(work, h):
    """Notes of which regions a look is due, h [ms] after the state, where boxes move at its velocities."""
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
    does with `margin` [mm], maybe with some more of those that are searched; returns how many."""
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
        # it moves as far again in the step as to its middle
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
    """Pairs that are searched are others now, or a step was given up that may have left anything."""
    drift.list_holds[SLACK] = -1.0
    drift.looked[:] = -math.inf


@njit(cache=True, error_model="numpy", **BORROWS)
def add_step(work, dt):
    """A step of dt [ms] is taken."""
    drift = work.mid.drift
    _rates(work)
    for sheet in range(drift.moved.size):
        drift.moved[sheet] += dt * drift.rates[sheet]
