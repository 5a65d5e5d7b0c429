"""The shapes of a scene's bodies as triangles in body axes [mm]: what page, stills and exports draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.model.guides import facets, outer
from mdlgen.model.tables import Floats, GuidePart, Ints, Model, RollerPart
from mdlgen.report.solids import BOX, CORNERS, Solid, bar, bent_plate, cylinder, join, slice_

PIECE = 20000  # triangles of a part of a mesh
MARK = 0.12  # breadth of the mark on a roller, in times its radius
PROUD = 0.01  # how far the mark stands out, in times the radius
CHEEK = 0.4, 0.12  # breadth and thickness of an arm beside its roller, in times the roller's radius


@dataclass(frozen=True)
class Mesh:
    """Triangles in body axes, seen from outside counterclockwise."""

    name: str
    kind: str  # roller, sector (of a rim), mark, arm, mesh (on a roller), plane or guide
    body: int  # an arm has none: they are counted on from the last body, as `motion.poses` has them
    points: Floats  # [mm], (n, 3)
    triangles: Ints  # (m, 3)


def machine(model: Model) -> list[Mesh]:
    """Rollers, each with a mark that shows how it turns, arms, planes, guides and meshes.

    A roller that nothing touches and that carries a mesh is that mesh.
    """
    found: list[Mesh] = []
    touched = {*model.contacts.part_a, *model.contacts.part_b}
    for number, roller in enumerate(model.rollers):
        if roller.name in touched or all(part.on != number for part in model.meshes):
            found += _roller(roller)
    for number, roller in enumerate(on_arms(model)):
        found.append(Mesh(roller.name, "arm", len(model.bodies.name) + number, *_arm(roller)))
    for plane in model.planes:
        found.append(Mesh(plane.name, "plane", plane.body, CORNERS * model.bodies.half[plane.body], BOX))
    for guide in model.guides:
        found.append(Mesh(guide.name, "guide", guide.body, *_guide(guide)))
    for part in model.meshes:
        points = (part.corners - part.middle) @ part.principal
        kind = "guide" if part.on < 0 else "mesh"
        for first in range(0, len(part.triangles), PIECE):  # a page counts corners in 16 bits
            used, own = np.unique(part.triangles[first : first + PIECE], return_inverse=True)
            found.append(Mesh(part.name, kind, part.body, points[used], own.reshape(-1, 3)))
    return found


def on_arms(model: Model) -> list[RollerPart]:
    """The rollers that arms carry."""
    return [roller for roller in model.rollers if roller.arm is not None]


def moving(model: Model) -> list[int]:
    """What may move: boxes, then rollers, pressed plates, meshes on rollers, then arms, which are counted on
    from the last body."""
    boxes = range(sum(sheet.count for sheet in model.sheets))
    arms = range(len(model.bodies.name), len(model.bodies.name) + len(on_arms(model)))
    machine = (*model.rollers, *(plate for plate, _ in model.plates))
    return [*boxes, *(part.body for part in machine), *(m.body for m in model.meshes if m.on >= 0), *arms]


def _roller(roller: RollerPart) -> list[Mesh]:
    """A cylinder about the z axis of its body, or the sectors of its rim, and a bar across both ends from the
    axis to the rim."""
    half, radius, rim = roller.width / 2, roller.radius, roller.rim
    if rim is None:
        found = [Mesh(roller.name, "roller", roller.body, *cylinder(radius, -half, half))]
    else:
        found = []
        for name, begin, end, own in zip(rim.name, rim.begin, rim.end, rim.radius, strict=True):
            kind = "sector" if name.startswith("s") else "roller"
            solid = slice_(float(own), float(begin), float(end), half)
            found.append(Mesh(f"{roller.name} {name}", kind, roller.body, *solid))
            if (0.5 * np.pi - begin) % (2.0 * np.pi) <= end - begin:  # where the mark is
                radius = float(own)
    size = np.array([0.5 * MARK * radius, 0.5 * (1.0 + PROUD) * radius, half + PROUD * radius])
    found.append(Mesh(roller.name, "mark", roller.body, CORNERS * size + [0.0, size[1], 0.0], BOX))
    return found


def _arm(roller: RollerPart) -> Solid:
    """A bar beside each end of its roller, from the pivot, where a pin joins them, along x to its axis."""
    assert roller.arm is not None, "asked only of a roller on an arm"
    way = roller.center - roller.arm.pivot
    length = float(np.linalg.norm(way - roller.axis * (way @ roller.axis)))
    breadth, thick = (part * roller.radius for part in CHEEK)
    near = roller.width / 2 + 2.0 * PROUD * roller.reach
    far = near + thick
    return join(
        bar(length, breadth, near, far), bar(length, breadth, -far, -near), cylinder(breadth / 4, -far, far)
    )


def _guide(guide: GuidePart) -> Solid:
    """A plate in the axes of its body."""
    if guide.radius > 0.0:
        far, begin = outer(guide), guide.middle - guide.half_angle
        return bent_plate(far - guide.thickness, far, begin, begin + 2 * guide.half_angle, guide.width / 2)
    (facet,) = facets(guide)
    points = (CORNERS * np.array(facet.lengths) / 2) @ facet.rotation.T + facet.center - guide.center
    return Solid(points @ guide.axes, BOX)
