"""Loads, supports and probes of a sheet, each at a material point or an edge."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from mdlgen.spec.fields import ForceVector, MomentVector, Name, Point2
from mdlgen.spec.over_time import WORDS, Profile
from mdlgen.spec.quantities import quantity
from mdlgen.spec.sheet import Edge
from mdlgen.spec.strict import Strict, fail


class OnSheet(Strict):
    """A material point `at` [x, y] from the sheet's centre in sheet axes, or an `edge`."""

    sheet: Name = Field(description="name of a sheet")
    at: Point2 | None = Field(default=None, description="[x, y] from the sheet's centre, in sheet axes")
    edge: Edge | None = Field(default=None, description="an edge of the sheet")

    @model_validator(mode="after")
    def _one_place(self) -> OnSheet:
        if (self.at is None) == (self.edge is None):
            raise fail("give exactly one of at and edge")
        return self


class Probe(OnSheet):
    """A point whose motion is recorded; an edge means its middle."""


class Load(OnSheet):
    """A load, given in the axes of the sheet at the start. Its direction does not turn with the sheet."""

    force: ForceVector | None = Field(default=None, description="total force, sheet axes at the start")
    moment: MomentVector | None = Field(
        default=None, description="total moment on an edge, sheet axes at the start"
    )
    stress: Annotated[float, quantity("MPa")] | None = Field(
        default=None, description="tension on an edge along its outward normal, times width and thickness"
    )
    profile: Profile | None = Field(
        default=None, description=f"what the load is multiplied by over time: {WORDS}; 1 where left out"
    )

    @model_validator(mode="after")
    def _one_kind(self) -> Load:
        given = [n for n in ("force", "moment", "stress") if getattr(self, n) is not None]
        if len(given) != 1:
            raise fail(f"give exactly one of force, moment and stress, not {' and '.join(given) or 'none'}")
        if self.edge is None and given != ["force"]:
            raise fail(f"{given[0]} acts on an edge; a point takes a force")
        return self


def _components(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or not value or any(v not in ("x", "y", "z") for v in value):
        raise fail(f"fix is a list of x, y, z, got {value!r}"[:200])
    if len(set(value)) != len(value):
        raise fail(f"fix names a direction twice: {value!r}")
    return tuple(value)


class Support(OnSheet):
    """Holds components (global axes) of a material point where it is at the start."""

    fix: Annotated[tuple[Literal["x", "y", "z"], ...], BeforeValidator(_components)] = Field(
        description="directions that are held: some of x, y, z"
    )
