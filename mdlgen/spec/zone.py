"""A part of a sheet that is unlike the rest: a metallic stripe, a window, a print."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from mdlgen.spec.fields import Length
from mdlgen.spec.quantities import quantity
from mdlgen.spec.strict import Strict, fail


def _two(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise fail(f"expected two lengths like ['-3 mm', '3 mm'], got {value!r}"[:200])
    return tuple(value)


Range = Annotated[tuple[Length, Length], BeforeValidator(_two)]
Factor = Annotated[float, Field(ge=1e-3, le=1e3)]


class Zone(Strict):
    """A rectangle of the sheet. A box that it covers in part is changed by that part.

    The sheet's mass is that of the whole sheet, zones included.
    """

    x: Range = Field(description="from and to along x, from the sheet's centre")
    y: Range = Field(description="from and to along y, from the sheet's centre")
    thickness: Annotated[float, quantity("mm", 0.01, 50.0, slip=1000.0)] | None = Field(
        default=None, description="thickness here; bending goes with its third power"
    )
    density: Factor = Field(default=1.0, description="factor to the density of the rest")
    stiffness: Factor = Field(
        default=1.0, description="factor to the moduli and the bending stiffness D of the rest"
    )
    friction: Annotated[float, Field(ge=0, le=1e3)] = Field(
        default=1.0, description="factor to the friction of every contact"
    )

    @model_validator(mode="after")
    def _order(self) -> Zone:
        for axis, (low, high) in (("x", self.x), ("y", self.y)):
            if not low < high:
                raise fail(f"{axis}: from {low:g} mm to {high:g} mm is no range; the first must be less")
        return self

    def meets(self, other: Zone) -> bool:
        """True if two zones share an area."""
        return all(
            max(mine[0], yours[0]) < min(mine[1], yours[1])
            for mine, yours in ((self.x, other.x), (self.y, other.y))
        )
