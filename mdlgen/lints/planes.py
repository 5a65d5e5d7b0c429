"""Lints of planes: too soft for what lies on them, or across a sheet's way on their narrow side."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.lints.ways import shown
from mdlgen.model.parts.roller import FLAT
from mdlgen.model.tables import BOX_PLANE, Model

NARROW = 2.0  # a plane that is so many times as tall as wide, and a sheet so many times as wide as it


def sinks(model: Model) -> Iterator[Lint]:
    """Sheets that lie on a plane so soft that their weight alone pushes them through it."""
    sheets, planes = {s.name: s for s in model.sheets}, {p.name: p for p in model.planes}
    table = model.contacts
    for row in np.flatnonzero(table.kind == BOX_PLANE).tolist():
        sheet, plane = sheets[table.part_a[row]], planes[table.part_b[row]]
        boxes = slice(sheet.first, sheet.first + sheet.count)
        weight = float(model.bodies.mass[boxes].sum()) * max(
            0.0, -float(model.begun_gravity @ plane.normal)
        )  # N
        each = weight / sheet.count
        depth = (each / float(table.stiffness[row])) ** (2 / 3)
        if depth > sheet.thickness:
            yield Lint(
                "W133",
                f"contacts.{table.called(row)}.stiffness",
                f"its weight of {weight:.3g} N pushes {sheet.name} {depth:.3g} mm into {plane.name}, more "
                f"than its thickness of {sheet.thickness:g} mm",
                f"give {each / (0.1 * sheet.thickness) ** 1.5:.2g} N/mm^1.5 or more: a tenth of that",
            )


def crosswise(model: Model) -> Iterator[Lint]:
    """Planes that stand in a sheet's way, as a stop does, on their narrow side: tall, and not wide."""
    sheets, planes = {s.name: s for s in model.sheets}, {p.name: p for p in model.planes}
    table = model.contacts
    named: set[str] = set()
    for row in np.flatnonzero(table.kind == BOX_PLANE).tolist():
        sheet, plane = sheets[table.part_a[row]], planes[table.part_b[row]]
        normal = sheet.rotation[:, 2]
        if abs(float(plane.normal @ normal)) > FLAT or plane.name in named:
            continue
        sides = model.bodies.rotation[plane.body].T
        across = np.cross(normal, plane.normal)
        wide, tall = (float(np.abs(sides[:2] @ way) @ np.array(plane.size[:2])) for way in (across, normal))
        width = float(np.abs(sheet.rotation[:, :2].T @ across) @ np.array(sheet.outline))
        if tall > NARROW * wide and wide < width / NARROW:
            named.add(plane.name)
            yield Lint(
                "W135",
                f"planes.{plane.name}.size",
                f"it stands in the way of {sheet.name}, {tall:.3g} mm tall and {wide:.3g} mm wide; that is "
                f"{width:.3g} mm wide there",
                "swap the two lengths, or name the side that the first one lies along: along: "
                f"{shown(across).lstrip('+-')}",
            )
