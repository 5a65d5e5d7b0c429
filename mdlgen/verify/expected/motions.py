"""Expected drives of an MDL file, and the times at which their laws are evaluated."""

from __future__ import annotations

import numpy as np

from mdlgen.altair.moving import DISPLACED, joint_of, places
from mdlgen.model.tables import (
    Floats,
    Model,
)
from mdlgen.verify.expected.axles import axle_stations
from mdlgen.verify.expected.stops import stop_stations
from mdlgen.verify.expected.times import Times, longest
from mdlgen.verify.expected.units import SECOND
from mdlgen.verify.tables import Table, table

RAMP_STATIONS = (0.0, 0.25, 0.5, 1.0, 2.0, 10.0)  # where the law of a drive is evaluated, in ramps
_STATIONS_WITHOUT = (0.0, 1e-3, 1.0)  # [s]
OF_LOADS = "loads"  # the key of the times of all loads


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
    for part, moving in model.gates:
        if not moving.free:
            found[f"mot_{part.name}"] = _profile_stations(moving.corners[:, 0] * SECOND)
    changing = [model.loads.profiles[entry][:, 0] for entry in model.loads.changing]
    if changing:
        found[OF_LOADS] = _profile_stations(np.unique(np.concatenate(changing)) * SECOND)
    most = longest(found)  # a table has as many columns for all
    found = {name: (*times, *[times[-1]] * (most - len(times))) for name, times in found.items()}
    return {**found, **axle_stations(model, found), **stop_stations(model)}


def _profile_stations(corners: Floats) -> tuple[float, ...]:
    """Every corner, the middle of every piece, and times before and after all."""
    middles = 0.5 * (corners[1:] + corners[:-1])
    return tuple(np.unique([0.0, 0.5 * corners[0], *corners, *middles, 2.0 * corners[-1] or 1.0]).tolist())


def motions(model: Model, times: Times) -> Table:
    """Speeds of rollers, and places of guides, planes and meshes. Those of rollers with a clutch, a motor or
    a limiter are in its torque (`clutches`, `axles`)."""
    driven = [r for r in model.rollers if r.speed is not None and r.one_way is None and r.axle is None]
    names, laws, scales, words = [], [], [], []
    for r in driven:
        names.append(f"mot_{r.name}")
        laws.append(r.prescribed(np.array(times[names[-1]]) / SECOND) / SECOND)
        scales.append(np.abs(r.corners[:, 1]).max() / SECOND)
        words.append((f"j_{r.name}", "ROT", "VEL"))
    for part, moving in model.gates:
        if not moving.free:
            names.append(f"mot_{part.name}")
            laws.append(places(moving, np.array(times[names[-1]]) / SECOND))
            scales.append(np.abs(moving.corners[:, 1]).max() or 1.0)
            words.append(
                (f"j_{part.name}_{joint_of(moving)[0]}", "ROT" if moving.turns else "TRANS", DISPLACED)
            )
    values = np.array(laws).reshape(len(names), -1) if names else np.zeros((0, longest(times)))
    return table(names, {"law": (values, np.reshape(scales, (-1, 1)))}, words)
