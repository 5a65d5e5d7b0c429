"""The grid of one sheet: boxes, which of them are held, and material points on it.

A node of the grid is counted in half cells from the corner of box (0, 0): box centres have two odd
numbers, corners two even ones, middles of edges one of each.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.model.tables import Floats, SheetPart


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
