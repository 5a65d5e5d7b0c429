"""Values that follow from the covers of rollers: nips, and stiffness of contacts that leave it out."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from pydantic_core import PydanticCustomError

from mdlgen.rubber.contact import WIDEST, Squeezed, loaded
from mdlgen.rubber.layer import Layer
from mdlgen.spec.machine import Roller
from mdlgen.spec.over_time import begun
from mdlgen.spec.quantities import following
from mdlgen.spec.strict import fail, fail_all

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene

PARALLEL = 0.985  # cosine of 10 degrees
SAME = 1e-6  # of two stiffnesses that one entry of the contacts may have: round-off of the solution
Pair = tuple[int, str, str]


class CoveredNip(NamedTuple):
    """A roller with a cover in its nip: the other roller ("": a flat face), the force [N], the width along
    the axis [mm], 1/R1 + 1/R2 [1/mm], the covers of both, its own first, and the nip."""

    other: str
    force: float
    width: float
    curvature: float
    covers: tuple[Layer, ...]
    nip: Squeezed

    def at(self, share: float) -> Squeezed | None:
        """The nip at a share of its force; None: it would be too wide."""
        return loaded(self.covers, self.curvature, share * self.force / self.width)


def meets(name: str, pairs: Iterable[Pair]) -> bool:
    """Tests whether a roller is in any contact. A cover that nothing meets has no nip, and needs no force."""
    return any(name in (one, two) for _, one, two in pairs)


def nip_of(scene: Scene, name: str, pairs: Iterable[Pair]) -> CoveredNip:
    """The nip of a roller with a cover. Raises the error where its force is not known, or it is too wide."""
    roller, other = scene.rollers[name], _facing(scene, name, pairs)
    assert roller.cover is not None, "asked only of one with a cover"
    partner = scene.rollers.get(other)
    force = roller.cover.force
    if force is None and partner is not None and partner.cover is not None:
        force = partner.cover.force
    if force is None:
        force = max((_pressing(scene, one) for one in (roller, partner) if one is not None), default=0.0)
    if force <= 0.0:
        raise fail(
            f"the force of the nip of {name} is not known: neither it nor a roller that faces it has a press "
            "with a preload; write like force: 5 N",
            ("rollers", name, "cover"),
        )
    facing = None
    if partner is not None:
        facing = partner.radius, partner.width, layer_of(partner)
    found = squeeze(roller.width, roller.cover.layer(roller.radius), force, facing)
    if found is None:
        raise fail(
            f"a force of {force:.4g} N presses the cover of {name} to a nip wider than {2 * WIDEST:g} of the "
            "radius, where the formulas of a thin strip of contact do not hold, or cannot be computed; use a "
            "harder cover, a wider roller or less force",
            ("rollers", name, "cover"),
        )
    return found._replace(other=other)


def layer_of(roller: Roller) -> Layer | None:
    """The cover of a roller as a layer."""
    return None if roller.cover is None else roller.cover.layer(roller.radius)


def squeeze(
    width: float, layer: Layer, force: float, other: tuple[float, float, Layer | None] | None
) -> CoveredNip | None:
    """The nip of a roller with a cover under a force and, with its radius, width and cover, another one
    (None: a flat face); None: it is too wide."""
    covers, curvature = (layer,), 1.0 / layer.radius
    if other is not None:
        curvature += 1.0 / other[0]
        width = min(width, other[1])
        if other[2] is not None:
            covers += (other[2],)
    try:
        nip = loaded(covers, curvature, force / width)
    except (ArithmeticError, ValueError, np.linalg.LinAlgError):  # of values that are very far apart
        nip = None
    return None if nip is None else CoveredNip("", force, width, curvature, covers, nip)


def stiffness_of(found: CoveredNip, both: bool = False) -> float:
    """k [N/mm^1.5] that has the force of the nip at its depth: of the first cover, or of both together."""
    depth = sum(cover.depth for cover in found.nip.covers[: 2 if both else 1])
    return found.force / (depth * math.sqrt(depth))


def with_stiffness(scene: Scene, pairs: Iterable[Pair]) -> None:
    """Gives contacts that leave their stiffness out that of the covers they are on. Raises the error where
    there is none, where it differs, and where a cover is not modelled."""
    pairs, errors = list(pairs), []
    found: dict[str, CoveredNip] = {}
    for name, roller in scene.rollers.items():
        if roller.cover is not None and meets(name, pairs):
            try:
                found[name] = nip_of(scene, name, pairs)
            except PydanticCustomError as error:
                errors.append(error)
    if errors:
        raise fail_all(errors)
    stiff: dict[int, dict[str, float]] = {}
    for index, one, two in pairs:
        contact, owner = scene.contacts[index], next((n for n in (one, two) if n in found), None)
        if owner is not None and any(n not in scene.rollers and n not in scene.sheets for n in (one, two)):
            other = two if owner == one else one
            errors.append(
                fail(
                    f"contact between {owner} and {other} is not modelled: {owner} has a cover, which meets "
                    "sheets and rollers only",
                    ("contacts", index, "between"),
                )
            )
        elif contact.stiffness is None:
            if owner is None:
                errors.append(_missing(index, f"neither {one} nor {two} has a cover"))
                continue
            both = one in scene.rollers and two in scene.rollers
            stiff.setdefault(index, {})[f"{one} and {two}"] = stiffness_of(found[owner], both)
    for index, values in stiff.items():
        low, high = (pick(values, key=values.__getitem__) for pick in (min, max))
        if scene.contacts[index].share == "pair":
            errors.append(_missing(index, "with share: pair it does not follow from a cover"))
        elif values[high] > (1.0 + SAME) * values[low]:
            text = f"it is {values[low]:.4g} of {low} and {values[high]:.4g} of {high}; give each an entry"
            errors.append(_missing(index, text))
    if errors:
        raise fail_all(errors)
    if stiff:
        vars(scene)["contacts"] = tuple(
            contact.model_copy(update={"stiffness": following(max(stiff[index].values()))})
            if index in stiff
            else contact
            for index, contact in enumerate(scene.contacts)
        )


def _missing(index: int, why: str) -> PydanticCustomError:
    return fail(
        f"the key 'stiffness' is missing: {why}; write like stiffness: 300 N/mm^1.5",
        ("contacts", index),
    )


def _pressing(scene: Scene, roller: Roller) -> float:
    """Preload of the press of a roller, and its weight along that [N]."""
    press = roller.press
    if press is None:
        return 0.0
    mass = roller.mass * (1.001 if press.carrier_mass is None else 1.0) + (press.carrier_mass or 0.0)
    pull = sum(g * d for g, d in zip(scene.gravity, press.direction, strict=True))
    return press.preload + mass * begun(scene.gravity_profile) * pull


def _facing(scene: Scene, name: str, pairs: Iterable[Pair]) -> str:
    """The nearest parallel roller on the same sheets, or in contact with this one, that is no further away
    than the smaller radius; "" where there is none."""
    own = scene.rollers[name]
    met = {frozenset((one, two)) for _, one, two in pairs}
    sheets = {sheet for sheet in scene.sheets if frozenset((sheet, name)) in met}
    best = ("", math.inf)
    for other, roller in scene.rollers.items():
        shares = any(frozenset((sheet, other)) in met for sheet in sheets)
        if other == name or not (shares or frozenset((other, name)) in met):
            continue
        if abs(sum(p * q for p, q in zip(own.axis, roller.axis, strict=True))) < PARALLEL:
            continue
        gap = [p - q for p, q in zip(roller.center, own.center, strict=True)]
        along = sum(g * a for g, a in zip(gap, own.axis, strict=True))
        apart = math.dist(gap, [along * a for a in own.axis]) - own.radius - roller.radius
        if abs(along) >= 0.5 * (own.width + roller.width) or apart > min(own.radius, roller.radius):
            continue
        if apart < best[1]:
            best = other, apart
    return best[0]
