"""Meshes: triangles in the axes of their file."""

from __future__ import annotations

from mdlgen.backends.msolve.writer.bodies import body
from mdlgen.backends.msolve.writer.parts.kind import Kind, Table
from mdlgen.backends.msolve.writer.units import axes, row
from mdlgen.model.meshes import origin
from mdlgen.model.tables import MeshPart, Model


class _Meshes(Kind[MeshPart]):
    def table(self, model: Model, part: MeshPart) -> Table:
        return {
            **body(model, part.body),
            "on": "ground" if part.on < 0 else model.rollers[part.on].name,
            "origin": row(origin(part, model.rollers)),
            "file_axes": axes(part.axes),
            "nodes": [row(corner) for corner in part.corners],
            "faces": part.triangles.tolist(),
        }


KIND = _Meshes()
