"""Loads that a text must have, as forces and moments on boxes along global axes."""

from __future__ import annotations

import numpy as np

from mdlgen.model.over_time import factor, no_profile
from mdlgen.model.tables import Floats, Model
from mdlgen.verify.expected.motions import OF_LOADS
from mdlgen.verify.expected.times import Times
from mdlgen.verify.expected.units import SECOND, body_name, reach
from mdlgen.verify.tables import Table, table


def load_points(model: Model) -> Floats:
    """Place of each load [mm], (n, 3)."""
    loads, bodies = model.loads, model.bodies
    return bodies.position[loads.body] + np.einsum("nij,nj->ni", bodies.rotation[loads.body], loads.local)


def load_times(times: Times) -> tuple[float, ...]:
    """Times at which loads are evaluated [s]; a single one where none changes."""
    return times.get(OF_LOADS, (0.0,))


def _factors(model: Model, times: tuple[float, ...]) -> Floats:
    """Factor of each row of the loads at times [s], (n, t)."""
    profiles = model.loads.profiles or (no_profile(),) * (max(model.loads.entry, default=0) + 1)
    found = [[factor(profiles[entry], t / SECOND) for t in times] for entry in model.loads.entry.tolist()]
    return np.array(found).reshape(len(found), len(times))


def loads(model: Model, times: Times) -> Table:
    """Point [mm], force [N] and moment [N mm] of each, at all times of loads; names are those of the rows."""
    table_ = model.loads
    names = [f"frc_{row}" for row in range(len(table_.body))]
    parts = {"at": (load_points(model), reach(model))}
    for word, values in (("force", table_.force), ("moment", table_.moment)):
        found = _factors(model, load_times(times))[:, :, None] * values[:, None]
        numbers = found.reshape(len(names), 3 * found.shape[1])
        parts[word] = numbers, np.abs(numbers).max(axis=1, initial=1e-12)[:, None]
    return table(names, parts, [(body_name(model, body),) for body in table_.body.tolist()])
