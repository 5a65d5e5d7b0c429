"""Stress of sheets that do not start in their shape at rest, which a static run can apply in steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mdlgen.backends.exudyn_local.system import System
from mdlgen.model.rotations import matrices
from mdlgen.model.tables import Model


def bring_on(model: Model, system: System) -> Callable[[float], None]:
    """Returns a function that sets the stress-free rotations of bushings to a part, 0 to 1, of those of the
    Model. With 0 the start has no stress, so that Newton's iteration begins without a jump."""
    bushings, table = system.bushings, model.bushings
    rows = bushings["row"]
    rotation = np.concatenate([model.bodies.rotation, np.eye(3)[None]])[table.b[rows]]
    axes, rest = table.axes[rows], table.rest[rows]
    whole, now = bushings["fb"].copy(), [1.0]

    def bring(part: float) -> None:
        if part != now[0]:
            frames = np.einsum("nji,njk->nik", rotation, axes @ matrices(-part * rest)).reshape(-1, 9)
            bushings["fb"] = whole if part >= 1.0 else frames
            now[0] = part

    return bring
