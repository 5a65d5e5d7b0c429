"""The machine's parts: rollers and planes (paper Tables 3 and 4)."""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import ConfigDict, Field, model_validator

from mdlgen.spec.cover import Cover
from mdlgen.spec.drive import AngularSpeed, Drive, OneWay
from mdlgen.spec.fields import (
    Angle,
    Direction,
    Length,
    LengthOrZero,
    Mass,
    Position,
    PositiveLength,
    Ratio,
    Size3,
    Stiffness,
    Torsion,
    one_of,
)
from mdlgen.spec.guide import check_edge
from mdlgen.spec.machine_part import PARALLEL, MachinePart, cosine, not_modelled, on_its_end
from mdlgen.spec.motor import Bearing, Limiter
from mdlgen.spec.moving import (
    MovingPart,
    Pivot,
    PivotStops,
    Slide,
    SlideStops,
    check_stops,
    pivot_field,
    slide_field,
)
from mdlgen.spec.quantities import combined, default, quantity, reading
from mdlgen.spec.rim import Rim
from mdlgen.spec.rows import Mirror, Repeat
from mdlgen.spec.strict import Strict, fail, with_values


class Press(Strict):
    """A spring that pushes a roller, or a plate, along a direction in which it may slide."""

    direction: Direction = Field(description="where the spring pushes to")
    stiffness: Stiffness = Field(description="spring stiffness")
    preload: Annotated[float, quantity("N", 0.0)] = Field(
        description="force of the spring at its free_length; weight along `direction` presses in addition"
    )
    free_length: PositiveLength = Field(
        default=default("6 mm"),
        description="length of the spring where its force is `preload`. A roller is there where it just "
        "touches its counterpart, a roller, plane or guide that it has a contact with. A plate, or a roller "
        "without a counterpart, is there with its `center` as given. A plate moves by this length at most, "
        "either way",
    )
    damping_ratio: Ratio = Field(default=0.05, description="relative damping of spring and roller or plate")
    start: Length | None = Field(
        default=None,
        description="where the roller or plate begins, along `direction` from where its spring has its "
        "`preload`: 0 mm is there, -2 mm lifts a roller by 2 mm. Where left out it begins in balance",
    )
    start_speed: Annotated[float, quantity("mm/s")] = Field(
        default=default("0 mm/s"), description="speed along `direction` with which it begins"
    )
    carrier_mass: Mass | None = Field(
        default=None,
        description="mass of the slide between spring and roller; a thousandth of the roller's where left "
        "out. A plate is its own slide; this mass adds to it",
    )
    stops: SlideStops | None = Field(
        default=None, description="the two ends of the slide, from where the part is given"
    )

    @model_validator(mode="after")
    def _between(self) -> Press:
        check_stops(self.stops, "mm", 1.0)
        return self


class Arm(Strict):
    """A rigid arm that pivots about an axis parallel to the roller's and carries it at its end.

    Angles and torques are about the direction of the roller's axis (right-hand rule), from where the roller
    has its `center` as given. A drive turns the roller against the arm, as a motor that sits on the arm does.
    """

    pivot: Position = Field(description="a point of the axis that the arm turns about, which is fixed")
    mass: Mass = Field(description="mass of the arm, without the roller")
    center: Position | None = Field(
        default=None,
        description="its centre of mass; where left out halfway between the pivot and the roller's centre",
    )
    inertia: Annotated[float, quantity("g*mm^2", 0.0, open_low=True)] | None = Field(
        default=None,
        description="moment of inertia about its centre of mass and the axis; where left out that of a rod "
        "from the pivot to the roller",
    )
    torque: Annotated[float, quantity("N*mm")] = Field(
        default=default("0 N*mm"), description="torque of its spring where `start` is 0 deg"
    )
    stiffness: Torsion = Field(default=default("0 N*mm/rad"), description="stiffness of its spring")
    damping: Annotated[float, quantity("N*mm*ms/rad", 0.0)] = Field(
        default=default("0 N*mm*ms/rad"), description="damping of its pivot"
    )
    start: Angle = Field(
        default=default("0 deg"),
        description="angle at which the arm begins, from where the roller has its `center` as given",
    )
    start_speed: AngularSpeed = Field(
        default=default("0 rad/s"), description="angular speed with which the arm begins"
    )
    stops: PivotStops | None = Field(default=None, description="the two ends of the turn")

    @model_validator(mode="after")
    def _between(self) -> Arm:
        check_stops(self.stops, "deg", math.degrees(1.0))
        return self

    @property
    def sprung(self) -> bool:
        """True if a spring, a damper or a torque turns it, not only weight and contact."""
        return any(value != 0.0 for value in (self.torque, self.stiffness, self.damping))


