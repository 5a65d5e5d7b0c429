"""Guides: fixed plates, straight or bent to an arc, as paper paths are drawn."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from pydantic import Field, model_validator

from mdlgen.spec.fields import Angle, Direction, LengthOrZero, Mass, Position, PositiveLength
from mdlgen.spec.machine_part import PARALLEL, cosine, not_modelled, on_its_end, rim_of_sectors
from mdlgen.spec.moving import MovingPart, Pivot, Slide, pivot_field, slide_field
from mdlgen.spec.quantities import default
from mdlgen.spec.strict import Strict, fail

if TYPE_CHECKING:
    from mdlgen.spec.machine import Roller

# Edges of sheet metal guides are sharp, 0.02 mm as cut to 0.1 mm where the burr is taken off. The blunt end
# of that is the default: by what a soft contact lets a sheet into one plate it must not stub on the next.
EDGE_RADIUS = 0.1  # mm
SQUARE = 1e-9  # cosine of the angle by which a line may be off the normal of its axis


def check_edge(radius: float | None, thickness: float) -> None:
    """Raises where the rounds of both faces would meet."""
    if radius is not None and radius > 0.5 * thickness * (1 + 1e-12):
        raise fail(
            f"{radius:g} mm is more than half of the thickness, {thickness:g} mm; allowed: 0 to "
            f"{0.5 * thickness:g} mm",
            within=("edge_radius",),
        )


def edge_radii(given: float | None, thickness: float, faces: int) -> tuple[float, float]:
    """Radii of the edges of a plate's upper and lower face [mm], of which `faces` (1, 2 or 3: both) are
    touched; those of the other one are no blunter than the default."""
    plain = min(EDGE_RADIUS, 0.5 * thickness)
    own = plain if given is None else given
    back = min(own, plain)
    return own if faces & 1 else back, own if faces & 2 else back


class Line(Strict):
    """A straight guide between two points in the middle of its width."""

    from_: Position = Field(alias="from", description="where it begins")
    to: Position = Field(description="where it ends")
    axis: Direction = Field(
        description="direction across the sheet; left and right are as seen with the axis towards you"
    )
    side: Literal["left", "right", "both"] = Field(
        description="which side is touched, seen on the way from `from` to `to`; with both the line is the "
        "middle of the plate"
    )

    @model_validator(mode="after")
    def _direction(self) -> Line:
        way = [b - a for a, b in zip(self.from_, self.to, strict=True)]
        length = math.hypot(*way)
        if length == 0.0:
            raise fail("from and to are one point; a line needs two")
        if abs(sum(w * a for w, a in zip(way, self.axis, strict=True))) > SQUARE * length:
            raise fail("the line is not square to its axis; from and to must differ across the axis only")
        return self


class Arc(Strict):
    """A guide bent to a part of a cylinder, of half a turn at most."""

    center: Position = Field(description="centre of the arc, in the middle of its width")
    axis: Direction = Field(
        description="direction across the sheet; angles turn about it by the right-hand rule"
    )
    radius: PositiveLength = Field(
        description="radius of the face that is touched; with side: both, of the middle of the plate"
    )
    from_: Angle = Field(
        alias="from",
        description="angle where it begins, counted from global x, or from global y where the axis is near x",
    )
    to: Angle = Field(description="angle where it ends")
    side: Literal["inside", "outside", "both"] = Field(description="which side is touched")

    @model_validator(mode="after")
    def _turn(self) -> Arc:
        turn = self.to - self.from_
        if not 0.0 < turn <= math.pi * (1 + 1e-12):
            raise fail(
                f"the arc goes from {math.degrees(self.from_):g} to {math.degrees(self.to):g} deg; "
                "allowed: more than 0, and 180 deg at most (give two guides for more)"
            )
        return self


class Guide(MovingPart):
    """A plate that leads sheets, fixed or moved."""

    kind = "guide"
    line: Line | None = Field(default=None, description="a straight guide")
    arc: Arc | None = Field(default=None, description="a guide bent to an arc")
    width: PositiveLength = Field(description="length along its axis")
    thickness: PositiveLength = Field(
        default=default("1 mm"), description="thickness of the plate, behind the face that is touched"
    )
    mass: Mass = Field(
        default=default("1 g"),
        description="mass of the plate, for the text, and for a pivot that has a center of mass",
    )
    edge_radius: LengthOrZero | None = Field(
        default=None,
        description="radius of the edges of the face that is touched; where left out 0.1 mm, or half of the "
        "thickness if that is less. A sheet whose corner is less than edge_radius (1 - sin(atan mu)) below "
        "the face climbs the edge; a lower one is stopped (event stub). The edges of the other face have 0.1 "
        "mm at most",
    )
    pivot: Pivot | None = pivot_field()
    slide: Slide | None = slide_field()

    @property
    def normal(self) -> tuple[float, float, float]:
        """Unit normal of a straight guide, on the left of its way."""
        assert self.line is not None, "asked of straight guides only"
        way = [b - a for a, b in zip(self.line.from_, self.line.to, strict=True)]
        length, (x, y, z), (u, v, w) = math.hypot(*way), self.line.axis, way
        return (y * w - z * v) / length, (z * u - x * w) / length, (x * v - y * u) / length

    @model_validator(mode="after")
    def _one(self) -> Guide:
        if (self.line is None) == (self.arc is None):
            raise fail("a guide is a line or an arc; give one of them")
        if self.arc is not None and self.thickness >= self.arc.radius:
            raise fail(f"thickness {self.thickness:g} mm is not less than the radius {self.arc.radius:g} mm")
        check_edge(self.edge_radius, self.thickness)
        return self

    def unlike_roller(self, names: tuple[str, str], roller: Roller) -> str | None:
        if self.arc is None:
            return on_its_end(names, roller.axis, self.normal)
        if abs(abs(cosine(roller.axis, self.arc.axis)) - 1.0) > PARALLEL:
            return f"{not_modelled(names)}the roller's axis is not parallel to that of the arc"
        if roller.rim is not None:
            return rim_of_sectors(names, "an arc")
        return None
