"""Values of each box of the sheets at stored states: the colours of the animation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mdlgen.model.parts.kind import Boxes
from mdlgen.model.parts.kinds import WITH_SHEET
from mdlgen.model.rotations import turns
from mdlgen.model.tables import (
    BOX_BOX,
    BOX_MESH,
    GROUND,
    Floats,
    Ints,
    Model,
)
from mdlgen.results import passing
from mdlgen.results.gates import motion_of, seen
from mdlgen.units import PER_SECOND

if TYPE_CHECKING:
    from mdlgen.results.result import Result
    from mdlgen.results.strain import SheetJoints


def count(model: Model) -> int:
    """Boxes of all sheets; they come before all other bodies."""
    return sum(sheet.count for sheet in model.sheets)


def there(result: Result, at: Ints) -> list[NDArray[np.bool_] | None]:
    """A mask of the boxes present at each of some stored states, (boxes,); None: all."""
    found = passing.there(result)
    if found is None:
        return [None] * len(at)
    counts = [sheet.count for sheet in result.model.sheets]
    return list(np.repeat(found[at], counts, axis=1))


def at_start(model: Model) -> NDArray[np.bool_] | None:
    """A mask of the boxes present as a run begins, (boxes,); if no sheet is, of the first sheet. None:
    all."""
    here = np.array([sheet.enters == 0.0 for sheet in model.sheets])
    here[0] |= not here.any()
    return None if here.all() else np.repeat(here, [sheet.count for sheet in model.sheets])


def speed(result: Result, at: Ints) -> Floats:
    """Speed of the box centres [mm/s], (t, boxes)."""
    return np.linalg.norm(result.velocity[at, : count(result.model)], axis=2) * PER_SECOND


def greatest(found: tuple[SheetJoints, Floats, Floats] | None, shape: tuple[int, int]) -> Floats:
    """Greatest membrane strain, in tension, and greatest curvature [1/mm] of the joints of each box, from
    `strain.histories`, (2, t, boxes)."""
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
    from mdlgen.report import (
        shares,  # the laws of contact take time to load, and most pages need none of them
    )

    model = result.model
    sheets = {sheet.name: sheet for sheet in model.sheets}
    machine = {part.body: part for part in model.machine}
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
        if kind not in WITH_SHEET:
            continue
        mine = model.pairs.contact == row
        boxes = model.pairs.a[mine]
        if not len(pressed) or not len(boxes):
            continue
        body, states = int(model.pairs.b[mine][0]), np.ix_(at[pressed], boxes)
        shown = Boxes(result.position[states], turns(result.rotation[states]), model.bodies.half[boxes])
        place = result.position[at[pressed], body]
        if motion_of(machine[body]) is not None:
            own = seen(result, machine[body], boxes, at[pressed])
            shown = Boxes(own.place, own.turn, shown.half)
            place = np.broadcast_to(model.bodies.position[body], place.shape)
        deep = WITH_SHEET[kind].depths(machine[body], shown, place)
        if deep is None:
            continue
        deep = np.maximum(deep, 0.0)
        deepest[pressed, row] = deep.max(axis=1)
        weight = deep**shares.EXPONENT
        total = weight.sum(axis=1, keepdims=True)
        part = weight / np.where(total > 0.0, total, 1.0)
        found[np.ix_(pressed, boxes)] += part * result.contact_force[at[pressed], row][:, None]
    return found, deepest
