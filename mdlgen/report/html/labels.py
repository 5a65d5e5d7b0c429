"""Labels of parts in space on a page: their names, their places, and facts about each."""

from __future__ import annotations

from typing import Any

import numpy as np

from mdlgen.model.tables import Model
from mdlgen.report.facts import facts
from mdlgen.report.meshes import moving
from mdlgen.report.motion import names


def labels(model: Model) -> dict[str, Any]:
    """`parts` with kind, facts, the place `at` of the name [mm] and the `row` of the moving bodies that it
    goes with (-1: none), `sheets` with their boxes and zones, and `gravity` [mm/ms^2]."""
    rows = {names(model)[body]: k for k, body in enumerate(moving(model))}
    middle = {s.name: s.first + s.n_x * (s.n_y // 2) + s.n_x // 2 for s in model.sheets}
    anchors = {probe.name: int(probe.body[0]) for probe in model.probes}
    return {
        "parts": [
            {
                "name": name,
                "kind": kind,
                "at": at.tolist(),
                "row": middle.get(name, anchors.get(name, -1) if kind == "probe" else rows.get(name, -1)),
                "facts": said,
            }
            for name, kind, at, said in facts(model)
        ],
        "sheets": [
            {"name": s.name, "first": s.first, "n_x": s.n_x, "count": s.count, "zones": _zones(model, k)}
            for k, s in enumerate(model.sheets)
        ],
        "gravity": [float(g) for g in model.gravity],
    }


def _zones(model: Model, index: int) -> list[tuple[str, list[int]]]:
    """Zones of a sheet and the boxes that they cover, counted from its first."""
    return [(zone.name, np.flatnonzero(zone.share).tolist()) for zone in model.sheets[index].zones]
