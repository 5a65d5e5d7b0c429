"""The sheets alone, as a system definition: what of the machine they meet is an attachment of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mdlgen.altair.rims import Meeting, meetings
from mdlgen.backends.motionview.writer.contact_rows import Pair
from mdlgen.backends.motionview.writer.contacts import contact_views, pair_rows, rough_pairs
from mdlgen.backends.motionview.writer.idle import SCRIPT, STATEMENT, used_by
from mdlgen.backends.motionview.writer.parts.kinds import graphics_of
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.scene_rows import Attachment, SystemView
from mdlgen.backends.motionview.writer.units import number
from mdlgen.backends.motionview.writer.views import given_values, scene_view
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.tables import BOX_BOX, Ints, Model


def kept_contacts(model: Model) -> Ints:
    """Row of the contacts of each pair of a box and another body, those of `sheet_pairs`."""
    table = model.contacts
    inside = model.pairs.contact[~table.of_machine[model.pairs.contact]]
    return np.sort(np.concatenate([inside, model.external_pairs.contact]), kind="stable")


def system_view(model: Model, set_contact: bool) -> SystemView:
    """The rows of a Model without its machine, and the attachments."""
    table = model.contacts
    given = given_values(model, STATEMENT if set_contact else SCRIPT, kept_contacts(model).tolist())
    of_sheets = np.flatnonzero(~table.of_machine).tolist()
    scene = replace(
        scene_view(model, set_contact),
        parameters=_used(model, given, of_sheets),
        machine=[],
        shafts=[],
        contacts=contact_views(model, given, of_sheets),
        pairs=sheet_pairs(model),
        laws=[],
    )
    return SystemView(
        name=model.name,
        variable=f"sys_{model.name}",
        definition=f"def_sys_{model.name}",
        attachments=attachments(model),
        scene=scene,
    )


def _used(model: Model, given: dict[str, list[Value]], contacts: Sequence[int]) -> list[Value]:
    """The user's parameters that something of the sheets follows from."""
    machine = {p.name for p in model.machine} | {"run"}
    written = {f"contact_{int(model.contacts.entry[row])}" for row in contacts}
    of_sheets = (
        p.formula
        for p in model.parameters
        if p.formula
        and p.data_set not in machine | {OF_USER}
        and (p.data_set in written or not p.data_set.startswith("contact_"))
    )
    used = used_by(model, of_sheets)
    return [value for value in given.get(OF_USER, []) if value.member in used]


def attachments(model: Model) -> list[Attachment]:
    """The body and the graphics of each part that a sheet has a contact with, by kind and name of the part.

    A part stays one where no pair with it is kept, so that the arguments do not change with the run.
    """
    table = model.contacts
    met = {table.part_b[row] for row in np.flatnonzero(~table.of_machine)}
    parts = [
        *((part.name, f"b_{part.name}", tuple(graphics_of(part))) for part in model.machine),
        *((e.name, e.body, e.graphics) for e in model.externals),
    ]
    made = []
    for name, body, graphics in parts:
        if name not in met:
            continue
        made.append(Attachment(_body(name), f"Body of {name}", "Body", body))
        inside = _graphics(name, len(graphics))
        for k, (own, given) in enumerate(zip(inside, graphics, strict=True)):
            number = f" {k}" if len(graphics) > 1 else ""
            made.append(Attachment(own, f"Graphic{number} of {name}", "Graphic", given))
    return made


def sheet_pairs(model: Model) -> list[Pair]:
    """One row for each pair of a box and a part of the machine, or a box of another sheet, by contact."""
    table, bodies, pairs = model.contacts, model.bodies, model.external_pairs
    rows = []
    shown = {part.name: graphics_of(part) for part in model.machine}
    for met, pair in zip(meetings(model), pair_rows(model), strict=True):
        row = int(model.pairs.contact[met.pair])
        if table.kind[row] == BOX_BOX:
            rows.append((row, pair))
        elif not table.of_machine[row]:
            name = table.part_b[row]
            every = shown[name]
            own = dict(zip(every, _graphics(name, len(every)), strict=True))
            inside = [own[graphic] for graphic in pair.graphics_2]
            rows.append((row, _by_number(pair, met)._replace(body_2=_body(name), graphics_2=inside)))
    rubs = (table.mu_static > 0) | (table.mu_dynamic > 0)
    rough = rough_pairs(model)
    for row, box, part in zip(pairs.contact.tolist(), pairs.box.tolist(), pairs.part.tolist(), strict=True):
        external = model.externals[part]
        name = bodies.name[box]
        made = Pair(
            name=f"con_{name}_{external.name}",
            label=f"{bodies.label[box]} / Part {external.name}",
            body_1=f"b_{name}",
            graphic_1=f"gbox_{name}",
            body_2=_body(external.name),
            graphics_2=_graphics(external.name, len(external.graphics)),
            friction="ON" if rubs[row] and bodies.friction[box] > 0 else "OFF",
            data_set=f"contact_{table.entry[row]}",
            rough=rough.get(box, ""),
            rougher=float(bodies.friction[box]),
        )
        rows.append((row, made))
    return [pair for _, pair in sorted(rows, key=lambda item: item[0])]


def _by_number(pair: Pair, met: Meeting) -> Pair:
    """A pair without the names of its rim's data set, which is in the model around."""
    if met.b.sector < 0:
        return pair
    rough = [v for v in pair.rough.split("*") if "_cells." in v] + [number(met.friction)]
    bouncy = "" if pair.restitution is None else number(pair.restitution)
    return pair._replace(rough="*".join(rough), stiff=number(met.stiffness), bouncy=bouncy)


def _body(part: str) -> str:
    return f"b_{part}_att"


def _graphics(part: str, count: int) -> list[str]:
    return [f"gra_{part}_att"] if count == 1 else [f"gra_{part}_att_{k}" for k in range(count)]
