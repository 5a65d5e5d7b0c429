"""The speed that a drive has, or aims at, over a run: its own law, and what rules ordered."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model.tables import Floats, RollerPart

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def aimed(result: Result, roller: RollerPart, time: Floats) -> Floats:
    """Target speed of a driven roller, or of the shaft of its clutch, at times [ms], (n,) [rad/ms]. At a jump
    it is the speed after the jump."""
    law = roller.prescribed
    for order in _orders(result, roller):
        law = partial(_from_then_on, law, *order)
    return np.asarray(law(time))


def corners_of(result: Result, roller: RollerPart) -> Floats:
    """Corners of that law: time [ms], speed [rad/ms], (n, 2); two at one time are a jump."""
    found = roller.corners
    for begin, target, ramp in _orders(result, roller):
        now = float(np.interp(begin, found[:, 0], found[:, 1]))
        found = np.vstack([found[found[:, 0] < begin], [[begin, now], [begin + ramp, target]]])
    return found


def _from_then_on(
    before: Callable[[Floats], Floats], begin: float, target: float, ramp: float, time: Floats
) -> Floats:
    """A speed law that follows `before` until `begin`, then ramps to a target."""
    now = float(before(np.array([begin]))[0])
    share = np.clip((time - begin) / ramp, 0.0, 1.0) if ramp > 0.0 else 1.0
    return np.where(time >= begin, now + share * (target - now), before(time))


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
