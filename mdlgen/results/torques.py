"""Torques of rollers from contacts and drives, and the used part of the grip of their contacts.

Signs are those of a rotation about the roller's axis as it is given. The torque of contacts is the sum of
friction and rolling resistance over the roller's contacts and those of meshes on it. The drive supplies the
rest of inertia times angular acceleration: M = I dw/dt - contacts. Its power is M times the speed of its
shaft. A free roller has no drive. A clutch, a limiter or a motor follows its own law (mechanics.driven,
results.motors). The motor of a shaft counts at the roller that leads it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model.tables import Floats, RollerPart
from mdlgen.results.aims import aimed, corners_of
from mdlgen.results.motors import axle_torque, shaft, spin
from mdlgen.results.result import GRIPS, RUBS

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# A contact grips, and has a reserve, where its friction limit is above this part of the greatest one.
GRAZE = 0.05
SAME_TIME = 1e-9  # relative to the run: precision of a time


@dataclass(frozen=True)
class Grip:
    """Friction of one contact over the stored times."""

    other: str  # the other part
    along: Floats  # along the roller's surface, as it turns [N], (t,)
    limit: Floats  # the most that it can be, mu_static times the normal force [N], (t,)

    @property
    def used(self) -> Floats:
        """Part of the grip that is used, |T| / (mu N), (t,); nan where the contact does not act."""
        acts = self.limit > GRAZE * self.limit.max(initial=0.0)
        return np.where(acts, np.abs(self.along) / np.where(acts, self.limit, 1.0), np.nan)


def rows_of(result: Result, roller: RollerPart) -> Iterator[tuple[int, int, str]]:
    """Contact rows of a roller and of meshes on it: row, which side of it is the roller, the other part."""
    contacts, model = result.model.contacts, result.model
    mine = {roller.name, *(m.name for m in model.meshes if m.on >= 0 and model.rollers[m.on] is roller)}
    for row, ends in enumerate(zip(contacts.part_a, contacts.part_b, strict=True)):
        for side in (0, 1):
            if ends[side] in mine:
                yield row, side, ends[1 - side]


def contact_torque(result: Result, roller: RollerPart) -> Floats | None:
    """Torque of contacts on a roller about its axis [N mm], (t,); None where a result does not have it."""
    if result.contact_torque is None:
        return None
    total = np.zeros(len(result.time))
    for row, side, _ in rows_of(result, roller):
        total += result.contact_torque[:, row, side]
    return total


def drive_torque(result: Result, roller: RollerPart) -> Floats | None:
    """Torque of the drive on a roller about its axis [N mm], (t,), 0 for a free one."""
    if roller.axle is not None:
        return axle_torque(result, roller)
    if roller.speed is None or roller.leader >= 0:
        return np.zeros(len(result.time))
    if roller.one_way is not None:
        return _clutch(result, roller)
    contacts = contact_torque(result, roller)
    if contacts is None:
        return None
    return roller.loaded_inertia * _acceleration(result, roller) - contacts


def drive_power(result: Result, roller: RollerPart) -> Floats | None:
    """Power of the drive of a roller [W], (t,): its torque times the speed of its shaft, in N mm/ms; of a
    motor behind its gear."""
    torque = drive_torque(result, roller)
    if torque is None:
        return None
    return torque * (spin(result, roller) if roller.motor else shaft(result, roller))


def grips(result: Result, roller: RollerPart) -> list[Grip]:
    """Friction of each of its contacts; none where a result does not have it."""
    if result.contact_friction is None:
        return []
    axes = {part.name: part.axis for part in result.model.rollers}
    found = []
    for row, side, other in rows_of(result, roller):
        along, limit = result.contact_friction[:, row, RUBS], result.contact_friction[:, row, GRIPS]
        # of two rollers the second one counts; friction turns both alike about one axis
        turned = side == 0 and other in axes and float(roller.axis @ axes[other]) < 0.0
        found.append(Grip(other, -along if turned else along, limit))
    return found


def over_time(result: Result, values: Floats) -> float:
    """Mean of values at the stored times over the run; of one state alone that value."""
    time = result.time
    if len(time) < 2 or time[-1] <= time[0]:
        return float(values[-1]) if len(values) else 0.0
    return float(0.5 * (values[1:] + values[:-1]) @ np.diff(time) / (time[-1] - time[0]))


def peak(values: Floats) -> float:
    """The value that is greatest in size, with its sign."""
    return float(values[np.abs(values).argmax()]) if len(values) else 0.0


def _acceleration(result: Result, roller: RollerPart) -> Floats:
    """Angular acceleration about its axis of a driven roller [rad/ms^2], (t,).

    At a corner of the drive lattice has contacts between those before and after it, exudyn those before; and
    so the acceleration is.
    """
    time, corners = result.time, corners_of(result, roller)
    spans = np.diff(corners[:, 0])
    # the inertia of a jump is taken at once, between two stored times
    slopes = np.where(spans > 0.0, np.diff(corners[:, 1]) / np.where(spans > 0.0, spans, 1.0), 0.0)
    inner = np.concatenate([[0.0], slopes, [0.0]])
    near = SAME_TIME * max(result.model.run.duration, float(time[-1])) if len(time) else 0.0
    after = inner[np.searchsorted(corners[:, 0], time + near)]
    before = inner[np.searchsorted(corners[:, 0], time - near)]
    between = 0.5 * (before + after) if result.solver == "lattice" else before
    found = np.where(time > 0.0, between, after)
    if roller.arm is not None and len(time) > 1:  # the drive turns against the arm
        swung = result.spin[:, roller.body] @ roller.axis - aimed(result, roller, time)
        found = found + np.gradient(swung, time)
    return found


def _clutch(result: Result, roller: RollerPart) -> Floats:
    """Torque of the shaft on a roller through its clutch, see mechanics.driven.clutch."""
    way = roller.one_way
    assert way is not None, "asked only of a roller with a clutch"
    behind = aimed(result, roller, result.time) - result.spin[:, roller.body] @ roller.axis
    s = np.maximum(way.direction * behind / way.creep, 0.0)
    return way.direction * 2.0 * way.torque * s * s / (1.0 + s)
