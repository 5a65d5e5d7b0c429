"""Lints of how parts stand as the run begins: too deep in each other."""

from __future__ import annotations

from collections.abc import Iterator

from mdlgen.lints.contacts import deep
from mdlgen.lints.lint import Lint
from mdlgen.model.parts.kinds import WITH_SHEET
from mdlgen.model.parts.roller import FLAT
from mdlgen.model.sheet_corners import corners
from mdlgen.model.tables import (
    BOX_BOX,
    MachinePart,
    Model,
    RollerPart,
    SheetPart,
)


def interference(model: Model) -> Iterator[Lint]:
    sheets, parts = {s.name: s for s in model.sheets}, {part.name: part for part in model.machine}
    for row, number in enumerate(model.contacts.kind.tolist()):
        one, other = model.contacts.part_a[row], model.contacts.part_b[row]
        if number == BOX_BOX:
            two = (sheets[one], sheets[other])
            if any(sheet.enters != 0.0 for sheet in two):
                continue  # see W178
            thin, thick = two if two[0].thickness <= two[1].thickness else two[::-1]
            depth = overlap(*two)
            if deep(depth, thin):
                yield _deep_start(model, row, f"sheets.{thick.name}.center", thick.name, depth, thin)
        elif number in WITH_SHEET:
            kind, sheet, part = WITH_SHEET[number], sheets[one], parts[other]
            depth = kind.depth_at_start(model, sheet, part)
            if deep(depth, sheet) and not _gives_way(part, depth):
                yield _deep_start(model, row, kind.place(part), part.name, depth, sheet)


def _gives_way(part: MachinePart, depth: float) -> bool:
    """True if a part has a cover that is pressed in no deeper than in its nip."""
    cover = part.cover if isinstance(part, RollerPart) else None
    return cover is not None and depth <= 1.01 * cover.depth


def _deep_start(model: Model, row: int, where: str, part: str, depth: float, sheet: SheetPart) -> Lint:
    force = float(model.contacts.stiffness[row]) * depth**1.5
    return Lint(
        "W112",
        where,
        f"{part} starts {depth:.3g} mm inside {sheet.name}, more than "
        f"{sheet.thickness / 2:g} mm, half of its thickness: it is thrown off with {force:.3g} N",
        "move the part out of the sheet",
    )


def overlap(one: SheetPart, two: SheetPart) -> float:
    """Depth of two flat sheets in each other at the start [mm]; 0 where they are not parallel."""
    normal = one.rotation[:, 2]
    if abs(float(normal @ two.rotation[:, 2])) < 1 - FLAT**2:
        return 0.0
    first, second = corners(one), corners(two)
    for axis in (*one.rotation.T[:2], *two.rotation.T[:2]):
        a, b = first @ axis, second @ axis
        if max(a.min(), b.min()) >= min(a.max(), b.max()):
            return 0.0
    return 0.5 * (one.thickness + two.thickness) - abs(float((two.center - one.center) @ normal))
