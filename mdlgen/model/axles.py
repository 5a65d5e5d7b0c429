"""Motors, limiters, bearings and shafts of a scene, as torques on rollers.

A shaft whose speed is prescribed gives each of its rollers a drive of that speed times its ratio. On a shaft
with a motor, or without a drive, the first roller by name leads. Its spin is the unknown of all, the others
turn by their ratio to it, and the torques on the shaft are carried over to it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.model.tables.axle import CONTROLLED, FREE, LIMITER, OPEN, STEPPER, AxlePart
from mdlgen.spec.drive import Drive
from mdlgen.spec.motor import Bearing, Limiter, Motor
from mdlgen.spec.scene import Scene
from mdlgen.spec.shaft import Shaft

STEPS_PER_PERIOD = 4  # whole steps of a motor in one period of its torque


class Turning(NamedTuple):
    """Drive of a roller: its prescribed or target speed, the torques on it, and the leader of its shaft."""

    speed: float | None = None  # [rad/ms], of a profile the greatest in size
    ramp: float = 0.0  # [ms]
    profile: np.ndarray | None = None  # time [ms], speed [rad/ms]
    axle: AxlePart | None = None
    leader: str | None = None
    ratio: float = 1.0  # its turns for one of the leader


def turning(scene: Scene, name: str) -> Turning:
    """The drive of a roller of a scene."""
    roller = scene.rollers[name]
    for called, shaft in scene.shafts.items():
        if name in shaft.rollers:
            if shaft.prescribed:
                assert shaft.drive is not None, "it is prescribed by its drive"
                found = _target(shaft.drive, shaft.rollers[name])
                return found._replace(axle=_axle(None, roller.limiter, None, 1.0, 0.0))
            return _on_shaft(called, shaft, name)
    if roller.drive is None:
        return Turning(axle=_axle(None, roller.limiter, roller.bearing, 1.0, 0.0))
    found = _target(roller.drive, 1.0)
    return found._replace(axle=_axle(roller.drive.motor, roller.limiter, roller.bearing, 1.0, 0.0))


def _on_shaft(called: str, shaft: Shaft, name: str) -> Turning:
    """A roller of a shaft that turns freely or by a motor."""
    leader = min(shaft.rollers)
    own = shaft.rollers[leader]
    found = _target(shaft.drive, shaft.rollers[name]) if shaft.drive is not None else Turning()
    if name != leader:
        return found._replace(leader=leader, ratio=shaft.rollers[name] / own)
    motor = shaft.drive.motor if shaft.drive is not None else None
    axle = _axle(motor, None, shaft.bearing, 1.0 / own, shaft.inertia, called)
    return found._replace(axle=axle)


def _target(drive: Drive, ratio: float) -> Turning:
    """The speed that a drive gives a roller that turns so much faster; of a motor that runs by its voltage,
    the no-load speed."""
    motor = drive.motor
    if motor is not None and motor.open:
        full = ratio * motor.no_load / motor.gear
        if motor.voltage is None:
            return Turning(speed=full)
        profile = np.array([[time, part * full] for time, part in motor.voltage])
        return Turning(speed=_greatest(profile), profile=profile)
    if drive.profile is not None:
        profile = np.array([[time, ratio * speed] for time, speed in drive.profile])
        return Turning(speed=_greatest(profile), profile=profile)
    assert drive.speed is not None, "the spec has one of the two"
    return Turning(speed=ratio * drive.speed, ramp=drive.ramp)


def _greatest(profile: np.ndarray) -> float:
    return max((speed for _, speed in profile.tolist()), key=abs)


def _axle(
    motor: Motor | None,
    limiter: Limiter | None,
    bearing: Bearing | None,
    ratio: float,
    inertia: float,
    shaft: str = "",
) -> AxlePart | None:
    """Torques on a roller; `ratio`: turns of the shaft, where motor and bearing are, for 1 of the roller."""
    if not (motor or limiter or bearing or shaft):
        return None
    times = abs(ratio)
    own: dict[str, float] = {}
    if bearing is not None:
        own |= {"friction": bearing.torque * times, "drag": bearing.drag * times**2}
        own["ease"] = bearing.creep / times
    kind, curve, no_load, gear = FREE, np.zeros((0, 2)), 0.0, times
    inertia *= times**2
    if motor is not None:
        gear = motor.gear * times
        kind = OPEN if motor.open else CONTROLLED if motor.control is not None else STEPPER
        no_load, curve = abs(motor.no_load) / gear, _curve(motor, gear)
        inertia += motor.inertia * gear**2
        if motor.control is not None:
            own |= {
                "proportional": motor.control.proportional * gear**2,
                "integral": motor.control.integral * gear**2,
                "limit": (motor.control.limit or motor.stall) * gear,
            }
        if motor.steps is not None:
            own |= {
                "poles": motor.steps.per_turn / STEPS_PER_PERIOD * gear,
                "damping": motor.steps.damping * gear**2,
            }
    if limiter is not None:
        kind = LIMITER
        own |= {"limit": limiter.torque, "creep": limiter.creep}
    return AxlePart(kind=kind, no_load=no_load, curve=curve, inertia=inertia, gear=gear, shaft=shaft, **own)


def _curve(motor: Motor, gear: float) -> np.ndarray:
    """Torque over how much slower than the no-load speed, both at the roller, rising from 0."""
    if motor.table is None:
        full = abs(motor.no_load) if motor.no_load else math.inf
        slow = full / gear if math.isfinite(full) else 1.0
        return np.array([[0.0, 0.0], [slow, motor.stall * gear]])
    last = motor.table[-1][0]
    rows = [[(last - speed) / gear, torque * gear] for speed, torque in reversed(motor.table)]
    return np.array(rows)
