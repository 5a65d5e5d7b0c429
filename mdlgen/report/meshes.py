"""The shapes of a scene's bodies as triangles in body axes [mm]: what page, stills and exports draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.model.guides import facets
from mdlgen.model.tables import Floats, Ints, Model, RollerPart

PIECE = 20000  # triangles of a part of a mesh
SIDES = 48  # of a roller's outline
MARK = 0.12  # breadth of the mark on a roller, in times its radius
PROUD = 0.01  # how far the mark stands out, in times the radius


@dataclass(frozen=True)
class Mesh:
    """Triangles in body axes, seen from outside counterclockwise."""

    name: str
    kind: str  # roller, mark, plane or guide
    body: int
    points: Floats  # [mm], (n, 3)
    triangles: Ints  # (m, 3)


# corners of a box in half lengths, and its faces
CORNERS = np.array([[i, j, k] for k in (-1.0, 1.0) for j in (-1.0, 1.0) for i in (-1.0, 1.0)])
FACES = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
BOX = np.concatenate([FACES[:, [0, 1, 2]], FACES[:, [0, 2, 3]]])


def machine(model: Model) -> list[Mesh]:
    """Rollers, each with a mark that shows how it turns, planes, guides and meshes."""
    found: list[Mesh] = []
    for roller in model.rollers:
        found += _roller(model, roller)
    for plane in model.planes:
        found.append(Mesh(plane.name, "plane", plane.body, CORNERS * model.bodies.half[plane.body], BOX))
    for guide in model.guides:
        # its body has the guide's axes and centre
        points = [
            ((CORNERS * np.array(facet.lengths) / 2) @ facet.rotation.T + facet.center - guide.center)
            @ guide.axes
            for facet in facets(guide)
        ]
        triangles = [BOX + len(CORNERS) * k for k in range(len(points))]
        found.append(Mesh(guide.name, "guide", guide.body, np.concatenate(points), np.concatenate(triangles)))
    for part in model.meshes:
        points = (part.corners - part.middle) @ part.principal
        for first in range(0, len(part.triangles), PIECE):  # a page counts corners in 16 bits
            used, own = np.unique(part.triangles[first : first + PIECE], return_inverse=True)
            found.append(Mesh(part.name, "guide", part.body, points[used], own.reshape(-1, 3)))
    return found


def moving(model: Model) -> list[int]:
    """Bodies that may move: boxes, then rollers, then meshes on them."""
    boxes = range(sum(sheet.count for sheet in model.sheets))
    return [*boxes, *(r.body for r in model.rollers), *(m.body for m in model.meshes if m.on >= 0)]


def _roller(model: Model, roller: RollerPart) -> list[Mesh]:
    """A cylinder, and a bar across both ends from the axis to the rim."""
    axis = roller.axis @ model.bodies.rotation[roller.body]
    side: Floats = np.asarray(np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))]), dtype=float)
    side = side / float(np.linalg.norm(side))
    frame: Floats = np.asarray(np.stack([side, np.cross(axis, side), axis], axis=1), dtype=float)
    turn = 2.0 * np.pi * np.arange(SIDES) / SIDES
    rim = roller.radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    half = roller.width / 2
    low = np.column_stack([rim, np.full(SIDES, -half)])
    high = np.column_stack([rim, np.full(SIDES, half)])
    points = np.concatenate([low, high, [[0.0, 0.0, -half], [0.0, 0.0, half]]])
    k = np.arange(SIDES)
    n = np.roll(k, -1)
    triangles = np.concatenate(
        [
            np.stack([k, n, n + SIDES], axis=1),
            np.stack([k, n + SIDES, k + SIDES], axis=1),
            np.stack([n, k, np.full(SIDES, 2 * SIDES)], axis=1),
            np.stack([k + SIDES, n + SIDES, np.full(SIDES, 2 * SIDES + 1)], axis=1),
        ]
    )
    size = np.array([0.5 * (1.0 + PROUD), 0.5 * MARK, half / roller.radius + PROUD]) * roller.radius
    bar = CORNERS * size + [size[0], 0.0, 0.0]
    return [
        Mesh(roller.name, "roller", roller.body, points @ frame.T, triangles),
        Mesh(roller.name, "mark", roller.body, bar @ frame.T, BOX),
    ]
