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

    def known(self, word: str, t: float) -> Amount | float:
        """What it knows at the time t by a word of conditions.OF_SENSOR."""
        dimension = OF_SENSOR[word]
        if dimension is None:
            return float(self.covered == (word == "covered"))
        return Amount(t - self.since if word == "since" else float(getattr(self, word)), dimension)
