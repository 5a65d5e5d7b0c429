"""Contact line of a sheet on a roller, and the velocities of both there."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.model.covers import speed_ratio
from mdlgen.model.rotations import turns
from mdlgen.model.tables import BOX_CYLINDER, Floats, Ints, RollerPart

if TYPE_CHECKING:
    from mdlgen.results.result import Result

MOST = 20_000  # boxes, times states, that are evaluated together
# Across the axis a box counts this part of a radius beyond its face: at a joint that bends away from the
# roller the axis passes over neither box.
BESIDE = 0.1
LEVEL = 1e-12  # an axis that is so nearly along a face's side is taken to be


@dataclass(frozen=True)
class ContactLine:
    """The line of a roller that a sheet lies on, at some times; means over the boxes, by their part of it."""

    share: Floats  # length of the line that lies on boxes [mm], 0: none, (t,)
    sheet: Floats  # velocity of the sheet there, along its face [mm/ms], (t, 3)
    roller: Floats  # and of the roller's surface
    low: Floats  # where it begins and ends, along the x, y or z that is nearest to the axis [mm], (t,)
    high: Floats


def of_row(result: Result, row: int) -> tuple[Ints, ContactLine]:
    """The stored states at which a sheet touches a roller, and the contact line there. It is cached, since
    events and losses both use it."""
    if row not in result.lines:
        at = np.flatnonzero(result.contact_force[:, row] > 0.0)
        boxes = result.model.pairs.a[result.model.pairs.contact == row]
        roller = result.model.roller(result.model.contacts.part_b[row])
        result.lines[row] = at, contact_line(result, boxes, roller, at)
    return result.lines[row]


def chosen(line: ContactLine, which: Ints) -> ContactLine:
    """Some of the states of a line."""
    return ContactLine(*(getattr(line, f.name)[which] for f in fields(line)))


def contact_line(result: Result, boxes: Ints, roller: RollerPart, at: Ints) -> ContactLine:
    """The contact line of some boxes of a sheet at the stored states `at`."""
    few = max(1, MOST // max(1, len(boxes)))
    parts = [_contact_line(result, boxes, roller, at[k : k + few]) for k in range(0, max(len(at), 1), few)]
    return ContactLine(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(ContactLine)))


def surface_ratio(result: Result, roller: RollerPart, at: Ints) -> Floats:
    """Speed of what rolls on a roller with a cover over that of its undeformed surface, by the force that all
    sheets have on it, (t,)."""
    assert roller.cover is not None, "asked only of one with a cover"
    table = result.model.contacts
    rows = [row for row in np.flatnonzero(table.kind == BOX_CYLINDER) if table.part_b[row] == roller.name]
    return np.asarray(speed_ratio(roller.cover, result.contact_force[np.ix_(at, rows)].sum(axis=1)))


def _contact_line(result: Result, boxes: Ints, roller: RollerPart, at: Ints) -> ContactLine:
    half, radius, axis = result.model.bodies.half[boxes], roller.radius, roller.axis
    center = result.position[at, roller.body][:, None]  # (t, 1, 3)
    place = result.position[np.ix_(at, boxes)]  # (t, boxes, 3)
    turn = turns(result.rotation[np.ix_(at, boxes)])
    # the axis, seen by each box, over its face: from where to where it passes
    offset = np.einsum("tnij,tni->tnj", turn, center - place)
    along = np.einsum("tnij,i->tnj", turn, axis)
    begin, end = np.full(offset.shape[:2], -roller.width / 2), np.full(offset.shape[:2], roller.width / 2)
    for k in (0, 1):
        level = np.abs(along[..., k]) < LEVEL
        slope = np.where(level, 1.0, along[..., k])
        side = half[:, k] + BESIDE * radius * (1.0 - along[..., k] ** 2)
        one, two = (-side - offset[..., k]) / slope, (side - offset[..., k]) / slope
        far = np.where(np.abs(offset[..., k]) <= side, np.inf, -np.inf)
        begin = np.maximum(begin, np.where(level, -far, np.minimum(one, two)))
        end = np.minimum(end, np.where(level, far, np.maximum(one, two)))
    near = np.abs(offset[..., 2]) < 1.5 * radius + half[:, 2]
    known = near & (end > begin)
    begin, end = np.where(known, begin, 0.0), np.where(known, end, 0.0)
    length = end - begin
    share = length.sum(axis=1)
    weight = length / np.where(share > 0.0, share, 1.0)[:, None]
    on = length > 0.0
    # the point of the surface in the middle of that, towards the box
    normal = turn[..., 2] * np.sign(offset[..., 2])[..., None]
    out = normal - (normal @ axis)[..., None] * axis
    size = np.linalg.norm(out, axis=2, keepdims=True)
    middle = 0.5 * (begin + end)[..., None]
    point = center + middle * axis - radius * out / np.where(size > 0.0, size, 1.0)

    def mean(rate: Any) -> Floats:
        flat = rate - normal * np.einsum("tni,tni->tn", rate, normal)[..., None]
        return np.einsum("tn,tni->ti", weight, flat)

    own = np.cross(result.spin[np.ix_(at, boxes)], point - place) + result.velocity[np.ix_(at, boxes)]
    rim = np.cross(result.spin[at, roller.body][:, None], point - center)
    if roller.cover is not None:
        rim = rim * surface_ratio(result, roller, at)[:, None, None]
    rim += result.velocity[at, roller.body][:, None]
    main = int(np.argmax(np.abs(axis)))
    ends = [center[..., main] + side * axis[main] for side in (begin, end)]
    low = np.where(on, np.minimum(*ends), np.inf).min(axis=1, initial=np.inf)
    high = np.where(on, np.maximum(*ends), -np.inf).max(axis=1, initial=-np.inf)
    return ContactLine(share, mean(own), mean(rim), low, high)
