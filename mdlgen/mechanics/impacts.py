"""What a step of the midpoint rule makes of a contact that it begins before, or turns back in.

The rule takes the force in the middle of a step over all of it. So a contact stores more, or less, than the
work done on it, and its damping has the rate in the middle alone.
"""

from __future__ import annotations

from mdlgen.mechanics.laws import sign_step
from mdlgen.program.kernel import njit

SLOW = 0.02  # part of its depth that a contact may move by in half of a step without a look at what it stores


@njit(cache=True, error_model="numpy", forceinline=True)
def stored_beyond(force, depth, energy, moved):
    """The energy that a point of `force`, depth and `energy` in the middle of a step stores in it beyond the
    work done on it, which moves by `moved` in half of it: 2/5 F z at both ends (of z^1.5; other laws are near
    enough)."""
    part = moved / depth
    if abs(part) <= SLOW:
        return 0.0
    ends = max(1.0 + part, 0.0) ** 2.5 - max(1.0 - part, 0.0) ** 2.5
    return energy * ends - 2.0 * force * moved


@njit(cache=True, error_model="numpy", forceinline=True)
def turning_back(rate, faster, beta, smoothing):
    """What damping misses in a step in which a contact turns from closing to opening, for 1 of its elastic
    force and of time: the rule has the rate in the middle, and may hold it at zero there until the step ends
    as fast outwards as it began inwards. `faster`: what the rate changes in half of the step."""
    begin, end = rate - faster, rate + faster
    if begin <= 0.0 or end >= 0.0 or max(begin, -end) < smoothing:
        return 0.0
    mean = 0.5 * (begin * begin + end * end) / (begin - end)
    return beta * max(mean - sign_step(rate, smoothing) * rate, 0.0)
