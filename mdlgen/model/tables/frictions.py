"""Friction of contacts as it is measured: by direction, face, speed and pressure, and with scatter."""

from __future__ import annotations

from dataclasses import dataclass

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints
from mdlgen.model.tables.bodies import Frozen

# Rows of a table of speeds: as many as the points of a Stribeck curve need, see model.measured.
MOST_SPEEDS = 8


@dataclass(frozen=True)
class Frictions(Frozen):
    """Factors on the friction coefficients of `Contacts`, one row for each contact."""

    direction: Floats  # along MD and CD, the lesser is 1, (n, 2)
    face: Floats  # of the sheet's front, at +z, and its back, the lesser is 1, (n, 2)
    points: Ints  # how many speeds the table has, 0: none, (n,)
    # speed [mm/ms], coefficient relative to that at the first speed, its slope [ms/mm], (n, MOST_SPEEDS, 3)
    speed: Floats
    pressure: Floats  # p_0 [MPa] and n of (p/p_0)^n; n = 0: none, (n, 2)
    scatter: Floats  # standard deviation over the mean, 0: none, and correlation length [mm], (n, 2)
    seed: Ints  # (n,)
