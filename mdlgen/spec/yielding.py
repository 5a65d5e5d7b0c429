"""Bending beyond which a sheet keeps a part of its curvature."""

from __future__ import annotations

from pydantic import Field

from mdlgen.spec.fields import Curvatures, Hardenings
from mdlgen.spec.strict import Strict


class Yield(Strict):
    """Moment over curvature in bending: elastic up to the yield curvature, then a straight line that rises
    less. It unloads elastically, and yields the other way once the moment has changed by twice the yield
    moment (kinematic hardening)."""

    curvature: Curvatures = Field(
        description="curvature up to which bending is elastic; [md, cd] gives MD (bending along x) and CD "
        "(along y) each their own"
    )
    hardening: Hardenings = Field(
        description="slope of the moment over the curvature beyond, relative to the elastic one: 0.01 to "
        "0.99, or [md, cd]"
    )

    @property
    def curvatures(self) -> tuple[float, float]:
        """Along MD and CD [1/mm]."""
        return self.curvature if isinstance(self.curvature, tuple) else (self.curvature, self.curvature)

    @property
    def hardenings(self) -> tuple[float, float]:
        """Along MD and CD."""
        return self.hardening if isinstance(self.hardening, tuple) else (self.hardening, self.hardening)
