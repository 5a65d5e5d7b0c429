"""Rows of meshes: their axes, their triangles, and the joints of those on rollers."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.ids import GROUND_ID, body_id, graphic_id
from mdlgen.backends.motionsolve.writer.joints import fix
from mdlgen.backends.motionsolve.writer.moving import add_gate
from mdlgen.backends.motionsolve.writer.parts.kind import Kind
from mdlgen.backends.motionsolve.writer.rows import Deck, Shell
from mdlgen.backends.motionsolve.writer.units import triples
from mdlgen.model.meshes import origin
from mdlgen.model.tables import MeshPart, Model


class _Meshes(Kind[MeshPart]):
    rank = 1

    def add_frame(self, deck: Deck, model: Model, part: MeshPart) -> None:
        """The axes of a mesh, on the body with which it moves."""
        (at,) = triples(origin(part, model.rollers)[None])
        deck.marker(f"m_{part.name}", f"Axes of {part.name}", _under(model, part), at, cosines(part.axes))

    def add_shell(self, deck: Deck, model: Model, part: MeshPart) -> None:
        """The triangles of a mesh round a marker of their own, and its joint to a roller."""
        name, label = f"gcad_{part.name}", model.bodies.label[part.body]
        (at,) = triples(origin(part, model.rollers)[None])
        axes = cosines(part.axes)
        marker = deck.marker(
            f"{name}_center_marker", f"{label} - Center Marker", body_id(part.body), at, axes
        )
        corners, triangles = triples(part.corners), part.triangles.tolist()
        deck.shells.append(Shell(name, label, graphic_id(part.body), marker, corners, triangles))
        if part.on >= 0:
            (middle,) = triples(model.bodies.position[part.body][None])
            on = _under(model, part)
            fix(deck, f"j_{part.name}", f"{label} fixed", body_id(part.body), middle, on)

    def add_joints(self, deck: Deck, model: Model, part: MeshPart) -> None:
        add_gate(deck, model, part, model.bodies.position[part.body])


def _under(model: Model, mesh: MeshPart) -> int:
    """Id of the body that a mesh is fixed to."""
    return GROUND_ID if mesh.on < 0 else body_id(model.rollers[mesh.on].body)


KIND = _Meshes()
