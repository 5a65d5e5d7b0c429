"""Facts about each part of a scene at its start, in words, and the place for its name."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import Anchor, Floats, Model, SheetPart
from mdlgen.report.arrows import extent
from mdlgen.report.sights import WORDS
from mdlgen.units import PER_SECOND


def facts(model: Model) -> Iterator[tuple[str, str, Floats, list[str]]]:
    """Name, kind, place of the name and facts of each sheet, part of the machine, probe and
    sensor."""
    bodies, seen = model.bodies, extent(model)
    for sheet in model.sheets:
        mine = slice(sheet.first, sheet.first + sheet.count)
        yield sheet.name, "sheet", bodies.position[mine].mean(axis=0), _of_sheet(model, sheet)
    for part in model.machine:
        kind = kind_of(part)
        yield part.name, part.kind, kind.label(model, part, seen), kind.facts(model, part)
    for probe in model.probes:
        yield probe.name, "probe", _of_anchor(model, probe), [f"a point of {model.sheets[probe.sheet].name}"]
    for sensor in model.reactions.sensors:
        reach = float(np.linalg.norm(sensor.way))
        yield (
            sensor.name,
            "sensor",
            sensor.ends.mean(axis=0) + 0.5 * sensor.way,
            [f"{WORDS[sensor.kind]}, {reach:.4g} mm long"],
        )


def _of_anchor(model: Model, anchor: Anchor) -> Floats:
    turned = np.einsum("nij,nj->ni", model.bodies.rotation[anchor.body], anchor.local)
    return anchor.share @ (model.bodies.position[anchor.body] + turned)


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
