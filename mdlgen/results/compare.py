"""The distance between two results of one scene, in the norm of `run.tolerance`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.model.tables import Floats
from mdlgen.results.result import Result

# Stored times that differ by less than this part of the run are the same; they differ by round-off.
SAME_TIME = 1e-9


@dataclass(frozen=True)
class Comparison:
    """Distance of `other` from `result`, over the boxes and the stored times that both cover."""

    position_rms_mm: float  # root mean square over boxes, by their mass, and times of the distance
    position_axes_mm: tuple[float, float, float]  # the same along x, y and z
    position_max_mm: float
    relative: float  # position_rms_mm / max(travel, sheet length / 10)
    travel_difference_mm: float  # of the first sheet at the last common time
    nip_force: dict[str, float]  # per contact row "a / b": mean |difference| / the larger mean force


def travel(result: Result, sheet: int = 0, at: int = -1) -> Floats:
    """Displacement of the sheet's centre of mass from the start to a stored time [mm], (3,)."""
    part = result.model.sheets[sheet]
    boxes = slice(part.first, part.first + part.count)
    return result.model.mass_share(sheet) @ (result.position[at, boxes] - result.model.bodies.position[boxes])


def scale(result: Result) -> float:
    """Length that errors are relative to [mm]: greatest travel of a sheet or a tenth of a sheet's length."""
    lengths = [max(sheet.size) / 10.0 for sheet in result.model.sheets]
    travels = [float(np.linalg.norm(travel(result, k))) for k in range(len(lengths))]
    return max(*lengths, *travels)


def compare(result: Result, other: Result) -> Comparison:
    """The distance of `other` from `result`.

    Where stored times differ, `other` is interpolated: positions by the cubic through positions and
    velocities, forces linearly. Raises SpecError for results that are not of the same boxes, or share no
    time.
    """
    boxes = _boxes(result)
    if boxes != _boxes(other):
        raise SpecError(
            f"the results of {result.model.name} and {other.model.name} have different boxes; "
            "compare two runs of one scene"
        )
    if not len(result.time) or not len(other.time):
        raise SpecError(f"a result of {result.model.name} holds no state to compare")
    slack = SAME_TIME * max(float(result.time[-1]), 1e-300)
    common = (result.time >= other.time[0] - slack) & (result.time <= other.time[-1] + slack)
    if not common.any():
        raise SpecError(f"the results of {result.model.name} share no time")
    time = result.time[common]
    count = len(boxes)
    here = result.position[common, :count]
    there = _positions(other, time, count, slack)
    distance = np.linalg.norm(here - there, axis=2)
    mass = result.model.bodies.mass[:count] / result.model.bodies.mass[:count].sum()
    square = mass @ np.mean((here - there) ** 2, axis=0)
    x, y, z = np.sqrt(square).tolist()
    rms = float(np.sqrt(square.sum()))
    first = result.model.sheets[0]
    own = slice(first.first, first.first + first.count)
    gap = result.model.mass_share(0) @ (here[-1, own] - there[-1, own])
    return Comparison(
        position_rms_mm=rms,
        position_axes_mm=(x, y, z),
        position_max_mm=float(distance.max()),
        relative=rms / scale(result),
        travel_difference_mm=float(np.linalg.norm(gap)),
        nip_force=_forces(result, other, common),
    )


def _boxes(result: Result) -> tuple[str, ...]:
    """Names of all boxes; they come before rollers and planes."""
    return result.model.bodies.name[: sum(s.count for s in result.model.sheets)]


def _positions(result: Result, time: Floats, count: int, slack: float) -> Floats:
    known, x, v = result.time, result.position[:, :count], result.velocity[:, :count]
    if len(known) == len(time) and np.all(np.abs(known - time) <= slack):
        return x
    if len(known) == 1:
        return np.repeat(x, len(time), axis=0)
    left = np.clip(np.searchsorted(known, time, side="right") - 1, 0, len(known) - 2)
    span = known[left + 1] - known[left]
    u = np.clip((time - known[left]) / span, 0.0, 1.0)[:, None, None]
    h = span[:, None, None]
    return (
        (1 + 2 * u) * (1 - u) ** 2 * x[left]
        + u * (1 - u) ** 2 * h * v[left]
        + u**2 * (3 - 2 * u) * x[left + 1]
        - u**2 * (1 - u) * h * v[left + 1]
    )


def _forces(result: Result, other: Result, common: np.ndarray) -> dict[str, float]:
    found = {}
    rows = {_row(other, k): k for k in range(len(other.model.contacts))}
    for k in range(len(result.model.contacts)):
        match = rows.get(_row(result, k))
        if match is None:
            continue
        here = result.contact_force[common, k]
        there = np.interp(result.time[common], other.time, other.contact_force[:, match])
        larger = max(float(here.mean()), float(there.mean()))
        found[_row(result, k)] = float(np.abs(here - there).mean()) / larger if larger > 0.0 else 0.0
    return found


def _row(result: Result, row: int) -> str:
    return f"{result.model.contacts.part_a[row]} / {result.model.contacts.part_b[row]}"
