"""Measures of a run over its stored times, by their names in the summary."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model.parts.kinds import KINDS
from mdlgen.model.tables import Floats, PlanePart, RollerPart
from mdlgen.results.drag import drags
from mdlgen.results.gates import place as place_of
from mdlgen.results.slide import slide
from mdlgen.results.torques import contact_torque, drive_power, drive_torque, grips
from mdlgen.results.way import way_of

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def series(result: Result, path: str) -> Floats:
    """A measure over the stored times, in internal units, (t,)."""
    kind, _, rest = path.partition(".")
    name, _, what = rest.partition(".")
    model = result.model
    if kind == "sheets":
        index = next(k for k, sheet in enumerate(model.sheets) if sheet.name == name)
        place, rate, yaw = result.sheet_motion(index)
        sizes = {"yaw": yaw, "yaw_deg": yaw}
        part = model.sheets[index]
        begun = model.mass_share(index) @ model.bodies.position[part.first : part.first + part.count]
        for key, vectors in (("travel", place - begun), ("speed", rate)):
            sizes[key] = np.linalg.norm(vectors, axis=1)
            sizes |= {f"{key}.{axis}": vectors[:, k] for k, axis in enumerate("xyz")}
        if what in sizes:
            return sizes[what]
        tension = result.tensions[index] if what.startswith("tension") else None
        if tension is not None:
            most, least = tension.greatest, tension.least
            sizes = {"tension": np.maximum(most, -least), "tension.max": most, "tension.min": least}
            if (what := what.removesuffix("_n")) in sizes:
                return sizes[what]
        if what in ("way", "way_mm", "skew", "skew_deg"):
            way = way_of(result, index)
            return way.length if what.startswith("way") else way.skew
    parts = {part.name: part for part in model.machine}
    if kind in {each.table for each in KINDS} and name in parts:
        if what in ("nip_force", "nip_force_n"):
            sides = zip(model.contacts.part_a, model.contacts.part_b, strict=True)
            return result.contact_force[:, [k for k, ends in enumerate(sides) if name in ends]].sum(axis=1)
        if what in ("slide", "slide_mm") and isinstance(part := parts[name], RollerPart | PlanePart):
            way = slide(result, part)
            if way is not None:
                return way
        if (
            what in ("slide", "slide_mm", "angle", "angle_deg")
            and (way := place_of(result, parts[name])) is not None
        ):
            return way
        for sheet, drag in drags(result, parts[name]).items():
            if what in (f"contacts.{sheet}.drag", f"contacts.{sheet}.drag_n"):
                return drag
        if kind == "rollers" and what in ("omega", "omega_rad_per_s"):
            roller = model.roller(name)
            return result.spin[:, roller.body] @ roller.axis
        if kind == "rollers" and (found := _turning(result, model.roller(name), what)) is not None:
            return found
    raise ValueError(
        f"{path} is known at the end alone; known over time: yaw, skew, speed, travel, way and tension of "
        "sheets; nip_force and slide of parts, contacts.SHEET.drag of planes, guides and meshes; and omega, "
        "torque, power, contact_torque and traction.OTHER.reserve of rollers"
    )


def _turning(result: Result, roller: RollerPart, what: str) -> Floats | None:
    """Torque, power or grip reserve of a roller over the stored times, (t,); a grip that does not act has
    the full reserve."""
    for name, unit, found in (
        ("torque", "n_mm", drive_torque),
        ("power", "w", drive_power),
        ("contact_torque", "n_mm", contact_torque),
    ):
        if what in (name, f"{name}_{unit}"):
            return found(result, roller)
    for grip in grips(result, roller):
        if what == f"traction.{grip.other}.reserve":
            return 1.0 - np.nan_to_num(grip.used)
    return None
