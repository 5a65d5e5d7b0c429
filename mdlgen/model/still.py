"""Checks and values that solvers need for parts that move."""

from __future__ import annotations

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import Model

# Least distance from the pivot to the centre of a free part, from which its rate is measured, relative to the
# sheet's thickness: a shorter one counts as zero.
NEAR = 0.1


def refuse_moving(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a part that moves in a static run, and for one that turns
    freely about its own centre, where no way measures its rate."""
    for part, moving in model.gates:
        word = "pivot" if moving.turns else "slide"
        path = (kind_of(part).table, part.name, word)
        if model.run.analysis == "static":
            raise RefusedError(
                f"{who}: a static analysis with a part that moves ({part.name}) is not there", path
            )
        arm = model.bodies.position[part.body] - moving.pivot
        far = float(np.linalg.norm(np.cross(moving.axis, arm)))
        least = NEAR * min((sheet.thickness for sheet in model.sheets), default=1.0)
        if moving.turns and moving.free and far < least:
            raise RefusedError(
                f"{who}: {part.name} turns freely about an axis {far:.3g} mm off its centre; "
                f"{least:.3g} mm or more is modelled",
                path,
            )
    for part in model.stopped if model.run.analysis == "static" else ():
        word = "arm" if part.press is None else "press"
        path = (kind_of(part).table, part.name, word, "stops")
        raise RefusedError(f"{who}: a static analysis with stops ({part.name}) is not there yet", path)
