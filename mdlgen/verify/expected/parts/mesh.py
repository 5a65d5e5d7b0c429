"""Meshes: their file, or in a deck their triangles, and the joints of those on rollers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.altair.rims import Side
from mdlgen.model.meshes import origin
from mdlgen.model.tables import Floats, Ints, MeshPart, Model
from mdlgen.spec.solid import moments
from mdlgen.verify.expected.parts.kind import (
    Bushing,
    Joint,
    Kind,
    Marker,
    axis_vectors,
    gate_joint,
    gate_points,
    gate_spring,
    gate_way,
    stops_data,
)
from mdlgen.verify.expected.units import reach
from mdlgen.verify.tables import Part, Table, table


class _Meshes(Kind[MeshPart]):
    def points(self, model: Model, part: MeshPart) -> Iterator[tuple[str, Floats]]:
        yield from gate_points(model, part.body, part.name, part.moving)
        yield f"p_{part.name}", origin(part, model.rollers)
        if part.moving is None or not (part.moving.free and part.moving.turns):
            yield f"p_{part.name}_cm", model.bodies.position[part.body]

    def joints(self, model: Model, part: MeshPart) -> Iterator[Joint]:
        yield from gate_joint(part.name, part.moving, model.bodies.position[part.body])
        if part.on >= 0:
            at, name = model.bodies.position[part.body], part.name
            yield Joint(f"j_{name}", "FIXED", f"b_{name}", _under(model, part), at, np.zeros(3))

    def markers(self, model: Model, part: MeshPart) -> Iterator[Marker]:
        yield Marker(f"m_{part.name}", _under(model, part), origin(part, model.rollers), part.axes)

    def bushings(self, model: Model, part: MeshPart) -> Iterator[Bushing]:
        yield from gate_spring(part.name, part.moving, model.bodies.position[part.body])

    def vectors(self, model: Model, part: MeshPart) -> Iterator[tuple[str, Floats]]:
        yield from gate_way(part.name, part.moving)
        yield from axis_vectors(f"v_{part.name}", part.axes)
        yield from axis_vectors(f"v_{part.name}_cm", model.bodies.rotation[part.body])

    def data(self, model: Model, part: MeshPart) -> dict[str, float]:
        found = {"scale": part.scale, **stops_data(model, part.name)}
        found |= {f"c_{a}": float(v) for a, v in zip("xyz", part.middle, strict=True)}
        found |= {f"j_{a}": float(v) for a, v in zip("xyz", part.gyration, strict=True)}
        return found | ({} if part.density is None else {"V": part.volume})

    def tables(self, model: Model) -> dict[str, Table]:
        return {"meshes": meshes(model), "mesh files": mesh_files(model)}

    def graphics(self, part: MeshPart, side: Side) -> list[str]:
        return [f"gcad_{part.name}"]

    def names(self, part: MeshPart) -> set[str]:
        return super().names(part) | {f"m_{part.name}", f"gcad_{part.name}", f"p_{part.name}_cm"}


KIND = _Meshes()


def _under(model: Model, mesh: MeshPart) -> str:
    """The body that a mesh is fixed to."""
    return "B_Ground" if mesh.on < 0 else f"b_{model.rollers[mesh.on].name}"


def meshes(model: Model) -> Table:
    """Markers of the files' axes."""
    places = np.array([origin(m, model.rollers) for m in model.meshes]).reshape(-1, 3)
    axes = np.array([m.axes.T for m in model.meshes]).reshape(-1, 9)
    parts: dict[str, Part] = {"origin": (places, reach(model)), "axes": (axes, 1.0)}
    return table([f"gcad_{m.name}" for m in model.meshes], parts, [(f"b_{m.name}",) for m in model.meshes])


def mesh_files(model: Model) -> Table:
    """Expected transforms of mesh files: no shift or turn against their marker, and scaled to mm."""
    parts: dict[str, Part] = {
        "moved": (np.zeros((len(model.meshes), 6)), 1.0),
        "scale": (np.array([[m.scale] * 3 for m in model.meshes]).reshape(-1, 3), None),
    }
    return table([f"gcad_{m.name}" for m in model.meshes], parts, [(m.file,) for m in model.meshes])


def mesh_shapes(model: Model) -> Table:
    """Expected shapes of meshes in a deck: counts, volume, its middle, least and greatest coordinates."""
    rows = [shape_numbers(m.corners, m.triangles) for m in model.meshes]
    scale = np.array([[1.0, 1.0, m.volume] + [float(np.abs(m.corners).max())] * 9 for m in model.meshes])
    parts: dict[str, Part] = {"shape": (np.array(rows).reshape(-1, 12), scale.reshape(-1, 12))}
    return table([f"gcad_{m.name}" for m in model.meshes], parts)


def shape_numbers(corners: Floats, triangles: Ints) -> list[float]:
    """The twelve numbers of `mesh_shapes`."""
    volume, middle, _ = moments(corners, triangles)
    ends = (*middle, *corners.min(axis=0), *corners.max(axis=0))
    return [float(v) for v in (len(corners), len(triangles), volume, *ends)]
