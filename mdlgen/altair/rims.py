"""A rim in MDL file and deck: boxes that show its sectors, and a contact for each sector.

A part of a cylinder has no form in either that is known, so each sector is shown by boxes, as an arc of a
guide is: each touches the round in its middle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from mdlgen.model.parts.guide import Facet
from mdlgen.model.tables import Floats, Model, RollerPart

DEEP = 0.25  # thickness of a box relative to the radius


class Side(NamedTuple):
    """The part of a body in a contact statement: all of it, or a sector of its rim."""

    suffix: str  # of the statement's name
    sector: int  # -1: all of it
    friction: float  # relative to that of the contact
    stiffness: float
    restitution: float  # nan: that of the contact


WHOLE = Side("", -1, 1.0, 1.0, math.nan)


def sides(roller: RollerPart) -> list[Side]:
    """The sectors of a roller's rim, gaps included; a round one as it is."""
    rim = roller.rim
    if rim is None:
        return [WHOLE]
    columns = (v.tolist() for v in (rim.friction, rim.stiffness, rim.restitution))
    return [Side(f"_{name}", k, *row) for k, (name, *row) in enumerate(zip(rim.name, *columns, strict=True))]


class Meeting(NamedTuple):
    """One contact statement of a stored pair."""

    pair: int
    a: Side
    b: Side

    @property
    def suffix(self) -> str:
        return self.a.suffix + self.b.suffix

    @property
    def friction(self) -> float:
        return self.a.friction * self.b.friction

    @property
    def stiffness(self) -> float:
        return self.a.stiffness * self.b.stiffness

    def restitution(self, contact: float) -> float:
        """c_R; at most one of two rollers in contact has a rim."""
        own = self.b.restitution if math.isnan(self.a.restitution) else self.a.restitution
        return contact if math.isnan(own) else own


def meetings(model: Model) -> Iterator[Meeting]:
    """The statements of all stored pairs, in their order."""
    of = {roller.body: sides(roller) for roller in model.rollers}
    for pair, (a, b) in enumerate(zip(model.pairs.a.tolist(), model.pairs.b.tolist(), strict=True)):
        for one in of.get(a, [WHOLE]):
            for two in of.get(b, [WHOLE]):
                yield Meeting(pair, one, two)


def rim_facets(roller: RollerPart, center: Floats, axes: Floats) -> list[tuple[str, Facet]]:
    """Name and box of each facet, sector by sector; `axes` are those of the roller's body, in columns."""
    rim, made = roller.rim, []
    for k in range(0 if rim is None else len(rim)):
        assert rim is not None
        radius, many = float(rim.radius[k]), rim.facets[k]
        turn = float(rim.end[k] - rim.begin[k]) / many
        chord = 2.0 * radius * math.tan(0.5 * turn)
        for i in range(many):
            angle = float(rim.begin[k]) + (i + 0.5) * turn
            away = axes @ [math.cos(angle), math.sin(angle), 0.0]
            # x back to the axis
            turned = np.stack([-away, np.cross(axes[:, 2], -away), axes[:, 2]], axis=1)
            place = center + (1.0 - 0.5 * DEEP) * radius * away
            lengths = (DEEP * radius, chord, roller.width)
            made.append((f"{roller.name}_{rim.name[k]}_{i}", Facet(place, turned, lengths)))
    return made


def graphics(roller: RollerPart, side: Side) -> list[str]:
    """Names of the graphics that a contact with a side of a roller has."""
    rim = roller.rim
    if rim is None:
        return [f"gcyl_{roller.name}"]
    chosen = range(len(rim)) if side.sector < 0 else (side.sector,)
    return [f"gbox_{roller.name}_{rim.name[k]}_{i}" for k in chosen for i in range(rim.facets[k])]
