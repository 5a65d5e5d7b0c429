"""Contacts between sheets: which sheets push each other, and which of their boxes may meet.

A text needs a statement for each pair of boxes that may meet, and Exudyn a place in its matrix. Two sheets
that slide over each other can have too many: their contact is then left to a solver that searches, and the
others refuse it by name.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.model.tables import BOX_BOX, Contacts, Floats, Model, SheetPart

# Pairs of boxes that are listed for two sheets; 200 boxes that stay where they are have some 4200.
MOST_PAIRS = 10_000


def linked(sheets: Sequence[str], contacts: Contacts) -> dict[str, list[str]]:
    """By sheet: those that can push it, over other sheets too, with itself."""
    group = {name: [name] for name in sheets}
    for row in np.flatnonzero(contacts.kind == BOX_BOX).tolist():
        one, two = group[contacts.part_a[row]], group[contacts.part_b[row]]
        if one is not two:
            both = one + two
            group.update(dict.fromkeys(both, both))
    return group


def meeting(
    one: SheetPart, two: SheetPart, extents: dict[str, tuple[Floats, Floats]]
) -> list[tuple[int, int]] | None:
    """Pairs of boxes whose swept bounds meet, all where a sheet has none; None where they are more than
    MOST_PAIRS. `extents` are the bounds (low, high) of the boxes by sheet, (boxes, 3)."""
    found: list[tuple[int, int]] = []
    everywhere = np.full((max(one.count, two.count), 3), np.inf)
    low, high = extents.get(one.name, (-everywhere[: one.count], everywhere[: one.count]))
    least, most = extents.get(two.name, (-everywhere[: two.count], everywhere[: two.count]))
    for k in range(one.count):
        near = np.flatnonzero(np.all((low[k] <= most) & (high[k] >= least), axis=1))
        if len(found) + len(near) > MOST_PAIRS:
            return None
        found.extend((one.first + k, two.first + int(other)) for other in near)
    return found


def refuse_searched(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for sheets that can meet in too many pairs of boxes; `who` needs
    them listed."""
    for row in model.pairs.searched.tolist():
        names = model.contacts.part_a[row], model.contacts.part_b[row]
        counts = [next(s for s in model.sheets if s.name == name).count for name in names]
        raise RefusedError(
            f"{who}: {names[0]} and {names[1]} can meet in more than {MOST_PAIRS} of their "
            f"{counts[0]} x {counts[1]} pairs of boxes, each of which it needs listed; fewer boxes, a "
            "shorter run or a smaller run.margin leave fewer",
            ("contacts", int(model.contacts.entry[row])),
        )
