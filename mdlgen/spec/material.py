"""The paper: moduli, bending, damping (paper section 2.2, Eqs. 4-7)."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field, model_validator

from mdlgen.spec.curve import Curve
from mdlgen.spec.fields import Frequency, LossFactors, Modulus, Plate, Ratio, Times, Torsion
from mdlgen.spec.strict import Strict, fail
from mdlgen.spec.yielding import Yield

RATIO = 0.12  # the paper's zeta (Table 2)


class Damping(Strict):
    """Damping of the joints: that of the paper (Eq. 7), or one that belongs to the material.

    `ratio` is relative to one box and its joint, as in Eq. 7: that of a mode of the whole sheet falls with
    the square of the number of boxes. `time` and `loss_factor` are Kelvin and Voigt's: stress = E (strain +
    tau strain rate) for each component of a joint, c = tau k, on any grid the same.
    """

    ratio: Ratio | None = Field(
        default=None,
        description="damping ratio zeta of one box on its joint, for all components but ty (Eq. 7); 0.12 "
        "where nothing is given",
    )
    ratio_ty: Ratio | None = Field(
        default=None,
        description="damping ratio of the rotation about y; as ratio where left out",
    )
    rotation: Literal["inertia", "paper"] | None = Field(
        default=None,
        description="how rotations are damped, with ratio. inertia, the default: c_t = 2 zeta sqrt(k_t I), "
        "where I is the inertia of a box about its edge; paper: with the mass of a box in g in place of I "
        "(Table 2)",
    )
    time: Times | None = Field(
        default=None,
        description="damping time tau, in place of ratio, the same on any grid: stress = E (strain + tau "
        "strain rate), in bending too. [tau_md, tau_cd] gives MD and CD each their own: tau_md acts on what "
        "follows from E_md, D_md or k_ty, tau_cd on what follows from E_cd, D_cd or k_tx, their mean on "
        "shear, twist, k_z and a given k_tz. With a measured curve E is its first slope",
    )
    loss_factor: LossFactors | None = Field(
        default=None,
        description="loss factor eta, measured at the frequency `at`, in place of ratio: "
        "tau = eta/(2 pi at); [eta_md, eta_cd] for MD and CD",
    )
    at: Frequency | None = Field(default=None, description="frequency at which loss_factor was measured")

    @model_validator(mode="after")
    def _one_of_them(self) -> Damping:
        forms = {"ratio": ("ratio", "ratio_ty", "rotation"), "time": ("time",), "loss": ("loss_factor", "at")}
        given = {form: [n for n in names if getattr(self, n) is not None] for form, names in forms.items()}
        if sum(map(bool, given.values())) > 1:
            message = ", ".join(name for names in given.values() for name in names)
            raise fail(
                f"damping by {message}: give time, or loss_factor with at, or ratio with what belongs to it"
            )
        if len(given["loss"]) == 1:
            message, other = ("loss_factor", "at") if self.at is None else ("at", "loss_factor")
            example = "at: 40 Hz" if self.at is None else "loss_factor: 0.05"
            raise fail(f"damping by {message} needs {other}, as {example}")
        return self

    @property
    def zetas(self) -> tuple[float, float]:
        """Relative damping of every component but ty, and of ty (Eq. 7)."""
        ratio = RATIO if self.ratio is None else self.ratio
        return ratio, ratio if self.ratio_ty is None else self.ratio_ty

    @property
    def times(self) -> tuple[float, float] | None:
        """Damping times of MD and CD [ms]; None with damping by ratio."""
        if self.time is not None:
            return _pair(self.time)
        if self.loss_factor is None or self.at is None:
            return None
        md, cd = _pair(self.loss_factor)
        turn = 2.0 * math.pi * self.at
        return md / turn, cd / turn

    @property
    def kind(self) -> Literal["inertia", "paper", "time"]:
        """Where the damping of a joint's rotations comes from."""
        return "time" if self.times is not None else self.rotation or "inertia"


def _pair(value: float | tuple[float, float]) -> tuple[float, float]:
    return value if isinstance(value, tuple) else (value, value)


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
    poisson: Ratio | None = Field(
        default=None,
        description="Poisson's ratio nu_md with layout plate: contraction along y over elongation along x of "
        "a strip pulled along x, and the same of curvatures; nu_cd is nu_md E_cd/E_md. Moduli and bending "
        "stiffness that are given are those of strips: a plate that is held across has E/(1 - nu_md nu_cd). "
        "Below sqrt(E_md/E_cd) and sqrt(D_md/D_cd); none where left out",
    )
    damping: Damping = Field(default_factory=Damping, description="damping of the joints")
    yield_: Yield | None = Field(
        default=None,
        alias="yield",
        description="bending beyond which the sheet keeps a part of its curvature; always elastic where left "
        "out",
    )

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

    @model_validator(mode="after")
    def _contraction(self) -> Material:
        if not self.poisson:
            return self
        for name in ("curve_md", "curve_cd"):
            if getattr(self, name) is not None:
                raise fail(
                    f"poisson and {name} are both given: what couples MD and CD is linear; give "
                    f"E_{name[-2:]} in place of {name}, or leave poisson out",
                    within=("poisson",),
                )
        if self.yield_ is not None:
            raise fail(
                "poisson and yield are both given: bending that yields along MD and CD is not coupled; leave "
                "one of them out",
                within=("poisson",),
            )
        self.bound("E", *self.moduli)
        return self

    def bound(self, name: str, md: float, cd: float) -> None:
        """Raises where Poisson's ratio leaves some strain without energy, with these values of `name`."""
        most = math.sqrt(md / cd)
        if self.poisson is not None and not self.poisson < most:
            raise fail(
                f"poisson: {float(self.poisson):g} is too large; allowed is less than "
                f"sqrt({name}_md/{name}_cd) = {most:.4g}, with which some strain would take no energy",
                within=("poisson",),
            )

    def strips(self, thickness: float, shape: float) -> tuple[float, float]:
        """Bending stiffness per width (D_md, D_cd) [N mm] of strips, also where hinges are given: of a joint
        whose length along x is `shape` times the one along y."""
        md, cd = self.plates(thickness)
        cd = cd if self.k_tx is None else self.k_tx / shape
        md = md if self.k_ty is None else self.k_ty * shape
        assert cd is not None and md is not None, "what is no hinge is a plate"
        return md, cd

    def plates(self, thickness: float) -> tuple[float | None, float | None]:
        """Bending stiffness per width (D_md, D_cd) [N mm]; None where a hinge stiffness is given, and where
        nothing is that of a solid plate, E s^3/12, a first guess."""
        md, cd = (modulus * thickness**3 / 12 for modulus in self.moduli)
        return (
            None if self.k_ty is not None else self.D_md if self.D_md is not None else md,
            None if self.k_tx is not None else self.D_cd if self.D_cd is not None else cd,
        )
