"""The shapes of a scene's bodies as triangles in body axes [mm]: what page, stills and exports draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.geometry.solids import Solid, bar, cylinder, join
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.parts.roller import PROUD
from mdlgen.model.tables import (
    Floats,
    Ints,
    MachinePart,
    Model,
    RollerPart,
)

CHEEK = 0.4, 0.12  # breadth and thickness of an arm next to its roller, relative to the roller's radius


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
            found += _drawn(model, roller)
    for number, roller in enumerate(on_arms(model)):
        found.append(Mesh(roller.name, "arm", len(model.bodies.name) + number, *_arm(roller)))
    for part in model.machine[len(model.rollers) :]:
        found += _drawn(model, part)
    return found


def _drawn(model: Model, part: MachinePart) -> list[Mesh]:
    shown = kind_of(part).drawn(part, model.bodies.half[part.body])
    return [Mesh(each.name, each.kind, part.body, *each.solid) for each in shown]


def on_arms(model: Model) -> list[RollerPart]:
    """The rollers that arms carry."""
    return [roller for roller in model.rollers if roller.arm is not None]


def moving(model: Model) -> list[int]:
    """Bodies that may move: boxes, then rollers, pressed plates, parts that turn about a pivot or slide,
    meshes on rollers, then arms, which are numbered after the last body."""
    boxes = range(sum(sheet.count for sheet in model.sheets))
    arms = range(len(model.bodies.name), len(model.bodies.name) + len(on_arms(model)))
    fixed = model.bodies.fixed
    return [*boxes, *(part.body for part in model.machine if not fixed[part.body]), *arms]


def _arm(roller: RollerPart) -> Solid:
    """A bar at each end of its roller, from the pivot, where a pin joins them, along x to its axis."""
    assert roller.arm is not None, "asked only of a roller on an arm"
    way = roller.center - roller.arm.pivot
    length = float(np.linalg.norm(way - roller.axis * (way @ roller.axis)))
    breadth, thick = (part * roller.radius for part in CHEEK)
    near = roller.width / 2 + 2.0 * PROUD * roller.reach
    far = near + thick
    return join(
        bar(length, breadth, near, far), bar(length, breadth, -far, -near), cylinder(breadth / 4, -far, far)
    )
