"""Rubber covers of rollers."""

from __future__ import annotations

from typing import Annotated

from pydantic import ConfigDict, Field, model_validator

from mdlgen.rubber.hardness import modulus
from mdlgen.rubber.layer import Layer
from mdlgen.spec.fields import Modulus, PositiveLength, one_of
from mdlgen.spec.quantities import quantity, ratio
from mdlgen.spec.strict import Strict, fail


class Cover(Strict):
    """A layer of rubber or foam that is bonded to the core of a roller; `radius` of the roller is the outer
    one. It gives the nip its width and its speed, and the contacts of the roller their stiffness where that
    is left out."""

    model_config = ConfigDict(json_schema_extra=one_of("hardness", "modulus"))

    thickness: PositiveLength = Field(description="thickness t of the cover, less than the radius")
    hardness: Annotated[float, quantity("ShA", 5.0, 95.0)] | None = Field(
        default=None,
        description="hardness in degrees of Shore A, as 40 ShA; Young's modulus follows (Gent 1958), from "
        "20 to 80 ShA. Another relation (Ruess) has 18 % more at 40 ShA and 63 % more at 60 ShA",
    )
    modulus: Modulus | None = Field(
        default=None, description="Young's modulus E of the cover, in place of hardness, where it is measured"
    )
    poisson: Annotated[float, ratio(0.0, 0.5)] = Field(
        description="Poisson's ratio nu: 0.49 to 0.4999 of solid rubber, 0.1 to 0.4 of foam. A sheet runs "
        "faster than the undeformed surface on rubber, and slower on foam"
    )
    force: Annotated[float, quantity("N", 0.0, open_low=True)] | None = Field(
        default=None,
        description="force of the nip at which stiffness and speed are those of the layer; where left out "
        "that of the nip, or of the press of this roller or of the one that faces it",
    )

    @model_validator(mode="after")
    def _one(self) -> Cover:
        if (self.hardness is None) == (self.modulus is None):
            raise fail("give exactly one of hardness and modulus, as hardness: 40 ShA or modulus: 1.7 MPa")
        return self

    @property
    def stiff(self) -> float:
        """Young's modulus E [MPa]."""
        if self.modulus is not None:
            return self.modulus
        assert self.hardness is not None, "one of both is given"
        return modulus(self.hardness)

    def layer(self, radius: float) -> Layer:
        """As a layer on a roller of that outer radius [mm]."""
        return Layer(self.stiff, self.poisson, self.thickness, radius)
