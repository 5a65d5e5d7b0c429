"""Rows of the contacts: one for each pair of bodies that is kept."""

from __future__ import annotations

from backends.motionsolve.bodies import graphic_id
from backends.motionsolve.rows import Contact, Deck, Law
from backends.motionsolve.units import number, thousandfold
from mdlgen.model.tables import Model


def add_contacts(deck: Deck, model: Model) -> None:
    """All kept pairs; the numbers of an entry stand in each of its pairs."""
    bodies, pairs = model.bodies, model.pairs
    laws = [_law(model, row) for row in range(len(model.contacts))]
    columns = (c.tolist() for c in (pairs.contact, pairs.a, pairs.b))
    deck.contacts += [
        Contact(
            f"con_{bodies.name[a]}_{bodies.name[b]}",
            f"{bodies.label[a]} / {bodies.label[b]}",
            id,
            graphic_id(a),
            graphic_id(b),
            laws[row],
        )
        for id, (row, a, b) in enumerate(zip(*columns, strict=True), 1)
    ]


def _law(model: Model, row: int) -> Law:
    table = model.contacts
    friction = None
    if table.mu_static[row] > 0 or table.mu_dynamic[row] > 0:
        speeds = table.stiction_velocity[row], table.friction_velocity[row]
        friction = (
            number(table.mu_static[row]),
            number(table.mu_dynamic[row]),
            thousandfold(speeds[0]),
            thousandfold(speeds[1]),
        )
    stiffness, restitution = number(table.stiffness[row]), number(table.restitution[row])
    return Law(stiffness, restitution, thousandfold(table.smoothing[row]), friction)
