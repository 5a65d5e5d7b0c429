"""Guides, planes and meshes that move, which no text says yet."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import Model


def refuse_moving(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a part that turns about a pivot or slides. A contact of
    Altair's programs may be with such a part, but a law by cubics, and stops, are not written yet."""
    for part, moving in model.gates:
        word = "pivot" if moving.turns else "slide"
        raise RefusedError(
            f"{who}: {part.name} has a {word}, by which it moves during the run; a joint with its motion is "
            f"not written yet. Run it locally, or leave the {word} out for the part as it begins",
            (kind_of(part).table, part.name, word),
        )
    for part in model.stopped:
        word = "arm" if part.press is None else "press"
        raise RefusedError(
            f"{who}: the {word} of {part.name} has stops, which are not written yet. Run it locally, or "
            "leave the stops out",
            (kind_of(part).table, part.name, word, "stops"),
        )
