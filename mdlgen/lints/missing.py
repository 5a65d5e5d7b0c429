"""Lints of contacts that are not there: parts that will come to overlap."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.overlaps.parts import Overlaps
from mdlgen.model.overlaps.sheets import SheetOverlaps
from mdlgen.model.tables import (
    Model,
)


def unfaced(model: Model) -> Iterator[Lint]:
    """Pressed rollers that nothing keeps from going through the roller that they are pressed towards."""
    known = {frozenset(pair) for pair in zip(model.contacts.part_a, model.contacts.part_b, strict=True)}
    carrying = {model.rollers[m.on].name for m in model.meshes if m.on >= 0}
    for roller in model.rollers:
        for other in model.rollers:
            named = frozenset((roller.name, other.name)) in known
            if roller.press is None or other is roller or named or {roller.name, other.name} & carrying:
                continue
            way = other.center - roller.center
            ahead, along = float(way @ roller.press.direction), float(way @ roller.axis)
            aside = float(np.linalg.norm(way - ahead * roller.press.direction - along * roller.axis))
            if (
                abs(along) < 0.5 * (roller.width + other.width)
                and aside < 0.5 * min(roller.radius, other.radius)
                # near enough for a nip
                and 0.0 < ahead < roller.reach + other.reach + 0.5 * min(roller.radius, other.radius)
            ):
                yield Lint(
                    "W118",
                    f"rollers.{roller.name}.press",
                    f"it presses towards {other.name} and has no contact with it, so it goes through it",
                    f"add to contacts {{between: [{roller.name}, {other.name}], stiffness: 30 N/mm^1.5, "
                    "friction: 0.5}",
                )


def unmet(model: Model) -> Iterator[Lint]:
    """Rollers and plates, guides or meshes that come into each other and have no contact."""
    for pair in Overlaps(model).ahead():
        roller, part = pair.roller.name, pair.part.name
        yield Lint(
            "W119",
            f"rollers.{roller}",
            f"it comes into {model.called(pair.part.body)} and has no contact with it: a run ends where they "
            "overlap",
            f"add to contacts {{between: [{roller}, {part}], stiffness: 30 N/mm^1.5, friction: 0.5}}",
        )


def on_each_other(model: Model) -> Iterator[Lint]:
    """Sheets that lie on or in another sheet, a roller, a plane or a guide and have no contact with it."""
    sheets, parts = SheetOverlaps(model).begin()
    says = "it lies on {}, or in it, and has no contact with it: the two go through each other"
    remedy = "add to contacts {{between: [{}, {}], stiffness: 300 N/mm^1.5, friction: 0.5}}"
    for one, two in sheets:
        message, what = says.format(f"sheet {two.name}"), remedy.format(one.name, two.name)
        yield Lint("W120", f"sheets.{one.name}", message, what)
    for sheet, part in parts:
        message, what = says.format(model.called(part.body)), remedy.format(sheet.name, part.name)
        yield Lint("W121", f"sheets.{sheet.name}", message, what)
