"""Run settings, gravity and units that a text must have."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Model
from mdlgen.verify.expected.units import SECOND
from mdlgen.verify.tables import Part, Table, table

RUN_NUMBERS = ("end", "print", "h_max", "h_min", "tol")


def run(model: Model) -> Table:
    """Analysis with its method; times and steps [s], error of the integrator; a static run has none."""
    settings = model.run
    if settings.analysis == "static":
        numbers, words = np.zeros(len(RUN_NUMBERS)), ("Static", "MKEAM" if len(model.pairs) else "FIM_D")
    else:
        longest = settings.step if settings.step is not None else min(0.01, settings.print_step)
        (error,) = (p.value for p in model.parameters if (p.data_set, p.member) == ("run", "tol"))
        times = (settings.duration, settings.print_step, longest, min(1e-3, longest / 100))
        numbers, words = np.array([*(v * SECOND for v in times), error]), ("Transient", "DSTIFF")
    parts: dict[str, Part] = {n: (numbers[k : k + 1], None) for k, n in enumerate(RUN_NUMBERS)}
    return table(["run"], parts, [words])


def units() -> Table:
    """The units of all texts."""
    return table(["units"], {}, [("NEWTON", "MILLIMETER", "KILOGRAM", "SECOND")])


def gravity(model: Model) -> Table:
    """Gravity [mm/s^2]."""
    g = model.gravity / SECOND**2
    return table(["gravity"], {"g": (g[None], np.abs(g).max(initial=1.0))})
