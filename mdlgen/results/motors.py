"""Torques of motors and torque limiters on rollers, by the law in mechanics.axle, and the events they report.

Torques are those on the roller that the motor is at, or on the one that leads its shaft, behind the gear.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.model.axles import STEPS_PER_PERIOD
from mdlgen.model.tables import Floats, RollerPart
from mdlgen.model.tables.axle import CONTROLLED, FREE, LIMITER, OPEN, STEPPER, AxlePart
from mdlgen.results.aims import aimed
from mdlgen.results.stays import intervals

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# A motor stalls if, for longer than STALLS [ms], two things hold. Its roller is slower than SLOW of the speed
# that it aims at, and its torque is above HARD of the most that it can give there. A motor that starts is not
# stalled: in the second half of such a time it is GAINS times as fast as in the first one (3 where it speeds
# up evenly from rest).
SLOW, HARD, STALLS, GAINS = 0.02, 0.9, 5.0, 1.5
# A limiter slips while its roller turns against the shaft at more than this times its creep, for longer than
# SLIPS [ms].
SLIPPING, SLIPS = 2.0, 1.0


def spin(result: Result, roller: RollerPart) -> Floats:
    """About its axis [rad/ms], (t,)."""
    return result.spin[:, roller.body] @ roller.axis


def shaft(result: Result, roller: RollerPart) -> Floats:
    """Speed of the drive of a roller, or that at which its motor aims [rad/ms], (t,)."""
    return aimed(result, roller, result.time) if roller.speed is not None else np.zeros(len(result.time))


def behind(result: Result, roller: RollerPart) -> Floats | None:
    """Angle by which it lags its shaft, or the equivalent of speed control [rad], (t,)."""
    if result.behind is None:
        return None
    own = [part.name for part in result.model.rollers if part.axle is not None]
    return result.behind[:, own.index(roller.name)]


def axle_torque(result: Result, roller: RollerPart) -> Floats | None:
    """Torque of a motor or a limiter on its roller [N mm], (t,); None where a result does not have the angle
    that it follows from."""
    axle = roller.axle
    assert axle is not None, "asked only of a roller with an axle"
    turns, aims = spin(result, roller), shaft(result, roller)
    if axle.kind == FREE:
        return np.zeros(len(result.time))
    if axle.kind == OPEN:
        return axle.of_curve(aims - turns)
    if axle.kind == LIMITER:
        x = np.clip((aims - turns) / axle.creep, -1.0, 1.0)
        return axle.limit * 0.5 * x * (3.0 - x * x)
    lag = behind(result, roller)
    if lag is None:
        return None
    if axle.kind == CONTROLLED:
        asked = axle.proportional * (aims - turns) + axle.integral * lag
        low, high = axle.limits(turns)
        return np.clip(asked, low, high)
    return hold(axle, aims) * np.sin(axle.poles * lag) + axle.damping * (aims - turns)


def hold(axle: AxlePart, aims: Floats) -> Floats:
    """Pull-out torque of a stepper at the speed of its steps."""
    if axle.no_load == 0.0:
        return np.full(len(aims), axle.stall)
    return axle.of_curve(np.maximum(axle.no_load - np.abs(aims), 0.0))


def _most(axle: AxlePart, turns: Floats, aims: Floats) -> Floats:
    """The greatest torque that a motor can give towards the speed at which it aims."""
    if axle.kind == STEPPER:
        return hold(axle, aims)
    if axle.kind == CONTROLLED:
        low, high = axle.limits(turns)
        return np.where(aims < 0.0, -low, high)
    return np.abs(axle.of_curve(aims))


def stalls(result: Result, roller: RollerPart) -> list[tuple[int, int]]:
    """First and last stored state of each time for which its motor stalls. One whose speed is 0 holds."""
    axle, torque = roller.axle, axle_torque(result, roller) if roller.motor else None
    if axle is None or torque is None:
        return []
    turns, aims = spin(result, roller), shaft(result, roller)
    wanted = np.abs(aims) > SLOW * np.abs(aims).max(initial=0.0)
    slow = np.sign(aims) * turns < SLOW * np.abs(aims)
    pulls = np.sign(aims) * torque > HARD * _most(axle, turns, aims)
    if axle.kind == STEPPER:  # out of step its torque goes to and fro
        pulls = np.ones(len(turns), bool)
    time = result.time
    found = intervals(time, wanted & slow & pulls, 0.0)
    found = [(first, last) for first, last in found if time[last] - time[first] > STALLS]
    return [part for part in found if not _gains(np.sign(aims) * turns, *part)]


def _gains(fast: Floats, first: int, last: int) -> bool:
    """True if a roller speeds up between two stored states."""
    middle = (first + last) // 2
    before, after = fast[first : middle + 1].mean(), fast[middle : last + 1].mean()
    return bool(after > 0.0 and after > GAINS * before)


def lost_steps(result: Result, roller: RollerPart) -> tuple[int, Floats] | None:
    """Whole steps that a stepper has lost at the end, below 0: it ran ahead; and over time (t,)."""
    lag = behind(result, roller) if roller.axle is not None and roller.axle.kind == STEPPER else None
    if lag is None or roller.axle is None:
        return None
    # its torque has the same value at each turn of the field
    turns = np.round(lag * roller.axle.poles / (2.0 * np.pi))
    sense = np.sign(roller.speed or 1.0)
    return int(sense * turns[-1]) * STEPS_PER_PERIOD, sense * turns * STEPS_PER_PERIOD


def slips(result: Result, roller: RollerPart) -> list[tuple[int, int]]:
    """First and last stored state of each time for which a limiter slips."""
    axle = roller.axle
    if axle is None or axle.kind != LIMITER:
        return []
    time, off = result.time, np.abs(shaft(result, roller) - spin(result, roller))
    found = intervals(time, off > SLIPPING * axle.creep, 0.0)
    return [(first, last) for first, last in found if time[last] - time[first] > SLIPS]


def motor_record(result: Result, roller: RollerPart) -> dict[str, Any]:
    """Values of the summary for a motor or a limiter apart from torque and power. Motor: is it stalled at the
    end, and stalled time in all; stepper: steps lost; limiter: time of slip."""
    time = result.time
    if len(time) < 2:
        return {}
    record: dict[str, Any] = {}
    if roller.motor:
        found = stalls(result, roller)
        record = {
            "stalled": bool(found) and found[-1][1] == len(time) - 1,
            "stalled_for_ms": float(sum(time[last] - time[first] for first, last in found)),
        }
        if (lost := lost_steps(result, roller)) is not None:
            record["lost_steps"] = lost[0]
    if roller.axle is not None and roller.axle.kind == LIMITER:
        record["limiter_slips_for_ms"] = float(
            sum(time[last] - time[first] for first, last in slips(result, roller))
        )
    return record


def motor_events(result: Result) -> list[dict[str, Any]]:
    """Stalls, lost steps and slipping limiters, as events without a sheet."""
    found: list[dict[str, Any]] = []
    time = result.time
    for roller in result.model.rollers:
        name = {"roller": roller.name}
        for first, last in stalls(result, roller):
            torque = axle_torque(result, roller)
            assert torque is not None, "it stalls by its torque"
            numbers = {
                "duration_ms": float(time[last] - time[first]),
                "torque_n_mm": float(torque[first : last + 1].mean()),
            }
            found.append({"time_ms": float(time[first]), "kind": "stall"} | name | numbers)
        lost = lost_steps(result, roller)
        if lost is not None and lost[0] != 0:
            at = int(np.flatnonzero(lost[1] != 0.0)[0])
            found.append({"time_ms": float(time[at]), "kind": "lost_steps"} | name | {"steps": lost[0]})
        for first, last in slips(result, roller):
            off = (shaft(result, roller) - spin(result, roller))[first : last + 1]
            numbers = {
                "duration_ms": float(time[last] - time[first]),
                "slip_rad": float(np.trapezoid(off, time[first : last + 1])),
            }
            found.append({"time_ms": float(time[first]), "kind": "limiter_slips"} | name | numbers)
    return found
