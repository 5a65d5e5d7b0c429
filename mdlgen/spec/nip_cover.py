"""Stiffness of the contacts of a nip whose rollers have covers, before the rollers are placed."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError

from mdlgen.rubber.layer import Layer
from mdlgen.spec.cover import Cover
from mdlgen.spec.covered import squeeze, stiffness_of
from mdlgen.spec.quantities import reading
from mdlgen.units import exact_quantity


def stiffness(own: dict[str, Any], other: dict[str, Any], force: Any, both: bool = False) -> str | None:
    """k of the contact of a roller with the sheet, or of both rollers with each other, from plain data of the
    two; None: the roller has no cover, or a value is wrong, which its own field reports."""
    sides = [(_radius(side), reading(side.get("width"), "mm", 0.0), _layer(side)) for side in (own, other)]
    load = reading(force, "N", 0.0)
    if both and sides[0][2] is None:
        sides.reverse()
    _, width, layer = sides[0]
    if layer is None or load <= 0.0 or any(side[0] <= 0.0 or side[1] <= 0.0 for side in sides):
        return None
    found = squeeze(width, layer, load, sides[1])
    return None if found is None else exact_quantity(stiffness_of(found, both), "N/mm^1.5")


def with_force(given: dict[str, Any], force: Any) -> dict[str, Any]:
    """A roller of a nip whose cover says no force with that of the nip."""
    cover = given.get("cover")
    if not isinstance(cover, dict) or cover.get("force") is not None or force is None:
        return given
    return {**given, "cover": {**cover, "force": force}}


def _radius(side: dict[str, Any]) -> float:
    if side.get("diameter") is not None:
        return 0.5 * reading(side["diameter"], "mm", 0.0)
    return reading(side.get("radius"), "mm", 0.0)


def _layer(side: dict[str, Any]) -> Layer | None:
    if side.get("cover") is None:
        return None
    try:
        layer = Cover.model_validate(side["cover"]).layer(_radius(side))
    except ValidationError:
        return None
    return layer if layer.thickness < layer.radius else None
