"""The base of every part of the machine with a body: its name, and the parts that it may touch."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar, get_args

from mdlgen.spec.strict import Strict

if TYPE_CHECKING:
    from mdlgen.spec.contact import Contact
    from mdlgen.spec.machine import Roller

PARALLEL = 1e-9  # of the cosine of the angle between two axes


class MachinePart(Strict):
    """A part of the machine. A table of the scene that holds such parts is one of the machine's."""

    kind: ClassVar[str]  # word for one in a sentence

    def unlike_sheets(self, name: str, contact: Contact) -> tuple[str, str] | None:
        """A key that its contact with a sheet must not have, and the message; None: all keys are allowed."""
        return None

    def unlike_roller(self, names: tuple[str, str], roller: Roller) -> str | None:
        """Why the contact of a roller and this part, of these names, is not modelled; None: it is."""
        return f"{not_modelled(names)}a {self.kind} touches sheets only"

    def unlike_others(self, names: tuple[str, str]) -> str:
        """Why the contact of another part that is no roller and this one is not modelled."""
        return f"{not_modelled(names)}a {self.kind} touches sheets and rollers only"


def not_modelled(names: tuple[str, str]) -> str:
    """How a message about a contact of two parts begins."""
    return f"contact between {names[0]} and {names[1]} is not modelled: "


def cosine(one: tuple[float, float, float], two: tuple[float, float, float]) -> float:
    """Cosine of the angle between two unit vectors."""
    return max(-1.0, min(1.0, sum(p * q for p, q in zip(one, two, strict=True))))


def on_its_end(
    names: tuple[str, str], axis: tuple[float, float, float], normal: tuple[float, float, float]
) -> str | None:
    """The message for a roller that stands on a flat face, less than 60 deg off its normal."""
    steep = abs(cosine(axis, normal))
    if steep <= 0.5:
        return None
    off = math.degrees(math.acos(steep))
    return (
        f"{not_modelled(names)}the roller stands on its end, its axis {off:.3g} deg off "
        "the normal of the face; allowed: 60 deg or more"
    )


def rim_of_sectors(names: tuple[str, str], other: str) -> str:
    """The message for a roller, the first of both, whose rim is in sectors."""
    return f"{not_modelled(names)}the rim of {names[0]} is in sectors, and {other} meets round rollers only"


def classes_of(scene: type[Any]) -> dict[str, type[MachinePart]]:
    """Classes of the machine's parts in the tables of a scene, by table, in the order of the bodies."""
    held = ((name, get_args(field.annotation)[-1:]) for name, field in scene.model_fields.items())
    classes = ((name, of[0]) for name, of in held if of and isinstance(of[0], type))
    return {name: of for name, of in classes if issubclass(of, MachinePart)}
