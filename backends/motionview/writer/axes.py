"""Directions as a text has them: global vectors where one fits, else vectors of their own."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.motionview.writer.rows import Axis
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.tables import Floats


def axis_of(name: str, direction: Floats) -> Axis:
    """The global vector along `direction`, or a vector called `name`."""
    for k, letter in enumerate("XYZ"):
        if np.array_equal(direction, np.eye(3)[k]):
            return Axis(f"V_Global_{letter}", None)
    return Axis(name, components(direction))


def components(direction: Floats) -> tuple[str, str, str]:
    x, y, z = (number(v) for v in direction)
    return x, y, z


def zx_vector(rotation: Floats) -> str:
    """The global vector in the plane of a body's z and x axes, from which ZX computes that x axis."""
    x, y = rotation[:, 0], rotation[:, 1]
    k = min((0, 1), key=lambda k: (abs(y[k]) > 1e-9, -x[k]))
    return f"V_Global_{'XY'[k]}"
