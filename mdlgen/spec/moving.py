"""Guides, planes and meshes that move: they turn about a fixed axis, or slide along a line."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, Field, model_validator

from mdlgen.spec.fields import Angle, Direction, Length, Mass, Name, Position, Stiffness, TimeOrZero, Torsion
from mdlgen.spec.machine_part import MachinePart
from mdlgen.spec.quantities import default, quantity
from mdlgen.spec.strict import Strict, fail

# A solver stores them in the record of each body, each with the speed there.
MOST_PLACES = 10
SAME = 1e-12  # rad or mm: a profile that begins this near to 0 begins there, by round-off


def _corner(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise fail(f"expected [time, place] like ['5 ms', 'open'], got {value!r}"[:200])
    return tuple(value)


AngleCorner = Annotated[tuple[TimeOrZero, Angle], BeforeValidator(_corner)]
WayCorner = Annotated[tuple[TimeOrZero, Length], BeforeValidator(_corner)]
_PROFILE = (
    "[time, place] of each corner, times increasing; a place is {what}, or a name of `positions`. The part "
    "is at rest at each corner, and goes from one to the next by 3 s^2 - 2 s^3 of the way, s the share of "
    f"the time. The first place is 0, where the part is given; 1 to {MOST_PLACES}"
)


class _Motion(Strict):
    """The keys that a pivot and a slide have in common."""

    inert: ClassVar[str]  # the key without which it is prescribed
    push: ClassVar[str]
    unit: ClassVar[str]
    scale: ClassVar[float]  # of a number of the model in that unit

    @property
    def sprung(self) -> bool:
        """Whether a spring or a damper acts on it."""
        return any(getattr(self, key) != 0.0 for key in (self.push, "stiffness", "damping"))

    @model_validator(mode="before")
    @classmethod
    def _named(cls, value: Any) -> Any:
        """The same with the places of the profile in place of their names."""
        if not isinstance(value, dict) or not isinstance(value.get("profile"), (list, tuple)):
            return value
        known = value.get("positions")
        known = known if isinstance(known, dict) else {}
        corners = []
        for k, corner in enumerate(value["profile"]):
            own = corner
            if isinstance(corner, (list, tuple)) and len(corner) == 2 and isinstance(corner[1], str):
                if corner[1] in known:
                    own = [corner[0], known[corner[1]]]
                elif corner[1].isidentifier():
                    raise fail(
                        f"profile.{k}: {corner[1][:63]!r} is no name of positions; allowed: "
                        f"{', '.join(map(str, known)) or 'none is given'}"
                    )
            corners.append(own)
        return {**value, "profile": corners}

    @model_validator(mode="after")
    def _law(self) -> _Motion:
        free = getattr(self, self.inert) is not None
        profile, positions = getattr(self, "profile"), getattr(self, "positions")  # noqa: B009
        if free:
            for key in ("profile", "positions"):
                if getattr(self, key) is not None:
                    raise fail(
                        f"{key} prescribes the motion, {self.inert} lets forces make it; give one of them",
                        within=(key,),
                    )
            return self
        for key in (self.push, "stiffness", "damping", "stops"):
            if getattr(self, key):  # a key that is left out has no force
                raise fail(
                    f"{key} acts on a part that is free to move, which needs {self.inert}", within=(key,)
                )
        if profile is None and positions is None:
            raise fail(
                f"nothing moves it; give a profile, positions that rules command, or {self.inert} for a part "
                "that forces move"
            )
        self._check(profile or ())
        return self

    def _check(self, profile: tuple[tuple[float, float], ...]) -> None:
        if len(profile) > MOST_PLACES:
            raise fail(f"profile: {len(profile)} corners; allowed 1 to {MOST_PLACES}")
        for k, ((before, _), (time, _)) in enumerate(pairwise(profile), 1):
            if not time > before:
                raise fail(f"profile.{k}: the time {time:g} ms is not above the one before, {before:g} ms")
        if profile and abs(profile[0][1]) > SAME:
            raise fail(
                f"profile.0: it begins at {profile[0][1] * self.scale:g} {self.unit}; allowed: 0, which is "
                "where the part is given. Give the part as it stands at the start, and all places from there"
            )


class Stops(Strict):
    """The two ends of a motion."""

    restitution: Annotated[float, Field(gt=0, le=1)] = Field(
        default=0.5, description="coefficient of restitution c_R"
    )


class PivotStops(Stops):
    """The two ends of a turn."""

    low: Angle = Field(description="angle of the lower one")
    high: Angle = Field(description="angle of the upper one")
    stiffness: Annotated[float, quantity("N*mm/rad", 0.0, open_low=True)] = Field(
        description="stiffness of both, beyond them"
    )


class SlideStops(Stops):
    """The two ends of a slide."""

    low: Length = Field(description="place of the lower one")
    high: Length = Field(description="place of the upper one")
    stiffness: Annotated[float, quantity("N/mm", 0.0, open_low=True)] = Field(
        description="stiffness of both, beyond them"
    )


def check_stops(stops: PivotStops | SlideStops | None, unit: str, scale: float) -> None:
    """Raises where the part, which begins at 0, does not begin between its stops."""
    if stops is not None and not (stops.low <= 0.0 <= stops.high and stops.low < stops.high):
        raise fail(
            f"stops go from {scale * stops.low:g} to {scale * stops.high:g} {unit}; allowed: low of 0 at "
            "most and high of 0 at least, since the part begins at 0",
            within=("stops",),
        )


class Pivot(_Motion):
    """A fixed axis that a part turns about. Angles are about the axis by the right-hand rule, from where the
    part is given, which is where it is as the run begins."""

    inert, push, unit, scale = "inertia", "torque", "deg", math.degrees(1.0)

    at: Position = Field(description="a point of the axis")
    axis: Direction = Field(description="its direction")
    positions: dict[Name, Angle] | None = Field(
        default=None, description="angles by names, for the profile and for rules, as open: 20 deg"
    )
    profile: tuple[AngleCorner, ...] | None = Field(
        default=None, strict=False, description=_PROFILE.format(what="an angle")
    )
    inertia: Annotated[float, quantity("g*mm^2", 0.0, open_low=True)] | None = Field(
        default=None,
        description="moment of inertia of all that turns, about the axis: the part is then free, and turned "
        "by what touches it, its weight and its spring",
    )
    stiffness: Torsion = Field(default=default("0 N*mm/rad"), description="stiffness of its spring")
    torque: Annotated[float, quantity("N*mm")] = Field(
        default=default("0 N*mm"), description="torque of its spring at the angle 0"
    )
    damping: Annotated[float, quantity("N*mm*ms/rad", 0.0)] = Field(
        default=default("0 N*mm*ms/rad"), description="damping of its pivot"
    )
    center: Position | None = Field(
        default=None,
        description="its centre of mass as the run begins, by which its mass turns it; the axis where left "
        "out: its weight is balanced",
    )
    stops: PivotStops | None = Field(default=None, description="the two ends of the turn")

    @model_validator(mode="after")
    def _between(self) -> Pivot:
        check_stops(self.stops, self.unit, self.scale)
        if self.center is not None and self.inertia is None:
            raise fail("center is of a part that is free to turn, which needs inertia", within=("center",))
        return self


class Slide(_Motion):
    """A line that a part slides along. Places count along the direction from where the part is given, which
    is where it is as the run begins. It does not turn."""

    inert, push, unit, scale = "mass", "force", "mm", 1.0

    direction: Direction = Field(description="direction of the line")
    positions: dict[Name, Length] | None = Field(
        default=None, description="places by names, for the profile and for rules, as up: 5 mm"
    )
    profile: tuple[WayCorner, ...] | None = Field(
        default=None, strict=False, description=_PROFILE.format(what="a length")
    )
    mass: Mass | None = Field(
        default=None,
        description="mass of all that slides: the part is then free, and moved by what touches it, its "
        "weight and its spring",
    )
    stiffness: Stiffness = Field(default=default("0 N/mm"), description="stiffness of its spring")
    force: Annotated[float, quantity("N")] = Field(
        default=default("0 N"), description="force of its spring at the place 0, along the direction"
    )
    damping: Annotated[float, quantity("N*ms/mm", 0.0)] = Field(
        default=default("0 N*ms/mm"), description="damping of its slide"
    )
    stops: SlideStops | None = Field(
        default=None, description="the two ends of the slide; a part that is free to slide needs them"
    )

    @model_validator(mode="after")
    def _between(self) -> Slide:
        check_stops(self.stops, self.unit, self.scale)
        if self.mass is not None and self.stops is None:
            raise fail("a part that is free to slide needs stops, which say how far it may come")
        return self


def pivot_field() -> Any:
    """The key `pivot` of a part that may move."""
    return Field(
        default=None, description="a fixed axis that it turns about; without pivot and slide it is fixed"
    )


def slide_field() -> Any:
    """The key `slide` of a part that may move."""
    return Field(default=None, description="a line that it slides along, in place of a pivot")


class MovingPart(MachinePart):
    """A part of the machine that may move as a whole: it has the keys `pivot` and `slide`."""

    @property
    def moves(self) -> Pivot | Slide | None:
        """How it moves; None: it does not."""
        pivot: Pivot | None = getattr(self, "pivot", None)
        return getattr(self, "slide", None) if pivot is None else pivot

    @model_validator(mode="after")
    def _one_motion(self) -> MovingPart:
        pivot, slide = getattr(self, "pivot", None), getattr(self, "slide", None)
        if pivot is not None and slide is not None:
            raise fail(f"a {self.kind} has a pivot or a slide; give one of them")
        if pivot is None and slide is None:
            return self
        for key, why in (
            ("press", "is pressed along a slide of its own"),
            ("on", "moves with its roller"),
            ("repeat", "is written out with what it is given by its center alone"),
            ("mirror", "is written out with what it is given by its center alone"),
        ):
            if getattr(self, key, None) is not None:
                word = "pivot" if pivot is not None else "slide"
                raise fail(f"a {self.kind} with {key} {why}; give it no {word}", within=(word,))
        return self
