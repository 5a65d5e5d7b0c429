"""Run settings and gravity that a text with its script must have."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Model
from mdlgen.verify.expected.units import SECOND
from mdlgen.verify.tables import Part, Table, table


def run(model: Model) -> Table:
    """Analysis and times [s]; a static run has none."""
    static = model.run.analysis == "static"
    times = (0.0, 0.0) if static else (model.run.duration * SECOND, model.run.print_step * SECOND)
    parts: dict[str, Part] = {"end": (np.array(times[:1]), None), "print": (np.array(times[1:]), None)}
    return table(["run"], parts, [("Static" if static else "Transient",)])


def gravity(model: Model) -> Table:
    """Gravity [mm/s^2]."""
    g = model.gravity / SECOND**2
    return table(["gravity"], {"g": (g[None], np.abs(g).max(initial=1.0))})
