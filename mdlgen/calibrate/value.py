"""The values that can be found, and a scene with another of them."""

from __future__ import annotations

from typing import NamedTuple

from mdlgen.errors import SpecError
from mdlgen.model.tables import SheetPart
from mdlgen.report.overview import bending
from mdlgen.spec.material import Damping, Material
from mdlgen.spec.scene import Scene

# Where a search starts for a value that is zero in the scene, from which no factor leads away.
_FROM_ZERO = 0.1


class Fit(NamedTuple):
    """One value of a material."""

    unit: str  # as in the spec; empty for a plain number
    instead: str | None = None  # the other form of the same bending, which is taken away
    greatest: float | None = None  # what the spec allows


FITS = {
    "k_tx": Fit("N*mm/rad", "D_cd"),
    "k_ty": Fit("N*mm/rad", "D_md"),
    "D_cd": Fit("N*mm", "k_tx"),
    "D_md": Fit("N*mm", "k_ty"),
    "damping.ratio": Fit("", greatest=10.0),
    "damping.ratio_ty": Fit("", greatest=10.0),
}


def find(name: str) -> Fit:
    """The value of that name. Raises SpecError for one that cannot be found from a drop."""
    if name not in FITS:
        raise SpecError(f"--fit: {name[:40]!r} is not a value that is fitted; there are: {', '.join(FITS)}")
    return FITS[name]


def start(name: str, material: Material, sheet: SheetPart) -> float:
    """The scene's own value, in whichever form it is given there; above zero."""
    if name.startswith("damping."):
        ratio, ratio_ty = material.damping.ratio, material.damping.ratio_ty
        value = ratio if name == "damping.ratio" or ratio_ty is None else ratio_ty
    else:
        value = bending(sheet)[name]
    return value if value > 0.0 else _FROM_ZERO


def with_value(scene: Scene, material: str, name: str, value: float) -> Scene:
    """The scene with that value of a material; the other form of the same bending is taken away."""
    old = scene.materials[material]
    if name.startswith("damping."):
        damping: Damping = old.damping.model_copy(update={name.removeprefix("damping."): value})
        new = old.model_copy(update={"damping": damping})
    else:
        new = old.model_copy(update={name: value, str(FITS[name].instead): None})
    return scene.model_copy(update={"materials": {**scene.materials, material: new}})
