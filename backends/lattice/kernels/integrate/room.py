"""Allocates the arrays of a step."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.kernels.integrate.mixing import ROWS
from mdlgen.backends.lattice.kernels.linear.band import empty as no_band
from mdlgen.backends.lattice.kernels.linear.coupled import couplings
from mdlgen.backends.lattice.kernels.state import (
    ENDS_OF_POINT,
    FACE,
    PATCH,
    POINT,
    Drift,
    Frozen,
    Matrix,
    Midpoint,
    State,
    Sticks,
)
from mdlgen.backends.lattice.kernels.tuning import MIXED
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.overlap import OVERLAP
from mdlgen.mechanics.point import MOST_POINTS
from mdlgen.mechanics.stick import STRETCH


def empty(system, wide: int) -> tuple[State, Midpoint, Matrix]:
    """State, midpoint and matrix of a System, all zero; `wide`: numbers in the result of a pair."""
    bodies, nodes, border = len(system.bodies), len(system.nodes), system.border
    sticking = bool((system.search.regions["sticking"] > 0.0).any())
    state = State(
        x=np.zeros((bodies, 3)),
        r=np.zeros((bodies, 9)),
        v=np.zeros((nodes, 3)),
        l=np.zeros((nodes, 3)),
        s=np.zeros(border),
        vb=np.zeros(border),
        u=np.zeros((nodes, 6)),
        ub=np.zeros(border),
    )
    places, rates = (
        (np.zeros((bodies, 3)), np.zeros((bodies, 9))),
        (np.zeros((bodies, 3)), np.zeros((bodies, 3))),
    )
    mid = Midpoint(
        motion=Motion(*places, *rates),
        forces=np.zeros((bodies, 6)),
        touched=np.zeros(len(system.pairs), np.int64),
        results=np.zeros((len(system.pairs) + 1, wide)),  # loops write to the row behind the last one
        rows=np.arange(max(1, len(system.pairs))),
        faces=np.zeros((max(1, len(system.pairs)), FACE)),
        totals=np.zeros(2),
        spent=np.zeros((len(system.runs), 2)),
        near=np.zeros(len(system.pairs), np.int64),
        overlaps=np.zeros(max(1, len(system.pairs) - system.search.first), OVERLAP),
        spare=np.zeros(1, OVERLAP),
        does=np.zeros(len(system.pairs), np.int64),
        lies=np.zeros(len(system.pairs), np.bool_),
        fastest=np.zeros((2, bodies)),
        sticks=sticks(len(system.pairs) - system.search.first, bodies) if sticking else sticks(0, 0),
        drift=drift(system),
    )
    matrix = Matrix(
        band=no_band(nodes, system.reach),
        border=np.zeros((border, 6 * nodes)),
        corner=np.zeros((border, border)),
        eliminated=np.zeros((border, 6 * nodes)),
        schur=np.zeros((border, border)),
        res=np.zeros(6 * nodes),
        resb=np.zeros(border),
        direction=np.zeros((4, 3)),
        unknowns=np.zeros(4, np.int64),
        couplings=couplings(len(system.pairs) - system.search.first, system.sheets, border),
        mixing=np.zeros((ROWS, 6 * nodes + border)),
        gram=np.zeros((MIXED, MIXED)),
        parts=np.zeros((2, MIXED)),
        offsets=system.offsets,
        slots=np.arange(system.reach + 1),
        inner_slots=np.searchsorted(system.offsets, np.arange(system.reach + 1)),
        inner=np.zeros((nodes, 6, 6 * len(system.offsets))),
        own=np.zeros((border, border)),
        single_factor=no_band(nodes, system.reach).astype(np.float32),
        single_inner=np.zeros((nodes, 6, 6 * len(system.offsets)), np.float32),
    )
    return state, mid, matrix


def sticks(pairs: int, bodies: int) -> Sticks:
    """Stretches of this number of searched pairs, and of bodies."""
    return Sticks(
        pairs=np.zeros(pairs, STRETCH),
        aside=np.zeros(pairs, STRETCH),
        head=np.full(bodies, -1, np.int64),
        following=np.full(pairs, -1, np.int64),
        half=np.zeros(1),
    )


def drift(system) -> Drift:
    """Record of sheets whose overlaps were not yet checked."""
    sheets, regions = int(system.sheets.max(initial=-1)) + 1, system.search.regions
    label = np.full(len(system.bodies), -1, np.int64)
    label[system.nodes] = system.sheets
    parts = [[label[r[end] : r[end] + r["many_" + end]].max(initial=-1) for end in "ab"] for r in regions]
    return Drift(
        ends=np.array(parts, np.int64).reshape(-1, 2),
        moved=np.zeros(sheets),
        rates=np.zeros(sheets),
        looked=np.full(len(regions), -np.inf),
        looks=np.zeros(len(regions), np.int64),
        listed=np.zeros(len(system.pairs) - system.search.first, np.int64),
        list_moved=np.zeros(len(regions)),
        list_holds=np.array([0.0, 0.0, -1.0]),
    )


def frozen(system, cells: int) -> Frozen:
    """Arrays for the points of an iteration with frozen contacts, for this number of cells of air, and for
    patches of all searched pairs. A point that exceeds the capacity is omitted from the iteration, not from
    the forces."""
    nodes, border, listed = len(system.nodes), system.border, system.search.first
    searched = len(system.pairs) - listed
    room = 2 * MOST_POINTS * listed + 2 * searched + cells
    return Frozen(
        points=np.zeros((room, POINT)),
        patches=np.zeros(searched, PATCH),
        pair=np.zeros(room, np.int64),
        ends=np.zeros(room, ENDS_OF_POINT),
        many=np.zeros(3, np.int64),
        lying=np.zeros(searched, np.int64),
        of_patches=np.zeros(1),
        vectors=np.zeros((6, 6 * nodes)),
        border=np.zeros((6, border)),
        block=np.zeros((1, 6, 6)),
    )