class Roller(MachinePart):
    """A cylinder that turns about its axis: driven, free, or pressed and free."""

    kind = "roller"
    model_config = ConfigDict(json_schema_extra=one_of("radius", "diameter"))

    center: Position = Field(description="middle of the cylinder")
    axis: Direction = Field(description="axis of rotation")
    radius: PositiveLength = Field(description="radius R")
    diameter: PositiveLength | None = Field(default=None, description="2 R, in place of radius")
    width: PositiveLength = Field(description="length along the axis")
    mass: Mass = Field(description="mass m; the inertia is that of a solid cylinder")
    drive: Drive | None = Field(
        default=None, description="prescribed rotation; without it the roller turns freely"
    )
    spin: AngularSpeed = Field(
        default=default("0 rad/s"),
        description="angular speed about the axis (right-hand rule) with which a roller without a drive "
        "begins",
    )
    one_way: OneWay | None = Field(
        default=None, description="a one-way clutch between the roller and its drive, or ground without one"
    )
    limiter: Limiter | None = Field(
        default=None, description="a torque limiter between the roller and its drive, or ground without one"
    )
    bearing: Bearing | None = Field(
        default=None,
        description="friction and drag of its bearing, of a roller that turns freely or by a motor",
    )
    press: Press | None = Field(default=None, description="slide and spring; without it the axis is fixed")
    arm: Arm | None = Field(default=None, description="an arm that carries it in place of a fixed axis")
    rim: Rim | None = Field(default=None, description="sectors of the rim that are unlike the rest")
    cover: Cover | None = Field(default=None, description="a cover of rubber or foam on the whole round")
    repeat: Repeat | None = Field(default=None, description="a row of such rollers")
    mirror: Mirror | None = Field(default=None, description="a second one, its mirror image")

    @model_validator(mode="before")
    @classmethod
    def _radius(cls, value: Any) -> Any:
        if not isinstance(value, dict) or value.get("diameter") is None:
            return value
        if value.get("radius") is not None:
            raise fail("radius and diameter are both given; give one of them", within=("diameter",))
        diameter = value["diameter"]
        half = combined(reading(diameter, "mm", 1.0) / 2, "{0}/2", (diameter, "mm"))
        return {**value, "radius": half}

    @model_validator(mode="after")
    def _plain(self) -> Roller:
        """The same with its radius alone."""
        return self if self.diameter is None else with_values(self, diameter=None)

    @model_validator(mode="after")
    def _cover(self) -> Roller:
        if self.cover is None:
            return self
        if self.rim is not None:
            raise fail("a roller with a rim of sectors has no cover: the one or the other", within=("cover",))
        if self.cover.thickness >= self.radius:
            raise fail(
                f"{self.cover.thickness:g} mm is not below the radius, {self.radius:g} mm, which is that of "
                "the cover's outside",
                within=("cover", "thickness"),
            )
        return self

    @model_validator(mode="after")
    def _begins(self) -> Roller:
        if self.drive is not None and self.spin != 0.0:
            raise fail(
                "a roller with a drive begins with the speed of its drive; leave spin out, or write the "
                "drive as a profile that begins with that speed",
                within=("spin",),
            )
        return self

    @model_validator(mode="after")
    def _arm(self) -> Roller:
        if self.arm is None:
            return self
        if self.press is not None or self.one_way is not None:
            word = "press" if self.press is not None else "one_way"
            raise fail(f"a roller on an arm has no {word}: the one or the other")
        if self.limiter is not None or self.bearing is not None:
            word = "limiter" if self.limiter is not None else "bearing"
            raise fail(f"a {word} of a roller on an arm is not modelled; leave one out", within=(word,))
        if self.drive is not None and self.drive.motor is not None:
            message = "a motor of a roller on an arm is not modelled; leave motor or arm out"
            raise fail(message, within=("drive", "motor"))
        gap = [c - p for c, p in zip(self.center, self.arm.pivot, strict=True)]
        along = sum(g * a for g, a in zip(gap, self.axis, strict=True))
        if math.dist(gap, [along * a for a in self.axis]) < 1e-6 * self.radius:
            raise fail("arm.pivot is on the roller's own axis; an arm needs a length", within=("arm",))
        return self

    @model_validator(mode="after")
    def _turned(self) -> Roller:
        motor = self.drive is not None and self.drive.motor is not None
        if self.one_way is not None and (self.limiter is not None or motor or self.bearing is not None):
            word = "motor" if motor else "limiter" if self.limiter is not None else "bearing"
            raise fail(f"a roller with a one_way clutch has no {word}: the one or the other")
        if self.limiter is not None and motor:
            raise fail(
                "a limiter behind a motor is not modelled: give the drive a prescribed speed, or leave the "
                "limiter out",
                within=("limiter",),
            )
        if self.bearing is not None and self.drive is not None and not motor and self.limiter is None:
            raise fail(
                "a drive of prescribed speed turns the roller whatever its bearing takes; leave bearing out, "
                "or give the drive a motor",
                within=("bearing",),
            )
        return self

    def unlike_roller(self, names: tuple[str, str], roller: Roller) -> str | None:
        if abs(abs(cosine(roller.axis, self.axis)) - 1.0) > PARALLEL:
            return f"the rollers {names[0]} and {names[1]} are in contact but their axes are not parallel"
        if roller.rim is not None and self.rim is not None:
            return f"{not_modelled(names)}both have a rim of sectors"
        return None


