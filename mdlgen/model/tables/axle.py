"""Torques, besides those of contacts, on a roller whose spin is unknown: motor, limiter, bearing, shaft."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.geometry.arrays import Floats
from mdlgen.model.tables.bodies import Frozen

# Kinds of an axle: nothing but its bearing; a motor that runs by its voltage; a motor with speed control; a
# stepper; a torque limiter.
FREE, OPEN, CONTROLLED, STEPPER, LIMITER = 0, 1, 2, 3, 4
MOTORS = (OPEN, CONTROLLED, STEPPER)


@dataclass(frozen=True)
class AxlePart(Frozen):
    """Torques on a roller about its axis, all values those at the roller, behind the gear."""

    kind: int  # FREE to LIMITER
    no_load: float  # size of the no-load speed, 0: a stepper whose torque does not fall [rad/ms]
    # of a motor: how much slower than the no-load speed it runs, from 0 on [rad/ms], and its torque [N mm],
    # (n, 2)
    curve: Floats
    inertia: float  # inertia of rotor and shaft [g mm^2]
    gear: float  # turns of the motor for one turn of the roller
    proportional: float = 0.0  # gain of speed control [N mm ms/rad]
    integral: float = 0.0  # gain of its integral part [N mm/rad]
    limit: float = 0.0  # greatest torque of speed control, or of a limiter [N mm]
    creep: float = 1.0  # creep of a limiter [rad/ms]
    poles: float = 0.0  # periods of the torque of a stepper per radian of the roller
    damping: float = 0.0  # damping of a stepper against its field [N mm ms/rad]
    friction: float = 0.0  # friction of the bearing [N mm]
    drag: float = 0.0  # viscous drag of the bearing [N mm ms/rad]
    ease: float = 1.0  # speed over which the bearing's friction changes its sign [rad/ms]
    shaft: str = ""  # name of the shaft that it stands for, "": the roller's own

    @property
    def motor(self) -> bool:
        """True if a motor turns it."""
        return self.kind in MOTORS

    @property
    def stall(self) -> float:
        """Torque of the motor at rest [N mm], 0 without one."""
        return float(self.curve[-1, 1]) if len(self.curve) else 0.0

    def of_curve(self, slow: Floats) -> Floats:
        """Torque of the motor that runs so much slower than its no-load speed [rad/ms], [N mm]: odd, and
        continued beyond its ends."""
        at, torque = self.curve.T
        size = np.abs(slow)
        k = np.clip(np.searchsorted(at, size) - 1, 0, len(at) - 2)
        slope = (torque[k + 1] - torque[k]) / (at[k + 1] - at[k])
        return np.sign(slow) * (torque[k] + slope * (size - at[k]))

    def limits(self, turns: Floats) -> tuple[Floats, Floats]:
        """Least and greatest torque of a motor with speed control at a spin [rad/ms], [N mm]."""
        high, low = self.of_curve(self.no_load - turns), -self.of_curve(self.no_load + turns)
        return np.maximum(low, -self.limit), np.minimum(high, self.limit)

    def begins_behind(self, aims: float) -> float:
        """The integral of speed control at rest that aims at a speed [rad/ms]: where that alone asks for more
        than the motor can give, what asks for just that [rad]."""
        if self.kind != CONTROLLED or self.integral == 0.0:
            return 0.0
        low, high = self.limits(np.zeros(1))
        asked = self.proportional * aims
        return float(np.clip(0.0, (low[0] - asked) / self.integral, (high[0] - asked) / self.integral))
