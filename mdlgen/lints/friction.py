"""Lints of friction as it is measured: scatter that boxes are too large for."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.scatter import deviation_of_box
from mdlgen.model.tables import Model


def coarse_scatter(model: Model) -> Iterator[Lint]:
    """Boxes that are larger than the correlation length of their friction: each has the mean over itself."""
    frictions, table = model.contacts.frictions, model.contacts
    if frictions is None:
        return
    sheets = {sheet.name: sheet for sheet in model.sheets}
    for row in np.flatnonzero(frictions.scatter[:, 0] > 0.0).tolist():
        sheet, (deviation, length) = sheets[table.part_a[row]], frictions.scatter[row].tolist()
        if max(sheet.d_x, sheet.d_y) <= length:
            continue
        left = deviation * deviation_of_box(sheet.d_x, sheet.d_y, length)
        yield Lint(
            "W140",
            f"contacts.{table.called(row)}.friction.scatter",
            f"a box of {sheet.name}, {sheet.d_x:.3g} x {sheet.d_y:.3g} mm, is larger than the length "
            f"{length:g} mm of its scatter, and has the mean over its face: boxes deviate by "
            f"{100 * left:.2g} %, not by {100 * deviation:g} %",
            f"use boxes of {0.5 * length:.3g} mm",
        )
