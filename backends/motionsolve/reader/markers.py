"""Markers: where they are and how they lie, in global axes."""

from __future__ import annotations

from typing import Any, NamedTuple

from mdlgen.backends.motionsolve.reader.entity import Entity, Vector
from mdlgen.backends.motionsolve.reader.index import Index

Axes = tuple[Vector, Vector, Vector]
GLOBAL: Axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Marker(NamedTuple):
    """A marker; axes are X, Y and Z."""

    name: str
    label: str
    body: str
    origin: Vector
    axes: Axes

    def record(self) -> dict[str, Any]:
        return {"label": self.label, "body": self.body, "origin": self.origin, "axes": self.axes}


def markers(index: Index) -> dict[int, Marker]:
    """All markers by id."""
    return {entity.id(): _marker(index, entity) for entity in index.of_kind("Reference_Marker")}


def _marker(index: Index, entity: Entity) -> Marker:
    """Places are global ones, also where a body's LPRF is elsewhere (documented, seen in decks)."""
    body = index.get(entity, "body_id", "Body_Rigid")
    origin = entity.vector("pos_x", "pos_y", "pos_z", default=0.0)
    return Marker(entity.name, entity.word("label", ""), body.name, origin, _axes(entity))


def _axes(entity: Entity) -> Axes:
    """X and Z are given; left out, they are the global ones."""
    x, y, z = GLOBAL
    if entity.has("a00"):
        x = entity.vector("a00", "a10", "a20")
    if entity.has("a02"):
        z = entity.vector("a02", "a12", "a22")
    if entity.has("a00") or entity.has("a02"):
        y = (z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0])
    return (x, y, z)
