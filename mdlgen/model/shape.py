"""The shape of a sheet that is not flat when nothing acts on it: curl, folds, dog-ears.

A curl or folds turn the sheet on lines between boxes, all about one direction, so that rigid boxes have that
shape exactly. A dog-ear turns the boxes beyond its crease as one; the stair of joints that it leaves is
stress-free as it stands.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mdlgen.model.lowering.joints import Joints
from mdlgen.model.rotations import matrices, vectors
from mdlgen.model.tables import (
    CLAMP,
    JOINT_X,
    SUPPORT,
    Anchor,
    Bend,
    Crease,
    Floats,
    Frames,
    Ints,
    Model,
    SheetPart,
)
from mdlgen.spec.shape import Shape
from mdlgen.spec.sheet import Sheet


def bend(sheet: Sheet) -> Bend | None:
    """The shape of a sheet, None where it is flat."""
    shape = sheet.shape
    if shape is None:
        return None
    if shape.along is None:
        creases, frames = _ears(sheet, shape)
        return Bend(shape.start, -1, math.inf, creases, frames)
    axis = "xy".index(shape.along)
    lines = np.array(sheet.lines[axis])
    creases = tuple(
        Crease(f"fold_{k}", None, (0.0, 0.0), (line, line), f.angle, f.stiffness, f.crease)
        for k, f in enumerate(shape.folds)
        for line in [int(np.argmin(np.abs(lines - f.at)))]
    )
    radius = shape.curl.radius if shape.curl is not None else math.inf
    return Bend(shape.start, axis, radius, creases, _chain(sheet, axis, radius, creases))


def turned(axis: int, angle: float) -> Floats:
    """Rotation of what runs along `axis` towards z by `angle`, (3, 3)."""
    return matrices(angle * np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0)][axis]))


def _chain(sheet: Sheet, axis: int, radius: float, creases: tuple[Crease, ...]) -> Frames:
    """Frames from the clamp line on, or from the sheet's centre both ways."""
    lines, count = np.array(sheet.lines[axis]), sheet.boxes[axis]
    folded = {crease.line[axis]: k for k, crease in enumerate(creases)}
    parent, line, part, cells, crease, angle = [0], [0], [0.0], [(-1, -1)], [-1], [0.0]
    origin = [np.zeros(2)]
    of = np.zeros(count, np.int64)

    def turn(at: int, near: tuple[int, int]) -> float:
        length = 0.5 * sum(float(lines[c + 1] - lines[c]) for c in near if c >= 0)
        fold = folded.get(at)
        return length / radius + (creases[fold].angle if fold is not None else 0.0)

    def hang(on: int, at: int, near: tuple[int, int], share: float) -> int:
        """A frame that hangs on another one at a line; the same where the sheet does not turn there."""
        by = share * turn(at, near)
        if by == 0.0:
            return on
        before, after = angle[on], angle[on] + by
        parent.append(on)
        line.append(at)
        part.append(share)
        cells.append(near)
        crease.append(folded.get(at, -1))
        angle.append(after)
        swing = [math.cos(before) - math.cos(after), math.sin(before) - math.sin(after)]
        origin.append(origin[on] + lines[at] * np.array(swing))
        return len(parent) - 1

    def go(first: int, frame: int, way: int) -> None:
        """Frames of the columns from `first` on."""
        column = first
        while True:
            of[column] = frame
            column += way
            if not 0 <= column < count:
                return
            at = column if way > 0 else column + 1
            frame = hang(frame, at, (at - 1, at), float(way))

    clamp = sheet.clamp
    if clamp is not None and clamp.edge[0] == "xy"[axis]:
        rows, low = sheet.clamped_rows(), clamp.edge.endswith("min")
        first, at = (rows, rows) if low else (count - 1 - rows, count - rows)
        near = (-1, first) if low else (first, -1)
        go(first, hang(0, at, near, 1.0 if low else -1.0), 1 if low else -1)
    else:
        middle = int(np.argmin(np.abs(lines)))
        if abs(lines[middle]) < 1e-9 * (lines[-1] - lines[0]) and 0 < middle < count:
            lines[middle] = 0.0
            near = (middle - 1, middle)
            go(middle, hang(0, middle, near, 0.5), 1)
            go(middle - 1, hang(0, middle, near, -0.5), -1)
        else:
            first = min(max(int(np.searchsorted(lines, 0.0)) - 1, 0), count - 1)
            go(first, 0, 1)
            go(first, 0, -1)
    places = np.zeros((len(origin), 3))
    places[:, axis], places[:, 2] = np.array(origin).T
    j, i = np.divmod(np.arange(sheet.boxes[0] * sheet.boxes[1]), sheet.boxes[0])
    return Frames(
        origin=places,
        rotation=np.array([turned(axis, a) for a in angle]),
        box=of[(i, j)[axis]],
        parent=np.array(parent),
        line=np.array(line),
        part=np.array(part),
        cells=np.array(cells),
        crease=np.array(crease),
    )


