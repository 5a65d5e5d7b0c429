"""Lints of the air between sheets: a viscosity that no gas has, and air where nothing moves."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.tables import Model

THIN, THICK = 5e-9, 1e-7  # range of viscosities of gases, with a margin at both ends [N ms/mm^2]
MICRO = 1e9  # uPa s for each of these


def _entries(model: Model) -> Iterator[tuple[str, float]]:
    """The path and the viscosity of each entry of the contacts that has air."""
    table, seen = model.contacts, set()
    for row in np.flatnonzero(table.air_viscosity > 0.0).tolist():
        if int(table.entry[row]) not in seen:
            seen.add(int(table.entry[row]))
            yield f"contacts.{table.called(row)}.air", float(table.air_viscosity[row])


def no_gas(model: Model) -> Iterator[Lint]:
    for where, viscosity in _entries(model):
        if not THIN <= viscosity <= THICK:
            yield Lint(
                "W136",
                f"{where}.viscosity",
                f"{viscosity * MICRO:.4g} uPa*s is {viscosity / 18.2e-9:.2g} times that of air",
                "give 18.2 uPa*s for air at 20 deg C, with the u",
            )


def still(model: Model) -> Iterator[Lint]:
    if model.run.analysis != "static":
        return
    for where, _ in _entries(model):
        yield Lint(
            "W137",
            where,
            "a film acts on what closes or opens, and nothing moves in a static analysis",
            "leave it out, or use analysis: transient",
        )
