"""Rims of rollers in sectors: Scene -> tables, and the profile that a flat face feels.

Let a flat face have its point nearest to the axis at the angle phi of the rim. It touches the sector with the
greatest R cos(delta), delta the angle from phi to the nearest point of the sector: its arc where delta is 0,
else its edge. That is the support function h(phi) of the rim. A solver needs only its pieces: the range of
angles of each arc or edge."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.model.tables import Floats, RimPart
from mdlgen.spec.machine import Roller
from mdlgen.spec.rim import TURN as TURN

SAG = 0.01  # how far a box that shows a part of a round may be from it [mm]
_SAME = 1e-9  # rad


class Piece(NamedTuple):
    """Piece of a rim that a flat face touches, from an angle up to that of the next piece."""

    begin: float  # [rad], from 0 to 2 pi
    sector: int
    edge: float  # angle of the edge that it touches [rad], nan: the arc


def lower_rim(roller: Roller) -> RimPart | None:
    """The sectors of a roller's rim with the gaps between them."""
    if roller.rim is None:
        return None
    names, rows, own = [], [], []
    sectors = roller.rim.sectors
    for k, sector in enumerate(sectors):
        radius = roller.radius if sector.radius is None else sector.radius
        restitution = math.nan if sector.restitution is None else sector.restitution
        names.append(f"s{k}")
        own.append(sector.radius is not None)
        rows.append((sector.from_, sector.to, radius, sector.friction, sector.stiffness, restitution))
        after = sectors[k + 1].from_ if k + 1 < len(sectors) else sectors[0].from_ + TURN
        if after - sector.to > _SAME:
            names.append(f"g{k}")
            own.append(False)
            rows.append((sector.to, after, roller.radius, 1.0, 1.0, math.nan))
    begin, end, radius, friction, stiffness, restitution = np.array(rows).T.copy()
    # a facet that touches the arc in its middle is this far off at its ends
    facet = 2.0 * np.arccos(radius / (radius + SAG))
    return RimPart(
        name=tuple(names),
        begin=begin,
        end=end,
        radius=radius,
        friction=friction,
        stiffness=stiffness,
        restitution=restitution,
        own=tuple(own),
        blend=roller.rim.blend,
        facets=tuple(max(1, math.ceil(n - 1e-9)) for n in ((end - begin) / facet).tolist()),
    )


def touched(rim: RimPart, angle: float) -> tuple[float, int, float]:
    """(h(angle) [mm], sector, angle of its edge, nan: its arc) of what a flat face touches."""
    best = (-math.inf, 0, math.nan)
    for k in range(len(rim)):
        begin, end, radius = float(rim.begin[k]), float(rim.end[k]), float(rim.radius[k])
        if (angle - begin) % TURN <= end - begin:
            found = (radius, k, math.nan)
        else:
            found = max((radius * math.cos(angle - edge), k, edge) for edge in (begin, end))
        if found[0] > best[0]:
            best = found
    return best


def pieces(rim: RimPart) -> list[Piece]:
    """The pieces of the profile by angle, the first at 0."""
    edges = [
        (float(a), float(r)) for side in (rim.begin, rim.end) for a, r in zip(side, rim.radius, strict=True)
    ]
    places = {0.0, *(angle % TURN for angle, _ in edges)}
    for k, (one, r) in enumerate(edges):
        for radius in set(rim.radius.tolist()):  # where an edge comes to stand out as far as an arc
            if radius < r:
                away = math.acos(radius / r)
                places |= {(one - away) % TURN, (one + away) % TURN}
        for two, s in edges[:k]:  # or as another edge
            across = math.atan2(s * math.cos(two) - r * math.cos(one), r * math.sin(one) - s * math.sin(two))
            places |= {across % TURN, (across + math.pi) % TURN}
    ends = sorted(places)
    found: list[Piece] = []
    for begin, end in zip(ends, [*ends[1:], TURN], strict=True):
        if end - begin < _SAME and found:
            continue
        _, sector, edge = touched(rim, 0.5 * (begin + end))
        if not found or found[-1].sector != sector or repr(found[-1].edge) != repr(edge):
            found.append(Piece(begin, sector, edge))
    return found


def towards(axes: Floats, direction: Floats) -> float:
    """Angle about the third of the axes (columns), from the first, at which a direction lies [rad]."""
    own = direction @ axes
    return math.atan2(own[1], own[0])
