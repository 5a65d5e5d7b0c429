"""Points that a text must have."""

from __future__ import annotations

import numpy as np

from mdlgen.altair import labels
from mdlgen.model.shape import apart, ground_frames
from mdlgen.model.tables import (
    SUPPORT,
    Anchor,
    Floats,
    Model,
    SheetPart,
)
from mdlgen.verify.expected.loads import load_points
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.expected.units import reach
from mdlgen.verify.tables import Table, table


def boxes_of(model: Model, sheet: SheetPart) -> range:
    return range(sheet.first, sheet.first + sheet.count)


def anchor_points(model: Model, anchor: Anchor) -> Floats:
    """The point of an anchor on each of its boxes [mm], (n, 3)."""
    bodies = model.bodies
    return bodies.position[anchor.body] + np.einsum("nij,nj->ni", bodies.rotation[anchor.body], anchor.local)


def points(model: Model) -> Table:
    names, places = [], []
    for index, sheet in enumerate(model.sheets):
        names.append(f"p_{sheet.name}")
        places.append(sheet.center[None])
        names += [f"p_{model.bodies.name[b]}" for b in boxes_of(model, sheet)]
        places.append(model.bodies.position[sheet.first : sheet.first + sheet.count])
        rows = np.flatnonzero((model.bushings.sheet == index) & (model.bushings.kind != SUPPORT))
        joints = model.bushings
        ends = zip(joints.node[rows].tolist(), joints.frames[rows].tolist(), rows.tolist(), strict=True)
        first = {labels.node(sheet, x, y, (one, two)): row for (x, y), (one, two), row in ends}
        names += [f"p_{name}" for name in first]
        places.append(joints.origin[list(first.values())])
        frames = [frame for frame in ground_frames(model, index) if frame.point]
        names += [frame.point for frame in frames]
        places += [frame.origin[None] for frame in frames]
    for name, anchor in [(s.name, s) for s in model.supports] + [
        (f"probe_{p.name}", p) for p in model.probes
    ]:
        found = anchor_points(model, anchor)
        split = apart(model, anchor)
        names += [f"p_{name}_{k}" for k in range(len(found))] if split else [f"p_{name}"]
        places.append(found if split else found[:1])
    if len(model.loads.body):
        names += [f"p_frc_{row}" for row in range(len(model.loads.body))]
        places.append(load_points(model))
    for part in model.machine:
        for name, place in kind_of(part).points(model, part):
            names.append(name)
            places.append(place[None])
    return table(names, {"at": (np.concatenate(places), reach(model))})
