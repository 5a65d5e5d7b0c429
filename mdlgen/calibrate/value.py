"""The values that can be found, and a scene with another of them."""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.errors import SpecError
from mdlgen.formulas import is_formula
from mdlgen.model.parameters.names import unit
from mdlgen.model.tables import SheetPart
from mdlgen.report.overview import bending
from mdlgen.spec.material import Damping, Material
from mdlgen.spec.scene import Scene

# Where a search starts for a value that is zero in the scene, or not given, from which no factor leads away.
_FROM_ZERO = 0.1
_BY_RATIO = ("ratio", "ratio_ty", "rotation")


class Fit(NamedTuple):
    """One value of a material."""

    unit: str  # as in the spec; empty for a plain number
    instead: str | None = None  # the other form of the same bending, or of the damping, which is taken away
    greatest: float | None = None  # greatest value that the spec allows


FITS = {
    "k_tx": Fit("N*mm/rad", "D_cd"),
    "k_ty": Fit("N*mm/rad", "D_md"),
    "D_cd": Fit("N*mm", "k_tx"),
    "D_md": Fit("N*mm", "k_ty"),
    "damping.ratio": Fit("", greatest=10.0),
    "damping.ratio_ty": Fit("", greatest=10.0),
    "damping.time": Fit("ms", "damping by ratio or loss_factor"),
    "damping.loss_factor": Fit("", "damping by ratio or time", greatest=10.0),
}


_OF_SCENE = "parameters."  # in front of a parameter that the user named


def of_scene(name: str) -> bool:
    """True if a value is a parameter of the scene, not a value of a material."""
    return name.startswith(_OF_SCENE)


def find(name: str, scene: Scene | None = None) -> Fit:
    """The value of that name, of a material or a parameter of the scene. Raises SpecError for one that cannot
    be found from a drop."""
    if of_scene(name):
        own = name.removeprefix(_OF_SCENE)
        if scene is None:
            return Fit("")
        if own not in scene.amounts:
            there = ", ".join(scene.amounts) or "none"
            raise SpecError(f"--fit: there is no parameter {own[:40]!r} in the scene; there are: {there}")
        given = scene.parameters[own]
        if isinstance(given, str) and is_formula(given, scene.parameters):
            raise SpecError(f"--fit: the parameter {own} is a formula; fit what it follows from")
        shown = unit(scene.amounts[own].dimension)
        return Fit("" if shown == "1" else shown)
    if name not in FITS:
        named = ", ".join([*FITS, f"{_OF_SCENE}NAME"])
        raise SpecError(f"--fit: {name[:40]!r} is not a value that is fitted; there are: {named}")
    return FITS[name]


def check(name: str, material: Material) -> None:
    """Raises SpecError where a scene lacks another value that this one needs."""
    if name == "damping.loss_factor" and material.damping.at is None:
        raise SpecError(
            "a loss factor belongs to a frequency, and the scene has none: give one, as "
            '--set materials.NAME.damping.at="40 Hz" --set materials.NAME.damping.loss_factor=0.05'
        )


def start(name: str, scene: Scene, material: Material, sheet: SheetPart) -> float:
    """The scene's own value, in whichever form it is given there; above zero. The mean of MD and CD."""
    damping = material.damping
    if of_scene(name):
        value = scene.amounts[name.removeprefix(_OF_SCENE)].value
    elif name == "damping.ratio":
        value = damping.zetas[0]
    elif name == "damping.ratio_ty":
        value = damping.zetas[1]
    elif name.startswith("damping."):
        value = 0.5 * sum(damping.times or (0.0, 0.0))
        if name == "damping.loss_factor" and damping.at is not None:
            value *= 2.0 * math.pi * damping.at
    else:
        value = bending(sheet)[name]
    return value if value > 0.0 else _FROM_ZERO


def with_value(scene: Scene, material: str, name: str, value: float) -> Scene:
    """The scene with that value of a material; the other form of the same bending, or of the damping, is
    removed. All values that depend on a parameter follow it."""
    if of_scene(name):
        return scene.with_({name: f"{value!r} {find(name, scene).unit}".rstrip()})
    old = scene.materials[material]
    if name.startswith("damping."):
        own = name.removeprefix("damping.")
        new = old.model_copy(update={"damping": _damping(old.damping, own, value)})
    else:
        new = old.model_copy(update={name: value, str(FITS[name].instead): None})
    return scene.model_copy(update={"materials": {**scene.materials, material: new}})


def _damping(old: Damping, own: str, value: float) -> Damping:
    """Damping with one value of it; what does not go with it is left out."""
    forms = (_BY_RATIO, ("time",), ("loss_factor", "at"))
    others = [name for form in forms if own not in form for name in form]
    return old.model_copy(update={**dict.fromkeys(others), own: value})