def outward(crease: Crease) -> Floats:
    """Unit vector in the sheet, square to the crease of a dog-ear, towards its corner."""
    assert crease.corner is not None
    along_x, along_y = crease.size
    return np.array([crease.corner[0] * along_y, crease.corner[1] * along_x, 0.0]) / math.hypot(*crease.size)


def _ears(sheet: Sheet, shape: Shape) -> tuple[tuple[Crease, ...], Frames]:
    """A frame for each dog-ear.

    It is turned about a line along its crease through the innermost corner of its boxes, so that none of them
    goes through the plane of the sheet.
    """
    x, y = (np.array(side) for side in sheet.lines)
    half = (float(x[-1]), float(y[-1]))
    middles = [0.5 * (side[1:] + side[:-1]) for side in (x, y)]
    box = np.zeros(sheet.boxes[0] * sheet.boxes[1], np.int64)
    creases: list[Crease] = []
    origin, rotation = [np.zeros(3)], [np.eye(3)]
    for k, ear in enumerate(shape.dog_ears):
        beyond = np.array([[ear.beyond(float(u), float(v), half) for u in middles[0]] for v in middles[1]])
        box[beyond.ravel()] = k + 1
        signs = (1 if ear.corner[0] == "x_max" else -1, 1 if ear.corner[1] == "y_max" else -1)
        crease = Crease(f"ear_{k}", signs, ear.size, (0, 0), ear.angle, ear.stiffness)
        out = outward(crease)
        rows, columns = np.nonzero(beyond)
        inner = (columns + (signs[0] < 0), rows + (signs[1] < 0))
        first = int(np.argmin(out[0] * x[inner[0]] + out[1] * y[inner[1]]))
        at = (int(inner[0][first]), int(inner[1][first]))
        creases.append(replace(crease, line=at))
        turn = matrices(ear.angle * np.cross(out, (0.0, 0.0, 1.0)))
        pivot = np.array([x[at[0]], y[at[1]], 0.0])
        origin.append(pivot - turn @ pivot)
        rotation.append(turn)
    count = len(origin)
    frames = Frames(
        origin=np.array(origin),
        rotation=np.array(rotation),
        box=box,
        parent=np.zeros(count, np.int64),
        line=np.zeros(count, np.int64),
        part=np.zeros(count),
        cells=np.full((count, 2), -1),
        crease=np.arange(count) - 1,
    )
    return tuple(creases), frames


def placed(sheet: SheetPart, flat: Floats, frame: Ints) -> Floats:
    """Points of the flat sheet (n, 3) where their frames have them at the start, sheet axes."""
    if sheet.bend is None or sheet.bend.start == "flat":
        return flat
    frames = sheet.bend.frames
    return frames.origin[frame] + np.einsum("nij,nj->ni", frames.rotation[frame], flat)


