"""Entries of summary.json for parts of the machine: contacts, energy, and torques of rollers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mdlgen.model.covers import speed_ratio, under
from mdlgen.model.tables import Floats, MachinePart, PlanePart, RollerPart
from mdlgen.results.drag import drags
from mdlgen.results.gates import record
from mdlgen.results.losses import driven
from mdlgen.results.motors import motor_record
from mdlgen.results.result import Result
from mdlgen.results.slide import slide
from mdlgen.results.swing import swing
from mdlgen.results.torques import (
    Grip,
    contact_torque,
    drive_power,
    drive_torque,
    grips,
    over_time,
    peak,
)
from mdlgen.units import PER_SECOND


def _energy_of_part(result: Result, part: MachinePart) -> dict[str, float | None]:
    """Energy that the drive of a roller put in, and energy that friction and rolling took at the contacts of
    a part. A contact between two parts of the machine counts half for each part."""
    found = result.losses
    power = None if found is None else found.of(result, part)
    record = {"friction_n_mm": None if power is None else float(np.trapezoid(power, result.time))}
    if isinstance(part, RollerPart):
        given = None if found is None else driven(result, part)
        record = {"driven_n_mm": None if given is None else float(given[-1]), **record}
    return record


def part_rows(result: Result, part: MachinePart) -> dict[int, str]:
    """Rows of contacts of a part of the machine, with the name of the other part."""
    contacts = result.model.contacts
    sides = zip(contacts.part_a, contacts.part_b, strict=True)
    return {k: b if a == part.name else a for k, (a, b) in enumerate(sides) if part.name in (a, b)}


def _contacts(result: Result, rows: dict[int, str]) -> dict[str, dict[str, float | None]]:
    """Statistics of each contact of a part."""
    statistics = result.statistics
    return {
        other: {
            "max_penetration_mm": statistics.max_depth[k],
            "mean_penetration_mm": statistics.mean_depth[k],
            "max_force_n": statistics.max_force[k],
            "mean_force_n": statistics.mean_force[k],
        }
        for k, other in rows.items()
    }


def _touched(result: Result, part: MachinePart) -> dict[str, Any]:
    """The sum of normal forces on a part at the end, and its contacts."""
    rows = part_rows(result, part)
    force = float(result.contact_force[-1, list(rows)].sum()) if len(result.time) else None
    contacts, taken = _contacts(result, rows), drags(result, part)
    for row, other in rows.items():
        if other in taken:
            contacts[other] |= _drag(result, row, taken[other])
    return {"nip_force_n": force, "contacts": contacts, "energy": _energy_of_part(result, part)}


def _drag(result: Result, row: int, drag: Floats) -> dict[str, float | None]:
    """Friction drag of a part on a sheet: at the end, the greatest of the stored times, and the mean over
    those at which the two touch."""
    if not len(drag):
        return dict.fromkeys(("drag_n", "max_drag_n", "mean_drag_n"))
    touches = result.contact_force[:, row] > 0.0
    mean = float(drag[touches].mean()) if touches.any() else 0.0
    return {"drag_n": float(drag[-1]), "max_drag_n": float(drag.max()), "mean_drag_n": mean}


def _pressing(result: Result, part: RollerPart | PlanePart) -> dict[str, Any]:
    """Press force of a roller or a plane on its counterpart."""
    sheets = {s.name for s in result.model.sheets}
    on_sheets = [k for k, other in part_rows(result, part).items() if other in sheets]
    return {
        **_touched(result, part),
        "max_penetration_mm": max((result.statistics.max_depth[k] for k in on_sheets), default=0.0),
        "mean_penetration_mm": _mean(result.statistics.mean_depth, on_sheets, result),
    }


def _centre(result: Result, part: RollerPart | PlanePart) -> dict[str, Any]:
    """Position at the end. For a pressed part also the displacement along its press direction, with its
    extremes over the stored times."""
    record: dict[str, Any] = {"center_mm": result.position[-1, part.body] if len(result.time) else None}
    if isinstance(part, RollerPart) and (turned := swing(result, part)) is not None and len(turned):
        angles = np.degrees([turned[-1], turned.max(), turned.min()])
        record |= dict(zip(("arm_deg", "max_arm_deg", "min_arm_deg"), angles, strict=True))
    if (way := slide(result, part)) is not None:
        numbers = (way[-1], way.max(), way.min()) if len(way) else (None, None, None)
        record |= dict(zip(("slide_mm", "max_slide_mm", "min_slide_mm"), numbers, strict=True))
    return record


def _plane(result: Result, plane: PlanePart) -> dict[str, Any]:
    """Position at the end of a moving part, and its press force."""
    return {**({} if plane.press is None else _centre(result, plane)), **_pressing(result, plane)}


def _roller(result: Result, roller: RollerPart) -> dict[str, Any]:
    rows = part_rows(result, roller)
    rollers = {r.name for r in result.model.rollers}
    on_rollers = np.array([k for k, other in rows.items() if other in rollers], dtype=np.int64)
    speed = float(result.spin[-1, roller.body] @ roller.axis) * PER_SECOND if len(result.time) else None
    return {
        "omega_rad_per_s": speed,
        **_centre(result, roller),
        **_pressing(result, roller),
        # nan, a contact that still acts, wins: the roller is not free then
        "free_of_counterpart_at_ms": np.max(result.statistics.last_force_at[on_rollers], initial=0.0),
        **_turning(result, roller),
        **_nip(result, roller, rows),
    }


def _nip(result: Result, roller: RollerPart, rows: dict[int, str]) -> dict[str, Any]:
    """Nip of a roller with a cover: width by the layer, and speed ratio of the run. Both are under the mean
    of its force over the stored times at which a sheet, or the other roller, is in the nip."""
    if roller.cover is None:
        return {}
    sheets = {s.name for s in result.model.sheets}
    chosen = [k for k, other in rows.items() if other in sheets] or list(rows)
    force = result.contact_force[:, chosen].sum(axis=1)
    mean = float(force[force > 0.0].mean()) if (force > 0.0).any() else 0.0
    nip = under(result.model, roller, mean)
    return {
        "mean_nip_force_n": mean,
        "nip_width_mm": None if nip is None else 2.0 * nip.half,
        "speed_ratio": float(speed_ratio(roller.cover, mean)),
    }


def _turning(result: Result, roller: RollerPart) -> dict[str, Any]:
    """Torques of the drive and the contacts of a roller, and the used part of their grip. Each has the value
    at the end, the greatest in magnitude over the stored times, and the mean."""
    record: dict[str, Any] = {}
    for name, unit, values in (
        ("torque", "n_mm", drive_torque(result, roller)),
        ("power", "w", drive_power(result, roller)),
        ("contact_torque", "n_mm", contact_torque(result, roller)),
    ):
        numbers = (None, None, None)
        if values is not None and len(values):
            numbers = (float(values[-1]), peak(values), over_time(result, values))
        record |= {f"{of}{name}_{unit}": v for of, v in zip(("", "max_", "mean_"), numbers, strict=True)}
    if roller.axle is not None:
        record |= motor_record(result, roller)
    return {**record, "traction": {grip.other: _traction(grip) for grip in grips(result, roller)}}


def _traction(grip: Grip) -> dict[str, float]:
    """Traction of one contact over the stored times at which it acts; nan where it never does, null in
    JSON."""
    used = grip.used
    acts = np.isfinite(used)
    if not acts.any():
        return dict.fromkeys(("tangential_n", "limit_n", "reserve", "least_reserve"), math.nan)
    along, limit = float(np.abs(grip.along[acts]).mean()), float(grip.limit[acts].mean())
    return {
        "tangential_n": along,
        "limit_n": limit,
        "reserve": 1.0 - along / limit,
        "least_reserve": 1.0 - float(used[acts].max()),
    }


# of kinds of which there is more to say than of every part
_MORE: dict[type, Callable[[Result, Any], dict[str, Any]]] = {RollerPart: _roller, PlanePart: _plane}


def of_part(result: Result, part: MachinePart) -> dict[str, Any]:
    return {**record(result, part), **_MORE.get(type(part), _touched)(result, part)}


def _mean(depth: Floats, rows: list[int], result: Result) -> float:
    """Mean over the time in contact; with several sheets each weighs by the stored times it touches at."""
    if not rows:
        return 0.0
    weight = (result.contact_force[:, rows] > 0.0).sum(axis=0).astype(float)
    return float(np.average(depth[rows], weights=weight if weight.any() else None))
