"""Lints of rubber covers: hardness, strain and nips for which their formulas do not hold."""

from __future__ import annotations

from collections.abc import Iterator

from mdlgen.lints.lint import Lint
from mdlgen.model.tables import BOX_CYLINDER, CYLINDER_CYLINDER, CoverPart, Model, RollerPart
from mdlgen.rubber.hardness import HIGH, LOW

# Depth over thickness: there rubber of the neo-Hookean law, G (1/l^2 - l) at a length l, is 27 % stiffer in
# compression than Hooke's law has it.
STRAINED = 0.2
# Half-width over the smallest radius: there the parabola of the nip is 2.3 % off its round.
WIDE = 0.3


def covered(model: Model) -> Iterator[tuple[RollerPart, CoverPart]]:
    """The rollers with a cover."""
    for roller in model.rollers:
        if roller.cover is not None:
            yield roller, roller.cover


def hardness(model: Model) -> Iterator[Lint]:
    for roller, cover in covered(model):
        if cover.hardness is not None and not LOW <= cover.hardness <= HIGH:
            yield Lint(
                "W147",
                f"rollers.{roller.name}.cover.hardness",
                f"{cover.hardness:g} ShA is outside {LOW:g} to {HIGH:g} ShA, where Young's modulus follows "
                f"from the hardness; {cover.modulus:.3g} MPa is a guess",
                "give the modulus of the cover in place of its hardness",
            )


def strain(model: Model) -> Iterator[Lint]:
    for roller, cover in covered(model):
        share = cover.depth / cover.thickness
        if share > STRAINED:
            yield Lint(
                "W148",
                f"rollers.{roller.name}.cover",
                f"{cover.force:.4g} N presses the cover in by {100.0 * share:.3g} % of its thickness, more "
                f"than {100.0 * STRAINED:g} %, where rubber is a quarter stiffer than the formulas have it",
                "take a harder or thicker cover, a wider roller or less force",
            )


def wide(model: Model) -> Iterator[Lint]:
    radii = {roller.name: roller.radius for roller in model.rollers}
    for roller, cover in covered(model):
        least = min(roller.radius, radii.get(cover.other, roller.radius))
        if cover.half > WIDE * least:
            yield Lint(
                "W149",
                f"rollers.{roller.name}.cover",
                f"its nip is {2.0 * cover.half:.3g} mm wide at {cover.force:.4g} N, more than {2.0 * WIDE:g} "
                f"of the radius {least:g} mm: the formulas are of a nip that is narrow against its rollers",
                "take a harder cover, a wider roller or less force",
            )


def through(model: Model) -> Iterator[Lint]:
    """Lints of two rollers in contact with a sheet and with each other."""
    table = model.contacts
    rows = {
        (table.part_a[row], table.part_b[row]): row
        for row, kind in enumerate(table.kind.tolist())
        if kind in (BOX_CYLINDER, CYLINDER_CYLINDER)
    }
    for roller, cover in covered(model):
        meets = rows.get((roller.name, cover.other), rows.get((cover.other, roller.name)))
        if meets is None:
            continue
        for sheet in model.sheets:
            one, two = (rows.get((sheet.name, name)) for name in (roller.name, cover.other))
            if one is None or two is None:
                continue
            depths = [(cover.force / float(table.stiffness[row])) ** (2 / 3) for row in (one, two)]
            over = sum(depths) - sheet.thickness
            if over > 0.0:
                force = float(table.stiffness[meets]) * over**1.5
                yield Lint(
                    "W150",
                    f"contacts.{table.called(meets)}",
                    f"with {sheet.name} between them {roller.name} and {cover.other} overlap by "
                    f"{over:.3g} mm and press each other with {force:.3g} N as well as the sheet",
                    "count that to the force of the press, or leave their contact out",
                )
