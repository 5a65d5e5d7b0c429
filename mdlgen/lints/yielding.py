"""Lints of sheets that yield: grids too coarse for it, and rollers that bend a sheet beyond it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.tables import Model, RollerPart, SheetPart

# Turn from box to box [rad] at which a chain of boxes is 1 % shorter than the arc: 1 - 2 sin(x/2)/x = x^2/24.
MOST_TURN = 0.5


def coarse(model: Model) -> Iterator[Lint]:
    """Yield curvatures at which a sheet turns by more from box to box than its grid can follow."""
    for sheet in model.sheets:
        for axis, curvature in enumerate(sheet.yields or ()):
            boxes = np.diff((sheet.lines_x, sheet.lines_y)[axis])
            turn = float(curvature * boxes.max())
            if len(boxes) > 1 and turn > MOST_TURN:
                yield Lint(
                    "W145",
                    _where(model, sheet),
                    f"at the yield curvature of {curvature:.3g} 1/mm along {('MD', 'CD')[axis]} {sheet.name} "
                    f"turns by {turn:.2g} rad from box to box of {boxes.max():.3g} mm: the grid bends in "
                    "corners, not in an arc",
                    f"use boxes of {MOST_TURN / curvature:.3g} mm or less there",
                )


def bent_beyond(model: Model) -> Iterator[Lint]:
    """Rollers so thin that a sheet that follows one keeps a part of the bend."""
    rollers, seen = {r.name: r for r in model.rollers}, set()
    for one, other in zip(model.contacts.part_a, model.contacts.part_b, strict=True):
        for sheet in model.sheets:
            roller = rollers.get(other if one == sheet.name else one if other == sheet.name else "")
            if roller is None or sheet.yields is None or (sheet.name, roller.name) in seen:
                continue
            seen.add((sheet.name, roller.name))
            axis = _bent(sheet, roller)
            radius, least = roller.radius + sheet.thickness / 2, 1.0 / sheet.yields[axis]
            if radius < least:
                yield Lint(
                    "W146",
                    f"rollers.{roller.name}.radius",
                    f"{sheet.name} yields where it follows {roller.name}: its middle bends to a radius of "
                    f"{radius:.3g} mm, and it is elastic down to {least:.3g} mm",
                    "no fault if it is meant: summary.json has the bend that is left",
                )


def _bent(sheet: SheetPart, roller: RollerPart) -> int:
    """The direction of a sheet, as it begins, that a roller bends: the one square to its axis."""
    along = np.abs(sheet.rotation.T @ roller.axis)
    return int(along[0] > along[1])


def _where(model: Model, sheet: SheetPart) -> str:
    paths = [p.path for p in model.parameters if p.data_set == sheet.name and p.path]
    named = [path for path in paths if path[0] == "materials"]
    return f"materials.{named[0][1]}.yield.curvature" if named else f"sheets.{sheet.name}.material"
