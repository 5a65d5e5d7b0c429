"""Lints of contacts: how deep and how smooth they are, and guides that are shown coarsely."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.nips import facets, nips
from mdlgen.model.parts.roller import FLAT
from mdlgen.model.press import balance
from mdlgen.model.rolling import rolls
from mdlgen.model.sheet_pairs import linked
from mdlgen.model.tables import (
    BOX_BOX,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    Floats,
    Model,
    PlanePart,
    RollerPart,
    SheetPart,
)

COARSE_SMOOTHING, FINE_SMOOTHING = 0.05, 1e-4  # of the surface speed
# Of a sheet's thickness: half of it, and 1 % more, so that neither round-off of places is a
# finding nor a depth that reads as half of the thickness.
DEEP = 0.505
BESIDE = 1.5  # boxes that carry a roller, over those that it stands on: their neighbours tilt with them


def coarse_boxes(model: Model) -> Iterator[Lint]:
    for sheet, roller, length in facets(model):
        yield Lint(
            "W104",
            f"rollers.{roller.name}.radius",
            f"radius {roller.radius:g} mm is below half a box ({length / 2:.3g} mm) of {sheet.name}: "
            "flat boxes cannot follow the roller",
            "use more boxes along the roller's circumference",
        )


def deep_nip(model: Model) -> Iterator[Lint]:
    for row, sheet, roller in nips(model):
        if roller.press is None or roller.cover is not None:  # of a cover see W150
            continue
        depth = (roller.press.preload / float(model.contacts.stiffness[row])) ** (2 / 3)
        if deep(depth, sheet):
            yield Lint(
                "W105",
                f"contacts.{model.contacts.called(row)}.stiffness",
                f"the preload {roller.press.preload:g} N of {roller.name} presses {depth:.3g} mm deep, "
                f"more than {sheet.thickness / 2:g} mm, half of the thickness of {sheet.name}: "
                "the rollers meet through it",
                "raise the stiffness or lower the preload",
            )


def deep_stack(model: Model) -> Iterator[Lint]:
    """Sheets under a pressed roller that it pushes too far into each other, or into a plate, as a run begins:
    there the roller is in balance with the sheet that it touches, and that sheet with nothing below it."""
    sheets, planes = {s.name: s for s in model.sheets}, {p.name: p for p in model.planes}
    groups, table = linked(list(sheets), model.contacts), model.contacts
    pressed = np.flatnonzero(table.kind == CYLINDER_CYLINDER).tolist()
    nipped = {name for row in pressed for name in (table.part_a[row], table.part_b[row])}
    for _, touched, roller in nips(model):
        spring = roller.press
        if spring is None or spring.preload <= 0.0:
            continue
        for row in np.flatnonzero(np.isin(table.kind, (BOX_BOX, BOX_PLANE))).tolist():
            one, name = sheets[table.part_a[row]], table.part_b[row]
            below = sheets.get(name)
            if any(sheet.enters != 0.0 for sheet in (one, below, touched) if sheet is not None):
                continue  # they come in one after another, at their place
            on_plane = name in planes and roller.name not in nipped and _faces(planes[name], spring.direction)
            if one.name not in groups[touched.name] or not (below or on_plane):
                continue
            both = [sheet for sheet in (one, below) if sheet is not None]
            boxes = BESIDE * min(_boxes_under(sheet, roller) for sheet in both)
            if boxes == 0:
                continue
            thin = min(both, key=lambda sheet: sheet.thickness)
            # a constant force F on k z^1.5 is stopped where its work F z is 0.4 k z^2.5
            wanted = 2.5 * spring.preload / (boxes * (0.5 * thin.thickness) ** 1.5)
            stiffness = float(table.stiffness[row])
            if stiffness < wanted:
                depth = (2.5 * spring.preload / (boxes * stiffness)) ** (2 / 3)
                yield Lint(
                    "W122",
                    f"contacts.{table.called(row)}.stiffness",
                    f"as the run begins, the preload {spring.preload:g} N of {roller.name} pushes {one.name} "
                    f"some {depth:.2g} mm into {name}, more than half of the thickness of {thin.name}",
                    f"give a stiffness of {wanted:.3g} N/mm^1.5 or more, or less preload; a smaller run.step "
                    "does not help",
                )


def smoothing(model: Model) -> Iterator[Lint]:
    speeds = {r.name: abs(r.speed) * r.radius for r in model.rollers if r.speed}
    contacts = model.contacts
    for row in range(len(contacts)):
        own = [speeds[p] for p in (contacts.part_a[row], contacts.part_b[row]) if p in speeds]
        speed = max(own or speeds.values(), default=0.0)
        if speed == 0.0:
            continue
        coarse = max(float(contacts.smoothing[row]), float(contacts.stiction_velocity[row]))
        fine = min(float(contacts.smoothing[row]), float(contacts.stiction_velocity[row]))
        where = f"contacts.{contacts.called(row)}.smoothing"
        message = f"of the surface speed {speed * 1e3:.4g} mm/s"
        if coarse > COARSE_SMOOTHING * speed:
            yield Lint(
                "W106",
                where,
                f"{coarse * 1e3:g} mm/s is {coarse / speed:.2g} {message}: the sheet creeps",
                f"use {COARSE_SMOOTHING * speed * 1e3:.2g} mm/s or less",
            )
        if fine < FINE_SMOOTHING * speed:
            yield Lint(
                "W107",
                where,
                f"{fine * 1e3:g} mm/s is {fine / speed:.2g} {message}: Newton converges slowly",
                f"use {FINE_SMOOTHING * speed * 1e3:.2g} mm/s or more unless creep below that matters",
            )


def idle_rolling(model: Model) -> Iterator[Lint]:
    contacts = model.contacts
    for entry in sorted(set(contacts.entry[contacts.rolling > 0.0].tolist())):
        rows = np.flatnonzero(contacts.entry == entry).tolist()
        if not any(rolls(model, row) for row in rows):
            one, two = contacts.part_a[rows[0]], contacts.part_b[rows[0]]
            yield Lint(
                "W125",
                f"contacts.{contacts.called(rows[0])}.rolling_resistance",
                f"{contacts.rolling[rows[0]]:g} between {one} and {two} does nothing: neither is a roller",
                "leave it out, or name a contact with a roller",
            )


def deep(depth: float, sheet: SheetPart) -> bool:
    """True if a part is deeper in a sheet than half of its thickness."""
    return depth > DEEP * sheet.thickness


def _boxes_under(sheet: SheetPart, roller: RollerPart) -> float:
    """Number of boxes of a sheet, flat at the start, that a roller stands on."""
    shares = balance.covered_shares(sheet, roller.center, roller.axis, roller.width, False)
    return sum(share for share, _ in shares)


def _faces(plane: PlanePart, direction: Floats) -> bool:
    """True if a body that moves along a direction meets the face of a plane."""
    return float(plane.normal @ direction) < -1.0 + FLAT
