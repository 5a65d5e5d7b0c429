"""Arrows of what moves and presses as a run begins: surfaces of drives, springs, speeds of sheets, loads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mdlgen.geometry.solids import Solid, arrow
from mdlgen.model.frames import frame
from mdlgen.model.tables import Floats, Model, PlanePart, RollerPart
from mdlgen.report.over_time import words
from mdlgen.units import PER_SECOND

LENGTH, LEAST = 0.1, 0.35  # of the greatest arrow, relative to the scene's diagonal; of the least, in its own
BREADTH = 0.16  # of a head, relative to the greatest length
AWAY = np.array([-0.55, -0.75, 0.5])  # direction of the first view of a scene


@dataclass(frozen=True)
class Arrow:
    """One arrow, from `at` along `way` [mm]."""

    part: str
    kind: str  # drive, press, motion or load
    at: Floats  # (3,)
    way: Floats  # (3,)
    says: str

    def solid(self, breadth: float) -> Solid:
        """Triangles [mm], global axes."""
        length = float(np.linalg.norm(self.way))
        points, triangles = arrow(length, breadth)
        return Solid(points @ frame(self.way / length).T + self.at, triangles)


def extent(model: Model) -> tuple[Floats, Floats]:
    """Least and greatest coordinates of centres of boxes and of rollers [mm], (3,) each."""
    low = [model.bodies.position[: sum(sheet.count for sheet in model.sheets)].min(axis=0)]
    high = [model.bodies.position[: sum(sheet.count for sheet in model.sheets)].max(axis=0)]
    for roller in model.rollers:
        center = model.bodies.position[roller.body]
        low.append(center - roller.reach)
        high.append(center + roller.reach)
    return np.min(low, axis=0), np.max(high, axis=0)


def longest(model: Model) -> float:
    """Length of the greatest arrow [mm]."""
    low, high = extent(model)
    return max(LENGTH * float(np.linalg.norm(high - low)), 1e-3)


def arrows(model: Model) -> list[Arrow]:
    """All arrows of a Model at its start. For each kind lengths are proportional, the greatest `longest`."""
    most = longest(model)
    found: list[Arrow] = []
    for kind in (_drives, _presses, _motions, _loads):
        raw = list(kind(model, most))
        greatest = max((size for *_, size in raw), default=0.0)
        for part, name, at, way, says, size in raw:
            length = most * max(size / greatest, LEAST) if greatest > 0.0 else most
            begin = at - way * length if name == "press" else at  # a press arrow ends at its part
            found.append(Arrow(part, name, begin, way * length, says))
    return found


Raw = tuple[str, str, Floats, Floats, str, float]  # part, kind, place, unit vector, words, size


def _drives(model: Model, most: float) -> Iterator[Raw]:
    """Arrows at the nearer end of a roller to the viewer, where its surface faces the part that it moves."""
    for number, roller in enumerate(model.rollers):
        if not roller.speed:
            continue
        toward = _facing(model, roller, number)
        way = np.sign(roller.speed) * np.cross(roller.axis, toward)
        center = model.bodies.position[roller.body]
        speed = PER_SECOND * abs(roller.speed) * roller.radius
        near = 1.0 if float(roller.axis @ AWAY) > 0.0 else -1.0
        side = near * roller.axis * (0.5 * roller.width + BREADTH * most)
        # its middle is at the point that faces the sheet
        at = center + side + roller.radius * toward
        yield roller.name, "drive", at, way, f"its surface moves at {speed:.4g} mm/s", speed


def _facing(model: Model, roller: RollerPart, number: int) -> Floats:
    """Unit vector from a roller's axis to the nearest sheet that it has a contact with, else to its
    counterpart, else upward; square to the axis."""
    center, table = model.bodies.position[roller.body], model.contacts
    sheets = {sheet.name: sheet for sheet in model.sheets}
    near: list[Floats] = []
    own = {roller.name, *(mesh.name for mesh in model.meshes if mesh.on == number)}
    for one, other in zip(table.part_a, table.part_b, strict=True):
        if other in own and one in sheets:
            normal = sheets[one].rotation[:, 2]
            near.append(normal * float((sheets[one].center - center) @ normal))
    if not near:
        mates = [{one, other} for one, other in zip(table.part_a, table.part_b, strict=True)]
        names = {name for pair in mates if roller.name in pair for name in pair} - {roller.name}
        near = [model.bodies.position[r.body] - center for r in model.rollers if r.name in names]
    up = -model.gravity if model.gravity.any() else np.array([0.0, 0.0, 1.0])
    for way in (*sorted(near, key=lambda n: float(n @ n)), up, *np.eye(3)):
        flat = way - roller.axis * float(way @ roller.axis)
        size = float(np.linalg.norm(flat))
        if size > 1e-9:
            return flat / size
    raise AssertionError("two of three axes are not along the roller's")


def _presses(model: Model, most: float) -> Iterator[Raw]:
    """Behind a pressed roller or plate, with the tip at it."""
    pressed: list[RollerPart | PlanePart] = [*model.rollers, *model.planes]
    for part in pressed:
        if part.press is None:
            continue
        way = part.press.direction
        back = (
            part.reach
            if isinstance(part, RollerPart)
            else 0.5 * float(np.abs(part.normal @ way)) * part.size[2]
        )
        at = model.bodies.position[part.body] - back * way
        spring = f"pressed by a spring with {part.press.preload:.4g} N, {part.press.stiffness:.4g} N/mm"
        yield part.name, "press", at, way, spring, part.press.preload


def _motions(model: Model, most: float) -> Iterator[Raw]:
    """Arrows of sheets that move as the run begins."""
    for sheet in model.sheets:
        size = float(np.linalg.norm(sheet.velocity))
        if size > 0.0:
            says = f"begins with {PER_SECOND * size:.4g} mm/s"
            yield sheet.name, "motion", sheet.center, sheet.velocity / size, says, size


def _loads(model: Model, most: float) -> Iterator[Raw]:
    """The sum of the forces on each sheet, in the middle of where they act."""
    loads = model.loads
    for sheet in model.sheets:
        mine = (loads.body >= sheet.first) & (loads.body < sheet.first + sheet.count)
        force = loads.force[mine].sum(axis=0)
        size = float(np.linalg.norm(force))
        if size > 0.0:
            body, local = loads.body[mine], loads.local[mine]
            places = model.bodies.position[body] + np.einsum("nij,nj->ni", model.bodies.rotation[body], local)
            changing = [words(loads.profiles[k]) for k in loads.changing if k in loads.entry[mine]]
            says = ", ".join([f"a load of {size:.4g} N", *changing])
            yield sheet.name, "load", places.mean(axis=0), force / size, says, size
