"""The speed of a driven roller over time, and a clutch that lets a roller turn freely in one sense.

A body record has `corners`, the number of corners of its law; `drive`, time and speed of each in turn;
`clutch`, the free sense of rotation (1 or -1 about the axis, 0: no clutch), a torque, and the speed at which
it acts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.model.limits import MOST_CORNERS
from mdlgen.model.tables import RollerPart
from mdlgen.program.kernel import njit

# Columns of a record's `clutch`.
SENSE, TORQUE, CREEP = 0, 1, 2
CLUTCH = [("clutch", "f8", 3)]
DRIVE = [("corners", "i8"), ("drive", "f8", 2 * MOST_CORNERS)]


class Clutch(NamedTuple):
    """Action of a clutch: the torque on the roller, its decrease per spin, the shaft's speed."""

    torque: float
    growth: float
    shaft: float


def drive(row: np.void, roller: RollerPart, time: float = 1.0, torque: float = 1.0) -> None:
    """Fills the fields of DRIVE and CLUTCH of a body record for a roller; `time` is a millisecond in the
    solver's units, `torque` a newton millimetre."""
    if roller.leader >= 0:
        return  # it turns with its leader
    corners = roller.corners * (time, 1.0 / time)
    if not len(corners) and roller.axle is not None:
        corners = np.zeros((1, 2))  # the shaft of a limiter that ground holds
    row["corners"] = len(corners)
    row["drive"][: corners.size] = corners.ravel()
    if roller.one_way is not None:
        way = roller.one_way
        row["clutch"] = (way.direction, way.torque * torque, way.creep / time)


@njit(cache=True, error_model="numpy", forceinline=True)
def prescribed(body, t):
    """Speed of a driven roller, or of the shaft of a clutch: linear between corners, constant beyond them, 0
    without any."""
    last = 2 * body.corners - 1
    if last < 0:
        return 0.0
    if t <= body.drive[0]:
        return body.drive[1]
    for i in range(2, last, 2):
        if t < body.drive[i]:
            before = body.drive[i - 1]
            share = (t - body.drive[i - 2]) / (body.drive[i] - body.drive[i - 2])
            return before + share * (body.drive[i + 1] - before)
    return body.drive[last]


@njit(cache=True, error_model="numpy")
def turned(body, t):
    """Angle by which a driven roller has turned since time 0."""
    last = 2 * body.corners - 2
    if last < 0:
        return 0.0
    angle, before, fast = 0.0, 0.0, prescribed(body, 0.0)
    for i in range(0, last + 2, 2):
        until = min(max(body.drive[i], 0.0), t)
        speed = prescribed(body, until)
        angle += 0.5 * (fast + speed) * (until - before)
        before, fast = until, speed
    return angle + fast * (t - before)


@njit(cache=True, error_model="numpy", forceinline=True)
def clutch(body, spin, t):
    """The Clutch at a spin about the axis.

    With b the speed against the free sense, relative to the shaft, and s = b / creep, the torque towards
    the free sense is 2 torque s^2 / (1 + s): nothing where b <= 0, `torque` at b = creep, and in proportion
    beyond. It has a continuous slope, and its power relative to the shaft is never positive.
    """
    sense, torque, creep = body.clutch[SENSE], body.clutch[TORQUE], body.clutch[CREEP]
    if sense == 0.0:
        return Clutch(0.0, 0.0, 0.0)
    shaft = prescribed(body, t)
    s = sense * (shaft - spin) / creep
    if s <= 0.0:
        return Clutch(0.0, 0.0, shaft)
    more = 1.0 + s
    return Clutch(
        sense * 2.0 * torque * s * s / more, 2.0 * torque / creep * s * (s + 2.0) / (more * more), shaft
    )
