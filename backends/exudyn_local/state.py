"""Records of arrays on which compiled code of this solver works."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.over_time import Changing
from mdlgen.mechanics.point import MOST_POINTS, OUT, POINT
from mdlgen.mechanics.shapes import Shapes
from mdlgen.mechanics.turning import TURNING
from mdlgen.model.tables import Floats, Ints

if TYPE_CHECKING:
    from mdlgen.backends.exudyn_local.films import Film
    from mdlgen.backends.exudyn_local.patches import Sticking
    from mdlgen.backends.exudyn_local.system import System

# Columns of the energies at a state [J, W]: kinetic, elastic, potential, dissipated power, power of drives
# and loads; and the energy that the springs of patches store. That is part of the elastic energy, and has
# been counted as dissipated.
KINETIC, ELASTIC, POTENTIAL, LOST, DRIVING, HELD, TOTALS = 0, 1, 2, 3, 4, 5, 6
# Numbers in the result of a pair at a state: without and with its points.
SEEN, WIDE = OUT + TURNING, OUT + 1 + POINT * MOST_POINTS


class Tables(NamedTuple):
    """Records of the scene of a run, see system.System."""

    bodies: np.ndarray
    bushings: np.ndarray
    points: np.ndarray
    pairs: np.ndarray
    shapes: Shapes
    loads: np.ndarray
    gravity: Floats
    film: Film
    stick: Sticking
    hinges: np.ndarray  # mechanics.plastic.HINGE, of the bushings that yield
    corners: np.ndarray
    given_up: Floats  # of each axle, of the angle by which it is behind its shaft, see integrals.py [rad]
    changes: Changing  # loads and gravity over time, which are set to a time before they are read


class Coordinates(NamedTuple):
    """Generalised coordinates, their rates, and the time [s]."""

    q: Floats
    v: Floats
    t: float


class Work(NamedTuple):
    """Work arrays: the motion of all bodies, the result of a pair, generalised forces; the forces of a
    corner, and their bodies."""

    motion: Motion
    out: Floats  # (OUT,)
    forces: Floats  # (free,)
    wrench: Floats  # (bodies, 6), zero but within a corner
    there: Ints  # (4,)


def workspace(system: System) -> Work:
    """Work arrays for a System, all zero."""
    n = len(system.bodies)
    motion = Motion(np.zeros((n, 3)), np.zeros((n, 9)), np.zeros((n, 3)), np.zeros((n, 3)))
    return Work(motion, np.zeros(OUT), np.zeros(max(1, system.free)), np.zeros((n, 6)), np.zeros(4, np.int64))
