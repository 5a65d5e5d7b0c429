"""Motors of rollers and shafts, what their bearings take, and torque limiters."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any

from pydantic import BeforeValidator, ConfigDict, Field, model_validator

from mdlgen.spec.fields import TimeOrZero, one_of
from mdlgen.spec.quantities import default, quantity, ratio
from mdlgen.spec.strict import Strict, fail

MOST_POINTS = 16  # of a table of torques, and of a profile of voltage: a solver keeps them in one row


def pair_of(example: str):
    """Reads a list of two; the example says which."""

    def read(value: Any) -> Any:
        if not isinstance(value, (list, tuple)) or len(value) != 2:
            raise fail(f"expected two values like {example}, got {value!r}"[:200])
        return tuple(value)

    return BeforeValidator(read)


Torque = Annotated[float, quantity("N*mm", 0.0, open_low=True)]
TorqueOrZero = Annotated[float, quantity("N*mm", 0.0)]
Speed = Annotated[float, quantity("rad/s", 0.0, open_low=True)]
Inertia = Annotated[float, quantity("g*mm^2", 0.0)]
Drag = Annotated[float, quantity("N*mm*ms/rad", 0.0)]
Gain = Annotated[float, quantity("N*mm*ms/rad", 0.0, open_low=True)]
Point = Annotated[
    tuple[Annotated[float, quantity("rad/s", 0.0)], TorqueOrZero], pair_of("['100 rad/s', '20 N*mm']")
]
Voltage = Annotated[tuple[TimeOrZero, Annotated[float, ratio(-1.0, 1.0)]], pair_of("['5 ms', 1]")]


class Bearing(Strict):
    """Losses in the bearing of a roller or a shaft: friction and viscous drag."""

    torque: TorqueOrZero = Field(
        default=default("0 N*mm"), description="friction torque, whatever the speed is"
    )
    drag: Drag = Field(
        default=default("0 N*mm*ms/rad"), description="viscous drag: torque in proportion to the speed"
    )
    creep: Speed = Field(
        default=default("0.1 rad/s"),
        description="speed over which the friction torque changes its sign. Held by less than that torque, "
        "the roller creeps slower than this",
    )


class Limiter(Strict):
    """A torque limiter between the shaft and the roller. The shaft is the drive, or ground where there is
    none."""

    torque: Torque = Field(description="torque at which it slips")
    creep: Speed = Field(
        default=default("0.1 rad/s"),
        description="speed of the roller against its shaft at which the limiter has its whole torque",
    )


class Control(Strict):
    """Speed control: torque by the error of the speed and of the angle, within the limits of the motor."""

    proportional: Gain = Field(description="torque of the motor for its error of speed")
    integral: Annotated[float, quantity("N*mm/rad", 0.0)] = Field(
        default=default("0 N*mm/rad"),
        description="torque of the motor for its error of angle, the integral of that of its speed; where "
        "the torque is at its limit, the integral is held there (anti-windup)",
    )
    limit: Torque | None = Field(
        default=None, description="greatest torque, by the current; the stall torque where left out"
    )


class Steps(Strict):
    """A stepper: the torque is that of a magnet, T = torque sin(N/4 (target - angle)), N steps per turn."""

    per_turn: Annotated[int, Field(ge=4, le=4000)] = Field(
        default=200, description="whole steps of the motor per turn, four for each period of the torque"
    )
    damping: Drag = Field(
        default=default("0 N*mm*ms/rad"), description="damping of the motor against its turning field"
    )


class Motor(Strict):
    """A motor with a limited torque. All values are those of its own shaft, before the gear."""

    model_config = ConfigDict(json_schema_extra=one_of("torque", "table"))

    torque: Torque | None = Field(
        default=None, description="stall torque; of a stepper the greatest holding torque"
    )
    speed: Annotated[float, quantity("rad/s")] | None = Field(
        default=None,
        description="no-load speed at full voltage, below 0: it turns the other way; the torque falls "
        "linearly to 0 there. A stepper whose torque does not fall with speed has none",
    )
    table: tuple[Point, ...] | None = Field(
        default=None,
        strict=False,
        description="in place of torque and speed: [speed, torque] from speed 0 to the no-load speed, where "
        f"the torque is 0; linear between; 2 to {MOST_POINTS}",
    )
    inertia: Inertia = Field(default=default("0 g*mm^2"), description="moment of inertia of the rotor")
    gear: Annotated[float, ratio(0.001, 1000.0)] = Field(
        default=1.0, description="turns of the motor for one turn of the roller or the shaft"
    )
    voltage: tuple[Voltage, ...] | None = Field(
        default=None,
        strict=False,
        description="without control: [time, fraction of the full voltage] of each corner, times increasing; "
        f"full voltage from the start where left out; 2 to {MOST_POINTS}",
    )
    control: Control | None = Field(default=None, description="speed control; the drive has the target")
    steps: Steps | None = Field(default=None, description="a stepper; the drive has the speed of its steps")

    @model_validator(mode="after")
    def _one_law(self) -> Motor:
        if (self.torque is None) == (self.table is None):
            raise fail("give either torque and speed, or table, as torque: 40 N*mm, speed: 300 rad/s")
        if self.control is not None and self.steps is not None:
            raise fail("control and steps are both given; give one of them", within=("steps",))
        if self.table is not None and self.speed is not None:
            raise fail("a table has the no-load speed; leave speed out", within=("speed",))
        if self.torque is not None and self.speed is None and self.steps is None:
            raise fail("torque needs a no-load speed, as speed: 300 rad/s")
        if self.speed == 0.0:
            raise fail("the no-load speed is 0; give a speed other than 0", within=("speed",))
        if self.voltage is not None and (self.control is not None or self.steps is not None):
            raise fail("voltage goes without control and steps", within=("voltage",))
        self._points()
        self._corners()
        return self

    def _points(self) -> None:
        if self.table is None:
            return
        if not 2 <= len(self.table) <= MOST_POINTS:
            raise fail(f"{len(self.table)} points; allowed 2 to {MOST_POINTS}", within=("table",))
        speeds, torques = zip(*self.table, strict=True)
        if speeds[0] != 0.0 or torques[-1] != 0.0 or any(t <= 0.0 for t in torques[:-1]):
            raise fail(
                "the first speed must be 0, the last torque 0, and those before it above 0",
                within=("table",),
            )
        if any(b <= a for a, b in pairwise(speeds)):
            raise fail("the speeds must increase", within=("table",))

    def _corners(self) -> None:
        if self.voltage is None:
            return
        if not 2 <= len(self.voltage) <= MOST_POINTS:
            raise fail(f"{len(self.voltage)} corners; allowed 2 to {MOST_POINTS}", within=("voltage",))
        times = [time for time, _ in self.voltage]
        if any(b <= a for a, b in pairwise(times)):
            raise fail("the times must increase", within=("voltage",))

    @property
    def open(self) -> bool:
        """True if its speed is that at which the torque-speed line meets the load."""
        return self.control is None and self.steps is None

    @property
    def stall(self) -> float:
        """Torque at rest [N mm]."""
        if self.table is not None:
            return self.table[0][1]
        assert self.torque is not None, "it has one of the two"
        return self.torque

    @property
    def no_load(self) -> float:
        """No-load speed with its sign [rad/ms], 0 of a stepper whose torque does not fall."""
        return self.table[-1][0] if self.table is not None else self.speed or 0.0
