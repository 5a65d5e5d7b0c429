"""The grid of one sheet: boxes, which of them are held, and material points on it.

A node of the grid is counted in half cells from the corner of box (0, 0): box centres have two odd
numbers, corners two even ones, middles of edges one of each.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.model.tables import Floats, Ints, SheetPart


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
    x = _between(sheet.lines_x, node_x)
    y = _between(sheet.lines_y, node_y)
    return np.stack([x, y, np.zeros_like(x)], axis=-1)


def _between(lines: Floats, node: Floats | Ints | float) -> Floats:
    """Coordinate of nodes: a line, or the middle between two."""
    whole = np.asarray(node, dtype=np.int64)
    return 0.5 * (lines[whole // 2] + lines[(whole + 1) // 2])


def place(sheet: SheetPart, points: Floats) -> Floats:
    """Sheet axes -> global."""
    return sheet.center + points @ sheet.rotation.T


def box_nodes(sheet: SheetPart) -> tuple[Floats, Floats]:
    """Grid nodes (x, y) of the box centres in body order."""
    j, i = np.divmod(np.arange(sheet.count), sheet.n_x)
    return 2.0 * i + 1, 2.0 * j + 1


def exposed_sides(sheet: SheetPart) -> np.ndarray:
    """A mask of the side faces (x_min, x_max, y_min, y_max) of each box without a neighbour, (count, 4)."""
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
    for value, lines in zip(at, (sheet.lines_x, sheet.lines_y), strict=True):
        count = len(lines) - 1
        near = int(np.argmin(np.abs(lines - value)))
        if abs(lines[near] - value) < 1e-9 * (lines[-1] - lines[0]):
            cells = (near - 1, near)
        else:
            cells = (int(np.searchsorted(lines, value)) - 1,)
        inside = [c for c in cells if 0 <= c < count]
        sides.append([(c, float(value - 0.5 * (lines[c] + lines[c + 1]))) for c in inside])
    return [(sheet.body(i, j), (x, y, 0.0)) for j, y in sides[1] for i, x in sides[0]]


def nearest_node(sheet: SheetPart, at: tuple[float, float]) -> np.ndarray:
    """The grid node nearest to a material point, (2,)."""
    return np.array(
        [
            np.argmin(np.abs(_between(lines, np.arange(2 * len(lines) - 1)) - value))
            for lines, value in zip((sheet.lines_x, sheet.lines_y), at, strict=True)
        ],
        dtype=np.int64,
    )


def edge_boxes(sheet: SheetPart, edge: str) -> list[tuple[int, tuple[float, float, float], float]]:
    """(body, middle of its side on the edge, its part of the edge) for each box along an edge."""
    along_x = edge[0] == "y"
    own, lines = np.diff(sheet.lines_x), np.diff(sheet.lines_y)
    across, along = (lines, own) if along_x else (own, lines)
    row = 0 if edge.endswith("min") else len(across) - 1
    half = float(across[row]) * (-0.5 if edge.endswith("min") else 0.5)
    parts = (along / along.sum()).tolist()
    if along_x:
        return [(sheet.body(i, row), (0.0, half, 0.0), part) for i, part in enumerate(parts)]
    return [(sheet.body(row, j), (half, 0.0, 0.0), part) for j, part in enumerate(parts)]


def edge_middle(sheet: SheetPart, edge: str) -> tuple[float, float]:
    """Sheet coordinates of the middle of an edge of the boxes' outline."""
    lines = sheet.lines_x if edge[0] == "x" else sheet.lines_y
    at = float(lines[0] if edge.endswith("min") else lines[-1])
    return (at, 0.0) if edge[0] == "x" else (0.0, at)
