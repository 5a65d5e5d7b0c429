"""Guides: the boxes that show them."""

from __future__ import annotations

from mdlgen.altair.rims import Side
from mdlgen.backends.msolve.writer.bodies import body, box
from mdlgen.backends.msolve.writer.parts.kind import Kind, Table
from mdlgen.model.parts.guide import facets
from mdlgen.model.tables import GuidePart, Model


class _Guides(Kind[GuidePart]):
    note = "boxes: place, axes, lengths"

    def table(self, model: Model, part: GuidePart) -> Table:
        return {**body(model, part.body), "boxes": [box(facet) for facet in facets(part)]}

    def graphics(self, part: GuidePart, side: Side) -> int:
        return len(facets(part))


KIND = _Guides()
