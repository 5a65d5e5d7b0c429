"""Guides: Scene -> tables, and the boxes by which text and deck show them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.model.frames import frame
from mdlgen.model.rims import SAG
from mdlgen.model.tables import Floats, GuidePart
from mdlgen.spec.guide import Guide, edge_radii
from mdlgen.spec.scene import Scene

SIDES = {"left": 1, "inside": 1, "right": 2, "outside": 2, "both": 3}  # as in mechanics.guide


class Facet(NamedTuple):
    """A box that a guide is shown by: z along its axis, x along a line, or from an arc to its axis."""

    center: Floats  # global [mm], (3,)
    rotation: Floats  # (3, 3)
    lengths: tuple[float, float, float]


def lower_guides(scene: Scene, first: int) -> tuple[GuidePart, ...]:
    """All guides; their bodies are numbered from `first`."""
    return tuple(
        _guide(name, scene.guides[name], first + index) for index, name in enumerate(sorted(scene.guides))
    )


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
    )


def inertia(guide: GuidePart) -> Floats:
    """Of a fixed body it is of no effect: that of a ball of the guide's width [g mm^2], (3,)."""
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


def bounds(guide: GuidePart) -> tuple[Floats, Floats]:
    """Least and greatest coordinates of a guide [mm], (3,)."""
    corners = np.array([[i, j, k] for i in (-0.5, 0.5) for j in (-0.5, 0.5) for k in (-0.5, 0.5)])
    points = np.concatenate([f.center + (corners * f.lengths) @ f.rotation.T for f in facets(guide)])
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
