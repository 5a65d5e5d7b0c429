"""The machine's parts: rollers and planes (paper Tables 3 and 4)."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from mdlgen.spec.fields import (
    Direction,
    Mass,
    Position,
    PositiveLength,
    Size3,
    Stiffness,
    Strict,
    TimeOrZero,
    default,
    quantity,
)


class Drive(Strict):
    """Prescribed speed about the roller's axis, reached by a linear ramp."""

    speed: Annotated[float, quantity("rad/s")] = Field(
        description="angular speed about the axis (right-hand rule)"
    )
    ramp: TimeOrZero = Field(default=default("0 ms"), description="time from 0 to the full speed, linear")


class Press(Strict):
    """A spring that pushes the roller along a direction in which it may slide."""

    direction: Direction = Field(description="where the spring pushes to")
    stiffness: Stiffness = Field(description="spring stiffness")
    preload: Annotated[float, quantity("N", 0.0)] = Field(description="spring force at the free length")
    free_length: PositiveLength = Field(
        default=default("6 mm"),
        description="spring length at which the preload is stated: where the roller just touches its "
        "counterpart (a roller it has a contact with), or its centre as given where it has none",
    )
    damping_ratio: float = Field(
        default=0.05, ge=0, le=10, description="relative damping of spring and roller"
    )
    carrier_mass: Mass | None = Field(
        default=None, description="mass of the slide between spring and roller; a thousandth of the roller's"
    )


class Roller(Strict):
    """A cylinder that turns about its axis: driven, free, or pressed and free."""

    center: Position = Field(description="middle of the cylinder")
    axis: Direction = Field(description="axis of rotation")
    radius: PositiveLength = Field(description="radius R")
    width: PositiveLength = Field(description="length along the axis")
    mass: Mass = Field(description="mass; the inertia is that of a solid cylinder")
    drive: Drive | None = Field(
        default=None, description="prescribed rotation; without it the roller turns freely"
    )
    press: Press | None = Field(default=None, description="slide and spring; without it the axis is fixed")


class Plane(Strict):
    """A fixed plate; its contact face is the one on the side of the normal."""

    center: Position = Field(description="middle of the plate (its face lies half the third size above)")
    normal: Direction = Field(description="outward normal of the contact face")
    size: Size3 = Field(description="two lengths of the face, then the thickness along the normal")
    mass: Mass = Field(description="mass; of no effect on the motion, since the plate is fixed")
