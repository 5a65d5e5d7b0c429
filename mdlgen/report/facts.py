"""What each part of a scene is as it begins, in words, and where its name may stand."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from mdlgen.model.tables import (
    Anchor,
    Floats,
    GuidePart,
    MachinePart,
    MeshPart,
    Model,
    PlanePart,
    RollerPart,
    SheetPart,
)
from mdlgen.report.arrows import extent

PER_SECOND = 1000.0


def facts(model: Model) -> Iterator[tuple[str, str, Floats, list[str]]]:
    """Name, kind, place of the name and facts of each sheet, part of the machine and probe."""
    bodies = model.bodies
    for sheet in model.sheets:
        mine = slice(sheet.first, sheet.first + sheet.count)
        yield sheet.name, "sheet", bodies.position[mine].mean(axis=0), _of_sheet(model, sheet)
    for part in model.machine:
        of, at = _FACTS.get(type(part), _of_other), _PLACES.get(type(part), _of_body)
        yield part.name, part.kind, at(model, part), of(model, part)
    for probe in model.probes:
        yield probe.name, "probe", _of_anchor(model, probe), [f"a point of {model.sheets[probe.sheet].name}"]


def _of_anchor(model: Model, anchor: Anchor) -> Floats:
    turned = np.einsum("nij,nj->ni", model.bodies.rotation[anchor.body], anchor.local)
    return anchor.share @ (model.bodies.position[anchor.body] + turned)


def _of_body(model: Model, part: MachinePart) -> Floats:
    return model.bodies.position[part.body]


def _on_plane(model: Model, plane: PlanePart) -> Floats:
    """At a corner of its face, or what is nearest to that of where other parts are: in the middle are the
    sheets."""
    bodies = model.bodies
    corner = bodies.half[plane.body] * [-1.0, -1.0, 1.0]
    corner = bodies.position[plane.body] + bodies.rotation[plane.body] @ corner
    near = np.clip(corner, *extent(model))
    return near + plane.normal * float((corner - near) @ plane.normal)


def _on_guide(model: Model, guide: GuidePart) -> Floats:
    """The middle of its face."""
    if guide.radius == 0.0:
        return guide.center
    way = np.array([np.cos(guide.middle), np.sin(guide.middle), 0.0])
    return guide.center + guide.radius * guide.axes @ way


def _of_sheet(model: Model, sheet: SheetPart) -> list[str]:
    mine = slice(sheet.first, sheet.first + sheet.count)
    x, y = sheet.outline
    mass = float(model.bodies.mass[mine].sum())
    facts = [
        f"{x:.4g} x {y:.4g} mm, {sheet.thickness:.4g} mm thick, {mass:.4g} g",
        f"{sheet.n_x} x {sheet.n_y} boxes, {sheet.layout}",
    ]
    for zone in sheet.zones:
        facts.append(f"zone {zone.name}: {int(np.count_nonzero(zone.share))} boxes")
    if sheet.bend is not None:
        facts.append(f"not flat at rest, begins {sheet.bend.start}")
    speed, spin = float(np.linalg.norm(sheet.velocity)), float(np.linalg.norm(sheet.spin))
    if speed > 0.0:
        facts.append(f"begins with {PER_SECOND * speed:.4g} mm/s")
    if spin > 0.0:
        facts.append(f"begins with a spin of {PER_SECOND * spin:.4g} rad/s")
    if sheet.clamp is not None:
        facts.append(f"clamped at {sheet.clamp.edge}")
    return facts


def _of_roller(model: Model, roller: RollerPart) -> list[str]:
    facts = [f"radius {roller.radius:.4g} mm, width {roller.width:.4g} mm, {roller.mass:.4g} g"]
    if roller.speed is None:
        facts.append("turns freely")
    elif roller.profile is not None:
        facts.append(f"driven by a profile, {PER_SECOND * roller.speed:.4g} rad/s at most")
    else:
        surface = PER_SECOND * abs(roller.speed) * roller.radius
        ramp = f", ramp {roller.ramp:.4g} ms" if roller.ramp else ""
        facts.append(f"driven at {PER_SECOND * roller.speed:.4g} rad/s, surface {surface:.4g} mm/s{ramp}")
    if roller.one_way is not None:
        facts.append(f"clutch, free in the sense {roller.one_way.direction:+d}")
    if roller.press is not None:
        spring = roller.press
        facts.append(
            f"pressed along {_shown(spring.direction)} by {spring.preload:.4g} N where it touches, "
            f"{spring.stiffness:.4g} N/mm"
        )
    if roller.arm is not None:
        facts.append(f"on an arm of {roller.arm.mass:.4g} g, spring torque {roller.arm.torque:.4g} N mm")
    if roller.rim is not None:
        facts.append(f"rim of {len(roller.rim)} sectors")
    return facts


def _of_plane(model: Model, plane: PlanePart) -> list[str]:
    facts = [" x ".join(f"{s:.4g}" for s in plane.size) + f" mm, face towards {_shown(plane.normal)}"]
    if plane.press is None:
        return [*facts, "fixed"]
    spring = plane.press
    force = f"pressed along {_shown(spring.direction)} by {spring.preload:.4g} N, {spring.stiffness:.4g} N/mm"
    return [*facts, f"{force}, {plane.sliding_mass:.4g} g"]


def _of_guide(model: Model, guide: GuidePart) -> list[str]:
    if guide.radius == 0.0:
        form = f"straight, {guide.length:.4g} mm long"
    else:
        form = f"arc of radius {guide.radius:.4g} mm over {np.degrees(2 * guide.half_angle):.4g} deg"
    return [f"{form}, {guide.width:.4g} mm wide", f"touched on the side: {guide.side}"]


def _of_mesh(model: Model, mesh: MeshPart) -> list[str]:
    where = "fixed" if mesh.on < 0 else f"turns with {model.rollers[mesh.on].name}"
    return [f"{mesh.file}, {len(mesh.triangles)} triangles", where]


def _of_other(model: Model, part: MachinePart) -> list[str]:
    return []


_PLACES: dict[type, Callable[[Model, Any], Floats]] = {PlanePart: _on_plane, GuidePart: _on_guide}
_FACTS: dict[type, Callable[[Model, Any], list[str]]] = {
    RollerPart: _of_roller,
    PlanePart: _of_plane,
    GuidePart: _of_guide,
    MeshPart: _of_mesh,
}


def _shown(way: Floats) -> str:
    """A direction as a scene has it."""
    for axis, part in zip("xyz", way.tolist(), strict=True):
        if abs(part) > 1.0 - 1e-9:
            return axis if part > 0.0 else f"-{axis}"
    return "[" + ", ".join(f"{round(part, 3) + 0.0:g}" for part in way.tolist()) + "]"
