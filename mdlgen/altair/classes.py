"""Groups equal boxes and equal joints of a sheet into classes, by layout: one formula serves each class.

An MDL file writes the values of each class once. Boxes are in one class if they have the same column and row
lengths and the same shares in zones; lengths that are given box by box are never equal.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.model.lowering.joints import Joints, find_joints
from mdlgen.model.shape import joint_creases
from mdlgen.model.tables import CLAMP, JOINT_X, Ints, SheetPart


class BoxClass(NamedTuple):
    """Boxes that are alike; called by the first of them."""

    first: int  # in the sheet
    column: int
    row: int
    many: int

    @property
    def name(self) -> str:
        return f"{self.column}_{self.row}"


class JointClass(NamedTuple):
    """Joints that are alike; called by the first of them."""

    kind: int
    along_x: bool
    first: int  # among the joints of its kind
    one: int  # class of the boxes that they begin in
    two: int
    column: int
    row: int
    crease: int  # -1: none

    @property
    def name(self) -> str:
        letter = "c" if self.kind == CLAMP else "x" if self.kind == JOINT_X else "y"
        return f"{letter}_{self.column}_{self.row}"


def box_classes(sheet: SheetPart) -> tuple[list[BoxClass], Ints]:
    """The classes in the order of their first boxes, and the class of each box, (boxes,)."""
    j, i = np.divmod(np.arange(sheet.count), sheet.n_x)
    column, row = i * sheet.graded[0], j * sheet.graded[1]
    keys = np.stack([column, row, *(zone.share for zone in sheet.zones)], axis=1)
    first, of = _ordered(keys)
    counts = np.bincount(of)
    made = [BoxClass(int(f), int(i[f]), int(j[f]), int(n)) for f, n in zip(first, counts, strict=True)]
    return made, of


def joint_classes(sheet: SheetPart) -> list[tuple[Joints, list[JointClass], Ints]]:
    """Per kind of joint: the joints, their classes, and the class of each joint."""
    _, of_box = box_classes(sheet)
    found = []
    for joints in find_joints(sheet):
        ones, twos = of_box[joints.one], of_box[joints.two]
        creases = joint_creases(sheet, joints)
        first, of = _ordered(np.stack([ones, twos, creases], axis=1))
        classes = [
            JointClass(
                joints.kind,
                joints.along_x,
                int(f),
                int(ones[f]),
                int(twos[f]),
                int(joints.one[f] % sheet.n_x),
                int(joints.one[f] // sheet.n_x),
                int(creases[f]),
            )
            for f in first
        ]
        found.append((joints, classes, of))
    return found


def _ordered(keys: np.ndarray) -> tuple[Ints, Ints]:
    """First row of each distinct key, in the order of these rows, and which of them each row is."""
    if not len(keys):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    _, first, of = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[of.ravel()]
