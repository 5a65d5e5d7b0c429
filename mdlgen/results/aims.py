"""The speed that a drive has, or aims at, over a run: its own law, and what rules ordered."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model.tables import Floats, RollerPart

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def aimed(result: Result, roller: RollerPart, time: Floats) -> Floats:
    """Target speed of a driven roller, or of the shaft of its clutch, at times [ms], (n,) [rad/ms]. At a jump
    it is the speed after the jump."""
    speed, orders = np.asarray(roller.prescribed(time)), _orders(result, roller)
    begins = np.array([begin for begin, _, _ in orders])
    # the speed at which each order finds the drive: by the law and by the orders before it
    found = np.asarray(roller.prescribed(begins))
    for k, (begin, target, ramp) in enumerate(orders):
        for moments, speeds in ((begins[k + 1 :], found[k + 1 :]), (time, speed)):
            later = moments >= begin
            share = np.clip((moments[later] - begin) / ramp, 0.0, 1.0) if ramp > 0.0 else 1.0
            speeds[later] = found[k] + share * (target - found[k])
    return speed


def corners_of(result: Result, roller: RollerPart) -> Floats:
    """Corners of that law: time [ms], speed [rad/ms], (n, 2); two at one time are a jump."""
    found = roller.corners
    for begin, target, ramp in _orders(result, roller):
        now = float(np.interp(begin, found[:, 0], found[:, 1]))
        found = np.vstack([found[found[:, 0] < begin], [[begin, now], [begin + ramp, target]]])
    return found


def _orders(result: Result, roller: RollerPart) -> list[tuple[float, float, float]]:
    """Orders of rules to the drive: time [ms], target speed [rad/ms], and ramp time [ms]."""
    rules = result.model.reactions.rules
    return [
        (float(row["time_ms"]), order.value, order.ramp)
        for row in result.reactions
        if row["kind"] == "rule"
        for order in rules[row["rule"]].orders
        if order.kind == "speed" and order.name == roller.name
    ]
