"""Distributions of a value of the scene: `PATH=LO:HI`, `PATH=normal(0.3, 0.05, 0.1:0.5)`, `PATH=[a, b]`."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from mdlgen.errors import SpecError, did_you_mean
from mdlgen.model.tables import Floats
from mdlgen.study.design.variable import interval, quantity, quantity_text, split, variable

# Digits of a drawn value: the same on every machine, though the last bits of exp and erf are not.
DIGITS = 10
# Least distance of a probability from 0 and 1, half of the finest step of a Sobol sequence of 30 bits; so a
# normal value without limits stays within 6.2 deviations of its mean.
_EDGE = 2.0**-31
# Limits that begin farther from the middle leave a tail, whose form no measurement of a scatter has shown.
_FARTHEST = 6.0

_CALL = re.compile(r"([A-Za-z]+)\s*\((.*)\)", re.DOTALL)
_FORMS = {
    "uniform": "uniform(0.1, 0.5)",
    "normal": "normal(0.3, 0.05) or normal(0.3, 0.05, 0.1:0.5): mean, deviation, limits",
    "lognormal": "lognormal(0.3, 0.2) or lognormal(0.3, 0.2, 0.1:0.5): median, deviation of ln, limits",
}
HOW = (
    "write PATH=LO:HI, PATH=normal(MEAN, DEVIATION), PATH=normal(MEAN, DEVIATION, LO:HI), uniform or "
    "lognormal likewise, or PATH=[a, b, c]"
)


@dataclass(frozen=True)
class Distribution:
    """A continuous distribution of one value of the scene; all numbers are in `unit`, "" for plain ones.

    `kind` is uniform, normal or lognormal. `center` is the mean of a normal one, the median of a lognormal
    one; `spread` the standard deviation of the value, of a lognormal one that of its natural logarithm (no
    unit); a uniform one has neither. Values lie in `low` to `high`: limits cut the density off, and the rest
    is scaled up.
    """

    path: str
    kind: str
    unit: str
    low: float = -math.inf
    high: float = math.inf
    center: float = math.nan
    spread: float = math.nan

    def quantile(self, probability: Floats) -> Floats:
        """Values that are exceeded with 1 - these probabilities, in `unit`, of the same shape."""
        if self.kind == "uniform":
            values = self.low + probability * (self.high - self.low)
        else:
            from scipy.stats import truncnorm

            inside = np.clip(probability, _EDGE, 1.0 - _EDGE)
            below, above = self._away(self.low), self._away(self.high)
            away = self.spread * truncnorm.ppf(inside, below, above)
            values = self.center + away if self.kind == "normal" else self.center * np.exp(away)
        rounded = [float(f"{value:.{DIGITS}g}") for value in values.ravel()]
        # a limit may have more digits than a drawn value
        return np.clip(np.reshape(rounded, values.shape), self.low, self.high)

    def text(self, value: float) -> str:
        """A value as it stands in a scene file."""
        return quantity_text(value, self.unit)

    def _away(self, limit: float) -> float:
        """A limit in deviations from the middle."""
        if self.kind == "normal":
            return (limit - self.center) / self.spread
        return math.log(limit / self.center) / self.spread if limit > 0.0 else -math.inf


@dataclass(frozen=True)
class Choice:
    """One of several values of a scene, all as likely; as a number it is its place in the list."""

    path: str
    texts: tuple[str, ...]

    def quantile(self, probability: Floats) -> Floats:
        """Places in the list from 0, of the same shape."""
        return np.minimum(np.floor(np.asarray(probability) * len(self.texts)), len(self.texts) - 1.0)

    def text(self, value: float) -> str:
        """A value as it stands in a scene file."""
        return self.texts[int(value)]


def parse_distribution(text: str, option: str = "--over") -> Distribution | Choice:
    """Parses `PATH=LO:HI`, `PATH=uniform(LO, HI)`, `PATH=normal(MEAN, DEVIATION[, LO:HI])`,
    `PATH=lognormal(MEDIAN, DEVIATION of ln[, LO:HI])` or `PATH=[a, b, c]`; quantities stand with their units.

    Raises SpecError in one line for anything else.
    """
    path, rest = split(text, option, HOW)
    message = f"{option} {text[:80]!r}"
    if rest.startswith("["):
        return Choice(path, variable(text, option).texts)
    call = _CALL.fullmatch(rest)
    if call is None:
        return _uniform(path, _ends(rest, message), message)
    kind, words = call[1].lower(), call[2].split(",")
    if kind not in _FORMS:
        close = did_you_mean(kind, _FORMS) or f"; there are: {', '.join(_FORMS)}"
        raise SpecError(f"{message}: there is no distribution {call[1][:40]!r}{close}")
    if not 2 <= len(words) <= (2 if kind == "uniform" else 3):
        raise SpecError(f"{message}: has {len(words)} values; write {_FORMS[kind]}")
    return _uniform(path, words, message) if kind == "uniform" else _bell(path, kind, words, message)


def _uniform(path: str, ends: list[str], message: str) -> Distribution:
    low, high, unit = interval(ends[0], ends[1], message)
    if not low < high:
        raise SpecError(f"{message}: the lower end {low:g} must be below the upper end {high:g}")
    return Distribution(path, "uniform", unit, low, high)


def _bell(path: str, kind: str, words: list[str], message: str) -> Distribution:
    if kind == "normal":
        center, spread, unit = interval(words[0], words[1], message)
    else:
        center, _, unit = interval(words[0], words[0], message)
        spread, _, other = interval(words[1], words[1], message)
        if other:
            raise SpecError(
                f"{message}: a deviation of the logarithm has no unit, got {words[1].strip()[:40]}"
            )
        if center <= 0.0:
            raise SpecError(f"{message}: the median must be above 0, got {words[0].strip()[:40]}")
    if spread <= 0.0:
        raise SpecError(f"{message}: the deviation must be above 0, got {words[1].strip()[:40]}")
    low, high = -math.inf, math.inf
    if len(words) == 3:
        # through the unit of the middle, so that all are numbers in one unit
        low, high = (interval(words[0], end, message)[1] for end in _ends(words[2], message))
    found = Distribution(path, kind, unit, low, high, center, spread)
    if not low < high:
        raise SpecError(f"{message}: the lower limit {low:g} must be below the upper limit {high:g}")
    if found._away(low) > _FARTHEST or found._away(high) < -_FARTHEST:
        raise SpecError(
            f"{message}: the limits leave a tail alone; allowed are limits within {_FARTHEST:g} deviations"
        )
    return found


def _ends(text: str, message: str) -> list[str]:
    ends = text.split(":")
    if len(ends) != 2 or quantity(ends[0]) is None:
        raise SpecError(f"{message}: {text.strip()[:40]!r} is no range; {HOW}")
    return ends
