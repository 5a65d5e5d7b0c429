"""The grid of one sheet: boxes, the joints between them, the clamp, and material points on it.

A node of the grid is counted in half cells from the corner of box (0, 0): box centres have two odd
numbers, corners two even ones, middles of edges one of each.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlgen.model import naming
from mdlgen.model.stiffness import JointValues
from mdlgen.model.tables import CLAMP, GROUND, JOINT_X, JOINT_Y, Floats, SheetPart


def rotation_matrix(angles: tuple[float, float, float]) -> Floats:
    """Rotation by `angles` about the global x, then y, then z axis [rad]."""
    (sx, sy, sz), (cx, cy, cz) = (tuple(f(a) for a in angles) for f in (math.sin, math.cos))
    return np.array(
        [
            [cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx],
            [sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx],
            [-sy, cy * sx, cy * cx],
        ]
    )


def local(sheet: SheetPart, node_x: Floats | float, node_y: Floats | float) -> Floats:
    """Position in sheet axes from its centre [mm] of grid nodes, (..., 3)."""
    x = (np.asarray(node_x, float) / 2 - sheet.n_x / 2) * sheet.d_x
    y = (np.asarray(node_y, float) / 2 - sheet.n_y / 2) * sheet.d_y
    return np.stack([x, y, np.zeros_like(x)], axis=-1)


def place(sheet: SheetPart, points: Floats) -> Floats:
    """Sheet axes -> global."""
    return sheet.center + points @ sheet.rotation.T


def box_nodes(sheet: SheetPart) -> tuple[Floats, Floats]:
    """Grid nodes (x, y) of the box centres in body order."""
    j, i = np.divmod(np.arange(sheet.count), sheet.n_x)
    return 2.0 * i + 1, 2.0 * j + 1


def exposed_sides(sheet: SheetPart) -> np.ndarray:
    """Which side faces (x_min, x_max, y_min, y_max) of each box have no neighbour, (count, 4)."""
    j, i = np.divmod(np.arange(sheet.count), sheet.n_x)
    return np.stack([i == 0, i == sheet.n_x - 1, j == 0, j == sheet.n_y - 1], axis=1)


def clamped_boxes(sheet: SheetPart) -> np.ndarray:
    """Boxes behind the clamp line, (count,)."""
    held = np.zeros(sheet.count, bool)
    if sheet.clamp is None or sheet.clamp.rows == 0:
        return held
    j, i = np.divmod(np.arange(sheet.count), sheet.n_x)
    index, count = (i, sheet.n_x) if sheet.clamp.edge[0] == "x" else (j, sheet.n_y)
    from_edge = index if sheet.clamp.edge.endswith("min") else count - 1 - index
    return from_edge < sheet.clamp.rows


@dataclass
class Joint:
    """One bushing before it becomes a row of the table."""

    name: str
    label: str
    kind: int
    a: int
    b: int
    node: tuple[int, int]
    scale: float  # of the sheet's values: 2 for a half cell
    along_x: bool


def joints(sheet: SheetPart) -> list[Joint]:
    """All bushings of a sheet, sorted by kind, row, column; none between two held boxes."""
    held = clamped_boxes(sheet)
    corners = (("a", -1), ("b", 1)) if sheet.layout == "edge_to_edge" else (("", 0),)
    found: list[Joint] = []

    def add(
        kind: int, letter: str, a: int, b: int, i: int, j: int, node: tuple[int, int], scale: float
    ) -> None:
        along_x = letter == "x" or (letter == "c" and node[1] % 2 == 1)
        for end, shift in corners:
            at = (node[0], node[1] + shift) if along_x else (node[0] + shift, node[1])
            name = naming.bushing(sheet.name, letter, i, j, end)
            found.append(Joint(name, name.replace("_", " "), kind, a, b, at, scale, along_x))

    clamp = sheet.clamp
    line = _clamp_line(sheet)
    for j in range(sheet.n_y):
        for i in range(sheet.n_x - 1):
            a, b, node = sheet.body(i, j), sheet.body(i + 1, j), (2 * i + 2, 2 * j + 1)
            if not (held[a - sheet.first] or held[b - sheet.first]):
                add(JOINT_X, "x", a, b, i, j, node, 1.0)
    for j in range(sheet.n_y - 1):
        for i in range(sheet.n_x):
            a, b, node = sheet.body(i, j), sheet.body(i, j + 1), (2 * i + 1, 2 * j + 2)
            if not (held[a - sheet.first] or held[b - sheet.first]):
                add(JOINT_Y, "y", a, b, i, j, node, 1.0)
    if clamp is not None:
        # A half-cell hinge between the line and the centre of the first free row: twice the joint.
        across_x = clamp.edge[0] == "x"
        first_free = clamp.rows if clamp.edge.endswith("min") else -1 - clamp.rows
        free = first_free % (sheet.n_x if across_x else sheet.n_y)
        for index in range(sheet.n_y if across_x else sheet.n_x):
            i, j = (free, index) if across_x else (index, free)
            node = (line, 2 * j + 1) if across_x else (2 * i + 1, line)
            add(CLAMP, "c", GROUND, sheet.body(i, j), i, j, node, 2.0)
    return found


def _clamp_line(sheet: SheetPart) -> int:
    """Grid node of the clamp line across its axis."""
    if sheet.clamp is None:
        return 0
    cells = sheet.n_x if sheet.clamp.edge[0] == "x" else sheet.n_y
    return 2 * sheet.clamp.rows if sheet.clamp.edge.endswith("min") else 2 * (cells - sheet.clamp.rows)


def joint_coefficients(joint: Joint, values: JointValues) -> tuple[np.ndarray, np.ndarray]:
    """(k, c) of one bushing, six each."""
    k, c = (values.k_joint_x, values.c_joint_x) if joint.along_x else (values.k_joint_y, values.c_joint_y)
    return joint.scale * np.array(k), joint.scale * np.array(c)


def boxes_at(sheet: SheetPart, at: tuple[float, float]) -> list[tuple[int, tuple[float, float, float]]]:
    """(body, point in box axes) of every box that holds the material point `at`; more than one on a line."""
    sides = []
    for value, count, pitch in zip(at, (sheet.n_x, sheet.n_y), (sheet.d_x, sheet.d_y), strict=True):
        cell = value / pitch + count / 2
        near = round(cell)
        cells = (near - 1, near) if abs(cell - near) < 1e-9 * max(count, 1) else (math.floor(cell),)
        inside = [c for c in cells if 0 <= c < count]
        sides.append([(c, value - (c + 0.5 - count / 2) * pitch) for c in inside])
    return [(sheet.body(i, j), (x, y, 0.0)) for j, y in sides[1] for i, x in sides[0]]


def edge_boxes(sheet: SheetPart, edge: str) -> list[tuple[int, tuple[float, float, float]]]:
    """(body, middle of its side on the edge) for each box along an edge."""
    last = {"x": sheet.n_x, "y": sheet.n_y}[edge[0]] - 1
    row = 0 if edge.endswith("min") else last
    sign = -0.5 if edge.endswith("min") else 0.5
    if edge[0] == "x":
        return [(sheet.body(row, j), (sign * sheet.d_x, 0.0, 0.0)) for j in range(sheet.n_y)]
    return [(sheet.body(i, row), (0.0, sign * sheet.d_y, 0.0)) for i in range(sheet.n_x)]


def edge_middle(sheet: SheetPart, edge: str) -> tuple[float, float]:
    """Sheet coordinates of the middle of an edge of the boxes' outline."""
    sign = -0.5 if edge.endswith("min") else 0.5
    if edge[0] == "x":
        return (sign * sheet.n_x * sheet.d_x, 0.0)
    return (0.0, sign * sheet.n_y * sheet.d_y)
