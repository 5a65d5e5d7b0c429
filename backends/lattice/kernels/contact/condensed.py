"""Arrays of the condensed contact system: the active boxes, which touch something, and their compliance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.linear.band import solve_six
from mdlgen.backends.lattice.kernels.tuning import COLUMNS, FEWEST_APART
from mdlgen.mechanics.pair import on_fixed_plate
from mdlgen.model.tables.contacts import BOX_BOX
from mdlgen.program.kernel import BORROWS, njit

# Treatment of contacts: all condensed; those with fixed plates in the matrix of the sheet; all in the matrix.
APART, PLANES, INSIDE = 0, 1, 2

# Columns of Condensed.kept: 1 where factors may be reused; number of active boxes; number of boxes in W.
REUSE, ACTIVE, STANDING = 0, 1, 2
# Columns of Condensed.looked: number of pairs that touch; 1 where evaluated at the final velocities; number
# of pairs in `mine`.
TOUCHED, UP_TO_DATE, MINE = 0, 1, 2


class Condensed(NamedTuple):
    """Arrays for the boxes that touch, made once for a run."""

    slot_of: np.ndarray  # (nodes,) slot of a node's columns, -1: none.
    owner: np.ndarray  # (slots,) node of each slot.
    following: np.ndarray  # (1,) slot to be filled next.
    cols: np.ndarray  # (slots, 6, 6 nodes) columns of the inverse.
    place_of: np.ndarray  # (nodes,) place among the chosen boxes, -1: none.
    chosen: np.ndarray  # nodes, by place.
    active: np.ndarray  # places of the boxes that touch now, by rank.
    rank: np.ndarray  # rank by place, -1: does not touch.
    kept: np.ndarray  # (3,) REUSE, ACTIVE, STANDING.
    stood: np.ndarray  # nodes in W, by place.
    rollers: np.ndarray  # bodies that turn or slide, pressed plates too.
    growth: np.ndarray  # growth of impulses with the velocities of active boxes and rollers.
    w: np.ndarray  # compliance W of the chosen boxes.
    part: np.ndarray  # compliance of the active boxes.
    jac: np.ndarray  # 1 + W growth, transposed, or its factors.
    swaps: np.ndarray  # exchanged rows.
    own: np.ndarray  # inverse masses of the rollers.
    measure: np.ndarray  # factors that convert unknowns to velocities.
    z: np.ndarray  # changes of velocity: chosen boxes, then rollers.
    z0: np.ndarray
    gap: np.ndarray  # residual of the equations.
    step: np.ndarray
    short: np.ndarray  # step of active boxes and rollers.
    push: np.ndarray  # decrease of the impulses due to it.
    p: np.ndarray  # impulses.
    p0: np.ndarray  # impulses at the start.
    used: np.ndarray  # impulses linearised by the last step.
    forces: np.ndarray  # (bodies, 6).
    axes: np.ndarray  # (bodies, 9) axes of the boxes, in which the matrix is written.
    mine: np.ndarray  # near pairs of the chosen boxes.
    seen: np.ndarray  # (pairs,) true where `mine` has a pair.
    looked: np.ndarray  # (3,) TOUCHED, UP_TO_DATE, MINE.
    touched: np.ndarray  # pairs that touch.
    results: np.ndarray  # results of their contacts.
    pair: np.ndarray  # (6, 6) growth of one pair's forces.
    direction: np.ndarray  # (4, 6) directions in which the unknowns of a pair's rollers move them.
    which: np.ndarray  # (4,) numbers of these unknowns.


def empty(system, wide: int) -> Condensed:
    """Arrays for a System; `wide`: numbers in the result of a pair."""
    nodes, border, pairs = len(system.nodes), system.border, len(system.pairs)
    slots = int(min(nodes, max(8, COLUMNS / (288 * max(nodes, 1)))))
    # above this a factor of the whole matrix is cheaper than one of this system
    most = int(min(slots, max(FEWEST_APART, (1.5 * nodes * system.reach**2) ** (1 / 3))))
    size = 6 * most + border
    return Condensed(
        slot_of=np.full(nodes, -1, np.int64),
        owner=np.full(slots, -1, np.int64),
        following=np.zeros(1, np.int64),
        cols=np.zeros((slots, 6, 6 * nodes)),
        place_of=np.full(nodes, -1, np.int64),
        chosen=np.zeros(most, np.int64),
        active=np.zeros(most, np.int64),
        rank=np.full(most, -1, np.int64),
        kept=np.zeros(3, np.int64),
        stood=np.zeros(most, np.int64),
        rollers=system.moving,
        growth=np.zeros((size, size)),
        w=np.zeros((size, size)),
        part=np.zeros((size, size)),
        jac=np.zeros((size, size)),
        swaps=np.zeros(size, np.int64),
        own=np.zeros(size),
        measure=np.ones(size),
        z=np.zeros(size),
        z0=np.zeros(size),
        gap=np.zeros(size),
        step=np.zeros(size),
        short=np.zeros(size),
        push=np.zeros(size),
        p=np.zeros(size),
        p0=np.zeros(size),
        used=np.zeros(size),
        forces=np.zeros((len(system.bodies), 6)),
        axes=np.zeros((len(system.bodies), 9)),
        mine=np.zeros(pairs, np.int64),
        seen=np.zeros(pairs, np.bool_),
        looked=np.zeros(3, np.int64),
        touched=np.zeros(pairs, np.int64),
        results=np.zeros((pairs + 1, wide)),
        pair=np.zeros((6, 6)),
        direction=np.zeros((4, 6)),
        which=np.zeros(4, np.int64),
    )


@njit(cache=True, error_model="numpy", **BORROWS)
def forget(condensed):
    """Drops the columns of the last matrix."""
    condensed.slot_of[:] = -1
    condensed.owner[:] = -1
    condensed.kept[REUSE] = condensed.kept[STANDING] = 0


@njit(cache=True, error_model="numpy", **BORROWS)
def release(condensed, m):
    """Unmarks the m chosen boxes."""
    for i in range(m):
        condensed.place_of[condensed.chosen[i]] = -1
        condensed.rank[i] = -1
    condensed.kept[REUSE] = condensed.kept[ACTIVE] = 0


@njit(cache=True, error_model="numpy", **BORROWS)
def choose(bodies, pairs, touched, count, where, condensed, m, most):
    """Adds boxes that touch to the m chosen ones; returns how many they are, -1: more than `most`,
    or boxes of two sheets touch each other: these contacts must be in the matrix."""
    if where == INSIDE:
        return 0
    for k in range(count):
        pair = pairs[touched[k]]
        if where == PLANES and on_fixed_plate(pair, bodies[pair.b]):
            continue
        if pair.kind == BOX_BOX:
            release(condensed, m)
            return -1
        node = bodies[pair.a].node
        if node >= 0 and condensed.place_of[node] < 0:
            if m >= most:
                release(condensed, m)
                return -1
            condensed.place_of[node] = m
            condensed.chosen[m] = node
            m += 1
    return m


@njit(cache=True, error_model="numpy", **BORROWS)
def columns(a, condensed, m):
    """Computes the missing columns of the inverse for the chosen boxes, and W where it is for other boxes."""
    slot_of, owner, cols, chosen, w = (
        condensed.slot_of,
        condensed.owner,
        condensed.cols,
        condensed.chosen,
        condensed.w,
    )
    stood, known = condensed.stood, 0
    while known < min(m, condensed.kept[STANDING]) and stood[known] == chosen[known]:
        known += 1
    for i in range(known, m):
        n = chosen[i]
        stood[i] = n
        if slot_of[n] >= 0:
            continue
        s = condensed.following[0]
        while owner[s] >= 0 and condensed.place_of[owner[s]] >= 0:
            s = (s + 1) % owner.size
        if owner[s] >= 0:
            slot_of[owner[s]] = -1
        condensed.following[0] = (s + 1) % owner.size
        owner[s], slot_of[n] = n, s
        cols[s] = 0.0
        for p in range(6):
            cols[s, p, 6 * n + p] = 1.0
        solve_six(a, cols[s], n)
    for j in range(m):
        s = slot_of[chosen[j]]
        for i in range(0 if j >= known else known, m):
            base = 6 * chosen[i]
            for q in range(6):
                for p in range(6):
                    w[6 * i + p, 6 * j + q] = cols[s, q, base + p]
    condensed.kept[STANDING] = m


@njit(cache=True, error_model="numpy", **BORROWS)
def unsee(condensed):
    """Clears the list of pairs that were evaluated."""
    for k in range(condensed.looked[MINE]):
        condensed.seen[condensed.mine[k]] = False
    condensed.looked[UP_TO_DATE] = condensed.looked[MINE] = 0
