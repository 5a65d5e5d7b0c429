"""A run that has its first state alone: what a run of a Model will have, before there is one."""

from __future__ import annotations

import numpy as np

from mdlgen.model.passing import begun_stays
from mdlgen.model.rotations import euler_parameters
from mdlgen.model.tables import Model
from mdlgen.results.result import ContactStatistics, Result


def begun_of(model: Model) -> Result:
    """The start of a Model as a Result."""
    bodies, rows = model.bodies, len(model.contacts.part_a)
    turn = euler_parameters(bodies.rotation)
    return Result(
        model=model,
        solver="",
        status="ok",
        time=np.zeros(1),
        position=bodies.position[None],
        rotation=turn[None],
        velocity=bodies.velocity[None],
        spin=bodies.spin[None],
        contact_force=np.zeros((1, rows)),
        contact_torque=np.zeros((1, rows, 2)),
        contact_friction=np.zeros((1, rows, 2)),
        statistics=ContactStatistics(*(np.zeros(rows) for _ in range(5))),
        stays=begun_stays(model),
    )
