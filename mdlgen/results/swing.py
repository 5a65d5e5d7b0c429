"""Angles by which arms have swung."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model.tables import Floats, RollerPart

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def swing(result: Result, roller: RollerPart) -> Floats | None:
    """Turn of its arm about the pivot since it was given, positive about the roller's axis [rad], (t,); None
    of a roller without an arm."""
    if roller.arm is None:
        return None
    begun = roller.center - roller.arm.pivot
    now = result.position[:, roller.body] - roller.arm.pivot
    along, across = begun, np.cross(roller.axis, begun)
    return np.arctan2(now @ across, now @ along)
