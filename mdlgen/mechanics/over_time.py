"""Loads and gravity that have a factor over time, linear between corners and constant beyond them.

`set_to` writes the mean over a span of time into the records of loads and into gravity, from which all other
code reads it. The span is a step of the midpoint rule: so a step changes the momentum of a body by the
impulse of the force, for any slope of a ramp and any place of a corner. A span of no length has the value at
its time.

Corners are in the fields `corners` and `drive` of a law, like those of a driven roller (see driven), and are
read at each call.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.driven import DRIVE, prescribed
from mdlgen.model.tables import Model
from mdlgen.program.kernel import njit

GRAVITY = -1
# A factor over time: its entry of the loads, or GRAVITY.
LAW = np.dtype([("entry", "i8"), *DRIVE])
# A quantity with such a factor: the row of a load, or GRAVITY; the number of its law; force and moment, or
# gravity and zeros, at a factor of 1.
ACTS = np.dtype([("load", "i8"), ("law", "i8"), ("full", "f8", 6)])


class Changing(NamedTuple):
    """Quantities that change over time; no laws: none does."""

    laws: np.ndarray  # LAW, that of gravity first
    acts: np.ndarray  # ACTS


def changing(model: Model, loads: np.ndarray, gravity: np.ndarray, time: float = 1.0) -> Changing:
    """The Changing of a Model with its loads and gravity in a solver's units, at a factor of 1; `time` is a
    millisecond there. In a static analysis nothing changes. Sets loads and gravity to those of time 0."""
    profiles = {GRAVITY: model.gravity_profile} if len(model.gravity_profile) else {}
    profiles |= {entry: model.loads.profiles[entry] for entry in model.loads.changing}
    laws = np.zeros(len(profiles), LAW)
    rows: list[tuple[int, int, list[float]]] = []
    for number, (entry, corners) in enumerate(profiles.items()):
        laws[number]["entry"], laws[number]["corners"] = entry, len(corners)
        laws[number]["drive"][: corners.size] = (corners * (time, 1.0)).ravel()
        if entry == GRAVITY:
            rows.append((GRAVITY, number, [*gravity.tolist(), 0.0, 0.0, 0.0]))
            continue
        for row in np.flatnonzero(model.loads.entry == entry).tolist():
            rows.append((row, number, [*loads["force"][row].tolist(), *loads["moment"][row].tolist()]))
    acts = np.array(rows, ACTS) if rows else np.zeros(0, ACTS)
    for act in acts:
        now = float(laws["drive"][act["law"], 1]) * act["full"]  # value of the first corner
        if act["load"] == GRAVITY:
            gravity[:] = now[:3]
        else:
            loads["force"][act["load"]], loads["moment"][act["load"]] = now[:3], now[3:]
    if model.run.analysis == "static":
        return Changing(laws[:0], acts[:0])
    return Changing(laws, acts)


@njit(cache=True, error_model="numpy")
def mean_factor(law, begin, end):
    """Mean of a factor from one time to another; for equal times, the factor at that time."""
    before = prescribed(law, begin)
    if not end > begin:
        return before
    total, at = 0.0, begin
    for i in range(0, 2 * law.corners, 2):
        if begin < law.drive[i] < end:
            total += 0.5 * (before + law.drive[i + 1]) * (law.drive[i] - at)
            at, before = law.drive[i], law.drive[i + 1]
    return (total + 0.5 * (before + prescribed(law, end)) * (end - at)) / (end - begin)


@njit(cache=True, error_model="numpy")
def set_to(changes, loads, gravity, begin, end):
    """Writes the means from one time to another into `loads` and `gravity`."""
    for k in range(changes.acts.size):
        row, full = changes.acts[k].load, changes.acts[k].full
        factor = mean_factor(changes.laws[changes.acts[k].law], begin, end)
        for i in range(3):
            if row < 0:
                gravity[i] = factor * full[i]
            else:
                loads[row].force[i] = factor * full[i]
                loads[row].moment[i] = factor * full[3 + i]


@njit(cache=True, error_model="numpy", forceinline=True)
def weight_changes(changes):
    """True if gravity changes: then weight has no potential, and its work is counted as that of a load."""
    return changes.laws.size > 0 and changes.laws[0].entry < 0
