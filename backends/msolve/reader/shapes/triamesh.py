"""Triangles, in the axes of their marker."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mdlgen.backends.msolve.forms import form
from mdlgen.backends.msolve.reader.frames import frame, label, on
from mdlgen.backends.msolve.reader.shapes.kind import Shape
from mdlgen.errors import SpecError

if TYPE_CHECKING:
    from mdlgen.backends.msolve.reader.standin import Thing


def _record(mesh: Thing) -> dict[str, Any]:
    origin, axes = frame(mesh.rm)
    count = len(mesh.nodes)
    if any(not 0 <= k < count for face in mesh.faces for k in face):
        raise SpecError(f"{label(mesh)}: a face names a node that is not there")
    shape = {"corners": mesh.nodes, "triangles": mesh.faces}
    return {
        "label": label(mesh),
        "type": "CADGRAPHIC",
        "body": on(mesh.rm),
        "origin": origin,
        "axes": axes,
        **shape,
    }


SHAPE = Shape(
    "Triamesh",
    form(
        "triamesh_msapi.htm",
        documented="label:text rm:Marker nodes:triples faces:counts refinement_level:count",
        needed="rm nodes faces",
    ),
    _record,
)
