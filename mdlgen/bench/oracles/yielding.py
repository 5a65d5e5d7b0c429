"""A mass on a spring that yields, without damping: where it turns round, by its energy alone."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Turn:
    """Where the mass turns round: displacement, its plastic part, what was dissipated up to there."""

    at: float
    plastic: float
    lost: float


def turns(energy: float, k: float, limit: float, share: float, count: int) -> list[Turn]:
    """The first turns of a mass that leaves the stress-free spring with an energy. The spring has the
    stiffness k up to the force `limit`, then `share` of it, and yields back once the force has changed by
    twice the limit.

    On each way the work up to the yield point, and from there on, is that of a trapezoid; so each turn is the
    root of a square equation.
    """
    at = plastic = lost = force = 0.0
    found, way = [], 1.0
    back = k * share / (1.0 - share)
    for _ in range(count):
        yields = way * limit + back * plastic  # force at which it does
        reach = (yields - force) / k
        work = 0.5 * (force + yields) * reach
        if work >= energy:
            moved = way * _root(k, way * force, energy)
            at, force = at + moved, force + k * moved
        else:
            moved = way * _root(share * k, way * yields, energy - work)
            at, force = at + reach + moved, yields + share * k * moved
            plastic += (1.0 - share) * moved
            lost += limit * (1.0 - share) * abs(moved)
        found.append(Turn(at, plastic, lost))
        energy, way = 0.0, -way
    return found


def _root(slope: float, force: float, energy: float) -> float:
    """The greater x with force x + slope x^2/2 = energy."""
    return (-force + math.sqrt(force * force + 2.0 * slope * energy)) / slope
