"""Detection of pairs that cross each other: the depth up to which a law holds, and the motion between checks.

A law of contact acts in a band behind a face: as thick as a plate, as deep as a roller's radius. Beyond it
there is no force, so a body that is fast or thin may be before the band at one state and behind it at the
next. States that are no further apart than `unseen` cannot miss the part of the band that is deeper than
`deepest`, where a run ends. The functions for each kind of pair are in mechanics.pairs.
"""

from __future__ import annotations

from mdlgen.mechanics.bounds import UNSEEN
from mdlgen.mechanics.by_kind import by_kind
from mdlgen.program.kernel import BORROWS, njit

deepest, closing, apart = (by_kind(__name__, name) for name in ("deepest", "closing", "apart"))
above = by_kind(__name__, "above", otherwise=0)
buried = by_kind(__name__, "buried")
_solid = by_kind(__name__, "SOLID", otherwise=False, inline=True)


@njit(cache=True, error_model="numpy", **BORROWS)
def _most(bodies, pair, shapes):
    """A little less than the width of the band beyond `deepest`, which for most laws equals `deepest`."""
    return UNSEEN * deepest(bodies, pair)


unseen = by_kind(__name__, "unseen", otherwise=_most)


@njit(cache=True, error_model="numpy", forceinline=True)
def solid(bodies, pair):
    """True if a pair has a box with a free side and a solid in which it may be `buried`."""
    return _solid(pair) and bodies[pair.a].exposed != 0
