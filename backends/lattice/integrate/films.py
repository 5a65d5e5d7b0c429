"""Air between sheets, and between a sheet and a plane: the grids that carry it."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.kernels.state import Film
from mdlgen.mechanics.film import CELL, FILM
from mdlgen.model.tables import BOX_BOX, Model, SheetPart

# Cells that a film has across a sheet at least: boxes of coarser grids have several.
FEWEST = 8


def _finer(one: SheetPart, two: SheetPart) -> bool:
    """Whether the second of two sheets has the smaller boxes; of the same size the first one carries."""
    areas = [s.size[0] * s.size[1] / s.count for s in (one, two)]
    return areas[1] < (1.0 - 1e-9) * areas[0]


def films(model: Model, system: System) -> Film:
    """What a run has of it. The finer of two sheets carries the air between them."""
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
        film["viscosity"], film["roughness"] = table.air_viscosity[row], table.air_roughness[row]
        cells, widest = cells + along * across, max(widest, min(along, across))
    blank = np.zeros(cells, CELL)
    blank["pair"] = blank["following"] = blank["point"] = -1
    nodes, pairs = (len(system.nodes), len(system.pairs)) if cells else (0, 0)
    bands = (np.zeros((cells, widest + 1)) for _ in range(3))
    return Film(
        found,
        film_of,
        blank,
        *bands,
        vectors=np.zeros((4, cells)),
        head=np.full(pairs, -1, np.int64),
        listed=np.zeros(min(pairs, cells), np.int64),
        many=np.zeros(1, np.int64),
        push=np.zeros((nodes, 6)),
        place=np.zeros((len(system.bodies) if cells else 0, 3)),
        off=np.zeros((nodes, 6)),
    )
