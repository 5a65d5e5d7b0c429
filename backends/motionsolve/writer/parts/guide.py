"""Rows of guides: their axes, and the boxes that show them."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.facets import Shown
from mdlgen.backends.motionsolve.writer.ids import GROUND_ID
from mdlgen.backends.motionsolve.writer.moving import add_gate
from mdlgen.backends.motionsolve.writer.parts.kind import Kind
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.backends.motionsolve.writer.units import triples
from mdlgen.model.parts.guide import facets
from mdlgen.model.tables import GuidePart, Model


class _Guides(Kind[GuidePart]):
    rank = 0

    def add_frame(self, deck: Deck, model: Model, part: GuidePart) -> None:
        """The axes of a guide, on ground."""
        (at,) = triples(part.center[None])
        deck.marker(f"m_{part.name}", f"Axes of {part.name}", GROUND_ID, at, cosines(part.axes))

    def shown(self, model: Model, part: GuidePart) -> list[Shown]:
        """The boxes that show a guide."""
        made = []
        for k, facet in enumerate(facets(part)):
            piece = "" if part.radius == 0.0 else f", part {k}"
            made.append(Shown(f"gbox_{part.name}_{k}", f"{part.name}{piece}", facet))
        return made

    def add_joints(self, deck: Deck, model: Model, part: GuidePart) -> None:
        add_gate(deck, model, part, part.center)


KIND = _Guides()
