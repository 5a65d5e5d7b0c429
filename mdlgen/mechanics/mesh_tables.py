"""Meshes of a Model in tables for compiled code: the place of each, and its tree of triangles."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.tree import AFTER, AREA, FIRST, NEXT, THICK, WIDTH, build_tree
from mdlgen.model.meshes import origin
from mdlgen.model.tables import Floats, Ints, Model

DEEPEST = 1.0  # mm: a deeper point is about to come out at the other side of the part, or is lost
SHARP = 1e-6  # cosine beyond which an edge is less than square; rounded files have square ones a little less
BEYOND = 1.5  # factor on that depth up to which a contact is still detected, so that a run can end
HEAD = np.dtype(
    [
        ("first", "i8"),  # node of the tree
        ("end", "i8"),
        ("place", "f8", 3),  # of the file's axes, in those of the body that the mesh moves with
        ("axes", "f8", 9),
        ("basis", "f8"),  # 4/3 w sqrt(2 R) of the roller that it is on, 0: fixed
        ("middles", "i8"),  # depth is looked at in the middles of elements
        ("most", "f8"),  # DEEPEST
        ("thin", "i8"),  # 1 where some part is thinner than twice that, or an edge is sharp
        ("edge", "f8"),  # radius of its edges, 0: sharp
        ("reach", "f8"),  # greatest distance from the body's centre
        ("unseen", "f8"),  # how far a box may move from one state that is looked at to the next
    ]
)


class Meshes(NamedTuple):
    """All meshes of a Model: one HEAD each, and the trees behind each other."""

    heads: np.ndarray
    bounds: Floats  # as in mechanics.tree
    links: Ints
    triangles: Floats


def mesh_tables(model: Model, mm: float = 1.0) -> Meshes:
    """The meshes of a Model for compiled code; `mm` is a millimetre in the solver's unit."""
    heads = np.zeros(len(model.meshes), HEAD)
    bounds, links, triangles = [np.zeros((0, 12))], [np.zeros((0, 3), np.int64)], [np.zeros((0, WIDTH))]
    built: dict[tuple[str, float], tuple[int, int, float, bool]] = {}
    for head, mesh in zip(heads, model.meshes, strict=True):
        if (mesh.file, mesh.scale) not in built:
            box, link, table = build_tree(mesh.corners * mm, mesh.triangles, DEEPEST * mm)
            before, shift = sum(map(len, links)), sum(map(len, triangles))
            link[:, FIRST] += shift
            link[:, AFTER] += before
            table[:, NEXT:][table[:, NEXT:] >= 0] += shift
            thin = bool((table[:, THICK] < DEEPEST * mm).any()) or _sharp(mesh.corners, mesh.triangles)
            built[mesh.file, mesh.scale] = before, before + len(link), _unseen(table), thin
            bounds.append(box)
            links.append(link)
            triangles.append(table)
        head["first"], head["end"], head["unseen"], head["thin"] = built[mesh.file, mesh.scale]
        body = mesh.body
        if mesh.on >= 0:
            roller = model.rollers[mesh.on]
            body = roller.body
            head["basis"] = 4 / 3 * roller.width * math.sqrt(2.0 * roller.radius) * mm**1.5
        turn = model.bodies.rotation[body]
        place = turn.T @ (origin(mesh, model.rollers) - model.bodies.position[body])
        head["place"], head["axes"] = place * mm, (turn.T @ mesh.axes).ravel()
        head["middles"], head["most"] = mesh.at == "centres", DEEPEST * mm
        head["edge"] = mesh.edge_radius * mm
        head["reach"] = (
            float(np.linalg.norm(place + mesh.corners @ (turn.T @ mesh.axes).T, axis=1).max()) * mm
        )
    return Meshes(heads, np.concatenate(bounds), np.concatenate(links), np.concatenate(triangles))


def _sharp(corners: Floats, triangles: Ints) -> bool:
    """True if two triangles of a closed surface meet at less than 90 deg, inside or outside."""
    one, two, three = (corners[triangles[:, k]] for k in range(3))
    normals = np.cross(two - one, three - one)
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort(sides.T)
    owners, same = order // 3, (np.diff(sides[order], axis=0) == 0).all(axis=1)
    pairs = normals[owners[:-1][same]], normals[owners[1:][same]]
    sizes = np.linalg.norm(pairs[0], axis=1) * np.linalg.norm(pairs[1], axis=1)
    return bool((np.einsum("ni,ni->n", *pairs) < -SHARP * sizes).any())


def _unseen(table: Floats) -> float:
    """A little less than the band in which a box that is too deep is detected, where the part is thinnest,
    without the 2 % of its surface at its sharpest edges."""
    order = np.argsort(table[:, THICK])
    area = np.cumsum(table[order, AREA])
    thin = table[order[np.searchsorted(area, 0.02 * area[-1])], THICK]
    return 0.8 * (BEYOND - 1.0) * float(thin)


def mesh_numbers(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Number of the mesh of each kept pair (0 where it has none), and the body with which the mesh moves."""
    number = {mesh.body: k for k, mesh in enumerate(model.meshes)}
    moved = {m.body: model.rollers[m.on].body for m in model.meshes if m.on >= 0}
    bodies = model.pairs.b.tolist()
    return (
        np.array([number.get(b, 0) for b in bodies], dtype=np.int64),
        np.array([moved.get(b, b) for b in bodies], dtype=np.int64),
    )
