"""Creep speed of parts that regularised friction holds (Eq. 12), and the allowed creep."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Floats

# Part of a sheet's length by which the position of a sheet is judged that travels less.
TENTH = 0.1


def slip_part(used: float | Floats) -> Floats:
    """Slip speeds, relative to the stiction velocity, at which friction is this part of its limit, 0 to 1:
    the inverse of x (3 - x^2)/2, of any shape."""
    return np.asarray(2.0 * np.sin(np.arcsin(np.minimum(used, 1.0)) / 3.0))


def load_part(slip: Floats) -> Floats:
    """Friction, relative to its limit, at slip speeds that are relative to the stiction velocity."""
    x = np.minimum(slip, 1.0)
    return 0.5 * x * (3.0 - x * x)


def judged_by(length: float, travel: float = 0.0) -> float:
    """Length relative to which `run.tolerance` judges the position of a sheet [mm]: its travel, at least
    TENTH of its length."""
    return max(travel, TENTH * length)
