"""A sheet in a nip with a rubber cover that rolls steadily, with Coulomb friction on all of the contact.

The sheet does not stretch. The surface is a ring of finite elements (annulus.py). The interval before each
node, upstream, either sticks to the sheet, with a stretch equal to the gain of the speed, or slips against a
friction mu p. That is the scheme of Kalker (Three-Dimensional Elastic Bodies in Rolling Contact, 1990).
Incoming material is free, so the friction begins without a jump at the leading edge. The pull on the sheet is
0.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.bench.oracles.annulus import Nip, Ring, surface
from mdlgen.rubber.layer import Floats

_MOST = 400  # changes of which nodes slip


def gain(ring: Ring, nip: Nip, friction: float) -> float:
    """v/(omega R) - 1 of the sheet, under the pressure of a nip without friction; friction inf: all sticks.

    Raises ArithmeticError where which nodes slip does not come to rest.
    """
    of, inside = surface(ring), np.flatnonzero(nip.force > 0.0)
    by_force = _intervals(ring, of.angle, -of.radial[0] @ nip.force, -of.radial[1] @ nip.force)[inside]
    own = np.stack(
        [_intervals(ring, of.angle, of.tangential[0][:, k], of.tangential[1][:, k])[inside] for k in inside],
        axis=1,
    )
    most = friction * nip.force[inside]
    sign, count = np.zeros(len(inside)), len(inside)
    for _ in range(_MOST):
        stick = np.flatnonzero(sign == 0.0)
        held = np.where(sign == 0.0, 0.0, sign * np.where(np.isinf(most), 0.0, most))
        # of nodes that stick by_force + own q - gain = 0, and all q add up to 0
        rows = np.zeros((len(stick) + 1, len(stick) + 1))
        rows[:-1, :-1], rows[:-1, -1], rows[-1, :-1] = own[np.ix_(stick, stick)], -1.0, 1.0
        right = np.append(-(by_force + own @ held)[stick], -held.sum())
        if not len(stick):
            raise ArithmeticError("all of the nip slips; the pull is not 0")
        found = np.linalg.solve(rows, right)
        pull, speed = held.copy(), float(found[-1])
        pull[stick] = found[:-1]
        slip = by_force + own @ pull - speed  # of the cover against the sheet
        over, back = (sign == 0.0) & (np.abs(pull) > most), (sign != 0.0) & (slip * sign > 0.0)
        if not over.any() and not back.any():
            return speed
        if over.any():
            worst = np.argmax(np.where(over, np.abs(pull) / np.maximum(most, 1e-300), 0.0))
            sign[worst] = math.copysign(1.0, pull[worst])
        else:
            sign[np.argmax(np.where(back, np.abs(slip), 0.0))] = 0.0
    raise ArithmeticError(f"which of {count} nodes slip does not come to rest at a friction of {friction:g}")


def _intervals(ring: Ring, angle: Floats, radial: Floats, tangential: Floats) -> Floats:
    """Stretch of the interval before each node, in the sense in which angles grow, (n,)."""
    along = np.diff(tangential, prepend=0.0) / np.diff(angle, prepend=angle[0] - 1.0)
    return (along + 0.5 * (radial + np.concatenate([[0.0], radial[:-1]]))) / ring.radius
