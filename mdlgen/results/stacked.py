"""Which sheets lie on each other: what a roller presses may be more than the sheet that it touches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model.tables import BOX_BOX

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def stacked(result: Result) -> np.ndarray | None:
    """Whether two sheets touch, themselves or over others, at each stored time, (t, sheets, sheets), every
    sheet with itself; None where no two of the scene can."""
    model, sheets = result.model, {sheet.name: k for k, sheet in enumerate(result.model.sheets)}
    rows = np.flatnonzero(model.contacts.kind == BOX_BOX).tolist()
    if not rows:
        return None
    together = np.repeat(np.eye(len(sheets), dtype=bool)[None], len(result.time), axis=0)
    for row in rows:
        one, two = sheets[model.contacts.part_a[row]], sheets[model.contacts.part_b[row]]
        touch = result.contact_force[:, row] > 0.0
        # all that lies on the one then lies on all that lies on the other
        joined = together[:, one, :, None] & together[:, two, None, :] & touch[:, None, None]
        together |= joined | joined.transpose(0, 2, 1)
    return together
