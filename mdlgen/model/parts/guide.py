"""Guides: plates, straight or bent to an arc, and the boxes by which text and deck show them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from mdlgen.geometry.arrays import Floats
from mdlgen.geometry.rods import Box, Rod, into_box
from mdlgen.geometry.solids import BOX, CORNERS, Solid, bent_plate
from mdlgen.model.frames import frame
from mdlgen.model.moved import carries, lower_motion, moves, swept, watched
from mdlgen.model.parameters.moving import moving_rows
from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.parts.kind import BodyRow, Boxes, Drawn, Kind
from mdlgen.model.press.before import Before
from mdlgen.model.press.faces import Bow, Face, face_of_guide
from mdlgen.model.rims import SAG
from mdlgen.model.sheet_corners import each_box
from mdlgen.model.tables import (
    BOX_GUIDE,
    CYLINDER_GUIDE,
    Bodies,
    GuidePart,
    Model,
    Parameter,
    RollerPart,
    SheetPart,
)
from mdlgen.spec.guide import Guide, edge_radii
from mdlgen.spec.scene import Scene

SIDES = {"left": 1, "inside": 1, "right": 2, "outside": 2, "both": 3}  # as in mechanics.guide


class Facet(NamedTuple):
    """A box that a guide is shown by: z along its axis, x along a line, or from an arc to its axis."""

    center: Floats  # global [mm], (3,)
    rotation: Floats  # (3, 3)
    lengths: tuple[float, float, float]


class _Guides(Kind[GuidePart]):
    table, part = "guides", GuidePart
    with_sheet, with_roller = BOX_GUIDE, CYLINDER_GUIDE
    leads = curved = True

    def lower(self, scene: Scene, before: Before, first: int) -> tuple[GuidePart, ...]:
        return tuple(
            _guide(name, scene.guides[name], first + index) for index, name in enumerate(sorted(scene.guides))
        )

    def face(self, scene: Scene, name: str, at: Floats, roller: str) -> Face | Bow | None:
        return face_of_guide(_guide(name, scene.guides[name], 0), at)

    def body(self, part: GuidePart, rollers: tuple[RollerPart, ...]) -> BodyRow:
        return BodyRow(part.center, part.axes, part.mass, _inertia(part), part.moving is None, np.zeros(3))

    def bounds(
        self, part: GuidePart, bodies: Bodies, rollers: tuple[RollerPart, ...]
    ) -> tuple[Floats, Floats]:
        return bounds(part) if part.moving is None else swept(part.moving, _points(part))

    def centre_bounds(
        self, part: GuidePart, position: Floats, margin: float | None
    ) -> tuple[Floats, Floats] | None:
        return None if part.moving is None else watched(part.moving, part.center)

    def carry(self, part: GuidePart) -> Floats:
        return np.zeros(3) if part.moving is None else carries(part.moving, _points(part))

    def blocks(self, part: GuidePart) -> Floats:
        return _points(part).reshape(-1, 8, 3)

    def reach(self, part: GuidePart, bodies: Bodies, way: Floats) -> float:
        low, high = bounds(part)
        return float(np.where(way > 0, high, low) @ way)

    def overlap(self, part: GuidePart, position: Floats, rotation: Floats) -> Callable[[Rod], float]:
        blocks = [Box(f.center, f.rotation, np.array(f.lengths) / 2) for f in facets(part)]
        return lambda rod: max(into_box(rod, block) for block in blocks)

    def inside(
        self, part: GuidePart, points: Floats, centers: Floats, position: Floats, rotation: Floats
    ) -> Floats:
        return depths(part, points, centers)

    def depth_at_start(self, model: Model, sheet: SheetPart, part: GuidePart) -> float:
        return max(float(depths(part, points, at).max()) for at, points in each_box(model, sheet))

    def place(self, part: GuidePart) -> str:
        return f"guides.{part.name}"

    def depths(self, part: GuidePart, boxes: Boxes, at: Floats) -> Floats:
        corners = np.einsum("tnij,ncj->tnci", boxes.turn, CORNERS * boxes.half[:, None])
        return depths(part, boxes.place[:, :, None] + corners, boxes.place[:, :, None]).max(axis=2)

    def drawn(self, part: GuidePart, half: Floats) -> list[Drawn]:
        return [Drawn(part.name, "guide", _solid(part))]

    def half_depth(self, part: GuidePart) -> float:
        return 0.5 * part.thickness

    def parameters(
        self, scene: Scene, name: str, starts: Mapping[str, tuple[float, float]]
    ) -> list[Parameter]:
        guide, base = scene.guides[name], ("guides", name)
        rows = []
        if guide.line is not None:
            for end, key, place in (("0", "from", guide.line.from_), ("1", "to", guide.line.to)):
                for k, axis in enumerate(NAMED_AXES):
                    path = (*base, "line", key, k)
                    label = f"{axis} where it {'ends' if key == 'to' else 'begins'}"
                    rows.append(Parameter(name, f"{axis}_{end}", label, place[k], "mm", path))
        if guide.arc is not None:
            arc, path = guide.arc, (*base, "arc")
            for k, axis in enumerate(NAMED_AXES):
                rows.append(
                    Parameter(name, axis, f"Centre {axis}", arc.center[k], "mm", (*path, "center", k))
                )
            rows += [
                Parameter(name, "R", f"Radius, {arc.side}", arc.radius, "mm", (*path, "radius")),
                Parameter(name, "from", "Angle where it begins (deg)", arc.from_, "rad", (*path, "from")),
                Parameter(name, "to", "Angle where it ends (deg)", arc.to, "rad", (*path, "to")),
            ]
        return [
            *rows,
            Parameter(name, "w", "Width", guide.width, "mm", (*base, "width")),
            Parameter(name, "s", "Thickness of the plate", guide.thickness, "mm", (*base, "thickness")),
            Parameter(name, "M", "Mass", guide.mass, "g", (*base, "mass")),
            *moving_rows(name, guide, base),
        ]

    def facts(self, model: Model, part: GuidePart) -> list[str]:
        if part.radius == 0.0:
            form = f"straight, {part.length:.4g} mm long"
        else:
            form = f"arc of radius {part.radius:.4g} mm over {np.degrees(2 * part.half_angle):.4g} deg"
        facts = [f"{form}, {part.width:.4g} mm wide", f"touched on the side: {part.side}"]
        return facts if part.moving is None else [*facts, moves(part.moving)]

    def label(self, model: Model, part: GuidePart, seen: tuple[Floats, Floats]) -> Floats:
        """The middle of its face."""
        if part.radius == 0.0:
            return part.center
        way = np.array([np.cos(part.middle), np.sin(part.middle), 0.0])
        return part.center + part.radius * part.axes @ way


def _guide(name: str, guide: Guide, body: int) -> GuidePart:
    if guide.line is not None:
        begin, end = np.array(guide.line.from_), np.array(guide.line.to)
        axis, way = np.array(guide.line.axis), end - begin
        center, axes, side = 0.5 * (begin + end), frame(axis, way), guide.line.side
        shape = (0.0, 0.0, 0.0, float(np.linalg.norm(way)), 1)
    else:
        assert guide.arc is not None
        arc = guide.arc
        center, axis, side = np.array(arc.center), np.array(arc.axis), arc.side
        half = 0.5 * (arc.to - arc.from_)
        # a facet that touches the arc in its middle is this far off at its ends
        facet = 2.0 * math.acos(arc.radius / (arc.radius + SAG))
        axes = frame(axis)
        shape = (arc.radius, arc.from_ + half, half, 0.0, max(1, math.ceil(2.0 * half / facet)))
    radius, middle, half_angle, length, facets = shape
    return GuidePart(
        name=name,
        body=body,
        center=center,
        axes=axes,
        radius=radius,
        middle=middle,
        half_angle=half_angle,
        length=length,
        width=guide.width,
        thickness=guide.thickness,
        sides=SIDES[side],
        side=side,
        mass=guide.mass,
        facets=facets,
        edges=edge_radii(guide.edge_radius, guide.thickness, SIDES[side]),
        moving=lower_motion(guide.moves, guide.mass),
    )


def _inertia(guide: GuidePart) -> Floats:
    """Inertia of a ball of the guide's width [g mm^2], (3,). The body is fixed, so it has no effect."""
    return np.full(3, guide.mass * guide.width**2 / 10)


