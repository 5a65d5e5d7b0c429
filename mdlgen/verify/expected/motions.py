"""Expected drives of an MDL file, and the times at which their laws are evaluated."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from mdlgen.model.tables import (
    Floats,
    Model,
)
from mdlgen.verify.expected.units import SECOND
from mdlgen.verify.tables import Table, table

RAMP_STATIONS = (0.0, 0.25, 0.5, 1.0, 2.0, 10.0)  # where the law of a drive is evaluated, in ramps
_STATIONS_WITHOUT = (0.0, 1e-3, 1.0)  # [s]
OF_LOADS = "loads"  # the key of the times of all loads
Times = Mapping[str, tuple[float, ...]]


def stations(model: Model) -> Times:
    """Times at which the law of each drive is evaluated [s], by motion, and those of loads over time."""
    found = {}
    for roller in model.rollers:
        if roller.speed is not None:
            ramp, name = roller.ramp * SECOND, f"mot_{roller.name}"
            if roller.profile is not None:
                found[name] = _profile_stations(roller.profile[:, 0] * SECOND)
            else:
                found[name] = tuple(s * ramp for s in RAMP_STATIONS) if ramp > 0.0 else _STATIONS_WITHOUT
    changing = [model.loads.profiles[entry][:, 0] for entry in model.loads.changing]
    if changing:
        found[OF_LOADS] = _profile_stations(np.unique(np.concatenate(changing)) * SECOND)
    most = max(map(len, found.values()), default=0)  # a table has as many columns for all
    return {name: (*times, *[times[-1]] * (most - len(times))) for name, times in found.items()}


def _profile_stations(corners: Floats) -> tuple[float, ...]:
    """Every corner, the middle of every piece, and times before and after all."""
    middles = 0.5 * (corners[1:] + corners[:-1])
    return tuple(np.unique([0.0, 0.5 * corners[0], *corners, *middles, 2.0 * corners[-1] or 1.0]).tolist())


def motions(model: Model, times: Times) -> Table:
    """Those of rollers with a clutch are in its torque (`clutches`)."""
    driven = [r for r in model.rollers if r.speed is not None and r.one_way is None]
    most = max(map(len, times.values()), default=0)
    laws = [r.prescribed(np.array(times[f"mot_{r.name}"]) / SECOND) / SECOND for r in driven]
    speeds = np.array(laws).reshape(len(driven), -1) if driven else np.zeros((0, most))
    scale = np.array([[np.abs(r.corners[:, 1]).max() / SECOND] for r in driven]).reshape(-1, 1)
    words = [(f"j_{r.name}", "ROT", "VEL") for r in driven]
    return table([f"mot_{r.name}" for r in driven], {"speed": (speeds, scale)}, words)
