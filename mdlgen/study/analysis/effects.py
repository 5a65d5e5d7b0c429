"""Effects of variables on a measure: means over the levels of one, interactions of two, and Sobol's
indices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.model.tables import Floats, Ints
from mdlgen.results.wording import ROUND_OFF

LEVEL = 0.95
# A variable with more values than LEVELS has its cases divided into GROUPS groups of equal size.
LEVELS, GROUPS = 12, 5
# Cells of two variables that hold one case or two count where this part of them is filled, as in a grid.
FILLED = 0.8
RESAMPLES, SEED = 1000, 0


@dataclass(frozen=True)
class Group:
    """Cases in which a variable has one value, or values from `low` to `high`."""

    low: float
    high: float
    mean: float  # of the measure
    deviation: float  # of that mean, from the scatter in the group; nan for one case
    cases: int


@dataclass(frozen=True)
class MainEffect:
    """How the mean of a measure goes with one variable, over all the others.

    `share` is the part of the measure's variance between the groups, freed of what chance alone would give
    (Kelley's epsilon squared): 0 without an effect, 1 where this variable decides alone.
    """

    groups: tuple[Group, ...]
    share: float

    @property
    def range(self) -> float:
        """Range from the least mean of a group to the greatest."""
        means = [group.mean for group in self.groups]
        return max(means) - min(means)


def is_constant(measure: Floats) -> bool:
    """True if a measure is the same in all cases, but for round-off: then no effects are reported."""
    return not len(measure) or float(np.ptp(measure)) <= ROUND_OFF * max(1.0, float(np.abs(measure).max()))


def main_effect(values: Sequence[float], measure: Sequence[float]) -> MainEffect | None:
    """Effect of a variable on a measure, by their values in the cases; cases without a number are left out.

    None where there are too few cases for two groups, or where the measure never changes.
    """
    x, y = np.asarray(values, dtype=float), np.asarray(measure, dtype=float)
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    if is_constant(y):
        return None
    group = _groups(x)
    members = [np.flatnonzero(group == k) for k in range(group.max() + 1)]
    if len(members) < 2:
        return None
    total = float(((y - y.mean()) ** 2).sum())
    inside = sum(float(((y[rows] - y[rows].mean()) ** 2).sum()) for rows in members)
    free = len(y) - len(members)
    share = 1.0 - inside / total * (len(y) - 1) / free if free else 1.0
    return MainEffect(tuple(_group(x[rows], y[rows]) for rows in members), max(share, 0.0))


def _groups(x: Floats) -> Ints:
    """The group of each value, from 0: one for each of a few values, else some of equal size."""
    levels, which = np.unique(x, return_inverse=True)
    if len(levels) <= LEVELS:
        return which.reshape(-1)
    group = np.empty(len(x), dtype=np.int64)
    for k, rows in enumerate(np.array_split(np.argsort(x, kind="stable"), GROUPS)):
        group[rows] = k
    return group


def interaction(one: Sequence[float], other: Sequence[float], measure: Sequence[float]) -> float | None:
    """Part of a measure's variance that two variables decide together, beyond what each does alone.

    It is what the means of their cells leave less than the sum of an effect of each does, freed of what
    chance alone would give where cells have several cases. None where the measure never changes, or the
    cases are too few for the cells that there are.
    """
    x1, x2, y = (np.asarray(v, dtype=float) for v in (one, other, measure))
    known = np.isfinite(x1) & np.isfinite(x2) & np.isfinite(y)
    if not known.any() or is_constant(y[known]):
        return None
    y = y[known]
    a, b = _groups(x1[known]), _groups(x2[known])
    rows, columns = int(a.max()) + 1, int(b.max()) + 1
    cell, count = np.unique(a * columns + b, return_inverse=True, return_counts=True)[1:]
    free = len(y) - len(count)
    if min(rows, columns) < 2 or free < len(count) < FILLED * rows * columns:
        return None
    means = np.bincount(cell.reshape(-1), y) / count
    inside = float(((y - means[cell.reshape(-1)]) ** 2).sum())
    sums = np.concatenate([np.eye(rows)[a], np.eye(columns)[b]], axis=1)
    found, _, rank, _ = np.linalg.lstsq(sums, y, rcond=None)
    beyond = float(((y - sums @ found) ** 2).sum()) - inside
    chance = inside / free * (len(count) - int(rank)) if free else 0.0
    return max(beyond - chance, 0.0) / float(((y - y.mean()) ** 2).sum())


def _group(x: Floats, y: Floats) -> Group:
    deviation = float(y.std(ddof=1)) / len(y) ** 0.5 if len(y) > 1 else float("nan")
    return Group(float(x.min()), float(x.max()), float(y.mean()), deviation, len(y))


@dataclass(frozen=True)
class Index:
    """A Sobol index and the interval that holds it with LEVEL, by the bootstrap."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Indices:
    """Parts of a measure's variance: `first` of a variable alone, `total` with its interactions."""

    first: Index
    total: Index


def sobol(measure: Sequence[float], variables: int) -> tuple[Indices, ...] | None:
    """Indices of each variable, from the measure in the cases of `sampling.sample("saltelli", ...)`.

    First order after Saltelli et al. (Comput. Phys. Commun. 181, 2010), total order after Jansen (1999). A
    missing number removes its n + 2 cases. The bootstrap resamples such rows, always with the same seed. None
    where less than two rows remain, or where the measure never changes. Raises SpecError for a number of
    cases that no such sample has.
    """
    y = np.asarray(measure, dtype=float)
    if variables < 1 or not len(y) or len(y) % (variables + 2):
        raise SpecError(f"{len(y)} cases of {variables} variables are no sample saltelli")
    rows = y.reshape(variables + 2, -1)
    rows = rows[:, np.isfinite(rows).all(axis=0)]
    if rows.shape[1] < 2 or is_constant(rows.ravel()):
        return None
    found = _indices(rows)
    random = np.random.default_rng(SEED)
    count = rows.shape[1]
    drawn = np.array([_indices(rows[:, random.integers(count, size=count)]) for _ in range(RESAMPLES)])
    low, high = np.nanquantile(drawn, [0.5 - LEVEL / 2, 0.5 + LEVEL / 2], axis=0)
    return tuple(
        Indices(*(Index(float(found[o, k]), float(low[o, k]), float(high[o, k])) for o in (0, 1)))
        for k in range(variables)
    )


def _indices(rows: Floats) -> Floats:
    """First and total order, (2, variables); nan where the rows do not differ."""
    one, other, mixed = rows[0], rows[1], rows[2:]
    both = rows[:2]
    variance = float(both.var())
    if not variance:
        return np.full((2, len(mixed)), np.nan)
    first = ((other - both.mean()) * (mixed - one)).mean(axis=1)
    total = 0.5 * ((one - mixed) ** 2).mean(axis=1)
    return np.stack([first, total]) / variance
