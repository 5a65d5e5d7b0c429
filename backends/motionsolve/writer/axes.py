"""Axes of markers, as direction cosines of X and Z."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.motionsolve.writer.rows import Cosines
from mdlgen.backends.motionsolve.writer.units import number
from mdlgen.model.tables import Floats

_PARALLEL = 1e-9  # sine of the angle below which an axis is the global Z


def cosines(rotation: Floats) -> Cosines | None:
    """X and Z of axes in columns (3, 3); None where they are the global ones, as the exporter has it."""
    if np.array_equal(rotation, np.eye(3)):
        return None
    a, b, c = (number(v) for v in rotation[:, 0])
    d, e, f = (number(v) for v in rotation[:, 2])
    return a, b, c, d, e, f


def along(z: Floats) -> Floats:
    """Axes of the markers of a joint along `z`, as MotionView sets them: X level, square to global Z
    (seen)."""
    level = np.array([-z[1], z[0], 0.0])
    if np.hypot(level[0], level[1]) <= _PARALLEL:
        level = np.array([1.0, 0.0, 0.0])
    y = np.cross(z, level)
    y /= np.linalg.norm(y)
    return np.stack([np.cross(y, z), y, z], axis=1)
