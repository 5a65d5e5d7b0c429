"""Rows of meshes: their axes, their triangles, and the joints of those on rollers."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.ids import GROUND_ID, body_id, graphic_id
from mdlgen.backends.motionsolve.writer.joints import fix
from mdlgen.backends.motionsolve.writer.rows import Deck, Shell
from mdlgen.backends.motionsolve.writer.units import triples
from mdlgen.model.meshes import origin
from mdlgen.model.tables import MeshPart, Model


def add_frame(deck: Deck, model: Model, mesh: MeshPart) -> None:
    """The axes of a mesh, on what it moves with."""
    (at,) = triples(origin(mesh, model.rollers)[None])
    deck.marker(f"m_{mesh.name}", f"Axes of {mesh.name}", _under(model, mesh), at, cosines(mesh.axes))


def add_shell(deck: Deck, model: Model, mesh: MeshPart) -> None:
    """The triangles of a mesh round a marker of their own, and its joint to a roller."""
    name, label = f"gcad_{mesh.name}", model.bodies.label[mesh.body]
    (at,) = triples(origin(mesh, model.rollers)[None])
    axes = cosines(mesh.axes)
    marker = deck.marker(f"{name}_center_marker", f"{label} - Center Marker", body_id(mesh.body), at, axes)
    corners, triangles = triples(mesh.corners), mesh.triangles.tolist()
    deck.shells.append(Shell(name, label, graphic_id(mesh.body), marker, corners, triangles))
    if mesh.on >= 0:
        (middle,) = triples(model.bodies.position[mesh.body][None])
        on = _under(model, mesh)
        fix(deck, f"j_{mesh.name}", f"{label} fixed", body_id(mesh.body), middle, on)


def _under(model: Model, mesh: MeshPart) -> int:
    """Id of the body that a mesh is fixed to."""
    return GROUND_ID if mesh.on < 0 else body_id(model.rollers[mesh.on].body)
