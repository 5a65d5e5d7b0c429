"""Values of sheets, probes and rollers that a condition may use, by name."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mdlgen.conditions import OF_ROLLER, OF_SHEET
from mdlgen.formulas import Amount
from mdlgen.model.tables import Anchor, Model
from mdlgen.reactions.sensing import Poses


def of_states(model: Model) -> dict[str, Callable[[Poses], Amount]]:
    """How the value of each name of a sheet, probe or roller follows from the state of all bodies."""
    found: dict[str, Callable[[Poses], Amount]] = {}
    points: dict[str, Callable[[Poses], tuple[np.ndarray, np.ndarray]]] = {
        **{sheet.name: _centre(model, k) for k, sheet in enumerate(model.sheets)},
        **{probe.name: _at(probe) for probe in model.probes},
    }
    for name, point in points.items():
        for word in OF_SHEET:
            found[f"{name}.{word}"] = _of_point(point, word)
    for roller in model.rollers:
        found[f"{roller.name}.omega"] = _spin(roller.body, roller.axis)
    return found


def _of_point(
    point: Callable[[Poses], tuple[np.ndarray, np.ndarray]], word: str
) -> Callable[[Poses], Amount]:
    dimension = OF_SHEET[word]
    assert dimension is not None, "they are numbers"

    def value(poses: Poses) -> Amount:
        place, rate = point(poses)
        if word == "speed":
            return Amount(math.hypot(*rate), dimension)
        of = rate if word.startswith("v") else place
        return Amount(float(of["xyz".index(word[-1])]), dimension)

    return value


def _centre(model: Model, sheet: int) -> Callable[[Poses], tuple[np.ndarray, np.ndarray]]:
    part, share = model.sheets[sheet], model.mass_share(sheet)
    boxes = slice(part.first, part.first + part.count)
    return lambda poses: (share @ poses.x[boxes], share @ poses.u[boxes])


def _at(probe: Anchor) -> Callable[[Poses], tuple[np.ndarray, np.ndarray]]:
    def point(poses: Poses) -> tuple[np.ndarray, np.ndarray]:
        arms = (poses.r[probe.body].reshape(-1, 3, 3) @ probe.local[:, :, None])[:, :, 0]
        rates = poses.u[probe.body] + np.cross(poses.w[probe.body], arms)
        return probe.share @ (poses.x[probe.body] + arms), probe.share @ rates

    return point


def _spin(body: int, axis: np.ndarray) -> Callable[[Poses], Amount]:
    dimension = OF_ROLLER["omega"]
    assert dimension is not None, "it is a number"
    return lambda poses: Amount(float(poses.w[body] @ axis), dimension)
