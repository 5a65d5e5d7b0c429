"""How far sheets have moved at most, by which overlaps of their boxes are known to hold without a look.

Whether an overlap that is kept still is what two boxes have takes as long as half of their force. Sheets
that hardly move need no such look: places of a sheet, and places that it would have were it larger, move by
no more than its speed times the time. So a look at two sheets makes sure that their overlaps hold for a while
longer (overlap.holds), and none follows until both may have moved as far together.
"""

from __future__ import annotations

import math

from mdlgen.mechanics.overlap import MOVED
from mdlgen.program.kernel import BORROWS, njit

# The part of what boxes may move that is left after a look.
LEFT = 0.5


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
        if not was + now - drift.looked[k] <= LEFT * MOVED * regions[k].least:
            # the step may be taken again from the state, the other way
            drift.looked[k] = was - now
            drift.looks[k] += 1


@njit(cache=True, error_model="numpy", **BORROWS)
def add_step(work, dt):
    """A step of dt [ms] is taken."""
    drift = work.mid.drift
    _rates(work)
    for sheet in range(drift.moved.size):
        drift.moved[sheet] += dt * drift.rates[sheet]
