"""Random values for scenes, in the ranges that the manual lists, rounded as a user would write them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

Choice = TypeVar("Choice")
Data = dict[str, Any]


@dataclass(frozen=True)
class Range:
    """Values of one quantity; `even` ones are drawn uniformly, the others uniformly in their logarithm."""

    low: float
    high: float
    unit: str
    meaning: str
    even: bool = False


RANGES = {
    "thickness": Range(0.05, 0.8, "mm", "thickness of a sheet"),
    "boxes": Range(1, 300, "", "boxes of a scene"),
    "speed": Range(0.1, 3.0, "m/s", "speed of a sheet or of a driven surface"),
    "force": Range(0.5, 10.0, "N", "force that presses a roller"),
    "stiffness": Range(30.0, 1000.0, "N/mm^1.5", "contact stiffness"),
    "friction": Range(0.1, 1.2, "", "coefficient of friction", even=True),
    "restitution": Range(0.1, 0.8, "", "coefficient of restitution", even=True),
    "smoothing": Range(1.0, 20.0, "mm/s", "smoothing speed, at most 5 % of a driven surface's speed"),
    "sticking": Range(5.0, 500.0, "N/mm", "with `--sticking`, stiffness along the faces"),
    "duration": Range(20.0, 250.0, "ms", "duration"),
}

# Digits to which values are rounded.
DIGITS = 3
# Part of the speed of a driven surface above which lint W106 warns of a smoothing.
CREEP = 0.05


def rounded(value: float, digits: int = DIGITS) -> float:
    """The value to so many significant digits."""
    return float(f"{value:.{digits}g}")


def mm(value: float, decimals: int = 3) -> str:
    """A length as text; places have decimals, not significant digits, so that parts that touch do."""
    text = f"{round(value, decimals) + 0.0:.{decimals}f}".rstrip("0").rstrip(".")
    return f"{text} mm"


def place(x: float, y: float, z: float, decimals: int = 3) -> list[str]:
    """A point as a list of lengths."""
    return [mm(x, decimals), mm(y, decimals), mm(z, decimals)]


class Draw:
    """Draws values from one generator. Its seed alone determines a scene."""

    def __init__(self, seed: Sequence[int]):
        self._random = np.random.default_rng(list(seed))

    def even(self, low: float, high: float) -> float:
        """Uniform between two values."""
        return rounded(self._random.uniform(low, high))

    def log(self, low: float, high: float) -> float:
        """Uniform in the logarithm."""
        return min(max(rounded(math.exp(self._random.uniform(math.log(low), math.log(high)))), low), high)

    def count(self, low: int, high: int) -> int:
        """A whole number, both ends included."""
        return int(self._random.integers(low, high + 1))

    def of(self, *choices: Choice) -> Choice:
        return choices[int(self._random.integers(len(choices)))]

    def weighted(self, weights: Sequence[float]) -> int:
        """An index, drawn by weight."""
        total = np.cumsum(weights)
        return int(np.searchsorted(total, self._random.uniform(0.0, total[-1]), side="right"))

    def chance(self, part: float) -> bool:
        return bool(self._random.uniform() < part)

    def sign(self) -> int:
        return self.of(-1, 1)

    def value(self, name: str, low: float | None = None, high: float | None = None) -> float:
        """A random value of a quantity of RANGES, in its unit; `low` and `high` narrow its range."""
        allowed = RANGES[name]
        least = allowed.low if low is None else max(low, allowed.low)
        most = allowed.high if high is None else max(least, min(high, allowed.high))
        return self.even(least, most) if allowed.even else self.log(least, most)

    def text(self, name: str, low: float | None = None, high: float | None = None) -> str:
        """The same with its unit."""
        return f"{self.value(name, low, high):g} {RANGES[name].unit}".strip()

    def contact(
        self, one: Any, other: Any, *, stiff: float = 0.0, speed: float | None = None, **given: Any
    ) -> Data:
        """A contact of two sides. `stiff` is the least stiffness [N/mm^1.5]; `speed` [m/s] that of a driven
        surface, for which the smoothing is small enough; a third leave it out."""
        made: Data = {"between": [one, other], "stiffness": self.text("stiffness", stiff)}
        made["friction"] = self.value("friction")
        if self.chance(0.8):
            made["restitution"] = self.value("restitution")
        if self.chance(2 / 3):
            most = None if speed is None else 1e3 * CREEP * speed
            made["smoothing"] = self.text("smoothing", None, most)
        return {**made, **given}

    def run(self, duration: float, **keys: Any) -> Data:
        """The entry `run` [ms]; most users leave the rest out."""
        allowed = RANGES["duration"]
        return {"duration": f"{rounded(min(max(duration, allowed.low), allowed.high)):g} ms", **keys}
