"""The bushings of one sheet: between its boxes, and at a clamp."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.model import naming
from mdlgen.model.grid import clamped_boxes
from mdlgen.model.lowering.plate import tributary
from mdlgen.model.tables import CLAMP, GROUND, JOINT_X, JOINT_Y, Clamp, Floats, Ints, SheetPart

_LETTER = {JOINT_X: "x", JOINT_Y: "y", CLAMP: "c"}


@dataclass(frozen=True)
class Joints:
    """Bushings of one kind, column by column."""

    name: list[str]
    kind: int
    a: Ints  # body, or GROUND, (n,)
    b: Ints  # body, (n,)
    node: Ints  # as in the table of bushings, (n, 2)
    along_x: bool
    one: Ints  # box in its sheet that the joint begins in, (n,)
    two: Ints  # and that it ends in; the same one at a clamp
    tributary: Floats  # width that it stands for in twist, over its own: see model.plate, (n,)

    @property
    def scale(self) -> float:
        """A half-cell hinge has twice the values of a joint."""
        return 2.0 if self.kind == CLAMP else 1.0


def find_joints(sheet: SheetPart) -> list[Joints]:
    """All bushings of a sheet, by kind, then row, then column; none between two held boxes."""
    found = [_between(sheet, along_x=True), _between(sheet, along_x=False)]
    return found if sheet.clamp is None else [*found, _hinges(sheet, sheet.clamp)]


def _between(sheet: SheetPart, along_x: bool) -> Joints:
    """Joints of each box with the next one along x, or along y."""
    right, up = (1, 0) if along_x else (0, 1)
    j, i = np.indices((sheet.n_y - up, sheet.n_x - right)).reshape(2, -1)
    one = i + j * sheet.n_x
    two = one + (1 if along_x else sheet.n_x)
    held = clamped_boxes(sheet)
    free = ~(held[one] | held[two])
    i, j, one, two = i[free], j[free], one[free], two[free]
    middle = np.stack([2 * i + 1 + right, 2 * j + 1 + up], axis=1)
    kind = JOINT_X if along_x else JOINT_Y
    return _bushings(sheet, kind, along_x, (i, j), (one, two), middle)


def _hinges(sheet: SheetPart, clamp: Clamp) -> Joints:
    """Half-cell hinges between the clamp line and the centres of the first free row."""
    across_x, from_min = clamp.edge[0] == "x", clamp.edge.endswith("min")
    cells, others = (sheet.n_x, sheet.n_y) if across_x else (sheet.n_y, sheet.n_x)
    free, line = (
        (clamp.rows, 2 * clamp.rows) if from_min else (cells - 1 - clamp.rows, 2 * (cells - clamp.rows))
    )
    along = np.arange(others)
    row = np.full(others, free)
    i, j = (row, along) if across_x else (along, row)
    on_line = np.full(others, line)
    middle = np.stack([on_line, 2 * j + 1] if across_x else [2 * i + 1, on_line], axis=1)
    box = i + j * sheet.n_x
    return _bushings(sheet, CLAMP, across_x, (i, j), (box, box), middle)


def _bushings(
    sheet: SheetPart,
    kind: int,
    along_x: bool,
    box: tuple[Ints, Ints],
    boxes: tuple[Ints, Ints],
    middle: Ints,
) -> Joints:
    """One bushing in the middle of each shared side, or one at each of its ends; named by `box` (i, j)."""
    corners = {"a": -1, "b": 1} if sheet.layout == "edge_to_edge" else {"": 0}
    shift = np.outer(list(corners.values()), (0, 1) if along_x else (1, 0))
    one, two = (np.repeat(box, len(corners)) for box in boxes)
    edge = None if sheet.clamp is None else sheet.clamp.edge
    side, cells = ("y", sheet.n_y) if along_x else ("x", sheet.n_x)
    strip = one // sheet.n_x if along_x else one % sheet.n_x
    return Joints(
        name=[
            naming.bushing(sheet.name, _LETTER[kind], i, j, end)
            for i, j in zip(*(index.tolist() for index in box), strict=True)
            for end in corners
        ],
        kind=kind,
        a=np.full(len(one), GROUND) if kind == CLAMP else sheet.first + one,
        b=sheet.first + two,
        node=(middle[:, None] + shift).reshape(-1, 2),
        along_x=along_x,
        one=one,
        two=two,
        tributary=tributary(strip, cells, edge == f"{side}_min", edge == f"{side}_max"),
    )
