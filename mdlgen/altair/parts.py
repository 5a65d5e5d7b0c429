"""Kinds of parts that a text has words for."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import GuidePart, MeshPart, Model, PlanePart, RollerPart

WRITTEN: tuple[type, ...] = (RollerPart, PlanePart, GuidePart, MeshPart)


def refuse_unwritten(model: Model, what: str) -> None:
    """Raises RefusedError by name for a part of another kind, which a text would name without having it."""
    for part in model.machine:
        if not isinstance(part, WRITTEN):
            kind = kind_of(part)
            raise RefusedError(
                f"{what}: {part.name} is a {kind.name}, which is not written yet; run this scene locally",
                (kind.table, part.name),
            )
