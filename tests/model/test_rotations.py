"""Rotations, many at once, against scipy's."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from mdlgen.model.rotations import column, euler_parameters, matrices, turns, vectors

SOME = np.random.default_rng(3).normal(size=(400, 3))
# no turn, tiny ones, half turns about each axis and between axes, and any
VECTORS = np.concatenate(
    [
        np.zeros((1, 3)),
        1e-9 * SOME[:20],
        np.pi * np.eye(3),
        np.pi * SOME[:20] / np.linalg.norm(SOME[:20], axis=1)[:, None],
        (np.pi - 1e-9) * SOME[20:40] / np.linalg.norm(SOME[20:40], axis=1)[:, None],
        SOME,
    ]
)


def test_matrices_and_euler_parameters_are_those_of_scipy() -> None:
    other = Rotation.from_rotvec(VECTORS)
    np.testing.assert_allclose(matrices(VECTORS), other.as_matrix(), atol=2e-15)
    found = euler_parameters(other.as_matrix())
    assert (found[:, 0] >= 0.0).all()
    np.testing.assert_allclose((found * found).sum(axis=1), 1.0, atol=1e-15)
    # q and -q are the same rotation, and half a turn has both
    same = np.einsum("ni,ni->n", found, np.roll(other.as_quat(), 1, axis=1))
    np.testing.assert_allclose(np.abs(same), 1.0, atol=2e-15)
    np.testing.assert_allclose(turns(found), other.as_matrix(), atol=5e-15)
    np.testing.assert_allclose(turns(3.0 * found), other.as_matrix(), atol=5e-15)
    for k in range(3):
        np.testing.assert_allclose(column(found, k), other.as_matrix()[..., k], atol=5e-15)


def test_shapes_are_kept() -> None:
    many = matrices(SOME.reshape(20, 20, 3))
    assert euler_parameters(many).shape == (20, 20, 4)
    np.testing.assert_array_equal(euler_parameters(many)[3, 4], euler_parameters(many[3, 4]))
    np.testing.assert_allclose(turns(euler_parameters(many)), many, atol=5e-15)
    assert euler_parameters(np.zeros((0, 3, 3))).shape == (0, 4)
    assert turns(np.zeros((0, 4))).shape == (0, 3, 3)


def test_vectors_undo_matrices() -> None:
    small = 0.9 * SOME[np.linalg.norm(SOME, axis=1) < 3.0]
    np.testing.assert_allclose(vectors(matrices(small)), small, atol=1e-12)
