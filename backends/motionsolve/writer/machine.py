"""Rows of the machine behind its bodies: what shows its parts, and what moves them."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.ids import body_id
from mdlgen.backends.motionsolve.writer.moving import add_stops
from mdlgen.backends.motionsolve.writer.parts.kinds import written
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.backends.motionsolve.writer.units import numbers, triples
from mdlgen.model.tables import Model


def facet_ids(model: Model) -> dict[str, int]:
    """Ids of the boxes that show parts, by name, behind the graphics of bodies and of surfaces."""
    names = [facet.name for kind, part in written(model) for facet in kind.shown(model, part)]
    return {name: id for id, name in enumerate(names, len(model.bodies.name) + len(model.sheets) + 1)}


def add_machine(deck: Deck, model: Model) -> None:
    """All parts."""
    _add_facets(deck, model)
    for kind, part in written(model):
        kind.add_shell(deck, model, part)
    for kind, part in written(model):
        kind.add_joints(deck, model, part)
    add_stops(deck, model)


def _add_facets(deck: Deck, model: Model) -> None:
    """The boxes that show parts, each around its own marker."""
    ids = facet_ids(model)
    for kind, part in written(model):
        for name, label, facet in kind.shown(model, part):
            (at,) = triples(facet.center[None])
            axes = cosines(facet.rotation)
            marker = deck.marker(
                f"{name}_center_marker", f"{label} - Center Marker", body_id(part.body), at, axes
            )
            x, y, z = numbers(facet.lengths)
            deck.box(name, label, ids[name], marker, (x, y, z))
