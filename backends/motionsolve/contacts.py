"""Rows of the contacts: one for each pair of bodies that is kept."""

from __future__ import annotations

from functools import cache, partial

from backends.motionsolve.bodies import facet_ids, graphic_id
from backends.motionsolve.rows import Contact, Deck, Law
from backends.motionsolve.units import number, thousandfold
from mdlgen.model.tables import Model


def add_contacts(deck: Deck, model: Model) -> None:
    """All kept pairs; the numbers of an entry stand in each of its pairs."""
    bodies, pairs = model.bodies, model.pairs
    law = cache(partial(_law, model))
    columns = (c.tolist() for c in (pairs.contact, pairs.a, pairs.b, model.pair_friction))
    facets = {guide.body: ids for guide, ids in zip(model.guides, facet_ids(model), strict=True)}
    deck.contacts += [
        Contact(
            f"con_{bodies.name[a]}_{bodies.name[b]}",
            f"{bodies.label[a]} / {bodies.label[b]}",
            id,
            graphic_id(a),
            facets.get(b, (graphic_id(b),)),
            law(row, rough),
        )
        for id, (row, a, b, rough) in enumerate(zip(*columns, strict=True), 1)
    ]


def _law(model: Model, row: int, rough: float) -> Law:
    """Numbers of a contact, with friction `rough` times its own."""
    table = model.contacts
    friction = None
    if rough * max(table.mu_static[row], table.mu_dynamic[row]) > 0:
        speeds = table.stiction_velocity[row], table.friction_velocity[row]
        friction = (
            number(table.mu_static[row] * rough),
            number(table.mu_dynamic[row] * rough),
            thousandfold(speeds[0]),
            thousandfold(speeds[1]),
        )
    stiffness, restitution = number(table.stiffness[row]), number(table.restitution[row])
    return Law(stiffness, restitution, thousandfold(table.smoothing[row]), friction)
