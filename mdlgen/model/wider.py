"""Pairs of a Model chosen again with a wider margin, where a run has left the bounds of the first ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mdlgen.errors import SpecError
from mdlgen.model.lowering.pairs import find_pairs
from mdlgen.model.tables import BOX_BOX, Floats, Model, Pairs
from mdlgen.spec.limits import DEFAULT

# A margin grows at least by this factor, so that a body that falls without end leaves few of them; and from
# at least this length [mm], since a margin may be as small as round-off.
FACTOR, LEAST = 2.0, 1.0
# Pairs that a wider margin may list where a scene has many already, relative to those.
MORE_PAIRS = 4


def wider(model: Model, position: Floats) -> Model | None:
    """The Model with a margin that the places of its bodies, (bodies, 3) [mm], are within.

    None where no margin helps: a spring is at its end, or the pairs would be more than the limit.
    """
    if not _outside(model.pairs, position).any():
        return model
    found = model
    while (out := _outside(found.pairs, position)).any():
        before = found.pairs
        try:
            found = with_margin(model, max(FACTOR * before.margin, LEAST))
        except SpecError:
            return None
        after = found.pairs
        if (after.low[out] == before.low[out]).all() and (after.high[out] == before.high[out]).all():
            return None
    return found


def with_margin(model: Model, margin: float) -> Model:
    """The Model with the pairs of that margin [mm]. Where these are all that there can be, nothing is watched
    any more. Raises SpecError for more pairs than the limit."""
    limits = DEFAULT._replace(pairs=max(DEFAULT.pairs, MORE_PAIRS * len(model.pairs)))

    def chosen(prune: bool) -> Pairs:
        scene = model.gravity, model.sheets, model.machine, model.bodies, model.contacts, model.run
        return find_pairs(*scene, prune, margin, limits)

    pairs, table = chosen(True), model.contacts
    boxes = {sheet.name: sheet.count for sheet in model.sheets}
    every = sum(
        1 if table.of_machine[row] else boxes[table.part_a[row]]
        for row in np.flatnonzero(table.kind != BOX_BOX).tolist()
    )
    if np.count_nonzero(table.kind[pairs.contact] != BOX_BOX) == every:
        pairs = chosen(False)
    return replace(model, pairs=pairs)


def _outside(pairs: Pairs, position: Floats) -> NDArray[np.bool_]:
    """A mask of the bodies out of their bounds, (bodies,)."""
    there = position[: len(pairs.low)]
    return np.any((there < pairs.low) | (there > pairs.high), axis=1)
