"""Axes made from one that is given."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Floats


def frame(z: Floats, guide: Floats | None = None) -> Floats:
    """A right-handed frame (columns x, y, z) with the given z; x near `guide`, or near global x or y."""
    near: Floats = np.eye(3)[1 if abs(z[0]) > 0.9 else 0] if guide is None else guide
    x = near - z * (near @ z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)
