"""Covers of rollers: Scene -> tables, and how much further a nip's surface goes than its core."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import BOX_CYLINDER, CYLINDER_CYLINDER, CoverPart, Floats, Model, RollerPart
from mdlgen.rubber.contact import Squeezed, loaded
from mdlgen.rubber.layer import Layer
from mdlgen.spec.covered import meets, nip_of, stiffness_of
from mdlgen.spec.scene import Scene

# Loads, relative to that of the nip, between which the misfit of the laws is stated.
LOW, HIGH = 0.5, 2.0


def lower_cover(scene: Scene, name: str) -> CoverPart | None:
    """The cover of a roller, in its nip; None: it has none, or is in no contact."""
    cover, pairs = scene.rollers[name].cover, list(scene.contact_pairs())
    if cover is None or not meets(name, pairs):
        return None
    found = nip_of(scene, name, pairs)
    own, k = found.nip.covers[0], stiffness_of(found)
    ends = [(share, nip.covers[0]) for share in (LOW, HIGH) if (nip := found.at(share)) is not None]
    u, gain, depth, share = (np.array(v) for v in zip(
        *((share ** (2 / 3), end.gain, end.depth, share) for share, end in ends), strict=True
    ))  # fmt: skip
    curved = u * u - u
    bend = float(curved @ (gain - own.gain * u) / (curved @ curved))
    return CoverPart(
        thickness=cover.thickness,
        modulus=cover.stiff,
        poisson=cover.poisson,
        hardness=cover.hardness,
        other=found.other,
        force=found.force,
        width=found.width,
        half=found.nip.half,
        pressure=found.nip.pressure,
        depth=own.depth,
        gain=own.gain,
        bend=bend,
        misfit=float(np.abs(k * depth**1.5 / (share * found.force) - 1.0).max()),
        gain_misfit=float(np.abs(own.gain * u + bend * curved - gain).max()),
    )


def under(model: Model, roller: RollerPart, force: float) -> Squeezed | None:
    """The nip of a roller with a cover under a force [N]; None: none touches, or it is too wide."""
    assert roller.cover is not None, "asked only of one with a cover"
    other = next((r for r in model.rollers if r.name == roller.cover.other), None)
    both = [part for part in (roller, other) if part is not None]
    layers = tuple(
        Layer(part.cover.modulus, part.cover.poisson, part.cover.thickness, part.radius)
        for part in both
        if part.cover is not None
    )
    curvature = sum(1.0 / part.radius for part in both)
    return loaded(layers, curvature, force / roller.cover.width) if force > 0.0 else None


def depth_of(cover: CoverPart, stiffness: float) -> float:
    """Depth [mm] at which a law k z^1.5 has the force of the cover's nip."""
    return (cover.force / stiffness) ** (2 / 3)


def speed_ratio(cover: CoverPart, force: Floats | float) -> Floats | float:
    """Speed of a sheet on the cover over that of its undeformed surface, under forces [N], as runs have it:
    v/(omega R) - 1 is a parabola over the depth, and that goes with F^(2/3)."""
    u = (np.maximum(force, 0.0) / cover.force) ** (2 / 3)
    return 1.0 + cover.gain * u + cover.bend * (u * u - u)


def levers(model: Model) -> tuple[Floats, Floats]:
    """Distance of the friction of each contact beyond the undeformed surface: l z + b z^2 at a depth z, l
    (n,) and b [1/mm] (n,).

    For a sheet on a roller it is measured from R, so that the rolling surface moves at omega (R + l z + b
    z^2). For two rollers a and b friction acts at R_a - z/2 and R_b - z/2 from their axes, shifted by that
    distance towards b. Their speeds match there if omega_a R_a (1 + gain_a) = omega_b R_b (1 + gain_b), to
    the first order of gains and z/R.
    """
    rollers = {roller.name: roller for roller in model.rollers}
    found = np.zeros((2, len(model.contacts)))
    if not any(roller.cover is not None for roller in rollers.values()):
        return found[0], found[1]
    table = model.contacts
    for row, kind in enumerate(table.kind.tolist()):
        one, two = rollers.get(table.part_a[row]), rollers.get(table.part_b[row])
        k = float(table.stiffness[row])
        if kind == BOX_CYLINDER and two is not None and two.cover is not None:
            found[:, row] = two.radius * _over_depth(two.cover, k)
        elif kind == CYLINDER_CYLINDER and one is not None and two is not None:
            found[:, row] = _between(one, two, k)
    return found[0], found[1]


def _over_depth(cover: CoverPart, k: float) -> Floats:
    """The gain over the depth z of a law k z^1.5: of z, and of z^2."""
    depth = depth_of(cover, k)
    return np.array([(cover.gain - cover.bend) / depth, cover.bend / depth**2])


def _between(one: RollerPart, two: RollerPart, k: float) -> Floats:
    found = np.zeros(2)
    if one.cover is None and two.cover is None:
        return found
    for sign, roller in ((1.0, one), (-1.0, two)):
        found[0] += sign * 0.5 / roller.radius
        if roller.cover is not None:
            found += sign * _over_depth(roller.cover, k)
    return found / (1.0 / one.radius + 1.0 / two.radius)


def covered(cover: CoverPart) -> list[str]:
    """The message about a cover and its nip."""
    hard = "" if cover.hardness is None else f"{cover.hardness:g} ShA, "
    facing, width = cover.other or "a flat face", 2.0 * cover.half
    force, gain = 100.0 * cover.misfit, 100.0 * cover.gain_misfit
    return [
        f"cover {cover.thickness:.4g} mm, {hard}E {cover.modulus:.4g} MPa, nu {cover.poisson:.4g}",
        f"nip with {facing} at {cover.force:.4g} N: {width:.3g} mm wide, {cover.depth:.3g} mm deep, "
        f"pressure {cover.pressure:.3g} MPa, speed ratio {1.0 + cover.gain:.5g}",
        f"from {LOW:g} to {HIGH:g} times that force the law of the run is within "
        f"{force:.2g} % of the layer's force and {gain:.2g} % of its speed",
    ]