def box_rotations(sheet: SheetPart) -> Floats:
    """Rotations of the boxes at the start, sheet axes, (boxes, 3, 3)."""
    if sheet.bend is None or sheet.bend.start == "flat":
        return np.broadcast_to(np.eye(3), (sheet.count, 3, 3))
    return sheet.bend.frames.rotation[sheet.bend.frames.box]


def joint_frames(sheet: SheetPart, joints: Joints) -> tuple[Ints, Ints]:
    """Frames of the two sides of each joint; the ground at a clamp is flat where that side is bent."""
    if sheet.bend is None:
        none = np.zeros(len(joints.one), np.int64)
        return none, none
    box = sheet.bend.frames.box
    one, two = box[joints.one], box[joints.two]
    across = (0 if joints.along_x else 1) == sheet.bend.axis
    return (np.zeros_like(one) if joints.kind == CLAMP and across else one), two


def joint_turns(sheet: SheetPart, joints: Joints) -> Floats:
    """Rotation vectors of side two against side one in the stress-free shape, flat axes [rad], (n, 3)."""
    one, two = joint_frames(sheet, joints)
    if sheet.bend is None:
        return np.zeros((len(one), 3))
    turn = sheet.bend.frames.rotation
    return vectors(np.einsum("nji,njk->nik", turn[one], turn[two]))


def joint_creases(sheet: SheetPart, joints: Joints) -> Ints:
    """Crease that each joint is on, -1: none, (n,)."""
    found = np.full(len(joints.one), -1)
    if sheet.bend is None or joints.kind == CLAMP:
        return found
    one, two = joint_frames(sheet, joints)
    for k, crease in enumerate(sheet.bend.creases):
        if crease.corner is not None:
            found[(one != two) & ((one == k + 1) | (two == k + 1))] = k
        elif (0 if joints.kind == JOINT_X else 1) == sheet.bend.axis:
            found[joints.node[:, sheet.bend.axis] == 2 * crease.line[sheet.bend.axis]] = k
    return found


def apart(model: Model, anchor: Anchor) -> bool:
    """True if a material point has a separate place on each of its boxes. They lie in several frames of a
    sheet that begins bent, which meet in that point only until a box moves."""
    sheet = model.sheets[anchor.sheet]
    if sheet.bend is None or sheet.bend.start == "flat":
        return False
    return len(set(sheet.bend.frames.box[anchor.body - sheet.first].tolist())) > 1


class GroundFrame(NamedTuple):
    """A marker on the ground that a text has for a bent sheet."""

    name: str
    label: str
    point: str  # that it stands on, of its own; empty: the sheet's
    origin: Floats  # global [mm], (3,)
    axes: Floats  # (3, 3)


def ground_frames(model: Model, index: int) -> list[GroundFrame]:
    """The frames of a sheet that begins bent, then those halfway between two, in the order of the text."""
    sheet, table = model.sheets[index], model.bushings
    if sheet.bend is None or sheet.bend.start == "flat":
        return []
    frames = sheet.bend.frames
    found = [
        GroundFrame(
            f"m_{sheet.name}_f{k}",
            f"Frame {k} of {sheet.name}",
            f"p_{sheet.name}_f{k}",
            sheet.center + sheet.rotation @ frames.origin[k],
            sheet.rotation @ frames.rotation[k],
        )
        for k in range(1, len(frames.parent))
    ]
    rows = np.flatnonzero((table.sheet == index) & (table.kind != SUPPORT))
    pairs = {(one, two): row for row, (one, two) in zip(rows, table.frames[rows].tolist(), strict=True)}
    for (one, two), row in sorted(pairs.items()):
        if one != two:
            label = f"Between frames {one} and {two} of {sheet.name}"
            name = f"m_{sheet.name}_h{one}_{two}"
            found.append(GroundFrame(name, label, "", sheet.center, table.axes[row]))
    return found
