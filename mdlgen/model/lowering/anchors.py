"""Anchors of a sheet: probes, supports, loads, and the pull of a tension test."""

from __future__ import annotations

import numpy as np

from mdlgen.model import grid
from mdlgen.model.over_time import corners
from mdlgen.model.tables import (
    Anchor,
    Loads,
    SheetPart,
    Tension,
)
from mdlgen.spec.action import OnSheet
from mdlgen.spec.scene import Scene


def anchor(
    name: str, item: OnSheet, sheets: tuple[SheetPart, ...], formulas: tuple[str, str] = ("", "")
) -> Anchor:
    """The material point of a probe or support, or the middle of an edge."""
    index = next(k for k, s in enumerate(sheets) if s.name == item.sheet)
    sheet = sheets[index]
    at = item.at if item.at is not None else grid.edge_middle(sheet, item.edge or "")
    found = grid.boxes_at(sheet, at)
    return Anchor(
        name=name,
        sheet=index,
        body=np.array([body for body, _ in found], dtype=np.int64),
        local=np.array([point for _, point in found], dtype=float),
        share=np.full(len(found), 1.0 / len(found)),
        node=grid.nearest_node(sheet, at),
        at=at,
        edge=item.edge,
        formulas=formulas,
    )


def lower_loads(scene: Scene, sheets: tuple[SheetPart, ...]) -> Loads:
    rows, entries = [], []
    for entry, load in enumerate(scene.loads):
        sheet = next(s for s in sheets if s.name == load.sheet)
        if load.at is not None:
            found = grid.boxes_at(sheet, load.at)
            targets = [(body, local, 1.0 / len(found)) for body, local in found]
        else:
            targets = grid.edge_boxes(sheet, load.edge or "")
        force, moment = np.array(load.force or (0.0, 0.0, 0.0)), np.array(load.moment or (0.0, 0.0, 0.0))
        if load.stress is not None:
            edge = load.edge or ""
            # each box has the force of its own section
            targets, section = _sections(sheet, targets)
            outward = np.eye(3)[0 if edge[0] == "x" else 1] * (-1.0 if edge.endswith("min") else 1.0)
            force = load.stress * section * outward
        for body, local, share in targets:
            rows.append((body, local, sheet.rotation @ force * share, sheet.rotation @ moment * share))
            entries.append(entry)
    profiles = [corners(load.profile) for load in scene.loads]
    count = len(rows)
    body, local, force, moment = [list(c) for c in zip(*rows, strict=True)] if rows else ([], [], [], [])
    return Loads(
        body=np.array(body, dtype=np.int64),
        local=np.array(local, dtype=float).reshape(count, 3),
        force=np.array(force, dtype=float).reshape(count, 3),
        moment=np.array(moment, dtype=float).reshape(count, 3),
        entry=np.array(entries, dtype=np.int64),
        edge=tuple(load.edge or "" for load in scene.loads),
        profiles=tuple(profiles) if any(len(profile) for profile in profiles) else (),
    )


def _sections(
    sheet: SheetPart, targets: list[tuple[int, tuple[float, float, float], float]]
) -> tuple[list[tuple[int, tuple[float, float, float], float]], float]:
    """Boxes along an edge with their parts of its section, and that section [mm^2]."""
    side = 1 if targets[0][1][0] else 0
    width = np.array([part for _, _, part in targets]) * sheet.outline[side]
    boxes = np.array([body - sheet.first for body, _, _ in targets])
    parts = width * sheet.thick[boxes]
    whole = float(parts.sum())
    shares = (parts / whole).tolist()
    return [(body, local, part) for (body, local, _), part in zip(targets, shares, strict=True)], whole


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
        lines = (sheet.lines_x, sheet.lines_y)[axis]
        lines = lines if sheet.clamp.edge.endswith("min") else -lines[::-1]
        # from the clamp line to the middle of the last box
        length = 0.5 * (lines[-1] + lines[-2]) - lines[sheet.clamp.rows]
        return Tension(index, axis, float(length))
    return None
