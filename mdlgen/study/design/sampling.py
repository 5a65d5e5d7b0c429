"""Samples of values: points of the unit cube, and the values that distributions have there."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from mdlgen.errors import SpecError, did_you_mean
from mdlgen.model.tables import Floats
from mdlgen.study.design.distribution import Choice, Distribution
from mdlgen.study.design.variable import check_count

KINDS = ("random", "lhs", "sobol", "saltelli")


def sample(kind: str, count: int, variables: Sequence[Distribution | Choice], seed: int) -> Floats:
    """Values of the variables in each case, (cases, variables), in the variables' units.

    `random` draws `count` independent cases; `lhs` fills each of `count` layers of every variable once;
    `sobol` takes the first `count` points of a scrambled Sobol sequence, most even for a power of two;
    `saltelli` has count (variables + 2) cases, which `effects.sobol` needs. The same seed gives the same
    cases on every machine. Raises SpecError for an unknown kind, and a count or a seed that cannot be.
    """
    if kind not in KINDS:
        close = did_you_mean(kind, KINDS) or f"; there are: {', '.join(KINDS)}"
        raise SpecError(f"--sample: there is no {kind[:40]!r}{close}")
    if not variables:
        raise SpecError("--sample: there is nothing to draw; name it with --over PATH=LO:HI")
    if count < 1 or seed < 0:
        raise SpecError(f"--sample {kind} {count}, seed {seed}: a count is 1 at least, a seed 0 at least")
    check_count(count * (len(variables) + 2) if kind == "saltelli" else count)
    points = _points(kind, count, len(variables), seed)
    return np.stack([v.quantile(points[:, k]) for k, v in enumerate(variables)], axis=1)


def _points(kind: str, count: int, size: int, seed: int) -> Floats:
    """Points of the unit cube, (cases, size)."""
    from scipy.stats import qmc

    random = np.random.default_rng(seed)
    if kind == "random":
        return random.random((count, size))
    if kind == "lhs":
        return qmc.LatinHypercube(size, rng=random).random(count)
    with warnings.catch_warnings():
        # of a count that is no power of two: see `sample`
        warnings.simplefilter("ignore", UserWarning)
        if kind == "sobol":
            return qmc.Sobol(size, rng=random).random(count)
        both = qmc.Sobol(2 * size, rng=random).random(count)
    return _crossed(both[:, :size], both[:, size:])


def _crossed(one: Floats, other: Floats) -> Floats:
    """Saltelli's cases: A, B, then for each variable A with that variable taken from B, one block each."""
    blocks = [one, other]
    for k in range(one.shape[1]):
        mixed = one.copy()
        mixed[:, k] = other[:, k]
        blocks.append(mixed)
    return np.concatenate(blocks)
