"""Finds contacts with a rolling resistance that acts, and the outputs that cannot express it."""

from __future__ import annotations

from mdlgen.model.tables import BOX_CYLINDER, BOX_MESH, OF_MACHINE, Model


def rolls(model: Model, row: int) -> bool:
    """True if a part of a contact is a roller, or a mesh on one."""
    kind = int(model.contacts.kind[row])
    if kind == BOX_MESH:
        return any(m.name == model.contacts.part_b[row] and m.on >= 0 for m in model.meshes)
    return kind == BOX_CYLINDER or kind in OF_MACHINE
