"""Parts that stand in the user's own MotionView model: their contacts, and who cannot have them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.model.tables import EXTERNAL, Contacts, ExternalPairs, ExternalPart, Model, SheetPart

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene


def lower_externals(scene: Scene) -> tuple[ExternalPart, ...]:
    return tuple(ExternalPart(name, part.body, part.graphics) for name, part in sorted(scene.parts.items()))


def external_pairs(
    sheets: tuple[SheetPart, ...], externals: tuple[ExternalPart, ...], contacts: Contacts
) -> ExternalPairs:
    """Every box of a sheet with every external part that the sheet has a contact with.

    None is left out: where the part is, and how it moves, is not known here.
    """
    by_name = {s.name: s for s in sheets}
    index = {e.name: k for k, e in enumerate(externals)}
    rows, boxes, parts = [], [], []
    for row in np.flatnonzero(contacts.kind == EXTERNAL).tolist():
        sheet = by_name[contacts.part_a[row]]
        rows.append(np.full(sheet.count, row))
        boxes.append(np.arange(sheet.first, sheet.first + sheet.count))
        parts.append(np.full(sheet.count, index[contacts.part_b[row]]))
    none = [np.zeros(0, dtype=np.int64)]
    return ExternalPairs(*(np.concatenate(none + column).astype(np.int64) for column in (rows, boxes, parts)))


def refuse_externals(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a Model with external parts; `who` cannot have them."""
    for part in model.externals:
        raise RefusedError(
            f"{who}: {part.name} is the body {part.body} of a MotionView model of your own, of which nothing "
            "else is known here; write the sheets for that model with mdlgen mdl --only sheets",
            ("parts", part.name),
        )
