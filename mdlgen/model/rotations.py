"""Rotation vectors, matrices and Euler parameters, many at once.

scipy has these too; they stand here because importing its rotations takes half a second of each run.
"""

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


def euler_parameters(rotations: Floats) -> Floats:
    """Euler parameters (..., 4), scalar first and not negative, of matrices (..., 3, 3).

    Four formulas yield them; the one that divides by the largest parameter is used (Shepperd 1978).
    """
    (a, b, c), (d, e, f), (g, h, i) = np.moveaxis(rotations, (-2, -1), (0, 1))
    squares = np.stack([1 + a + e + i, 1 + a - e - i, 1 - a + e - i, 1 - a - e + i])  # 4 q_i^2
    w, x, y, z = squares
    ways = np.stack(
        [
            np.stack([w, h - f, c - g, d - b]),
            np.stack([h - f, x, b + d, c + g]),
            np.stack([c - g, b + d, y, f + h]),
            np.stack([d - b, c + g, f + h, z]),
        ]
    )
    best = np.take_along_axis(ways, squares.argmax(axis=0)[None, None], axis=0)[0]
    best *= np.where(best[0] < 0.0, -1.0, 1.0) / np.sqrt((best * best).sum(axis=0))
    return np.moveaxis(best, 0, -1)


def column(parameters: Floats, k: int) -> Floats:
    """Column k of the rotation matrices of Euler parameters (..., 4), scalar first and of any length: where
    the body's axis k points, (..., 3)."""
    w, *q = np.moveaxis(parameters, -1, 0)
    two = 2.0 / (w * w + q[0] * q[0] + q[1] * q[1] + q[2] * q[2])
    i, j = (k + 1) % 3, (k + 2) % 3
    found = np.empty((*w.shape, 3))
    found[..., k] = 1.0 - two * (q[i] * q[i] + q[j] * q[j])
    found[..., i] = two * (q[i] * q[k] + w * q[j])
    found[..., j] = two * (q[j] * q[k] - w * q[i])
    return found


def turns(parameters: Floats) -> Floats:
    """Rotation matrices (..., 3, 3) of Euler parameters (..., 4), scalar first and of any length."""
    return np.stack([column(parameters, k) for k in range(3)], axis=-1)


def without_jumps(quaternions: Floats) -> Floats:
    """Euler parameters (t, bodies, 4) with signs such that no body's jump from one time to the next."""
    if len(quaternions) < 2:
        return quaternions
    signs = np.sign(np.einsum("tbi,tbi->tb", quaternions[1:], quaternions[:-1]))
    signs[signs == 0] = 1.0
    return np.concatenate([quaternions[:1], quaternions[1:] * np.cumprod(signs, axis=0)[:, :, None]])
