"""Drive of a roller: a speed over time, and a clutch that is free in one sense."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from mdlgen.spec.fields import Direction, TimeOrZero
from mdlgen.spec.motor import Motor
from mdlgen.spec.quantities import default, quantity
from mdlgen.spec.strict import Strict, fail

# Ten starts and stops have 40. A solver stores them in the record of each body; an MDL file writes one sum.
MOST_CORNERS = 64


def _corner(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise fail(f"expected [time, speed] like ['5 ms', '180 rad/s'], got {value!r}"[:200])
    return tuple(value)


AngularSpeed = Annotated[float, quantity("rad/s")]
Corner = Annotated[tuple[TimeOrZero, AngularSpeed], BeforeValidator(_corner)]


class Drive(Strict):
    """Speed about the roller's axis: reached by a linear ramp, or a profile in time. It is prescribed, or the
    target of a motor with a limited torque."""

    speed: AngularSpeed | None = Field(
        default=None, description="angular speed about the axis (right-hand rule)"
    )
    surface_speed: Annotated[float, quantity("mm/s", 0.0)] | None = Field(
        default=None,
        description="in place of speed: how fast the roller's surface moves where it touches its sheet",
    )
    direction: Direction | None = Field(
        default=None, description="with surface_speed: which way the surface moves where it touches its sheet"
    )
    ramp: TimeOrZero = Field(default=default("0 ms"), description="time from 0 to the full speed, linear")
    profile: tuple[Corner, ...] | None = Field(
        default=None,
        strict=False,
        description="in place of speed and ramp: [time, speed] of each corner, times increasing; linear "
        f"between corners, constant before the first and after the last; 2 to {MOST_CORNERS}",
    )
    motor: Motor | None = Field(
        default=None,
        description="a motor that has to reach that speed; one without control or steps has the speed at "
        "which its torque is that of the load, and takes no speed, surface_speed or profile",
    )

    @model_validator(mode="after")
    def _one_law(self) -> Drive:
        given = [n for n in ("speed", "surface_speed", "profile") if getattr(self, n) is not None]
        if self.motor is not None and self.motor.open:
            if given or self.direction is not None or self.ramp != 0.0:
                word = (given or ["direction" if self.direction is not None else "ramp"])[0]
                raise fail(
                    f"{word} goes with a motor that has control or steps: this one runs by its voltage; "
                    "leave it out, or give motor.control",
                    within=(word,),
                )
            return self
        if len(given) != 1:
            raise fail("give exactly one of speed and profile, or surface_speed with direction")
        if (self.direction is None) != (self.surface_speed is None):
            message = (
                "direction goes with surface_speed" if self.direction else "surface_speed needs a direction"
            )
            raise fail(f"{message}, as surface_speed: 450 mm/s, direction: +x")
        if self.profile is None:
            return self
        if self.ramp != 0.0:
            raise fail("ramp goes with speed; a profile has its own times")
        if not 2 <= len(self.profile) <= MOST_CORNERS:
            raise fail(f"profile: {len(self.profile)} corners; allowed 2 to {MOST_CORNERS}")
        for k, ((before, _), (time, _)) in enumerate(zip(self.profile, self.profile[1:], strict=False), 1):
            if not time > before:
                raise fail(f"profile.{k}: the time {time:g} ms is not above the one before, {before:g} ms")
        return self


class OneWay(Strict):
    """A clutch that lets the roller turn freely in one sense; against ground, or against its drive."""

    direction: Literal[1, -1] = Field(
        description="sense about the axis (right-hand rule) that is free, 1 or -1; of a driven roller the "
        "one in which it may turn faster than its drive"
    )
    torque: Annotated[float, quantity("N*mm", 0.0, open_low=True)] = Field(
        description="torque of the clutch where the roller is turned against the free sense at the speed "
        "`creep`; it is proportional to that speed"
    )
    creep: Annotated[float, quantity("rad/s", 0.0, open_low=True)] = Field(
        default=default("0.1 rad/s"),
        description="speed against the free sense at which the clutch has its `torque`",
    )
