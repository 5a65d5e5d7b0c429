"""Arrays of a run for the air between sheets, and between a sheet and a plane."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.kernels.state import Film
from mdlgen.mechanics.film_grid import film_grids
from mdlgen.model.tables import Model


def films(model: Model, system: System) -> Film:
    """Arrays for the films of a System."""
    found, film_of, blank, widest = film_grids(model)
    cells = len(blank)
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
