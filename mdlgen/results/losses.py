"""Energy that drives bring in and contacts take by friction and rolling, part by part, from the stored
states.

The loss of a contact is its friction and torques, as the solvers store them, times the slip of the surfaces.
Where a sheet lies on a roller the slip is that of its contact line. On a plane or guide it is the velocity of
the boxes that touch it, weighted by their depths to the power 1.5. Two parts of the machine dissipate what
one does not pass on to the other: - (M_a w_a + M_b w_b).

Contacts of sheets with each other and of meshes, and damping of normal forces, joints and presses, have no
such account. Together they are the rest of all that the run dissipated. Integrals are trapezoids over the
stored states, so that a loss between two of them is missed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.model.parts.kind import Boxes
from mdlgen.model.parts.kinds import KINDS, WITH_SHEET
from mdlgen.model.rotations import column, turns
from mdlgen.model.tables import (
    BOX_BOX,
    BOX_CYLINDER,
    EXTERNAL,
    Floats,
    MachinePart,
    RollerPart,
)
from mdlgen.results.contact_line import of_row, surface_ratio
from mdlgen.results.gates import motion_of, seen
from mdlgen.results.result import ON_B, RUBS
from mdlgen.results.torques import drive_power

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# Depths to this power are forces (Eq. 10).
EXPONENT = 1.5
MOST = 20_000  # boxes, times states, that are evaluated together
STANDS = 1e-9  # [mm/ms]: a slower surface has no direction
# kinds of contacts without an account: depths do not say how their force is shared
_BY_AREA = [kind for kind in KINDS if kind.by_area]
_WITHOUT = {
    BOX_BOX,
    EXTERNAL,
    *(number for kind in _BY_AREA for number in (kind.with_sheet, kind.with_roller)),
}


@dataclass(frozen=True)
class Losses:
    """Power that contacts take by friction and rolling [N mm/ms = W], by their row, (t,); rows without an
    account are not in it."""

    rows: dict[int, Floats]

    def of(self, result: Result, part: MachinePart) -> Floats | None:
        """Power lost by a part of the machine: all at its contacts with sheets, and half of that between it
        and another part; None where none of its contacts has an account."""
        contacts, sheets = result.model.contacts, {sheet.name for sheet in result.model.sheets}
        found = []
        for row, power in self.rows.items():
            ends = contacts.part_a[row], contacts.part_b[row]
            if part.name in ends:
                found.append(power if sheets & set(ends) else 0.5 * power)
        return reduce(add, found) if found else None


def losses(result: Result) -> Losses | None:
    """Of a run; None where a result does not have friction, or does not go on in time."""
    if result.contact_friction is None or result.contact_torque is None or len(result.time) < 2:
        return None
    contacts, found = result.model.contacts, {}
    for row, kind in enumerate(contacts.kind.tolist()):
        if kind in _WITHOUT:
            continue
        acts = np.flatnonzero(result.contact_force[:, row] > 0.0)
        power = np.zeros(len(result.time))
        if len(acts):
            if kind == BOX_CYLINDER:
                power[acts] = _on_roller(result, row)
            elif kind in WITH_SHEET:
                power[acts] = _on_plate(result, row, acts)
            else:
                power[acts] = _in_machine(result, row, acts)
        found[row] = power
    return Losses(found)


def driven(result: Result, roller: RollerPart) -> Floats | None:
    """Energy that a drive has given since the start [N mm], (t,); None of a roller without one."""
    power = drive_power(result, roller) if roller.driven else None
    return None if power is None else summed(result, power)


def summed(result: Result, power: Floats) -> Floats:
    """Energy since the start [N mm], (t,)."""
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(result.time)
    return np.concatenate([[0.0], np.cumsum(steps)])


def kinetic(result: Result, bodies: slice, at: int) -> float:
    """Kinetic energy of some bodies at a stored state [N mm]."""
    table = result.model.bodies
    speed, spin = result.velocity[at, bodies], result.spin[at, bodies]
    own = np.einsum("nij,ni->nj", turns(result.rotation[at, bodies]), spin)
    moving = 0.5 * float(table.mass[bodies] @ (speed * speed).sum(axis=1))
    return moving + 0.5 * float((table.inertia[bodies] * own * own).sum())


def _on_roller(result: Result, row: int) -> Floats:
    """Power lost by a sheet on a roller: friction against its slip, and the rolling couple against the
    roller."""
    assert result.contact_friction is not None and result.contact_torque is not None
    roller = result.model.roller(result.model.contacts.part_b[row])
    at, line = of_row(result, row)
    slip = line.sheet - line.roller
    spin = result.spin[at, roller.body] @ roller.axis
    # along the surface as it turns about the axis
    size = np.linalg.norm(line.roller, axis=1)
    way = np.sign(spin)[:, None] * line.roller / np.maximum(size, STANDS)[:, None]
    radius = np.full(len(at), roller.radius)
    if roller.cover is not None:  # friction has the lever of its speed
        radius = radius * surface_ratio(result, roller, at)
    across = slip - (slip @ roller.axis)[:, None] * roller.axis
    friction, torque = result.contact_friction[at, row, RUBS], result.contact_torque[at, row, ON_B]
    turned = size > STANDS
    signed = np.einsum("ti,ti->t", slip, way)
    rubbed = np.where(turned, friction * signed, np.abs(friction) * np.linalg.norm(across, axis=1))
    rolled = -(torque - friction * radius) * spin if roller.rim is None else np.zeros(len(at))
    return np.where(line.share > 0.0, rubbed, 0.0) + rolled


def _on_plate(result: Result, row: int, at: Any) -> Floats:
    """Power lost by a sheet on a plane or guide: size of the friction times the speed of the touching
    boxes."""
    assert result.contact_friction is not None
    model, mine = result.model, result.model.pairs.contact == row
    boxes = model.pairs.a[mine]
    if not len(boxes):
        return np.zeros(len(at))
    part = next(p for p in model.machine if p.name == model.contacts.part_b[row])
    kind, half = WITH_SHEET[int(model.contacts.kind[row])], model.bodies.half[boxes]
    few, speeds = max(1, MOST // len(boxes)), []
    for begin in range(0, len(at), few):
        some = at[begin : begin + few]
        states = np.ix_(some, boxes)
        shown = Boxes(result.position[states], turns(result.rotation[states]), half)
        rate = result.velocity[states] - result.velocity[some, part.body][:, None]
        normal = column(result.rotation[states], 2)
        at_part = result.position[some, part.body]
        if motion_of(part) is not None:
            own = seen(result, part, boxes, some)
            shown, rate, normal = Boxes(own.place, own.turn, half), own.rate, own.turn[..., 2]
            at_part = np.broadcast_to(model.bodies.position[part.body], at_part.shape)
        deep = kind.depths(part, shown, at_part)
        if deep is None:
            return np.zeros(len(at))
        weight = np.maximum(deep, 0.0) ** EXPONENT
        total = weight.sum(axis=1, keepdims=True)
        weight = np.where(total > 0.0, weight / np.where(total > 0.0, total, 1.0), 1.0 / len(boxes))
        # of the middle of each box, along its own face
        along = rate - normal * np.einsum("tni,tni->tn", rate, normal)[..., None]
        speeds.append(np.einsum("tn,tn->t", weight, np.linalg.norm(along, axis=2)))
    return result.contact_friction[at, row, RUBS] * np.concatenate(speeds)


def _in_machine(result: Result, row: int, at: Any) -> Floats:
    """Between two parts of the machine, of which those that are no rollers do not turn."""
    assert result.contact_torque is not None
    model, found = result.model, np.zeros(len(at))
    axes = {roller.name: roller for roller in model.rollers}
    for side, name in enumerate((model.contacts.part_a[row], model.contacts.part_b[row])):
        if name in axes:
            spin = result.spin[at, axes[name].body] @ axes[name].axis
            found -= result.contact_torque[at, row, side] * spin
    return found
