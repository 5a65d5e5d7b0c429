"""Planes: plates, fixed or pressed by a spring."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.geometry.arrays import Floats
from mdlgen.geometry.rods import Box, Rod, into_box
from mdlgen.geometry.solids import BOX, CORNERS, Solid
from mdlgen.model.frames import frame
from mdlgen.model.moved import carries, lower_motion, moves, swept, watched
from mdlgen.model.parameters.machine import center_rows, spring_rows, start_row
from mdlgen.model.parameters.moving import moving_rows, stops_rows
from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.parts.kind import SLACK, BodyRow, Boxes, Drawn, Kind
from mdlgen.model.parts.roller import FLAT
from mdlgen.model.parts.words import begins, direction
from mdlgen.model.press.before import Before
from mdlgen.model.press.faces import Face, faces_of_plate
from mdlgen.model.press.springs import plate_press
from mdlgen.model.sheet_corners import corners, corners_of_boxes
from mdlgen.model.tables import (
    BOX_PLANE,
    CYLINDER_PLANE,
    Bodies,
    Model,
    Parameter,
    PlanePart,
    Press,
    RollerPart,
    SheetPart,
)
from mdlgen.spec.guide import edge_radii
from mdlgen.spec.scene import Scene


def _lie_over(part: PlanePart, axes: Floats, sheet: SheetPart, face: Floats) -> bool:
    """Whether a flat sheet is level with a plate and lies over a part of it that has none of its corners;
    `axes` of the plate, `face` the middle of its face."""
    if abs(float(part.normal @ sheet.rotation[:, 2])) < 1 - FLAT**2:
        return False
    plate = face + (CORNERS * np.array(part.size) / 2) @ axes.T
    for axis in (*axes.T[:2], *sheet.rotation.T[:2]):
        one, two = plate @ axis, corners(sheet) @ axis
        if max(one.min(), two.min()) >= min(one.max(), two.max()):
            return False
    return True


class _Planes(Kind[PlanePart]):
    table, part = "planes", PlanePart
    with_sheet, with_roller = BOX_PLANE, CYLINDER_PLANE

    def lower(self, scene: Scene, before: Before, first: int) -> tuple[PlanePart, ...]:
        return tuple(
            PlanePart(
                name=name,
                body=first + index,
                center=np.array(plane.center),
                normal=np.array(plane.normal),
                size=plane.size,
                mass=plane.mass,
                press=plate_press(scene, name, before) if plane.press else None,
                edges=edge_radii(plane.edge_radius, plane.size[2], 1),
                moving=lower_motion(plane.moves, plane.mass),
            )
            for index, (name, plane) in enumerate(sorted(scene.planes.items()))
        )

    def face(self, scene: Scene, name: str, at: Floats, roller: str) -> Face:
        plane = scene.planes[name]
        if plane.press is not None:
            raise SpecError(
                f"{roller} and {name} are pressed against each other; give one of them a fixed place",
                ("rollers", roller, "press"),
            )
        return faces_of_plate(np.array(plane.center), frame(np.array(plane.normal)), plane.size, at)

    def body(self, part: PlanePart, rollers: tuple[RollerPart, ...]) -> BodyRow:
        a, b, c = part.size
        inertia = part.mass / 12 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
        start = part.press.start * part.press.direction if part.press else np.zeros(3)
        place, half = part.center + start, np.array(part.size) / 2
        fixed = part.press is None and part.moving is None
        return BodyRow(place, frame(part.normal), part.sliding_mass, inertia, fixed, half)

    def bounds(
        self, part: PlanePart, bodies: Bodies, rollers: tuple[RollerPart, ...]
    ) -> tuple[Floats, Floats]:
        """A pressed one may move by the length of its spring."""
        if part.moving is not None:
            return swept(part.moving, _corners(part))
        center = bodies.position[part.body]
        extent = np.abs(bodies.rotation[part.body]) @ (np.array(part.size) / 2)
        if part.press is not None:
            center, extent = part.center, extent + part.travel + SLACK
        return center - extent, center + extent

    def blocks(self, part: PlanePart) -> Floats:
        return _corners(part)[None]

    def reach(self, part: PlanePart, bodies: Bodies, way: Floats) -> float:
        extent = float(np.abs(bodies.rotation[part.body].T @ way) @ (np.array(part.size) / 2))
        return float(bodies.position[part.body] @ way) + extent

    def press(self, part: PlanePart) -> Press | None:
        return part.press

    def centre_bounds(
        self, part: PlanePart, position: Floats, margin: float | None
    ) -> tuple[Floats, Floats] | None:
        """A spring ends, whatever is kept; its slide keeps a plate on its way to round-off."""
        if part.moving is not None:
            return watched(part.moving, part.center)
        if part.press is None:
            return None
        far = part.travel + 1e-6 * part.press.free_length
        return part.center - far, part.center + far

    def carry(self, part: PlanePart) -> Floats:
        return part.travel if part.moving is None else carries(part.moving, _corners(part))

    def overlap(self, part: PlanePart, position: Floats, rotation: Floats) -> Callable[[Rod], float]:
        block = Box(position, rotation, np.array(part.size) / 2)
        return lambda rod: into_box(rod, block)

    def inside(
        self, part: PlanePart, points: Floats, centers: Floats, position: Floats, rotation: Floats
    ) -> Floats:
        arms = (points - position) @ rotation
        return (np.array(part.size) / 2 - np.abs(arms)).min(axis=-1)

    def depth_at_start(self, model: Model, sheet: SheetPart, part: PlanePart) -> float:
        face = model.bodies.position[part.body] + part.normal * part.size[2] / 2
        axes = model.bodies.rotation[part.body]
        points = corners(sheet) if sheet.bend is None else corners_of_boxes(model, sheet)
        over = np.all(np.abs((points - face) @ axes[:, :2]) <= np.array(part.size[:2]) / 2, axis=1)
        if not over.any() and sheet.bend is None and _lie_over(part, axes, sheet, face):
            over[:] = True  # narrower than the sheet, and level with it
        depth = float(np.max(-((points - face) @ part.normal)[over], initial=0.0))
        return depth if depth < part.size[2] else 0.0

    def half_depth(self, part: PlanePart) -> float:
        return 0.5 * part.size[2]

    def constraints(self, model: Model, sheet: SheetPart, part: PlanePart) -> list[tuple[Floats, Floats]]:
        return [(corner, part.normal) for corner in corners(sheet)]

    def depths(self, part: PlanePart, boxes: Boxes, at: Floats) -> Floats:
        face = at[:, None] + part.normal * part.size[2] / 2
        lowest = np.abs(np.einsum("tnij,i->tnj", boxes.turn, part.normal)) * boxes.half
        return lowest.sum(axis=2) - (boxes.place - face) @ part.normal

    def drawn(self, part: PlanePart, half: Floats) -> list[Drawn]:
        return [Drawn(part.name, "plane", Solid(CORNERS * half, BOX))]

    def parameters(
        self, scene: Scene, name: str, starts: Mapping[str, tuple[float, float]]
    ) -> list[Parameter]:
        plane, base = scene.planes[name], ("planes", name)
        rows = center_rows(name, plane.center, base)
        for k, size in enumerate(plane.size):
            axis = NAMED_AXES[k]
            label = f"Length along its {axis}"
            rows.append(Parameter(name, f"L_{axis}", label, size, "mm", (*base, "size", k)))
        rows.append(Parameter(name, "M", "Mass", plane.mass, "g", (*base, "mass")))
        rows += moving_rows(name, plane, base)
        if plane.press is None:
            return rows
        rows += spring_rows(name, plane.press, base)
        rows += stops_rows(name, plane.press.stops, (*base, "press", "stops"))
        if plane.press.carrier_mass is not None:
            path = (*base, "press", "carrier_mass")
            rows.append(Parameter(name, "M_c", "Mass of its slide", plane.press.carrier_mass, "g", path))
        return [*rows, start_row(name, starts[name][1], plane.press)]

    def facts(self, model: Model, part: PlanePart) -> list[str]:
        facts = [" x ".join(f"{s:.4g}" for s in part.size) + f" mm, face towards {direction(part.normal)}"]
        if part.moving is not None:
            return [*facts, moves(part.moving)]
        if part.press is None:
            return [*facts, "fixed"]
        spring = part.press
        force = f"pressed along {direction(spring.direction)} by {spring.preload:.4g} N"
        return [*facts, f"{force}, {spring.stiffness:.4g} N/mm, {part.sliding_mass:.4g} g", *begins(spring)]

    def label(self, model: Model, part: PlanePart, seen: tuple[Floats, Floats]) -> Floats:
        """At a corner of its face, or what is nearest to that of where other parts are: in the middle are the
        sheets."""
        bodies = model.bodies
        corner = bodies.half[part.body] * [-1.0, -1.0, 1.0]
        corner = bodies.position[part.body] + bodies.rotation[part.body] @ corner
        near = np.clip(corner, *seen)
        return near + part.normal * float((corner - near) @ part.normal)


def _corners(part: PlanePart) -> Floats:
    """The corners of the plate as it is given [mm], (8, 3)."""
    return part.center + (CORNERS * np.array(part.size) / 2) @ frame(part.normal).T


KIND = _Planes()
