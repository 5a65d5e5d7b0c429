"""A sheet that is not flat when nothing acts on it: curled, folded, with dog-ears."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from mdlgen.spec.fields import Angle, CreaseStiffness, Length, Size2
from mdlgen.spec.strict import Strict, fail

Direction = Literal["x", "y"]


class Curl(Strict):
    """Bent to a circle along one direction."""

    radius: Length = Field(
        description="radius of the bent sheet; positive: its edges rise along its z axis, negative: they sink"
    )
    along: Direction = Field(description="the direction that is bent: x (MD) or y (CD)")


class Fold(Strict):
    """A crease across one direction, on a line between boxes."""

    along: Direction = Field(description="the direction that is folded: x (MD) or y (CD)")
    at: Length = Field(description="where along it, from the sheet's centre; a line between boxes")
    angle: Angle = Field(
        description="angle by which the sheet turns there, towards its z axis; -170 to 170 deg"
    )
    stiffness: Annotated[float, Field(ge=1e-3, le=10)] = Field(
        default=1.0,
        description="factor to the bending stiffness of the joints on the line, whose effect depends on the "
        "grid; `crease` does not",
    )
    crease: CreaseStiffness | None = Field(
        default=None,
        description="stiffness of the crease per length: moment per width over the angle by which it opens, "
        "in series with the sheet on both sides; in place of stiffness",
    )

    @model_validator(mode="after")
    def _within(self) -> Fold:
        if self.stiffness != 1.0 and self.crease is not None:
            raise fail("stiffness and crease are both given; give one of them", within=("crease",))
        if not 0.0 < abs(self.angle) <= math.radians(170.0) * (1 + 1e-12):
            raise fail(f"angle {math.degrees(self.angle):g} deg; allowed -170 to 170 deg, not 0")
        return self


def _corner(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise fail(f"corner needs two edges like [x_max, y_min], got {value!r}"[:200])
    return tuple(value)


class DogEar(Strict):
    """A corner folded over the diagonal of a rectangle: boxes whose centres lie beyond it."""

    corner: Annotated[
        tuple[Literal["x_min", "x_max"], Literal["y_min", "y_max"]], BeforeValidator(_corner)
    ] = Field(description="the two edges that meet there, as [x_max, y_min]")
    size: Size2 = Field(description="lengths along x and y from the corner to the ends of the crease")
    angle: Angle = Field(
        description="angle by which the corner turns towards the sheet's z axis; -170 to 170 deg"
    )
    stiffness: Annotated[float, Field(ge=1e-3, le=10)] = Field(
        default=1.0, description="factor to the bending stiffness of the sheet, for the crease"
    )

    @model_validator(mode="after")
    def _within(self) -> DogEar:
        if not 0.0 < abs(self.angle) <= math.radians(170.0) * (1 + 1e-12):
            raise fail(f"angle {math.degrees(self.angle):g} deg; allowed -170 to 170 deg, not 0")
        return self

    def beyond(self, x: float, y: float, half: tuple[float, float]) -> bool:
        """True if a point is on the corner's side of the crease; `half`: of the outline."""
        from_x = half[0] + x if self.corner[0] == "x_min" else half[0] - x
        from_y = half[1] + y if self.corner[1] == "y_min" else half[1] - y
        return from_x / self.size[0] + from_y / self.size[1] < 1.0


class Shape(Strict):
    """The shape in which a sheet is free of stress."""

    start: Literal["bent", "flat"] = Field(
        default="bent",
        description="bent: the sheet begins in this shape; flat: it begins flat, and its joints push it "
        "towards this shape",
    )
    curl: Curl | None = Field(default=None, description="a curl")
    folds: tuple[Fold, ...] = Field(default=(), strict=False, description="creases, parallel to each other")
    dog_ears: tuple[DogEar, ...] = Field(default=(), strict=False, description="folded corners")

    @model_validator(mode="after")
    def _one_way(self) -> Shape:
        ways = {fold.along for fold in self.folds} | ({self.curl.along} if self.curl else set())
        if len(ways) > 1:
            raise fail(
                "curl and folds must go along one direction: a sheet does not bend in two without stretching"
            )
        if self.curl is not None and self.curl.radius == 0.0:
            raise fail("curl.radius is 0 mm; give the radius, or leave the curl out")
        if self.dog_ears and ways:
            raise fail("dog_ears together with a curl or folds are not modelled; give the one or the other")
        if self.dog_ears and self.start == "flat":
            raise fail("dog_ears begin folded; start: flat goes with a curl and folds")
        if not ways and not self.dog_ears:
            raise fail("give a curl, folds or dog_ears")
        return self

    @property
    def along(self) -> Direction | None:
        """The direction in which the sheet is bent; None with dog-ears."""
        if self.curl is not None:
            return self.curl.along
        return self.folds[0].along if self.folds else None
