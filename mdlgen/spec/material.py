"""The paper: moduli, bending, damping (paper section 2.2, Eqs. 4-7)."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from mdlgen.spec.curve import Curve
from mdlgen.spec.fields import Modulus, Plate, Strict, Torsion, fail


class Damping(Strict):
    """Relative damping of the joints (Eq. 7)."""

    ratio: float = Field(
        default=0.12, ge=0, le=10, description="relative damping zeta of every component but ty"
    )
    ratio_ty: float | None = Field(
        default=None,
        ge=0,
        le=10,
        description="zeta of the rotation about y; the same as ratio where left out",
    )
    rotation: Literal["inertia", "paper"] = Field(
        default="inertia",
        description="inertia: c_t = 2 zeta sqrt(k_t I), I the box inertia about its edge; "
        "paper: the paper's formula with the box mass in g in place of I, which gives Table 2",
    )


class Material(Strict):
    """An orthotropic sheet material; x is the machine direction MD, y the cross direction CD."""

    E_md: Modulus | None = Field(default=None, description="Young's modulus along x (MD)")
    E_cd: Modulus | None = Field(default=None, description="Young's modulus along y (CD)")
    curve_md: Curve | None = Field(
        default=None, description="measured stress over strain along x, in place of E_md"
    )
    curve_cd: Curve | None = Field(
        default=None, description="measured stress over strain along y, in place of E_cd"
    )
    k_tx: Torsion | None = Field(default=None, description="hinge stiffness per bushing for bending along y")
    k_ty: Torsion | None = Field(default=None, description="hinge stiffness per bushing for bending along x")
    k_tz: Torsion | None = Field(
        default=None,
        description="in-plane stiffness per bushing; 20 times the larger of k_tx, k_ty where left out; "
        "with layout plate it follows from E_md and E_cd",
    )
    D_md: Plate | None = Field(
        default=None,
        description="bending stiffness per width along x, in place of k_ty; E_md s^3/12, a first guess, "
        "where both are left out",
    )
    D_cd: Plate | None = Field(
        default=None,
        description="bending stiffness per width along y, in place of k_tx; E_cd s^3/12, a first guess, "
        "where both are left out",
    )
    D_twist: Plate | None = Field(
        default=None,
        description="twisting stiffness per width D66, with layouts plate and center_to_center; in plate "
        "0.387 sqrt(D_md D_cd) where left out",
    )
    G: Modulus | None = Field(
        default=None,
        description="shear modulus in the plane, with layout plate; 0.387 sqrt(E_md E_cd) where left out",
    )
    damping: Damping = Field(default_factory=Damping)

    @model_validator(mode="after")
    def _stretching(self) -> Material:
        for modulus, curve, way in (("E_md", "curve_md", "x"), ("E_cd", "curve_cd", "y")):
            given = [name for name in (modulus, curve) if getattr(self, name) is not None]
            if len(given) != 1:
                what = "both are given" if given else "both are missing"
                raise fail(f"stretching along {way}: {modulus} and {curve}, {what}; give exactly one of them")
        return self

    @property
    def moduli(self) -> tuple[float, float]:
        """Young's moduli along x and y [MPa]; of a curve the slope at its start."""
        pairs = ((self.E_md, self.curve_md), (self.E_cd, self.curve_cd))
        x, y = (curve.modulus if curve is not None else modulus for modulus, curve in pairs)
        assert x is not None and y is not None, "the spec requires one of E_* and curve_*"
        return x, y

    @model_validator(mode="after")
    def _bending(self) -> Material:
        for hinge, plate, way in (("k_tx", "D_cd", "y"), ("k_ty", "D_md", "x")):
            given = [name for name in (hinge, plate) if getattr(self, name) is not None]
            if len(given) > 1:
                raise fail(f"bending along {way}: both {hinge} and {plate} are given; give one of them")
        return self

    def plates(self, thickness: float) -> tuple[float | None, float | None]:
        """Bending stiffness per width (D_md, D_cd) [N mm]; None where a hinge stiffness is given, and where
        nothing is that of a solid plate, E s^3/12, a first guess."""
        md, cd = (modulus * thickness**3 / 12 for modulus in self.moduli)
        return (
            None if self.k_ty is not None else self.D_md if self.D_md is not None else md,
            None if self.k_tx is not None else self.D_cd if self.D_cd is not None else cd,
        )
