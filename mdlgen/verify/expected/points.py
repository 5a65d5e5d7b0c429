"""Points that a text must have."""

from __future__ import annotations

import numpy as np

from mdlgen.altair import labels
from mdlgen.altair.rims import rim_facets
from mdlgen.model.meshes import origin as mesh_origin
from mdlgen.model.parts.guide import Facet, facets
from mdlgen.model.shape import apart, ground_frames
from mdlgen.model.tables import (
    SUPPORT,
    Anchor,
    Floats,
    Model,
    PlanePart,
    RollerPart,
    SheetPart,
)
from mdlgen.verify.expected.units import reach
from mdlgen.verify.tables import Table, table


def boxes_of(model: Model, sheet: SheetPart) -> range:
    return range(sheet.first, sheet.first + sheet.count)


def anchor_points(model: Model, anchor: Anchor) -> Floats:
    """The point of an anchor on each of its boxes [mm], (n, 3)."""
    bodies = model.bodies
    return bodies.position[anchor.body] + np.einsum("nij,nj->ni", bodies.rotation[anchor.body], anchor.local)


def spring_anchor(part: RollerPart | PlanePart) -> Floats:
    press = part.press
    assert press is not None
    return part.center + press.direction * (press.touch - press.free_length)


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
    for roller in model.rollers:
        names.append(f"p_{roller.name}")
        places.append(model.bodies.position[roller.body][None])
        for name, facet in rim(model, roller):
            names.append(f"p_{name}")
            places.append(facet.center[None])
        if roller.press is not None:
            names.append(f"p_{roller.name}_anchor")
            places.append(spring_anchor(roller)[None])
        if roller.arm is not None:
            names += [f"p_{roller.name}_pivot", f"p_{roller.name}_arm"]
            places += [roller.arm.pivot[None], roller.arm.center[None]]
    for plane in model.planes:
        names.append(f"p_{plane.name}")
        places.append(model.bodies.position[plane.body][None])
        if plane.press is not None:
            names.append(f"p_{plane.name}_anchor")
            places.append(spring_anchor(plane)[None])
    for guide in model.guides:
        names += [f"p_{guide.name}", *(f"p_{guide.name}_{k}" for k in range(guide.facets))]
        places += [guide.center[None], *(facet.center[None] for facet in facets(guide))]
    for mesh in model.meshes:
        names += [f"p_{mesh.name}", f"p_{mesh.name}_cm"]
        places += [mesh_origin(mesh, model.rollers)[None], model.bodies.position[mesh.body][None]]
    return table(names, {"at": (np.concatenate(places), reach(model))})


def rim(model: Model, roller: RollerPart) -> list[tuple[str, Facet]]:
    body = roller.body
    return rim_facets(roller, model.bodies.position[body], model.bodies.rotation[body])