def outer(guide: GuidePart) -> float:
    """The greater radius of an arc's plate [mm]."""
    return guide.radius + {1: guide.thickness, 2: 0.0, 3: guide.thickness / 2}[guide.sides]


def facets(guide: GuidePart) -> list[Facet]:
    """The boxes of a guide: one, or of an arc as many as keep within SAG of its face.

    Each touches the arc in the middle and meets its neighbours without a gap on the outer side.
    """
    if guide.radius == 0.0:
        off = {1: -0.5, 2: 0.5, 3: 0.0}[guide.sides] * guide.thickness
        lengths = (guide.length, guide.thickness, guide.width)
        return [Facet(guide.center + off * guide.axes[:, 1], guide.axes, lengths)]
    turn = 2.0 * guide.half_angle / guide.facets
    chord = 2.0 * outer(guide) * math.tan(0.5 * turn)
    made = []
    for k in range(guide.facets):
        angle = guide.middle - guide.half_angle + (k + 0.5) * turn
        away = guide.axes @ [math.cos(angle), math.sin(angle), 0.0]
        place = guide.center + (outer(guide) - 0.5 * guide.thickness) * away
        # x back to the axis
        axes = np.stack([-away, np.cross(guide.axes[:, 2], -away), guide.axes[:, 2]], axis=1)
        made.append(Facet(place, axes, (guide.thickness, chord, guide.width)))
    return made


