"""Contacts by law, and the requests for their forces."""

from __future__ import annotations

from typing import Any

from mdlgen.altair.recorded import recorded
from mdlgen.altair.rims import Meeting, Side, meetings
from mdlgen.backends.msolve.writer.parts.kinds import WRITTEN
from mdlgen.backends.msolve.writer.units import same, thousandfold
from mdlgen.model.tables import Model

Table = dict[str, Any]


def contacts(model: Model) -> list[Table]:
    """Groups of pairs with the same law: names of what touches, the side with several graphics second."""
    groups: dict[str, Table] = {}
    shapes = _Shapes(model)
    friction = model.pair_friction
    for met in meetings(model):
        row, a, b = (int(v[met.pair]) for v in (model.pairs.contact, model.pairs.a, model.pairs.b))
        sides = [(a, met.a), (b, met.b)]
        if shapes.many(a, met.a):  # a contact has one graphic on its first side, as the text has it
            sides.reverse()
        law = _law(model, row, float(friction[met.pair]) * met.friction, met)
        rounds = [shapes.is_round(*side) for side in sides]
        if rounds[0] != rounds[1]:
            law["master_surface"] = "IJ"[rounds.index(True)]
        one, two = (shapes.name(*side) for side in sides)
        name = _called(model, met)
        pair = (one, two) if name == f"{one}_{two}" else (one, two, name)
        groups.setdefault(repr(law), {"law": law, "pairs": []})["pairs"].append(pair)
    return list(groups.values())


def _called(model: Model, met: Meeting) -> str:
    a, b = (model.bodies.name[int(v[met.pair])] for v in (model.pairs.a, model.pairs.b))
    return f"{a}_{b}{met.suffix}"


def _law(model: Model, row: int, rough: float, met: Meeting) -> Table:
    table = model.contacts
    law: Table = {
        "penalty": same(table.stiffness[row] * met.stiffness),
        "restitution_coefficient": same(met.restitution(float(table.restitution[row]))),
    }
    if rough * max(table.mu_static[row], table.mu_dynamic[row]) <= 0:
        return {**law, "coulomb_friction": "OFF"}
    return {
        **law,
        "coulomb_friction": "ON",
        "mu_static": same(table.mu_static[row] * rough),
        "mu_dynamic": same(table.mu_dynamic[row] * rough),
        "stiction_transition_velocity": thousandfold(table.stiction_velocity[row]),
        "friction_transition_velocity": thousandfold(table.friction_velocity[row]),
    }


class _Shapes:
    """Graphics on which contacts act, by body."""

    def __init__(self, model: Model):
        self.model = model
        self.machine = {part.body: part for part in model.machine}

    def name(self, body: int, side: Side) -> str:
        return f"{self.model.bodies.name[body]}{side.suffix}"

    def many(self, body: int, side: Side) -> bool:
        part = self.machine.get(body)
        return part is not None and WRITTEN[type(part)].graphics(part, side) > 1

    def is_round(self, body: int, side: Side) -> bool:
        part = self.machine.get(body)
        return part is not None and WRITTEN[type(part)].is_round(part, side)


def forces(model: Model) -> list[tuple[str, str]]:
    """Contacts whose forces are recorded: the part that acts, and the part that it acts on."""
    return [(model.contacts.part_a[row], model.contacts.part_b[row]) for row in recorded(model)]
