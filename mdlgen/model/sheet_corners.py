"""Corners of sheets and of their boxes, as the run begins [mm]."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.model.tables import Floats, Model, SheetPart

_SIGNS = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], dtype=float)


def corners(sheet: SheetPart) -> Floats:
    """The eight corners of the flat sheet, (8, 3)."""
    half = np.array([*sheet.outline, sheet.thickness]) / 2
    return sheet.center + _SIGNS * half @ sheet.rotation.T


def each_box(model: Model, sheet: SheetPart) -> Iterator[tuple[Floats, Floats]]:
    """Centre and corners of each box, (3,) and (8, 3)."""
    bodies = model.bodies
    for body in range(sheet.first, sheet.first + sheet.count):
        at = bodies.position[body]
        yield at, at + (_SIGNS * bodies.half[body]) @ bodies.rotation[body].T


def corners_of_boxes(model: Model, sheet: SheetPart) -> Floats:
    """All corners of all boxes as they begin [mm], (8 boxes, 3)."""
    boxes = slice(sheet.first, sheet.first + sheet.count)
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], dtype=float)
    arms = signs[None] * model.bodies.half[boxes][:, None]
    turned = np.einsum("nij,nkj->nki", model.bodies.rotation[boxes], arms)
    return (model.bodies.position[boxes][:, None] + turned).reshape(-1, 3)
