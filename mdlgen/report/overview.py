"""An overview of a scene before it is run: derived quantities, counts, lints."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from mdlgen.checks import lints
from mdlgen.lints.cost import cost
from mdlgen.lints.smoothing import smoothings
from mdlgen.model.covers import covered
from mdlgen.model.parts.kind import Kind
from mdlgen.model.parts.kinds import KINDS
from mdlgen.model.tables import Model, SheetPart

UNITS = {
    "d": "mm", "m": "g", "I": "g mm^2",
    "k": "N/mm", "c": "N ms/mm", "kt": "N mm/rad", "ct": "N mm ms/rad", "D": "N mm",
}  # fmt: skip


def overview(model: Model) -> dict[str, Any]:
    """The output of `check --json`, in mm, N, g, ms, rad: `derived` are the paper's Tables 1 and 2."""
    return {
        "scene": model.name,
        "analysis": model.run.analysis,
        "sheets": {s.name: _sheet(model, k) for k, s in enumerate(model.sheets)},
        **{kind.table: _parts(kind, model.parts_of(kind.part)) for kind in KINDS},
        "external_parts": {e.name: {"body": e.body, "graphics": list(e.graphics)} for e in model.externals},
        "contacts": len(model.contacts),
        "probes": len(model.probes),
        "boxes": sum(s.count for s in model.sheets),
        "bushings": len(model.bushings),
        "pairs": {
            "possible": model.pairs.possible,
            "kept": len(model.pairs),
            "searched": len(model.pairs.searched),
            "margin_mm": model.pairs.margin,
            "external": len(model.external_pairs),
        },
        **({"covers": found} if (found := covers(model)) else {}),
        "smoothing": smoothings(model),
        "cost": None if (of := cost(model)) is None else asdict(of),
        "lints": [asdict(lint) for lint in lints(model)],
    }


def covers(model: Model) -> dict[str, dict[str, Any]]:
    """Derived values of covers, by roller: modulus, nip under its force, stiffness of the contacts."""
    found: dict[str, dict[str, Any]] = {}
    for roller in model.rollers:
        cover = roller.cover
        if cover is None:
            continue
        found[roller.name] = {
            "modulus_mpa": cover.modulus,
            "facing": cover.other,
            "force_n": cover.force,
            "nip_width_mm": 2.0 * cover.half,
            "depth_mm": cover.depth,
            "pressure_mpa": cover.pressure,
            "speed_ratio": 1.0 + cover.gain,
            "stiffness_n_per_mm_1_5": cover.force / cover.depth**1.5,
            "force_misfit": cover.misfit,
            "speed_misfit": cover.gain_misfit,
            "said": covered(cover),
        }
    return found


def _parts(kind: Kind[Any], parts: tuple[Any, ...]) -> int | dict[str, Any]:
    return {part.name: kind.overview(part) for part in parts} if kind.described else len(parts)


def _sheet(model: Model, index: int) -> dict[str, Any]:
    sheet = model.sheets[index]
    return {
        "boxes": sheet.count,
        "n_x": sheet.n_x,
        "n_y": sheet.n_y,
        "bushings": int(np.sum(model.bushings.sheet == index)),
        "layout": sheet.layout,
        "grid": sheet.grid,
        "outline_mm": list(sheet.outline),
        "unlike": unlike(model, sheet),
        "derived": {name: float(value) for name, value in sheet.derived.items()},
        "bending": bending(sheet),
        "curves": curves(model, sheet),
    }


def curves(model: Model, sheet: SheetPart) -> dict[str, dict[str, Any]]:
    """The measured curves that a sheet's joints follow, by md and cd; slopes in MPa."""
    table, found = model.curves, {}
    for number, name in enumerate(table.name):
        if name.rpartition("_")[0] == sheet.name:
            first, after = (int(k) for k in table.start[number : number + 2])
            found[name.rpartition("_")[2]] = {
                "points": after - first,
                "greatest_strain": float(table.strain[after - 1]),
                "greatest_stress_mpa": float(table.stress[after - 1]),
                "initial_slope_mpa": float(table.slope[first]),
                "final_slope_mpa": float(table.slope[after - 1]),
                "extrapolate": "linear" if table.linear[number] else "refuse",
            }
    return found


def unlike(model: Model, sheet: SheetPart) -> dict[str, Any]:
    """Differences of boxes from the mean one: range of lengths and mass, zones, and how it is bent."""
    boxes = slice(sheet.first, sheet.first + sheet.count)
    found: dict[str, Any] = {}
    for axis, graded, lengths in zip("xy", sheet.graded, 2 * model.bodies.half[boxes, :2].T, strict=True):
        if graded:
            found[f"d_{axis}_mm"] = [float(lengths.min()), float(lengths.max())]
    mass = model.bodies.mass[boxes]
    if not sheet.uniform:
        found["m_g"] = [float(mass.min()), float(mass.max())]
    if sheet.zones:
        found["zones"] = {zone.name: int(np.count_nonzero(zone.share)) for zone in sheet.zones}
    if sheet.bend is not None:
        creases = [crease.name for crease in sheet.bend.creases]
        found["bent"] = {"start": sheet.bend.start, "creases": creases}
        if np.isfinite(sheet.bend.radius):
            found["bent"] |= {"radius_mm": sheet.bend.radius, "along": "xy"[sheet.bend.axis]}
    return found


def bending(sheet: SheetPart) -> dict[str, float]:
    """Bending in both forms: per bushing [N mm/rad], and per width [N mm] (D = k_t length / width)."""
    parts = 2 if sheet.layout == "edge_to_edge" else 1  # bushings per pair
    k_tx, k_ty = sheet.derived["k_tx"], sheet.derived["k_ty"]
    return {
        "k_tx": k_tx,
        "k_ty": k_ty,
        "D_cd": parts * k_tx * sheet.d_y / sheet.d_x,
        "D_md": parts * k_ty * sheet.d_x / sheet.d_y,
    }
