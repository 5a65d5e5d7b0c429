"""Arrays of a run for the air between sheets."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.film_grid import film_grids
from mdlgen.mechanics.pack import Units
from mdlgen.model.tables import Floats, Ints, Model

# Delay of pressures [s], due to the mass of their coordinates, which need one for an initial acceleration.
LAG = 1e-9
# Most entries of a cell in the jacobian: itself and its neighbours, and the coordinates of the two boxes
# around it, in rows and in columns.
MOST_ENTRIES = 5 + 2 * 2 * 7


class Film(NamedTuple):
    """Arrays of the air in a run; no films: there is none."""

    films: np.ndarray  # mechanics.film.FILM, one for each contact with air
    film_of: Ints  # of each pair, -1: none
    cells: np.ndarray  # mechanics.film.CELL, of all films
    areas: Floats  # of whole cells [m^2]
    flow: Floats  # matrices of Reynolds' equation, (cells, band) [m^5/(N s)]
    factor: Floats  # factors of them
    head: Ints  # first cell of each pair, -1: none
    listed: Ints  # pairs that have cells
    many: Ints  # and how many these are, (1,)
    first: Ints  # (1,) coordinate of the first cell


def film_of(model: Model, first: int, units: Units) -> Film:
    """The air of a Model, with coordinates from `first` on; none in a static run, where nothing moves."""
    grids = film_grids(model, units)
    cells = len(grids.cells) if model.run.analysis == "transient" else 0
    areas = np.zeros(cells)
    for film in grids.films if cells else ():
        half = model.bodies.half[film["body"]] * units.mm
        one = slice(film["cell"], film["cell"] + film["cells"])
        areas[one] = 4.0 * half[0] * half[1] / (film["parts_x"] * film["parts_y"])
    pairs = len(model.pairs) if cells else 0
    return Film(
        films=grids.films if cells else grids.films[:0],
        film_of=grids.film_of[model.pairs.contact[:pairs]],
        cells=grids.cells[:cells],
        areas=areas,
        flow=np.zeros((cells, grids.widest + 1)),
        factor=np.zeros((cells, grids.widest + 1)),
        head=np.full(pairs, -1, np.int64),
        listed=np.zeros(min(pairs, cells), np.int64),
        many=np.zeros(1, np.int64),
        first=np.array([first], np.int64),
    )


def entries_of(film: Film) -> tuple[Ints, Floats]:
    """Arrays for the results of air.air_slopes: rows and columns, and values."""
    most = MOST_ENTRIES * film.cells.size
    return np.zeros((2, most), np.int64), np.zeros(most)
