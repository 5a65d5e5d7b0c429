"""How the normal force between a sheet and a mesh, or another sheet, is shared among boxes: by what of the
other surface lies over each, and how deep.

A solver keeps the force of a pair of parts. The other surface is taken as points that stand for pieces of it:
those of a mesh smaller than the boxes, those of a box equal parts of what lies over the other box. A point
that is in a box, at a depth z below the face that looks at it, weighs its area times z^1.5 (z for a mesh on a
roller, whose law is an elastic foundation; see mechanics.mesh and mechanics.facing).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mdlgen.mechanics.mesh_face import GENTLE, STEEP
from mdlgen.mechanics.mesh_tables import DEEPEST
from mdlgen.model.rotations import turns
from mdlgen.model.tables import Floats, Ints, MeshPart, SheetPart

if TYPE_CHECKING:
    from mdlgen.results.result import Result

EXPONENT = 1.5  # of the contact law
PIECES = 4  # of the least side of a box, in the size of a mesh's pieces
PARTS = 6  # pieces of the area that two boxes share, each way
ON_EDGE = 0.3  # cosine below which a box stands on another with its side
MOST_PIECES = 200_000  # of a mesh; beyond it they are larger


def on_mesh(result: Result, sheet: SheetPart, mesh: MeshPart, at: Ints) -> Floats:
    """Share of each box of a sheet in its force with a mesh, at stored states, (t, boxes); sums to 1."""
    from scipy.spatial import KDTree  # takes half a second to import

    rows = np.arange(sheet.first, sheet.first + sheet.count)
    half = result.model.bodies.half[rows]
    points, normals, areas = _pieces(mesh, 2.0 * float(half[:, :2].min()) / PIECES)
    # in the axes of the mesh's body
    points, normals = (points - mesh.middle) @ mesh.principal, normals @ mesh.principal
    tree, reach = KDTree(points), float(np.linalg.norm(half, axis=1).max() + DEEPEST)
    shares = np.zeros((len(at), len(rows)))
    for k, t in enumerate(at):
        frame = turns(result.rotation[t, mesh.body])
        place = (result.position[t, rows] - result.position[t, mesh.body]) @ frame
        turn = frame.T @ turns(result.rotation[t, rows])
        near = KDTree(place).sparse_distance_matrix(tree, reach, output_type="ndarray")
        box, which = near["i"], near["j"]
        local = np.einsum("nji,nj->ni", turn[box], points[which] - place[box])
        way = np.einsum("nji,nj->ni", turn[box], normals[which])
        # the face that looks at the piece is on the side that the piece's normal comes from
        depth = half[box, 2] + local[:, 2] * np.sign(way[:, 2])
        inside = np.all(np.abs(local[:, :2]) < half[box, :2], axis=1) & (depth > 0.0) & (depth < DEEPEST)
        # as in the law of the broad faces, which ends where a surface stands on edge over them
        slope = np.clip((np.abs(way[:, 2]) - STEEP) / (GENTLE - STEEP), 0.0, 1.0)
        weight = areas[which] * np.abs(way[:, 2]) * slope * slope * (3.0 - 2.0 * slope)
        weight *= np.where(inside, depth, 0.0) ** (1.0 if mesh.on >= 0 else EXPONENT)
        shares[k] = np.bincount(box, weight, len(rows))
        if shares[k].sum() == 0.0:  # a side is pushed, or it only grazes: the nearest box has it
            away, _ = tree.query(place)
            shares[k, int(np.argmin(away))] = 1.0
    return shares / shares.sum(axis=1, keepdims=True)


def _pieces(mesh: MeshPart, size: float) -> tuple[Floats, Floats, Floats]:
    """Middles of the pieces of a mesh [mm], their normals and areas [mm^2], in the axes of its file: each
    triangle that is longer than `size` is cut into equal parts."""
    corners = mesh.corners[mesh.triangles]
    ways = corners[:, 1:] - corners[:, :1]
    longest = np.maximum(
        np.linalg.norm(ways, axis=2).max(axis=1), np.linalg.norm(ways[:, 1] - ways[:, 0], axis=1)
    )
    normal = np.cross(ways[:, 0], ways[:, 1])
    area = 0.5 * np.linalg.norm(normal, axis=1)
    sound = area > 0.0
    corners, longest, normal, area = corners[sound], longest[sound], normal[sound], area[sound]
    normal = normal / (2.0 * area[:, None])
    parts = np.maximum(1, np.ceil(longest / size)).astype(np.int64)
    if (parts**2).sum() > MOST_PIECES:
        scale = np.sqrt(max(MOST_PIECES - len(parts), 1) / (parts**2).sum())
        parts = np.maximum(1, np.floor(parts * scale)).astype(np.int64)
    middles, normals, areas = [], [], []
    for n in sorted(set(parts.tolist())):
        mine = parts == n
        u, v = (index.ravel() for index in np.indices((n, n)))
        up = u + v < n
        down = u + v < n - 1
        u = np.concatenate([u[up] + 1 / 3, u[down] + 2 / 3]) / n
        v = np.concatenate([v[up] + 1 / 3, v[down] + 2 / 3]) / n
        weight = np.stack([1 - u - v, u, v], axis=1)
        middles.append(np.einsum("pc,tci->tpi", weight, corners[mine]).reshape(-1, 3))
        normals.append(np.repeat(normal[mine], n * n, axis=0))
        areas.append(np.repeat(area[mine] / n**2, n * n))
    return np.concatenate(middles), np.concatenate(normals), np.concatenate(areas)


def between(result: Result, one: SheetPart, two: SheetPart, at: Ints) -> tuple[Floats, Floats]:
    """Share of each box of two sheets in the force between them, at stored states, (t, boxes) each."""
    from scipy.spatial import KDTree

    model = result.model
    first, second = (np.arange(s.first, s.first + s.count) for s in (one, two))
    reach = sum(float(np.linalg.norm(model.bodies.half[rows], axis=1).max()) for rows in (first, second))
    found = np.zeros((len(at), one.count)), np.zeros((len(at), two.count))
    for k, t in enumerate(at):
        place = result.position[t]
        near = KDTree(place[first]).sparse_distance_matrix(
            KDTree(place[second]), reach, output_type="ndarray"
        )
        a, b = first[near["i"]], second[near["j"]]
        weight = _over(result, a, b, int(t))
        if not len(a):
            continue
        if weight.sum() == 0.0:  # they only graze: the nearest two have it
            weight[np.argmin(np.linalg.norm(place[a] - place[b], axis=1))] = 1.0
        weight = weight / weight.sum()
        found[0][k] = np.bincount(a - one.first, weight, one.count)
        found[1][k] = np.bincount(b - two.first, weight, two.count)
    return found


def _over(result: Result, boxes: Ints, others: Ints, t: int) -> Floats:
    """Integral of z^1.5 over what of the face of each other box lies over a box, (n,)."""
    half, place = result.model.bodies.half, result.position[t]
    turn, far = turns(result.rotation[t, boxes]), turns(result.rotation[t, others])
    gap = np.einsum("nji,nj->ni", turn, place[others] - place[boxes])
    axes = np.einsum("nji,njk->nik", turn, far)
    spread = np.einsum("nik,nk->ni", np.abs(axes), half[others])
    total = np.zeros(len(boxes))
    near = np.flatnonzero(np.all(np.abs(gap) < half[boxes] + spread, axis=1))
    gap, axes, spread, mine, theirs = (
        gap[near],
        axes[near],
        spread[near],
        half[boxes[near]],
        half[others[near]],
    )
    side = np.where(gap[:, 2] >= 0.0, 1.0, -1.0)
    # where both outlines lie in the plane of the box: equal parts of that are looked at
    begin = np.maximum(-mine[:, :2], gap[:, :2] - spread[:, :2])
    size = np.minimum(mine[:, :2], gap[:, :2] + spread[:, :2]) - begin
    normal = axes[:, :, 2]
    flat = np.abs(normal[:, 2]) > ON_EDGE
    lean = np.where(flat, normal[:, 2], 1.0)
    face = gap - (side * np.sign(lean) * theirs[:, 2])[:, None] * normal
    deepest = mine[:, 2] - side * gap[:, 2] + spread[:, 2]
    steps = (np.arange(PARTS) + 0.5) / PARTS
    for u in steps:
        for v in steps:
            x, y = begin[:, 0] + u * size[:, 0], begin[:, 1] + v * size[:, 1]
            z = face[:, 2] - (normal[:, 0] * (x - face[:, 0]) + normal[:, 1] * (y - face[:, 1])) / lean
            point = np.stack([x, y, z], axis=1) - gap
            inside = np.all(np.abs(np.einsum("nik,ni->nk", axes, point))[:, :2] < theirs[:, :2], axis=1)
            depth = np.where(flat, np.where(inside, mine[:, 2] - side * z, 0.0), deepest)
            total[near] += np.maximum(depth, 0.0) ** EXPONENT * size[:, 0] * size[:, 1]
    return total
