"""Lints of sheets that friction has to hold, which creep where it does not stick: on slopes, and where a
driven part stands still."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.lints.ways import NEAR
from mdlgen.model.creep import judged_by, slip_part
from mdlgen.model.frictions import measured
from mdlgen.model.parts.roller import FLAT
from mdlgen.model.sheet_corners import corners_of_boxes
from mdlgen.model.tables import (
    BOX_BOX,
    BOX_CYLINDER,
    BOX_MESH,
    BOX_PLANE,
    Floats,
    Model,
    PlanePart,
    RollerPart,
    SheetPart,
)
from mdlgen.units import PER_SECOND

# Part of the run for which a driven part stands at least, where it may have to hold something.
STANDS = 0.1
# Part of the limit of friction that stands for a load which is not known before the run.
HALF = 0.5
STIFF = "50 N/mm"  # of friction that sticks: an example, usual for paper
MOST_NAMED = 3  # parts in a line


class _Held(NamedTuple):
    """A sheet that friction may have to hold in one contact."""

    row: int
    far: float  # by which it then creeps [mm]
    used: float  # part of the limit of friction that holds it
    still: float  # time for which the holding part stands still [ms]


def on_slope(model: Model) -> Iterator[Lint]:
    """Sheets at rest that friction alone holds on a leaning plane."""
    table = model.contacts
    for same, held in _by_entry(model, _slopes(model)):
        speed = float(table.stiction_velocity[held.row] * slip_part(held.used))
        yield Lint(
            "W138",
            f"contacts.{table.called(held.row)}.friction",
            f"friction holds {_names(table.part_a[row] for row in same)} on the slope of "
            f"{_names(table.part_b[row] for row in same)} at {100.0 * held.used:.3g} % of its limit, and "
            f"creeps at {speed * PER_SECOND:.3g} mm/s: by {held.far:.2g} mm in {held.still:g} ms "
            f"({_over(model, held.row)})",
            _remedy(model, held.row),
        )


def stopped(model: Model) -> Iterator[Lint]:
    """Driven parts that stand still for a part of the run where a sheet may be in contact with them."""
    table = model.contacts
    by_rules = model.reactions.ordered("speed")
    for same, held in _by_entry(model, _stops(model)):
        ruled = any(_carrier(model, table.part_b[row]) in by_rules for row in same)
        unless = " unless a rule moves it" if ruled else ""
        yield Lint(
            "W139",
            f"contacts.{table.called(held.row)}.friction",
            f"{_names(table.part_b[row] for row in same)}: the drive stands still for {held.still:.4g} ms"
            f"{unless}, and what friction holds there at half of its limit creeps by {held.far:.2g} mm: "
            f"{_names(table.part_a[row] for row in same)} ({_over(model, held.row)})",
            _remedy(model, held.row),
        )


def _slopes(model: Model) -> Iterator[_Held]:
    sheets, planes = _free(model), {plane.name: plane for plane in model.planes}
    table, duration = model.contacts, model.run.duration
    for row in _creeping(model, BOX_PLANE):
        sheet, plane = sheets.get(table.part_a[row]), planes[table.part_b[row]]
        stiction = float(table.stiction_velocity[row])
        if sheet is None or np.linalg.norm(sheet.velocity) > stiction:
            continue
        if not _lies_on(model, sheet, plane) or not _alone(model, sheet, row):
            continue
        pressed = -float(model.begun_gravity @ plane.normal)
        pulled = float(np.linalg.norm(model.begun_gravity + pressed * plane.normal))
        limit = float(table.mu_static[row]) * pressed
        if limit <= pulled:
            continue  # it falls off, or slides
        far = stiction * float(slip_part(pulled / limit)) * duration
        if far > model.run.tolerance * judged_by(max(sheet.size)):
            yield _Held(row, far, pulled / limit, duration)


def _stops(model: Model) -> Iterator[_Held]:
    sheets, table, duration = _free(model), model.contacts, model.run.duration
    carriers = {roller.name: roller for roller in model.rollers}
    carriers |= {mesh.name: model.rollers[mesh.on] for mesh in model.meshes if mesh.on >= 0}
    travels: dict[str, float] = {}
    for name, other in zip(table.part_a, table.part_b, strict=True):
        if other in carriers:
            travels[name] = max(travels.get(name, 0.0), _way_of(carriers[other], duration))
    for row in _creeping(model, BOX_CYLINDER, BOX_MESH):
        sheet, roller = sheets.get(table.part_a[row]), carriers.get(table.part_b[row])
        if sheet is None or roller is None:
            continue
        still = _still_for(roller, duration)
        far = float(table.stiction_velocity[row] * slip_part(HALF)) * still
        allowed = model.run.tolerance * judged_by(max(sheet.size), travels[sheet.name])
        if still > STANDS * duration and far > allowed:
            yield _Held(row, far, HALF, still)


def _carrier(model: Model, name: str) -> str:
    """Name of the roller that carries a mesh; else the name itself."""
    on = {mesh.name: mesh.on for mesh in model.meshes if mesh.on >= 0}
    return model.rollers[on[name]].name if name in on else name


def _by_entry(model: Model, found: Iterable[_Held]) -> Iterator[tuple[list[int], _Held]]:
    """Rows of each entry of the contacts, and of these what creeps furthest."""
    groups: dict[int, list[_Held]] = {}
    for held in found:
        groups.setdefault(int(model.contacts.entry[held.row]), []).append(held)
    for group in groups.values():
        yield [held.row for held in group], max(group, key=lambda held: held.far)


def _names(names: Iterable[str]) -> str:
    """Names for a line, each once; beyond MOST_NAMED their number."""
    each = list(dict.fromkeys(names))
    more = f" and {len(each) - MOST_NAMED} more" if len(each) > MOST_NAMED else ""
    return ", ".join(each[:MOST_NAMED]) + more


def _still_for(roller: RollerPart, duration: float) -> float:
    """Time for which the drive of a roller holds it still in a run [ms]; 0 without a drive."""
    times, rates = _speeds(roller, duration)
    return float(np.diff(times)[(rates[1:] == 0.0) & (rates[:-1] == 0.0)].sum())


def _way_of(roller: RollerPart, duration: float) -> float:
    """Distance that its drive moves the surface of a roller in a run, back and forth [mm]; 0 without one."""
    times, rates = _speeds(roller, duration)
    return float(np.trapezoid(np.abs(rates), times)) * roller.reach


def _speeds(roller: RollerPart, duration: float) -> tuple[Floats, Floats]:
    """Corners of what its drive does in a run: times [ms] and speeds [rad/ms], (n,) each; none without."""
    corners = roller.corners
    if not len(corners):
        return np.zeros(0), np.zeros(0)
    inner = corners[:, 0][(corners[:, 0] > 0.0) & (corners[:, 0] < duration)]
    times = np.concatenate([[0.0], inner, [duration]])
    return times, roller.prescribed(times)


def _free(model: Model) -> dict[str, SheetPart]:
    """The sheets that the scene itself does not hold, of a run in time, by name."""
    if model.run.analysis == "static":
        return {}
    held = {anchor.sheet for anchor in model.supports}
    return {
        sheet.name: sheet for k, sheet in enumerate(model.sheets) if sheet.clamp is None and k not in held
    }


def _creeping(model: Model, *kinds: int) -> list[int]:
    """Rows of contacts of some kinds that meet in the run and whose friction does not stick."""
    table = model.contacts
    met = np.isin(np.arange(len(table)), [*model.pairs.contact.tolist(), *model.pairs.searched.tolist()])
    rubs = (table.mu_static > 0.0) & (table.sticking == 0.0)
    return np.flatnonzero(met & rubs & np.isin(table.kind, kinds)).tolist()


def _lies_on(model: Model, sheet: SheetPart, plane: PlanePart) -> bool:
    """Tests whether a sheet begins at the face of a plane."""
    face = model.bodies.position[plane.body] + 0.5 * plane.size[2] * plane.normal
    height = float(((corners_of_boxes(model, sheet) - face) @ plane.normal).min())
    return height < NEAR * sheet.thickness


def _alone(model: Model, sheet: SheetPart, row: int) -> bool:
    """Tests whether nothing else is in reach of a sheet that could hold or move it: only the plane of a row,
    planes that lean alike, and other sheets."""
    table, planes = model.contacts, {plane.name: plane for plane in model.planes}
    normal = planes[table.part_b[row]].normal
    for other in set(model.pairs.contact.tolist()):
        if table.part_a[other] != sheet.name or table.kind[other] == BOX_BOX:
            continue
        plane = planes.get(table.part_b[other])
        if plane is None or float(plane.normal @ normal) < 1.0 - FLAT**2:
            return False
    return True


def _over(model: Model, row: int) -> str:
    """The speed over which friction rises, in words."""
    smoothing, stiction = model.contacts.smoothing[row], model.contacts.stiction_velocity[row]
    name = "smoothing" if smoothing == stiction else "stiction velocity"
    return f"{name} {stiction * PER_SECOND:.3g} mm/s"


def _remedy(model: Model, row: int) -> str:
    table = model.contacts
    static, dynamic = float(table.mu_static[row]), float(table.mu_dynamic[row])
    if table.frictions is not None:
        if (table.frictions.direction[row] != 1.0).any():
            return "give a lower smoothing"
        if measured(table.frictions, row) is not None:
            return f"add sticking: {STIFF} to the friction, which holds it, or give a lower smoothing"
    return (
        f"give friction: {{static: {static:g}, dynamic: {dynamic:g}, sticking: {STIFF}}}, which holds it, or "
        "a lower smoothing"
    )
