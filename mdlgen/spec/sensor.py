"""Sensors: what sees whether a sheet is at a place of the machine."""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import BeforeValidator, ConfigDict, Field, model_validator

from mdlgen.spec.fields import Direction, Position, PositiveLength, one_of
from mdlgen.spec.quantities import default, quantity
from mdlgen.spec.strict import Strict, fail

REACH = 5.0  # of a point and a line that say none [mm] (convention: guides of a channel are 2 to 4 mm apart)
# A line along its own direction of view sees nothing: sine of the angle between the two.
_ALONG = 1e-3


def _two(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise fail(f"expected two points, as [[0 mm, -5 mm, 0 mm], [0 mm, 5 mm, 0 mm]], got {value!r}"[:200])
    return tuple(value)


Ends = Annotated[tuple[Position, Position], BeforeValidator(_two)]


class Sensor(Strict):
    """Sees sheets: by a beam between two points, from one point, or along a line. It acts on nothing.

    A sheet counts by its middle surface. The sensor is covered while one is there, of two that overlap until
    the last one has gone, as a light barrier is.
    """

    model_config = ConfigDict(json_schema_extra=one_of("beam", "point", "line"))

    beam: Ends | None = Field(
        default=None, strict=False, description="both ends of a beam of light, which a sheet interrupts"
    )
    point: Position | None = Field(
        default=None, description="a point, as in the face of a guide, from which it looks along `direction`"
    )
    line: Ends | None = Field(
        default=None, strict=False, description="both ends of a line from which it looks along `direction`"
    )
    direction: Direction | None = Field(default=None, description="where a point or a line looks to")
    reach: PositiveLength | None = Field(
        default=None, description="how far a point or a line sees along `direction`; 5 mm if left out"
    )
    hysteresis: Annotated[float, quantity("mm", 0.001)] = Field(
        default=default("0.01 mm"),
        description="how far the edge of a sheet has to be off before it is clear again, 0.001 mm at least",
    )
    sees: tuple[str, ...] = Field(
        default=("*",),
        strict=False,
        description="names or patterns of the sheets that it sees; all if left out",
    )

    @model_validator(mode="after")
    def _one_kind(self) -> Sensor:
        given = [name for name in ("beam", "point", "line") if getattr(self, name) is not None]
        if len(given) != 1:
            raise fail(f"give exactly one of beam, point and line, not {' and '.join(given) or 'none'}")
        if self.beam is not None:
            for name in ("direction", "reach"):
                if getattr(self, name) is not None:
                    raise fail(f"a beam has no {name}: its ends say where it goes", within=(name,))
            if not math.dist(*self.beam) > 0.0:
                raise fail("both ends of the beam are at one place", within=("beam",))
            return self
        if self.direction is None:
            raise fail(f"a {given[0]} needs a direction in which it looks, as direction: z")
        if self.line is not None:
            along = [b - a for a, b in zip(*self.line, strict=True)]
            length = math.hypot(*along)
            if not length > 0.0:
                raise fail("both ends of the line are at one place", within=("line",))
            share = abs(sum(p * q for p, q in zip(along, self.direction, strict=True))) / length
            if 1.0 - share**2 < _ALONG**2:
                raise fail("the line looks along itself, where it sees nothing", within=("direction",))
        return self
