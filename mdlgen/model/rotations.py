"""Rotation vectors and matrices, many at once."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Floats


def matrices(vectors: Floats) -> Floats:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3) [rad] (Rodrigues)."""
    angle = np.linalg.norm(vectors, axis=-1)[..., None, None]
    zero = np.zeros(vectors.shape[:-1])
    x, y, z = np.moveaxis(vectors, -1, 0)
    skew = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*vectors.shape, 3)
    # sin(a)/a and (1 - cos(a))/a^2; np.sinc has a pi in it
    one, two = np.sinc(angle / np.pi), 0.5 * np.sinc(0.5 * angle / np.pi) ** 2
    return np.eye(3) + one * skew + two * (skew @ skew)


def vectors(rotations: Floats) -> Floats:
    """Rotation vectors (..., 3) of matrices (..., 3, 3), for angles below pi."""
    r = rotations
    twice = np.stack(
        [r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]], -1
    )
    sine = 0.5 * np.linalg.norm(twice, axis=-1)
    angle = np.arctan2(sine, 0.5 * (np.trace(r, axis1=-2, axis2=-1) - 1.0))
    scale = np.divide(angle, sine, out=np.ones_like(angle), where=sine > 1e-300)
    return 0.5 * scale[..., None] * twice
