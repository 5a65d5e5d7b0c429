"""Loads that a text must have, as forces and moments on boxes along global axes."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Floats, Model
from mdlgen.verify.expected.units import body_name, reach
from mdlgen.verify.tables import Table, table


def load_points(model: Model) -> Floats:
    """Where each load acts [mm], (n, 3)."""
    loads, bodies = model.loads, model.bodies
    return bodies.position[loads.body] + np.einsum("nij,nj->ni", bodies.rotation[loads.body], loads.local)


def loads(model: Model) -> Table:
    """Point [mm], force [N] and moment [N mm] of each; names are those of the rows."""
    table_ = model.loads
    names = [f"frc_{row}" for row in range(len(table_.body))]
    size = [np.abs(v).max(axis=1, initial=1e-12)[:, None] for v in (table_.force, table_.moment)]
    parts = {
        "at": (load_points(model), reach(model)),
        "force": (table_.force, size[0]),
        "moment": (table_.moment, size[1]),
    }
    return table(names, parts, [(body_name(model, body),) for body in table_.body.tolist()])
