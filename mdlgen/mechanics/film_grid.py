"""The grids that carry the air between two sheets, or a sheet and a plane, as records in a solver's units."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.film import CELL, FILM
from mdlgen.mechanics.pack import OWN, Units
from mdlgen.model.tables import BOX_BOX, Ints, Model, SheetPart

# Least number of cells of a film across a sheet: boxes of coarser grids have several.
FEWEST = 8
# Gaps that are wider [mm] count as open.
WIDE = 2.0


class Grids(NamedTuple):
    """Records of the air films of a Model."""

    films: np.ndarray  # mechanics.film.FILM, one for each contact with air
    film_of: Ints  # film of each contact, -1: none
    cells: np.ndarray  # mechanics.film.CELL, of all films, blank
    widest: int  # greatest number of cells of a row


def _finer(one: SheetPart, two: SheetPart) -> bool:
    """True if the second of two sheets has the smaller boxes; for the same size the first one carries the
    air."""
    areas = [s.size[0] * s.size[1] / s.count for s in (one, two)]
    return areas[1] < (1.0 - 1e-9) * areas[0]


def film_grids(model: Model, units: Units = OWN) -> Grids:
    """Records of the films of a Model; the finer of two sheets carries the air between them."""
    table = model.contacts
    rows = np.flatnonzero(table.air_viscosity > 0.0)
    sheets = {s.name: s for s in model.sheets}
    found = np.zeros(len(rows), FILM)
    film_of = np.full(len(table), -1, np.int64)
    film_of[rows] = np.arange(len(rows))
    cells = widest = 0
    for film, row in zip(found, rows.tolist(), strict=True):
        carrier, second = sheets[table.part_a[row]], 0
        if table.kind[row] == BOX_BOX and _finer(carrier, sheets[table.part_b[row]]):
            carrier, second = sheets[table.part_b[row]], 1
        x, y = (math.ceil(FEWEST / n) for n in (carrier.n_x, carrier.n_y))
        along, across = x * carrier.n_x, y * carrier.n_y
        film["row"], film["body"], film["carrier"] = row, carrier.first, second
        film["n_x"], film["n_y"], film["parts_x"], film["parts_y"] = carrier.n_x, carrier.n_y, x, y
        film["cell"], film["cells"] = cells, along * across
        film["width"], film["across"] = min(along, across), int(along > across)
        film["viscosity"] = table.air_viscosity[row] * units.mpa * units.ms
        film["roughness"], film["wide"] = table.air_roughness[row] * units.mm, WIDE * units.mm
        cells, widest = cells + along * across, max(widest, min(along, across))
    blank = np.zeros(cells, CELL)
    blank["pair"] = blank["following"] = blank["point"] = -1
    return Grids(found, film_of, blank, widest)
