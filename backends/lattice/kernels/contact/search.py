"""The neighbour search: sorts boxes into cells, lists pairs, and detects when the search must be repeated."""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.tuning import SKIN
from mdlgen.mechanics.frame import (
    LAW,
    LAW_BETA,
    LAW_DYNAMIC,
    LAW_SLIDING,
    LAW_SMOOTHING,
    LAW_STATIC,
    LAW_STICTION,
    Law,
)
from mdlgen.model.tables import BOX_BOX
from mdlgen.program.kernel import njit

EMPTY = -1  # kind of an unused row


@njit(cache=True, error_model="numpy", forceinline=True)
def _hash(i, j, k, many):
    return (i * 73856093 ^ j * 19349663 ^ k * 83492791) & (many - 1)


@njit(cache=True, error_model="numpy")
def _sort(search, x):
    """Puts the boxes into their cells, and stores their places."""
    search.head[:] = -1
    for b in search.boxes:
        for i in range(3):
            search.place[b, i] = x[b, i]
            search.cell[b, i] = math.floor(x[b, i] / search.size)
        at = _hash(search.cell[b, 0], search.cell[b, 1], search.cell[b, 2], search.head.size)
        search.following[b] = search.head[at]
        search.head[at] = b


@njit(cache=True, error_model="numpy")
def look(pairs, search, x):
    """Lists the near pairs of boxes behind those of the Model. Returns False if the array is full."""
    if search.regions.size == 0:
        return True
    _sort(search, x)
    count, listed = search.first, search.listed
    for number in range(search.regions.size):
        region = search.regions[number]
        for a in search.boxes:  # of a halved scene, those of one side
            if not region.a <= a < region.a + region.many_a:
                continue
            for cell in range(27):
                i, j, k = cell % 3 - 1, cell // 3 % 3 - 1, cell // 9 - 1
                i, j, k = search.cell[a, 0] + i, search.cell[a, 1] + j, search.cell[a, 2] + k
                b = search.head[_hash(i, j, k, search.head.size)]
                while b >= 0:
                    own = search.cell[b, 0] == i and search.cell[b, 1] == j and search.cell[b, 2] == k
                    if own and region.b <= b < region.b + region.many_b:
                        reach = search.radius[a] + search.radius[b] + SKIN
                        dx, dy, dz = x[a, 0] - x[b, 0], x[a, 1] - x[b, 1], x[a, 2] - x[b, 2]
                        if dx * dx + dy * dy + dz * dz < reach * reach:
                            if count == pairs.size:
                                return False
                            _fill(pairs[count], region, a, b, search.rough[a] * search.rough[b])
                            own = listed[count - search.first]
                            own.a, own.b, own.region = a, b, number
                            count += 1
                    b = search.following[b]
    if count < pairs.size:  # rows behind this one are not read
        pairs[count].kind = listed[count - search.first].a = EMPTY
    return True


@njit(cache=True, error_model="numpy")
def _fill(pair, region, a, b, rough):
    pair.kind, pair.a, pair.b = BOX_BOX, a, b
    pair.row, pair.shared, pair.k = region.row, region.shared, region.k
    pair.sticking = region.sticking
    for i in range(LAW):
        pair.law[i] = region.law[i] * (rough if i in (LAW_STATIC, LAW_DYNAMIC) else 1.0)
    pair.mark = mark_of(region, a, b)


@njit(cache=True, error_model="numpy", forceinline=True)
def mark_of(region, a, b):
    """Place of two boxes among the marks of pairs that have touched."""
    return region.mark + (a - region.a) * region.many_b + (b - region.b)


@njit(cache=True, error_model="numpy", forceinline=True)
def law_of_boxes(search, own):
    """Law of a searched pair, from its row `own` of LISTED. It equals the one that `_fill` writes into the
    record of the pair, which is slower to read."""
    region, rough = search.regions[own.region], search.rough[own.a] * search.rough[own.b]
    row = region.law
    return Law(
        region.k,
        region.shared != 0,
        row[LAW_BETA],
        row[LAW_STATIC] * rough,
        row[LAW_DYNAMIC] * rough,
        row[LAW_STICTION],
        row[LAW_SLIDING],
        row[LAW_SMOOTHING],
        0.0,
    )


@njit(cache=True, error_model="numpy")
def strayed(bodies, search, x, u, dt):
    """True if, after dt at the velocities u (nodes, 6), a box would be further than half of SKIN from its
    place in the last search."""
    for b in search.boxes:
        n = bodies[b].node
        if n < 0:
            continue
        square = 0.0
        for i in range(3):
            square += (x[b, i] + dt * u[n, i] - search.place[b, i]) ** 2
        if not square <= 0.25 * SKIN * SKIN:
            return True
    return False
