"""Rows of guides: their axes, and the boxes that show them."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.facets import Shown
from mdlgen.backends.motionsolve.writer.ids import GROUND_ID
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.backends.motionsolve.writer.units import triples
from mdlgen.model.parts.guide import facets
from mdlgen.model.tables import GuidePart, Model


def add_frame(deck: Deck, model: Model, guide: GuidePart) -> None:
    """The axes of a guide, on ground."""
    (at,) = triples(guide.center[None])
    deck.marker(f"m_{guide.name}", f"Axes of {guide.name}", GROUND_ID, at, cosines(guide.axes))


def shown(model: Model, guide: GuidePart) -> list[Shown]:
    """The boxes that show a guide."""
    made = []
    for k, facet in enumerate(facets(guide)):
        part = "" if guide.radius == 0.0 else f", part {k}"
        made.append(Shown(f"gbox_{guide.name}_{k}", f"{guide.name}{part}", facet))
    return made
