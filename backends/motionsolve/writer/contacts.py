"""Rows of the contacts: one for each pair of bodies."""

from __future__ import annotations

from functools import cache, partial

from mdlgen.altair.rims import Side, graphics, meetings
from mdlgen.backends.motionsolve.writer.ids import graphic_id
from mdlgen.backends.motionsolve.writer.machine import facet_ids
from mdlgen.backends.motionsolve.writer.parts.kinds import written
from mdlgen.backends.motionsolve.writer.rows import ContactRow, Deck, Law
from mdlgen.backends.motionsolve.writer.units import number, thousandfold
from mdlgen.model.tables import Model


def add_contacts(deck: Deck, model: Model) -> None:
    """All kept pairs, and all sectors of a rim in them; each contains the numbers of its entry."""
    bodies, pairs = model.bodies, model.pairs
    law = cache(partial(_law, model))
    columns = (c.tolist() for c in (pairs.contact, pairs.a, pairs.b, model.pair_friction))
    rows = list(zip(*columns, strict=True))
    ids, rollers = facet_ids(model), {r.body: r for r in model.rollers if r.rim is not None}
    boxes = {part.body: [box.name for box in kind.shown(model, part)] for kind, part in written(model)}

    def of(body: int, side: Side) -> tuple[int, ...]:
        names = graphics(rollers[body], side) if body in rollers else boxes.get(body)
        return tuple(ids[name] for name in names) if names else (graphic_id(body),)

    every = {r.body: r for r in model.rollers}

    def is_round(body: int, side: Side) -> bool:
        return body in every and graphics(every[body], side)[0].startswith("gcyl_")

    for id, met in enumerate(meetings(model), 1):
        row, a, b, rough = rows[met.pair]
        sides = [list(of(a, met.a)), list(of(b, met.b))]
        cylinders = [is_round(a, met.a), is_round(b, met.b)]
        if len(sides[0]) > 1:  # a statement has one graphic on its first side, as the text has it
            sides.reverse()
            cylinders.reverse()
        name = f"con_{bodies.name[a]}_{bodies.name[b]}{met.suffix}"
        label = f"{bodies.label[a]} / {bodies.label[b]}{met.suffix.replace('_', ' ')}"
        own = (rough * met.friction, met.stiffness, met.restitution(float(model.contacts.restitution[row])))
        master = "" if cylinders[0] == cylinders[1] else "IJ"[cylinders.index(True)]
        deck.contacts.append(
            ContactRow(name, label, id, sides[0][0], tuple(sides[1]), law(row, *own), master)
        )


def _law(model: Model, row: int, rough: float, stiff: float, restitution: float) -> Law:
    """Numbers of a contact, with friction `rough` and stiffness `stiff` times its own."""
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
    stiffness = number(table.stiffness[row] * stiff)
    return Law(stiffness, number(restitution), thousandfold(table.smoothing[row]), friction)
