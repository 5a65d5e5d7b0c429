"""The rim of a roller that is not the same all round: toothed rubber here, smooth plastic there."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field, model_validator

from mdlgen.spec.fields import Angle, PositiveLength
from mdlgen.spec.quantities import default
from mdlgen.spec.strict import Strict, fail

# A solver stores them in the record of each body, with the gaps between them.
MOST_SECTORS = 8
TURN = 2.0 * math.pi
_SAME = 1e-9  # rad: two sectors that meet may differ by the rounding of their angles


class Sector(Strict):
    """A part of the circumference. A key that is left out is as for the rest of the roller."""

    from_: Angle = Field(
        alias="from",
        description="angle of its first end at the start of the run: about the axis by the right-hand rule, "
        "from global x, or from global y where the axis is near x",
    )
    to: Angle = Field(description="angle of its other end")
    radius: PositiveLength | None = Field(
        default=None, description="radius of the sector; the roller's where left out"
    )
    friction: Annotated[float, Field(ge=0, le=1e3)] = Field(
        default=1.0, description="factor to the friction of each of the roller's contacts"
    )
    stiffness: Annotated[float, Field(ge=1e-3, le=1e3)] = Field(
        default=1.0, description="factor to the stiffness k of each of the roller's contacts"
    )
    restitution: Annotated[float, Field(ge=0, le=1)] | None = Field(
        default=None, description="coefficient of restitution c_R; that of the contact where left out"
    )

    @model_validator(mode="after")
    def _order(self) -> Sector:
        if not 0.0 < self.to - self.from_ < TURN - _SAME:
            raise fail(
                f"the sector goes from {math.degrees(self.from_):g} to {math.degrees(self.to):g} deg; "
                "allowed: more than 0 and less than 360 deg"
            )
        return self


class Rim(Strict):
    """Sectors of a roller that turn with it. The rest of it is as the roller and its contacts say."""

    sectors: Annotated[tuple[Sector, ...], Field(strict=False)] = Field(
        description=f"1 to {MOST_SECTORS}, in the order of their angles as the run begins"
    )
    blend: Angle = Field(
        default=default("2 deg"),
        description="angle over which friction, stiffness and restitution go from one sector to the next",
    )

    @model_validator(mode="after")
    def _apart(self) -> Rim:
        if not 1 <= len(self.sectors) <= MOST_SECTORS:
            raise fail(f"{len(self.sectors)} sectors; allowed 1 to {MOST_SECTORS}")
        if not math.radians(0.1) <= self.blend <= math.radians(30.0):
            raise fail(f"blend {math.degrees(self.blend):g} deg; allowed 0.1 to 30 deg")
        for k, sector in enumerate(self.sectors):
            last = k + 1 == len(self.sectors)
            after = self.sectors[0].from_ + TURN if last else self.sectors[k + 1].from_
            if sector.to > after + _SAME:
                raise fail(
                    f"sectors.{k} ends at {math.degrees(sector.to):g} deg, beyond "
                    f"{math.degrees(after):g} deg where the next begins; give them in order, each to where "
                    "the next begins at most"
                )
        return self
