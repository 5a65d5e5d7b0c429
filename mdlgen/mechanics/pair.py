"""One contact pair of a solver's tables: its force, the check that it may touch, and its memory.

The kinds of pairs are in mechanics.pairs, where `bodies`, `pair`, `shapes` and `motion` are described.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.beside import stands
from mdlgen.mechanics.by_kind import KINDS, by_kind
from mdlgen.mechanics.frame import ARC_RADIUS, LAW_ROLLING, LAW_SMOOTHING, box_of, held_frame
from mdlgen.mechanics.measured import MEASURED, by_pressure, lay_measured
from mdlgen.mechanics.point import FORCE_A, HOLDS, OUT, POINTS, PRESSING, resist_rolling
from mdlgen.mechanics.vector import back, dot, sub, three, vec
from mdlgen.program.kernel import BORROWS, CALLED, njit

# Kinds of contacts that have a law.
WITH_LAW = frozenset(KINDS)
_ON_PLATES = frozenset(kind for kind, module in KINDS.items() if getattr(module, "ON_PLATE", False))

near = by_kind(__name__, "near", inline=True)
on_plate = by_kind(__name__, "ON_PLATE", otherwise=False, inline=True)
_force, _plate = by_kind(__name__, "force", inline=True), by_kind(__name__, "plate", inline=True)
_notes = by_kind(__name__, "NOTES", otherwise=False, inline=True)
_noted = by_kind(__name__, "noted", inline=True)
rolls = by_kind(__name__, "rolling", otherwise=((0.0, 0.0, 0.0), 0.0))


@njit(cache=True, error_model="numpy", forceinline=True)
def on_fixed_plate(pair, other):
    """True if the other part of a pair, with the record `other`, is a plate that does not move."""
    return on_plate(pair) and other.slide < 0


def before_an_end(pair: np.void) -> bool:
    """True if a side of the box of a pair stands before an end of its plate."""
    return int(pair["kind"]) in _ON_PLATES and int(pair["beside"]) != 0


@njit(cache=True, error_model="numpy", **BORROWS, **CALLED)
def _press_again(half, row, out):
    """Sets the pressure on a box's face from the force of its pair, and resets that force."""
    by_pressure(out, row, out[PRESSING] / (4.0 * half[0] * half[1]))
    for i in range(FORCE_A, HOLDS):
        out[i] = 0.0
    if out.size > OUT:
        out[POINTS] = 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def pair_force(bodies, pair, shapes, motion, out):
    """One contact pair into `out`, which must be zero (see mechanics.point for its columns). Returns whether
    it touches."""
    out[MEASURED] = 0.0
    if pair.measured > 0:
        lay_measured(out, shapes.frictions[pair.measured - 1], motion.r, pair.a)
    touches = _force(bodies, pair, shapes, motion, out)
    while touches and out[MEASURED] > 1.0:
        # the normal force, on which friction depends, is known now
        _press_again(bodies[pair.a].half, shapes.frictions[pair.measured - 1], out)
        touches = _force(bodies, pair, shapes, motion, out)
    if pair.law[LAW_ROLLING] > 0.0 and out[PRESSING] > 0.0:
        axis, curved = rolls(bodies, pair, shapes, motion)
        if curved > 0.0:
            one, two = vec(motion.w, pair.a), vec(motion.w, pair.b)
            resist_rolling(out, one, two, axis, 1.0 / curved, pair.law[LAW_ROLLING], pair.law[LAW_SMOOTHING])
    return touches


@njit(cache=True, error_model="numpy", **BORROWS)
def remember(bodies, pairs, shapes, motion):
    """Updates the memory of pairs from the places at the beginning of a step, or a run. A box and a plate
    store the ends of the plate before which outer sides of the box stand (see mechanics.edge); others store
    the value of their kind."""
    for p in range(pairs.size):
        if pairs[p].kind < 0:  # the rest is unused rows
            break
        if _notes(pairs[p]):
            pairs[p].beside = _noted(bodies, pairs[p], shapes, motion)
        if not on_plate(pairs[p]):
            continue
        a, b = pairs[p].a, pairs[p].b
        exposed, ends = bodies[a].exposed, bodies[b].ends
        if exposed == 0 or ends == 0:
            continue
        one = held_frame(motion, a)
        two, plate = _plate(bodies, pairs[p], motion)
        if plate.shape[ARC_RADIUS] == 0.0:
            at, half, size = back(two.r, sub(one.x, two.x)), three(bodies[a].half), plate.half
            reach = math.sqrt(dot(half, half))
            if at[1] > plate.top + reach or at[1] < plate.top - 2.0 * size[2] - reach:
                pairs[p].beside = 0  # clear of the plate
                continue
            if pairs[p].beside == 0 and abs(at[0]) + reach < size[0] and abs(at[2]) + reach < size[1]:
                continue  # inside of all ends
        pairs[p].beside = stands(one, box_of(bodies[a]), two, plate)
