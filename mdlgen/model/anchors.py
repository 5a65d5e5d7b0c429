"""What holds on to a sheet: probes, supports, loads, and the pull of a tension test."""

from __future__ import annotations

import numpy as np

from mdlgen.model import grid
from mdlgen.model.tables import (
    Anchor,
    Loads,
    SheetPart,
    Tension,
)
from mdlgen.spec.action import OnSheet
from mdlgen.spec.scene import Scene


def anchor(name: str, item: OnSheet, sheets: tuple[SheetPart, ...]) -> Anchor:
    """The material point of a probe or support, or the middle of an edge."""
    index = next(k for k, s in enumerate(sheets) if s.name == item.sheet)
    sheet = sheets[index]
    at = item.at if item.at is not None else grid.edge_middle(sheet, item.edge or "")
    found = grid.boxes_at(sheet, at)
    node = np.round([2 * at[0] / sheet.d_x + sheet.n_x, 2 * at[1] / sheet.d_y + sheet.n_y])
    return Anchor(
        name=name,
        sheet=index,
        body=np.array([body for body, _ in found], dtype=np.int64),
        local=np.array([point for _, point in found], dtype=float),
        share=np.full(len(found), 1.0 / len(found)),
        node=node.astype(np.int64),
        at=at,
        edge=item.edge,
    )


def lower_loads(scene: Scene, sheets: tuple[SheetPart, ...]) -> Loads:
    rows = []
    for load in scene.loads:
        sheet = next(s for s in sheets if s.name == load.sheet)
        if load.at is not None:
            targets = grid.boxes_at(sheet, load.at)
        else:
            targets = grid.edge_boxes(sheet, load.edge or "")
        force, moment = np.array(load.force or (0.0, 0.0, 0.0)), np.array(load.moment or (0.0, 0.0, 0.0))
        if load.stress is not None:
            edge = load.edge or ""
            across = sheet.n_y * sheet.d_y if edge[0] == "x" else sheet.n_x * sheet.d_x
            outward = np.eye(3)[0 if edge[0] == "x" else 1] * (-1.0 if edge.endswith("min") else 1.0)
            force = load.stress * across * sheet.thickness * outward
        for body, local in targets:
            share = 1.0 / len(targets)
            rows.append((body, local, sheet.rotation @ force * share, sheet.rotation @ moment * share))
    count = len(rows)
    body, local, force, moment = [list(c) for c in zip(*rows, strict=True)] if rows else ([], [], [], [])
    return Loads(
        np.array(body, dtype=np.int64),
        *(np.array(v, dtype=float).reshape(count, 3) for v in (local, force, moment)),
    )


def find_tension(scene: Scene, sheets: tuple[SheetPart, ...]) -> Tension | None:
    """The first sheet that is pulled by stress on the edge opposite to its clamp."""
    for load in scene.loads:
        if load.stress is None or load.edge is None:
            continue
        index = next(k for k, s in enumerate(sheets) if s.name == load.sheet)
        sheet = sheets[index]
        if sheet.clamp is None or sheet.clamp.edge[0] != load.edge[0] or sheet.clamp.edge == load.edge:
            continue
        axis = 0 if load.edge[0] == "x" else 1
        count, pitch = ((sheet.n_x, sheet.d_x), (sheet.n_y, sheet.d_y))[axis]
        return Tension(index, axis, (count - sheet.clamp.rows - 0.5) * pitch)
    return None
