"""What each box of the sheets does at stored states: the colours of the animation."""

from __future__ import annotations

import numpy as np

from mdlgen.model.guides import depths
from mdlgen.model.rotations import turns
from mdlgen.model.tables import (
    BOX_BOX,
    BOX_CYLINDER,
    BOX_GUIDE,
    BOX_MESH,
    BOX_PLANE,
    GROUND,
    Floats,
    Ints,
    Model,
)
from mdlgen.report import shares
from mdlgen.report.shares import EXPONENT
from mdlgen.report.solids import CORNERS
from mdlgen.results.result import Result
from mdlgen.results.strain import SheetJoints

PER_SECOND = 1000.0


def count(model: Model) -> int:
    """Boxes of all sheets; they come before all other bodies."""
    return sum(sheet.count for sheet in model.sheets)


def speed(result: Result, at: Ints) -> Floats:
    """Of the box centres [mm/s], (t, boxes)."""
    return np.linalg.norm(result.velocity[at, : count(result.model)], axis=2) * PER_SECOND


def greatest(found: tuple[SheetJoints, Floats, Floats] | None, shape: tuple[int, int]) -> Floats:
    """Of `strain.histories`: the greatest membrane strain, in tension, and the greatest curvature [1/mm] of
    the joints of each box, (2, t, boxes)."""
    most = np.zeros((2, *shape))
    if found is None:
        return most
    joints, strains, curvatures = found
    box = np.concatenate([joints.a, joints.b])
    held = np.flatnonzero(box != GROUND)
    order = held[np.argsort(box[held], kind="stable")]
    boxes, first = np.unique(box[order], return_index=True)
    joint = order % len(joints)
    for out, values in zip(most, (np.maximum(strains, 0.0), np.abs(curvatures)), strict=True):
        out[:, boxes] = np.maximum.reduceat(values[:, joint], first, axis=1)
    return most


def contact(result: Result, at: Ints) -> tuple[Floats, Floats]:
    """Normal force of each box [N], (t, boxes), and how deep the deepest box of each row of contacts is [mm],
    (t, rows); of meshes and other sheets 0.

    A solver keeps the force of each pair of parts; it is shared among the pair's boxes as their
    penetrations to the power 1.5 are, with meshes and other sheets over the area that each covers
    (report.shares). A force between two sheets is on the boxes of both.
    """
    model = result.model
    sheets = {sheet.name: sheet for sheet in model.sheets}
    found, deepest = np.zeros((len(at), count(model))), np.zeros((len(at), len(model.contacts)))
    for row, kind in enumerate(model.contacts.kind.tolist()):
        pressed = np.flatnonzero(result.contact_force[at, row] > 0.0)
        if kind in (BOX_MESH, BOX_BOX) and len(pressed):
            one, force = sheets[model.contacts.part_a[row]], result.contact_force[at[pressed], row][:, None]
            name = model.contacts.part_b[row]
            if kind == BOX_MESH:
                mesh = next(m for m in model.meshes if m.name == name)
                parts = [(one, shares.on_mesh(result, one, mesh, at[pressed]))]
            else:
                both = shares.between(result, one, sheets[name], at[pressed])
                parts = list(zip((one, sheets[name]), both, strict=True))
            for sheet, part in parts:
                found[pressed, sheet.first : sheet.first + sheet.count] += part * force
            continue
        if kind not in (BOX_CYLINDER, BOX_PLANE, BOX_GUIDE):
            continue
        mine = model.pairs.contact == row
        boxes = model.pairs.a[mine]
        if not len(pressed) or not len(boxes):
            continue
        other = int(model.pairs.b[mine][0])
        deep = _depths(result, kind, boxes, other, model.contacts.part_b[row], at[pressed])
        deep = np.maximum(deep, 0.0)
        deepest[pressed, row] = deep.max(axis=1)
        weight = deep**EXPONENT
        total = weight.sum(axis=1, keepdims=True)
        part = weight / np.where(total > 0.0, total, 1.0)
        found[np.ix_(pressed, boxes)] += part * result.contact_force[at[pressed], row][:, None]
    return found, deepest


def _depths(result: Result, kind: int, boxes: Ints, other: int, name: str, at: Ints) -> Floats:
    """How deep boxes are in a part [mm], (t, boxes); where they are off it, not above zero."""
    model = result.model
    place = result.position[np.ix_(at, boxes)]
    turn = turns(result.rotation[np.ix_(at, boxes)])
    half = model.bodies.half[boxes]
    if kind == BOX_CYLINDER:
        roller = model.roller(name)
        offset = np.einsum("tnij,tni->tnj", turn, result.position[at, other][:, None] - place)
        along = np.einsum("tnij,i->tnj", turn, roller.axis)
        # the point of the box's middle plane that is nearest to the axis, kept on the box
        reach = np.clip(-np.einsum("tnk,tnk->tn", offset, along), -roller.width / 2, roller.width / 2)
        near = offset + reach[..., None] * along
        beside = np.abs(near[..., :2]) - half[:, :2]
        away = np.hypot(np.maximum(beside[..., 0], 0.0), np.maximum(beside[..., 1], 0.0))
        return roller.radius - np.hypot(away, np.maximum(np.abs(near[..., 2]) - half[:, 2], 0.0))
    if kind == BOX_PLANE:
        plane = next(p for p in model.planes if p.name == name)
        face = result.position[at, other][:, None] + plane.normal * plane.size[2] / 2
        lowest = np.abs(np.einsum("tnij,i->tnj", turn, plane.normal)) * half
        return lowest.sum(axis=2) - (place - face) @ plane.normal
    guide = next(g for g in model.guides if g.name == name)
    corners = place[:, :, None] + np.einsum("tnij,ncj->tnci", turn, CORNERS * half[:, None])
    return depths(guide, corners, place[:, :, None]).max(axis=2)
