"""Energy errors of a midpoint step in which a contact begins, or in which it turns from closing to opening.

The rule uses the force in the middle of a step for all of it. So a contact stores more, or less, than the
work done on it, and its damping depends on the rate in the middle alone.
"""

from __future__ import annotations

from mdlgen.mechanics.laws import sign_step
from mdlgen.program.kernel import njit

SLOW = 0.02  # motion in half of a step, relative to the depth, below which the energy error is not evaluated


@njit(cache=True, error_model="numpy", forceinline=True)
def stored_beyond(force, depth, energy, moved):
    """Energy that a point stores in a step beyond the work done on it. `force`, depth and `energy` are those
    of the middle of the step; the depth changes by `moved` in half of it. The energy at both ends is taken as
    2/5 F z, which is exact for z^1.5; other laws are close enough."""
    part = moved / depth
    if abs(part) <= SLOW:
        return 0.0
    ends = max(1.0 + part, 0.0) ** 2.5 - max(1.0 - part, 0.0) ** 2.5
    return energy * ends - 2.0 * force * moved


@njit(cache=True, error_model="numpy", forceinline=True)
def turning_back(rate, faster, beta, smoothing):
    """Energy that damping misses in a step in which a contact turns from closing to opening, per elastic
    force and time. The rule uses the rate in the middle, which may be zero while the step ends as fast
    outwards as it began inwards. `faster`: change of the rate in half of the step."""
    begin, end = rate - faster, rate + faster
    if begin <= 0.0 or end >= 0.0 or max(begin, -end) < smoothing:
        return 0.0
    mean = 0.5 * (begin * begin + end * end) / (begin - end)
    return beta * max(mean - sign_step(rate, smoothing) * rate, 0.0)
