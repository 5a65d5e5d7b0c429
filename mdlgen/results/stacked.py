"""Detects sheets that lie on each other: a roller may press more sheets than the one that it touches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model.tables import BOX_BOX

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def stacked(result: Result) -> np.ndarray | None:
    """A mask of sheets that touch, directly or through others, at each stored time, (t, sheets, sheets), true
    on the diagonal; None where no two sheets of the scene can touch."""
    model, sheets = result.model, {sheet.name: k for k, sheet in enumerate(result.model.sheets)}
    rows = np.flatnonzero(model.contacts.kind == BOX_BOX).tolist()
    if not rows:
        return None
    together = np.repeat(np.eye(len(sheets), dtype=bool)[None], len(result.time), axis=0)
    for row in rows:
        one, two = sheets[model.contacts.part_a[row]], sheets[model.contacts.part_b[row]]
        touch = result.contact_force[:, row] > 0.0
        # all sheets that lie on sheet `one` then also lie on all that lie on sheet `two`
        joined = together[:, one, :, None] & together[:, two, None, :] & touch[:, None, None]
        together |= joined | joined.transpose(0, 2, 1)
    return together
