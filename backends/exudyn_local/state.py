"""What compiled code of this solver works on, by names."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.mesh import Meshes
from mdlgen.model.tables import Floats

# Of the energies at a state [J, W]: kinetic, elastic, potential, dissipated power, power of drives and loads.
KINETIC, ELASTIC, POTENTIAL, LOST, DRIVING, TOTALS = 0, 1, 2, 3, 4, 5


class Tables(NamedTuple):
    """Records of what a run is of, see system.System."""

    bodies: np.ndarray
    bushings: np.ndarray
    points: np.ndarray
    pairs: np.ndarray
    meshes: Meshes
    loads: np.ndarray
    gravity: Floats


class Coordinates(NamedTuple):
    """Generalised coordinates, their rates, and the time [s]."""

    q: Floats
    v: Floats
    t: float


class Work(NamedTuple):
    """Arrays to work in: the motion of all bodies, what a pair does, generalised forces."""

    motion: Motion
    out: Floats  # (OUT,)
    forces: Floats  # (free,)