class Plane(MovingPart):
    """A plate, fixed or pressed by a spring; its contact face is the one on the side of the normal."""

    kind = "plane"
    center: Position = Field(
        description="middle of the plate; its face lies half of the thickness above, along the normal"
    )
    normal: Direction = Field(description="outward normal of the contact face")
    size: Size3 = Field(
        description="two lengths of the face, then the thickness along the normal. The first length lies "
        "along `along`; where that is left out, along the projection of global x on the face, or of global y "
        "where the normal is near x"
    )
    along: Direction | None = Field(
        default=None,
        description="direction of the first length of size, one of the two sides of the face",
    )
    mass: Mass = Field(
        default=default("1 g"),
        description="mass of the plate, for the text alone where it is fixed; a plate with press needs it",
    )
    press: Press | None = Field(
        default=None, description="slide and spring; without it the plate is fixed. It does not turn"
    )
    edge_radius: LengthOrZero | None = Field(
        default=None,
        description="radius of the edges of its face, see edge_radius of a guide; where left out 0.1 mm, or "
        "half of the thickness if that is less",
    )
    pivot: Pivot | None = pivot_field()
    slide: Slide | None = slide_field()
    repeat: Repeat | None = Field(default=None, description="a row of such planes")
    mirror: Mirror | None = Field(default=None, description="a second one, its mirror image")

    @model_validator(mode="after")
    def _presses(self) -> Plane:
        check_edge(self.edge_radius, self.size[2])
        if self.press is None:
            return self
        if "mass" not in self.model_fields_set:
            raise fail("a plate with press moves, so its mass counts; write like mass: 20 g")
        if abs(sum(d * n for d, n in zip(self.press.direction, self.normal, strict=True))) < 0.05:
            raise fail(
                "the direction lies in the plate's own face, or less than 3 degrees off it, where it presses "
                "nothing; give it a part along the normal",
                within=("press", "direction"),
            )
        if self.press.start is not None and abs(self.press.start) >= self.press.free_length:
            raise fail(
                f"{self.press.start:g} mm is beyond the way of the plate, its free_length of "
                f"{self.press.free_length:g} mm either way",
                within=("press", "start"),
            )
        return self

    @model_validator(mode="after")
    def _first_along(self) -> Plane:
        """The same with its lengths in the usual order."""
        if self.along is None:
            return self
        first, second = self.sides
        one, two = (
            abs(sum(a * s for a, s in zip(self.along, side, strict=True))) for side in (first, second)
        )
        if max(one, two) < 1.0 - 1e-9:
            shown = " or ".join(f"[{', '.join(f'{c:.4g}' for c in side)}]" for side in (first, second))
            raise fail(f"the sides of this plate lie along {shown}; give one of them", within=("along",))
        a, b, thickness = self.size
        return with_values(self, along=None, size=(a, b, thickness) if one > two else (b, a, thickness))

    @property
    def sides(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Unit vectors along the first and the second length."""
        n = self.normal
        near = (0.0, 1.0, 0.0) if abs(n[0]) > 0.9 else (1.0, 0.0, 0.0)
        lean = sum(p * q for p, q in zip(near, n, strict=True))
        flat = [p - lean * q for p, q in zip(near, n, strict=True)]
        x, y, z = (f / math.hypot(*flat) for f in flat)
        return (x, y, z), (n[1] * z - n[2] * y, n[2] * x - n[0] * z, n[0] * y - n[1] * x)

    def unlike_roller(self, names: tuple[str, str], roller: Roller) -> str | None:
        return on_its_end(names, roller.axis, self.normal)
