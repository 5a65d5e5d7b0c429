"""Stretches of pairs whose friction sticks: their update after a step, and after a new search.

A step begins with the stretches of the last one (mechanics.stick). Iterations do not change those, so a step
that is repeated, shorter, begins with the same. Pairs that a search lists in other places keep their
stretches.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.state import DISSIPATED, ELASTIC
from mdlgen.mechanics.overlap import OVERLAPS
from mdlgen.mechanics.stick import end_step, let_go
from mdlgen.model.tables import BOX_BOX
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def end_of_step(work, count, close, energies):
    """Stores the stretches at the end of a step. `count`: how many pairs touch in its middle; `close`: how
    many are near. The springs that are released dissipate their energy: energies (groups, 4)."""
    tables, mid, first = work.tables, work.mid, work.search.first
    near, overlaps, sticks = mid.near, mid.overlaps, mid.sticks.pairs
    known = 0
    for at in range(close):
        p = near[at]
        touches = known < count and mid.touched[known] == p
        if touches:
            known += 1
        pair = tables.pairs[p]
        if pair.kind != BOX_BOX or pair.sticking == 0.0:
            continue
        stuck, kept = sticks[p - first], overlaps[p - first]
        if touches and kept.state == OVERLAPS:
            end_step(stuck, kept, pair.a, pair.b)
        elif stuck.count > 0:
            energies[work.islands.group_of_row[pair.row], DISSIPATED] += let_go(stuck)


@njit(cache=True, error_model="numpy", **BORROWS)
def _copy(to, of):
    to.a, to.b, to.count, to.first, to.energy = of.a, of.b, of.count, of.first, of.energy
    for corner in range(of.count):
        for i in range(2):
            to.corners[corner, i], to.begun[corner, i] = of.corners[corner, i], of.begun[corner, i]


@njit(cache=True, error_model="numpy", **BORROWS)
def set_aside(sticks):
    """Moves the stretches of all pairs to `aside`, before the next search of pairs."""
    sticks.head[:] = -1
    count = 0
    for k in range(sticks.pairs.size):
        stuck = sticks.pairs[k]
        if stuck.count == 0:
            continue
        _copy(sticks.aside[count], stuck)
        sticks.following[count] = sticks.head[stuck.a]
        sticks.head[stuck.a] = count
        count += 1
        let_go(stuck)


@njit(cache=True, error_model="numpy", **BORROWS)
def put_back(pairs, sticks, first, islands, energies):
    """Restores the stretches in `aside` to the pairs from `first` on, which were searched again. Springs
    whose pair is no longer listed dissipate their energy: energies (groups, 4)."""
    for b in range(sticks.head.size):
        k = sticks.head[b]
        while k >= 0:
            group = islands.group[max(islands.part[b], 0)]
            energies[group, DISSIPATED] += sticks.aside[k].energy
            k = sticks.following[k]
    for p in range(first, pairs.size):
        pair = pairs[p]
        if pair.kind != BOX_BOX:
            break
        k = sticks.head[pair.a]
        while k >= 0:
            if sticks.aside[k].b == pair.b:
                _copy(sticks.pairs[p - first], sticks.aside[k])
                energies[islands.group_of_row[pair.row], DISSIPATED] -= sticks.aside[k].energy
                break
            k = sticks.following[k]


@njit(cache=True, error_model="numpy", **BORROWS)
def energy_into(sticks, listed, regions, groups, energies):
    """Adds what all springs store between steps to energies (groups, 3) [N mm]; `groups`: of each contact."""
    for k in range(sticks.pairs.size):
        if sticks.pairs[k].count > 0:
            energies[groups[regions[listed[k].region].row], ELASTIC] += sticks.pairs[k].energy
