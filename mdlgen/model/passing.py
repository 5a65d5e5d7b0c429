"""Sheets that come in and leave during a run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mdlgen.model.tables import BOX_BOX, Floats, Ints, Model, SheetPart

if TYPE_CHECKING:
    from mdlgen.spec.sheet import Sheet

# Part of run.tolerance: a sheet nearer than this to being beyond a plane is beyond it.
NEAR = 0.01
# Part of a step: an event nearer than this to the end of a step is at that end. For a run of 1e6 steps that
# is as short as the round-off of its times.
SAME = 1e-9


def planes_out(sheet: Sheet) -> tuple[tuple[int, float, float], ...]:
    """The planes beyond which a sheet has left, as `SheetPart.out` has them: the side is the one on which it
    does not come in."""
    found = []
    for out in sheet.out:
        if out.axis is not None:
            axis = "xyz".index(out.axis)
            found.append((axis, float(out.at), math.copysign(1.0, out.at - sheet.center[axis])))
    return tuple(found)


def passing(model: Model) -> bool:
    """True if a sheet of a Model may come in or leave during a run."""
    return any(sheet.passes for sheet in model.sheets)


def at_start(model: Model) -> list[bool]:
    """For each sheet, true if it is present as the run begins."""
    return [sheet.enters == 0.0 for sheet in model.sheets]


def share(model: Model) -> float:
    """The part of a run for which sheets are there, in the mean, about: each goes to the nearest plane beyond
    which it has left at its own speed, or that of the fastest drive. Sheets that lie on each other as the run
    begins are fed one after another: half of the run each, in the mean. A rule lets all in that it may."""
    end, drive = model.run.duration, max((abs(r.speed or 0.0) * r.radius for r in model.rollers), default=0.0)
    on_sheets = np.flatnonzero(model.contacts.kind == BOX_BOX)
    stacked = {part for row in on_sheets for part in (model.contacts.part_a[row], model.contacts.part_b[row])}
    stays = 0.0
    for sheet in model.sheets:
        speed = float(np.linalg.norm(sheet.velocity))
        if sheet.name in stacked and sheet.enters == 0.0 and speed == 0.0:
            stays += 0.5 * end
            continue
        begun = 0.0 if math.isnan(sheet.enters) else min(sheet.enters, end)
        fast = max(speed, drive)
        rotation = model.bodies.rotation.reshape(-1, 9)
        ways = -far(model, sheet, model.bodies.position, rotation)
        stays += min(end - begun, float(ways.min()) / fast) if ways.size and fast > 0.0 else end - begun
    return stays / (end * len(model.sheets)) if passing(model) else 1.0


def begun_stays(model: Model) -> Floats | None:
    """`Result.stays` as a run begins: 0 and nan of sheets that are there, nan of others, (sheets, 2); None
    where no sheet comes in or leaves."""
    if not passing(model):
        return None
    stays = np.full((len(model.sheets), 2), np.nan)
    stays[at_start(model), 0] = 0.0
    return stays


def far(
    model: Model,
    sheet: SheetPart,
    position: Floats,
    rotation: Floats,
    solved: NDArray[np.bool_] | None = None,
) -> Floats:
    """How far all of a sheet is beyond each of its planes [mm], (planes,), below 0: it is not, yet.

    `position` (n, 3) [mm] and `rotation` (n, 9) are of all bodies; `solved` (n,): those whose places are
    known, None: all.
    """
    boxes = np.arange(sheet.first, sheet.first + sheet.count)
    if solved is not None:
        boxes = boxes[solved[boxes]]
    half, turn = model.bodies.half[boxes], np.abs(rotation[boxes]).reshape(-1, 3, 3)
    found = [
        (side * (position[boxes, axis] - at) - (turn[:, axis] * half).sum(axis=1)).min()
        for axis, at, side in sheet.out
    ]
    return np.array(found)


def energy_as_they_come(model: Model, boxes: Ints) -> float:
    """Kinetic and potential energy with which boxes come in [N mm]."""
    table = model.bodies
    spin = np.einsum("nji,nj->ni", table.rotation[boxes], table.spin[boxes])
    kinetic = 0.5 * (table.mass[boxes] @ (table.velocity[boxes] ** 2).sum(axis=1))
    kinetic += 0.5 * (table.inertia[boxes] * spin**2).sum()
    return float(kinetic - table.mass[boxes] @ (table.position[boxes] @ model.gravity))
