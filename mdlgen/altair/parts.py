"""Parts of kinds that an output has no words for."""

from __future__ import annotations

from collections.abc import Container

from mdlgen.errors import RefusedError
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import Model


def refuse_unwritten(model: Model, written: Container[type], what: str) -> None:
    """Raises RefusedError by name for a part of a kind that is not `written`: the output would name it
    without having it."""
    for part in model.machine:
        if type(part) not in written:
            raise RefusedError(
                f"{what}: {part.name} is a {part.kind}, which is not written yet; run this scene locally",
                (kind_of(part).table, part.name),
            )
