"""Detects stubs of a sheet: an outer side that comes to the end of a plate, below its face, and stops there.

It is read from the stored states, by the rule of mechanics.edge: a side that stands before an end, between
both faces of the plate, does so until it is above or below the plate, or has gone over the edge's round.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mdlgen.model.ends import End, Slab, ends, slab
from mdlgen.model.rotations import turns
from mdlgen.model.tables import ON_PLATES, Floats, GuidePart, PlanePart
from mdlgen.results.gates import motion_of, seen

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# A side that has come to an end no faster than this [mm/ms] was laid there. It is stopped where its speed
# falls below this part of the speed at which it came, no further than this from the end [mm].
STANDS, STOPPED, NEAR = 0.01, 0.1, 1.0
_FACES = 0.35  # cosine of the angle between a side and an end that it comes to, as in mechanics.beside


class Stop(NamedTuple):
    """A sheet at the end of a plate."""

    sheet: str
    part: str
    held: np.ndarray  # true if a side of it is stopped there, (t,)
    below: Floats  # how far the deeper corner of what is stopped is below the face that is touched [mm], (t,)
    force: Floats  # of the sheet on the plate [N], (t,)


def stops(result: Result) -> list[Stop]:
    """Each sheet and plate in contact where an end of one stops the other at a stored state."""
    model, found = result.model, []
    parts: dict[str, PlanePart | GuidePart] = {p.name: p for p in (*model.planes, *model.guides)}
    for row in np.flatnonzero(np.isin(model.contacts.kind, ON_PLATES)).tolist():
        plate = slab(parts[model.contacts.part_b[row]])
        boxes = model.pairs.a[model.pairs.contact == row]
        boxes = boxes[model.bodies.exposed[boxes].any(axis=1)]
        if not len(boxes) or not plate.part.ends:
            continue
        held, below = np.zeros(len(result.time), bool), np.zeros(len(result.time))
        for end in ends(plate):
            if plate.part.ends & (1 << end.number):
                for side in range(4):
                    mine = boxes[model.bodies.exposed[boxes, side]]
                    if len(mine):
                        _side(result, plate, end, mine, side, held, below)
        if held.any():
            force = result.contact_force[:, row]
            found.append(Stop(model.contacts.part_a[row], model.contacts.part_b[row], held, below, force))
    return found


def _side(
    result: Result, plate: Slab, end: End, boxes: Any, side: int, held: np.ndarray, below: Floats
) -> None:
    """Adds where one side of some boxes is stopped by an end."""
    p, sign, thick = side // 2, 1.0 if side % 2 else -1.0, 2.0 * plate.half[2]
    half, body = result.model.bodies.half[boxes], plate.part.body
    if motion_of(plate.part) is None:
        moved = result.position[:, body] - result.position[0, body]
        middle = result.position[:, boxes] - moved[:, None] - end.point
        turn, spin = turns(result.rotation[:, boxes]), result.spin[:, boxes]
        rate = result.velocity[:, boxes] - result.velocity[:, body, None]
    else:
        place, turn, rate, spin = seen(result, plate.part, boxes, slice(None))
        middle = place - end.point
    way = sign * turn[..., p]
    faces = -(way @ end.out) > _FACES
    if not faces.any():
        return
    corners = np.stack(
        [
            middle
            + half[:, p, None] * way
            + t * half[:, 1 - p, None] * turn[..., 1 - p]
            + up * half[:, 2, None] * turn[..., 2]
            for t in (-1.0, 1.0)
            for up in (-1.0, 1.0)
        ]
    )
    inside = -(corners @ end.out).min(axis=0)
    depth = -(corners @ end.up)
    across = corners @ end.along
    beside = (depth.max(axis=0) > 0.0) & (depth.min(axis=0) < thick)
    beside &= (across.min(axis=0) < end.length) & (across.max(axis=0) > -end.length)
    if not (beside & faces & (inside <= 0.0)).any():  # none comes from outside
        return
    arm = half[:, p, None] * way
    rate = rate + np.cross(spin, arm)
    speed = -(rate @ end.out)
    stays, fastest = np.zeros(len(boxes), bool), np.zeros(len(boxes))
    for t in range(len(result.time)):
        out = inside[t] <= 0.0
        stays = beside[t] & ((out & (faces[t] | stays)) | (~out & stays))
        fastest = np.where(stays & out, np.maximum(fastest, speed[t]), np.where(stays, fastest, 0.0))
        stopped = stays & (inside[t] > -NEAR) & (fastest > STANDS) & (speed[t] < STOPPED * fastest)
        if stopped.any():
            held[t] = True
            deep = depth[:, t][:, stopped].max(axis=0)
            if plate.faces == (-1.0,):
                deep = thick - depth[:, t][:, stopped].min(axis=0)
            below[t] = max(below[t], float(deep.max()))
