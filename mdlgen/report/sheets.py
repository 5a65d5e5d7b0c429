"""Sheets and their zones as colours that are no number."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Floats, Model
from mdlgen.report import boxes


def parts_of_sheets(model: Model) -> tuple[list[tuple[str, float]], Floats]:
    """Names of sheets and of their zones with a part of the ramp for each, and that of each box, (boxes,).

    A box is of the zone that covers most of it.
    """
    names, which = [], np.zeros(boxes.count(model), dtype=np.int64)
    for sheet in model.sheets:
        mine = slice(sheet.first, sheet.first + sheet.count)
        which[mine] = len(names)
        names.append(sheet.name)
        most = np.zeros(sheet.count)
        for zone in sheet.zones:
            more = zone.share > most
            which[mine][more] = len(names)
            most = np.maximum(most, zone.share)
            names.append(f"{sheet.name}: {zone.name}")
    # from the middle of the ramp towards its bright end; the first is the same in every scene
    places = 0.55 + 0.35 * np.arange(len(names)) / max(1, len(names) - 1)
    return list(zip(names, places.tolist(), strict=True)), places[which]
