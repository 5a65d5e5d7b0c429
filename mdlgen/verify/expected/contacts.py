"""Contacts that a text with its script must have."""

from __future__ import annotations

from functools import cache

import numpy as np

from mdlgen.altair.recorded import called, recorded
from mdlgen.altair.rims import Side, meetings
from mdlgen.model.tables import Model
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.expected.units import SECOND, body_name
from mdlgen.verify.tables import Part, Table, table

CONTACT_NUMBERS = (
    "penalty",
    "restitution",
    "mu_static",
    "mu_dynamic",
    "stiction_velocity",
    "friction_velocity",
    "normal_trans_vel",
)


def masters(rows: Table) -> Table:
    """The side of each of `contacts` whose surface the solver must take as the master: a cylinder against
    another shape (paper, 3.1). Elsewhere the solver chooses."""
    found = []
    for words in rows.words:
        rounds = [any(name.startswith("gcyl_") for name in side) for side in (words[4:5], words[5:])]
        found.append(("" if rounds[0] == rounds[1] else "I" if rounds[0] else "J",))
    return table(rows.names, {}, found)


def contacts(model: Model) -> Table:
    """One row for each pair of bodies that may touch, and each sector of a rim in it; without friction its
    four numbers are 0."""
    rows, pairs, outside, bodies = model.contacts, model.pairs, model.external_pairs, model.bodies
    met = list(meetings(model))
    inside = np.array([m.pair for m in met], dtype=int)
    of = np.concatenate([pairs.contact[inside], outside.contact])
    own = np.array([(m.friction, m.stiffness) for m in met]).reshape(-1, 2)
    rough = np.concatenate([model.pair_friction[inside] * own[:, 0], bodies.friction[outside.box]])
    stiff = np.concatenate([own[:, 1], np.ones(len(outside))])
    restitution = rows.restitution[of]
    restitution[: len(met)] = [m.restitution(c) for m, c in zip(met, restitution, strict=False)]
    rubs = ((rows.mu_static[of] > 0) | (rows.mu_dynamic[of] > 0)) & (rough > 0)
    numbers = np.stack(
        [
            rows.stiffness[of] * stiff,
            restitution,
            *(np.where(rubs, v * rough, 0.0) for v in (rows.mu_static[of], rows.mu_dynamic[of])),
            *(
                np.where(rubs, v / SECOND, 0.0)
                for v in (rows.stiction_velocity[of], rows.friction_velocity[of])
            ),
            rows.smoothing[of] / SECOND,
        ],
        axis=1,
    )
    machine = {part.body: part for part in model.machine}

    @cache  # most bodies meet many
    def end(body: int, side: Side) -> tuple[str, list[str]]:
        part = machine.get(body)
        shown = [f"gbox_{bodies.name[body]}"] if part is None else kind_of(part).graphics(part, side)
        return body_name(model, body), shown

    names, words = [], []
    for m in met:
        a, b = int(pairs.a[m.pair]), int(pairs.b[m.pair])
        names.append(f"con_{bodies.name[a]}_{bodies.name[b]}{m.suffix}")
        ends = [end(a, m.a), end(b, m.b)]
        if len(ends[0][1]) > 1:  # the first side of a statement has one graphic
            ends.reverse()
        words.append((ends[0][0], ends[1][0], *ends[0][1], *ends[1][1]))
    for a, part in zip(outside.box.tolist(), outside.part.tolist(), strict=True):
        other = model.externals[part]
        names.append(f"con_{bodies.name[a]}_{other.name}")
        given = [v.removeprefix("MODEL.") for v in (other.body, *other.graphics)]
        words.append((body_name(model, a), given[0], f"gbox_{bodies.name[a]}", *given[1:]))
    said = [("POISSON", "ON" if on else "OFF", *row) for on, row in zip(rubs.tolist(), words, strict=True)]
    parts: dict[str, Part] = {n: (numbers[:, k], None) for k, n in enumerate(CONTACT_NUMBERS)}
    return table(names, parts, said)


SIX = ("2", "3", "4", "6", "7", "8")
"""Components of the force and of the torque of a contact, as the solver's function CONTACT counts them."""


def contact_outputs(model: Model) -> Table:
    """Per recorded row of contacts and component: each contact of it, the side that is its second part, the
    component, and the frame that it is along."""
    names, words = [], []
    said = dict(zip(contacts(model).names, contacts(model).words, strict=True))
    mine: dict[int, list[str]] = {}
    for met in meetings(model):
        a, b = (model.bodies.name[int(v[met.pair])] for v in (model.pairs.a, model.pairs.b))
        mine.setdefault(int(model.pairs.contact[met.pair]), []).append(f"con_{a}_{b}{met.suffix}")
    for row in recorded(model):
        on = f"b_{model.contacts.part_b[row]}"
        sides = [(name, "1" if said[name][3] == on else "0") for name in mine[row]]
        for component in SIX:
            names.append(f"{called(model, row)}.{component}")
            words.append(sorted(f"{name} {side} {component} Global_Frame" for name, side in sides))
    return table(names, {}, words)
