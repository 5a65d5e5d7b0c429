"""A static run: the load in parts, each in balance before the next."""

from __future__ import annotations

import time as clock

import numpy as np

from backends.lattice.arrays import System
from backends.lattice.record import Recorder
from mdlgen.model.tables import Model
from mdlgen.results.result import Result

FIRST_PART = 1.0  # of the load
LEAST_PART = 1e-4
GOOD = 1e-6  # residual relative to the load, by our own account


def rest(model: Model, system: System, moving: tuple) -> Result:
    """The Result of a Model at rest; `moving` is (state, mid, matrix) at the start."""
    from backends.lattice.compiled import balance

    state, mid, matrix = moving
    x, r, v, l = state[:4]
    v[:] = 0.0
    l[:] = 0.0
    u, w, f = np.zeros_like(x), np.zeros_like(x), mid[4]
    a, res = matrix[0], matrix[5]
    bodies = (system.bodies, system.joints, system.loads, system.gravity, system.nodes)
    load = _load(model, system)
    begun = clock.perf_counter()
    level, part, rounds, left = 0.0, FIRST_PART, 0, 0.0
    reason = None
    while level < 1.0:
        aim = min(1.0, level + part)
        kept = x.copy(), r.copy()
        left, more = balance.equilibrium(*bodies, aim, load, x, r, u, w, f, a, res)
        rounds += more
        if left <= GOOD:
            level, part = aim, 2 * part
            continue
        x[:], r[:] = kept
        part *= 0.25
        if part < LEAST_PART:
            reason = f"no balance was found above {100 * level:.3g} % of the load"
            break
    wall = clock.perf_counter() - begun
    tables = (system.bodies, system.joints, system.pairs, system.loads, system.gravity, system.nodes)
    kept_rows = (np.zeros((len(model.contacts), 9)), np.zeros(len(system.pairs), bool))
    recorder = Recorder(model, system, tables, state, mid, kept_rows)
    recorder.store(0.0)
    result = recorder.result("lattice", reason, np.zeros(3))
    result.wall_s, result.steps = wall, 0
    return result


def _load(model: Model, system: System) -> float:
    """What residuals are measured by [N]: the weight, the loads, or a moment over a sheet's length."""
    weight = float(system.bodies["mass"][system.nodes].sum() * np.linalg.norm(system.gravity))
    length = max(max(s.size) for s in model.sheets)
    forces = [float(np.linalg.norm(row["force"])) for row in system.loads]
    moments = [float(np.linalg.norm(row["moment"])) / length for row in system.loads]
    return max(weight, *forces, *moments, 1e-12)