def _points(guide: GuidePart) -> Floats:
    """Corners of the boxes of a guide [mm], (8 facets, 3)."""
    return np.concatenate([f.center + (CORNERS / 2 * f.lengths) @ f.rotation.T for f in facets(guide)])


def bounds(guide: GuidePart) -> tuple[Floats, Floats]:
    """Least and greatest coordinates of a guide [mm], (3,)."""
    points = _points(guide)
    return points.min(axis=0), points.max(axis=0)


def depths(guide: GuidePart, points: Floats, center: Floats) -> Floats:
    """How deep points of bodies with these centres are in a guide; 0 where they do not touch it [mm].

    `points` (..., 3) and `center`, (3,) or one for each point; (...).
    """
    own = (points - guide.center) @ guide.axes
    middle = (center - guide.center) @ guide.axes
    if guide.radius == 0.0:
        inward, side = own[..., 1], middle[..., 1]
        over = np.abs(own[..., 0]) <= guide.length / 2
    else:
        inward = guide.radius - np.hypot(own[..., 0], own[..., 1])
        side = guide.radius - np.hypot(middle[..., 0], middle[..., 1])
        angle = np.arctan2(own[..., 1], own[..., 0]) - guide.middle
        over = np.cos(angle) >= math.cos(guide.half_angle)
    sign = {1: 1.0, 2: -1.0, 3: np.copysign(1.0, side)}[guide.sides]
    deep = (guide.thickness / 2 if guide.sides == 3 else 0.0) - sign * inward
    over &= (np.abs(own[..., 2]) <= guide.width / 2) & (deep < guide.thickness)
    return np.where(over, np.maximum(deep, 0.0), 0.0)


def _solid(guide: GuidePart) -> Solid:
    """A plate in the axes of its body."""
    if guide.radius > 0.0:
        far, begin = outer(guide), guide.middle - guide.half_angle
        return bent_plate(far - guide.thickness, far, begin, begin + 2 * guide.half_angle, guide.width / 2)
    (facet,) = facets(guide)
    points = (CORNERS * np.array(facet.lengths) / 2) @ facet.rotation.T + facet.center - guide.center
    return Solid(points @ guide.axes, BOX)


KIND = _Guides()
