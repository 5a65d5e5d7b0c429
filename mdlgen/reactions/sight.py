"""The knowledge of a sensor at a time."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mdlgen.conditions import OF_SENSOR
from mdlgen.formulas import Amount


@dataclass
class Sight:
    """The knowledge of a sensor. Times in ms, nan: not yet."""

    covered: bool = False
    count: int = 0
    since: float = math.nan  # time of its last change
    gap: float = math.nan
    speed: float = math.nan
    skew: float = math.nan
    position: float = math.nan
    looks: float = 0.0  # time of its next evaluation

    def known(self, t: float) -> dict[str, Amount | float]:
        values = {
            "count": float(self.count),
            "since": t - self.since,
            **{name: getattr(self, name) for name in ("gap", "speed", "skew", "position")},
        }
        found: dict[str, Amount | float] = {"covered": float(self.covered), "clear": float(not self.covered)}
        for name, value in values.items():
            dimension = OF_SENSOR[name]
            assert dimension is not None, "they are numbers"
            found[name] = Amount(value, dimension)
        return found
