"""Rows of contacts and of the pairs of bodies that may touch."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from mdlgen.altair.recorded import called, part_of, recorded
from mdlgen.altair.rims import Side, graphics, meetings
from mdlgen.backends.motionview.writer.cells import rough_boxes
from mdlgen.backends.motionview.writer.contact_rows import ContactView, ForceView, Pair
from mdlgen.backends.motionview.writer.parts.kinds import graphics_of
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.model.tables import Model, RollerPart

_ON_A_LINE = 500  # characters of a sum: lines of 528 were seen
_AROUND = len("+CONTACT({.idstring},1,2,{Global_Frame.idstring})")


def contact_views(model: Model, given: dict[str, list[Value]], written: Sequence[int]) -> list[ContactView]:
    """One row for each entry of the spec's list that made one of the contacts `written`."""
    table = model.contacts
    views = []
    for entry, group in groupby(written, key=lambda row: int(table.entry[row])):
        rows = list(group)
        more = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
        label = f"Contact {entry}: {table.part_a[rows[0]]} / {table.part_b[rows[0]]}{more}"
        name = f"contact_{entry}"
        views.append(ContactView(name, label, given[name], table.share[rows[0]]))
    return views


def pair_rows(model: Model) -> list[Pair]:
    """One row for each pair of bodies, and for each sector of a rim in it."""
    bodies, table = model.bodies, model.contacts
    shown = [[f"gbox_{name}"] for name in bodies.name]
    for part in model.machine:
        shown[part.body] = graphics_of(part)
    rollers = {roller.body: roller for roller in model.rollers}
    rubs = [s > 0 or d > 0 for s, d in zip(table.mu_static, table.mu_dynamic, strict=True)]
    rough, rougher = rough_pairs(model), model.pair_friction.tolist()
    data_set = [f"contact_{entry}" for entry in table.entry.tolist()]
    rows, one, two = (c.tolist() for c in (model.pairs.contact, model.pairs.a, model.pairs.b))

    def of(body: int, side: Side) -> list[str]:
        return graphics(rollers[body], side) if body in rollers else shown[body]

    made = []
    for met in meetings(model):
        row, a, b = rows[met.pair], one[met.pair], two[met.pair]
        own = [(body, side) for body, side in ((a, met.a), (b, met.b)) if side.sector >= 0]
        label = f"{bodies.label[a]} / {bodies.label[b]}{met.suffix.replace('_', ' ')}"
        name = f"con_{bodies.name[a]}_{bodies.name[b]}{met.suffix}"
        one_graphic, two_graphics = of(a, met.a), of(b, met.b)
        first, second = (a, b)
        if len(one_graphic) > 1:  # a statement has one graphic on its first side
            first, second, one_graphic, two_graphics = b, a, two_graphics, one_graphic
        factors = [_sector_values(rollers[body], side) for body, side in own]
        made.append(
            Pair(
                name,
                label,
                f"b_{bodies.name[first]}",
                one_graphic[0],
                f"b_{bodies.name[second]}",
                two_graphics,
                "ON" if rubs[row] and rougher[met.pair] * met.friction > 0 else "OFF",
                data_set[row],
                "*".join(v for v in (rough.get(a, ""), rough.get(b, ""), *(f[0] for f in factors)) if v),
                rougher[met.pair] * met.friction,
                "*".join(f[1] for f in factors if f[1]),
                met.stiffness,
                "".join(f[2] for f in factors),
                None if not any(f[2] for f in factors) else met.restitution(0.0),
                _master(one_graphic, two_graphics),
            )
        )
    return made


def force_views(model: Model, pairs: Sequence[Pair]) -> list[ForceView]:
    """One row for each contact of two parts whose force solvers record; `pairs` are those of `pair_rows`."""
    table, bodies = model.contacts, model.bodies
    terms: dict[int, list[tuple[str, int]]] = {row: [] for row in recorded(model)}
    for met, pair in zip(meetings(model), pairs, strict=True):
        row = int(model.pairs.contact[met.pair])
        if row in terms:
            on = f"b_{bodies.name[int(model.pairs.b[met.pair])]}"
            terms[row].append((pair.name, 0 if pair.body_1 == on else 1))
    views = []
    for row, of in terms.items():
        name = called(model, row)
        label = f"Contact of {table.part_a[row]} on {table.part_b[row]}: force, torque"
        parts = _short(of)
        for k, part in enumerate(parts, 1):
            own = name if k == 1 else f"{name}_part{k}"
            views.append(ForceView(own, part_of(label, k, len(parts)), part))
    return views


def _short(terms: list[tuple[str, int]]) -> list[list[tuple[str, int]]]:
    """The terms of a sum in parts, each on a line that is no longer than those that were seen."""
    parts: list[list[tuple[str, int]]] = [[]]
    left = _ON_A_LINE
    for term in terms:
        wide = len(term[0]) + _AROUND
        if parts[-1] and wide > left:
            parts.append([])
            left = _ON_A_LINE
        parts[-1].append(term)
        left -= wide
    return parts


def _master(one: list[str], two: list[str]) -> str:
    """The side with a cylinder where the other has none: its mesh is the finer one (paper, 3.1)."""
    first, second = (any(name.startswith("gcyl_") for name in side) for side in (one, two))
    return "" if first == second else "I" if first else "J"


def _sector_values(roller: RollerPart, side: Side) -> tuple[str, str, str]:
    """References to friction, stiffness and restitution of a sector; empty where it has none of its own."""
    assert roller.rim is not None
    name = roller.rim.name[side.sector]
    if name[0] == "g":
        return "", "", ""
    base = f"ds_{roller.name}.real_{name}_%s.value"
    bouncy = "" if np.isnan(side.restitution) else base % "restitution"
    return base % "friction", base % "stiffness", bouncy


def rough_pairs(model: Model) -> dict[int, str]:
    """Reference to the friction of each box whose sheet has zones."""
    return {sheet.first + k: text for sheet in model.sheets for k, text in enumerate(rough_boxes(sheet))}
