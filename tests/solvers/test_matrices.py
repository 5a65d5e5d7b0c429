"""Matrices of the lattice: factored and solved, whole and by columns of their inverse."""

from __future__ import annotations

import numpy as np
import pytest

from mdlgen.backends.lattice.kernels.linear import band, dense

pytestmark = pytest.mark.usefixtures("as_python")


@pytest.mark.parametrize(("nodes", "reach"), [(1, 0), (5, 1), (30, 4), (40, 11)])
def test_the_band_is_factored_and_solved(nodes: int, reach: int) -> None:
    rng = np.random.default_rng(nodes)
    size, height = 6 * nodes, 6 * (reach + 1)
    full = rng.normal(size=(size, size))
    rows, columns = np.indices(full.shape)
    full[np.abs(rows // 6 - columns // 6) > reach] = 0.0
    full = full @ full.T  # twice as wide
    full[np.abs(rows // 6 - columns // 6) > reach] = 0.0
    full += np.eye(size) * (np.abs(full).sum(axis=1).max() + 1)
    packed = band.empty(nodes, reach)
    for node in range(nodes):
        for c in range(6):
            count = min(height, size - 6 * node)
            packed[node, c, :count] = full[6 * node : 6 * node + count, 6 * node + c]
    wanted = rng.normal(size=size)
    found = wanted.copy()
    assert band.factor(packed)
    band.solve(packed, found)
    assert np.abs(full @ found - wanted).max() < 1e-12 * np.abs(wanted).max() * nodes
    single, short = wanted.copy(), np.zeros(size, np.float32)
    band.solve_single(packed.astype(np.float32), single, short)
    assert np.abs(single - found).max() < 1e-5 * np.abs(found).max()
    packed[0, 0, 0] = -1.0
    assert not band.factor(packed)


@pytest.mark.parametrize("precision", [np.float64, np.float32])
def test_a_factor_in_vectors_is_that_in_python(precision: type) -> None:
    """And what is behind the last row that counts stays zero."""
    rng = np.random.default_rng(1)
    nodes, reach = 30, 11
    plain = band.empty(nodes, reach).astype(precision)
    for j in range(nodes):
        rows = 6 * min(reach + 1, nodes - j)
        plain[j, :, :rows] = rng.normal(size=(6, rows))
        plain[j, range(6), range(6)] += 12.0 * (reach + 1)
    vectors = plain.copy()
    assert band.factor(plain) and band.factor.dispatcher(vectors)
    counts = np.tril(np.ones((6, 6), bool)).T
    near = 20.0 * float(np.finfo(precision).eps)
    assert np.allclose(vectors[:, :, :6][:, counts], plain[:, :, :6][:, counts], rtol=0, atol=near)
    assert np.allclose(vectors[:, :, 6:], plain[:, :, 6:], rtol=0, atol=near)
    assert not vectors[:, :, 6 * (reach + 1) :].any() and not vectors[-1, :, 6:].any()


@pytest.mark.parametrize("nodes, reach", [(1, 0), (5, 1), (30, 7)])
def test_six_columns_of_the_inverse_are_those_of_six_solves(nodes: int, reach: int) -> None:
    rng = np.random.default_rng(nodes)
    a = band.empty(nodes, reach)
    for j in range(nodes):
        rows = 6 * min(reach + 1, nodes - j)
        a[j, :, :rows] = rng.normal(size=(6, rows))
        a[j, range(6), range(6)] += 12.0 * (reach + 1)
    assert band.factor(a)
    node = nodes // 2
    x = np.zeros((6, 6 * nodes))
    x[range(6), range(6 * node, 6 * node + 6)] = 1.0
    alone = x.copy()
    band.solve_six(a, x, node)
    for row in alone:
        band.solve(a, row)
    assert np.allclose(x, alone, rtol=0, atol=1e-15 * np.abs(alone).max() * nodes)  # sums in another order


@pytest.mark.parametrize("many", [1, 3, 4, 6, 7, 56, 57])
def test_a_small_matrix_is_factored_and_solved_transposed(many: int) -> None:
    rng = np.random.default_rng(many)
    matrix, right = rng.normal(size=(many, many)), rng.normal(size=many)
    room, swaps = np.full((many + 2, many + 2), np.nan), np.zeros(many, np.int64)
    room[:many, :many] = matrix
    assert dense.lu(room, swaps, many)
    found = right.copy()
    dense.lu_solve_transposed(room, swaps, found, many)
    # relative to what was to be solved; growth of a random matrix under row exchange is small
    assert np.abs(matrix.T @ found - right).max() < 1e-13 * many * max(1.0, np.abs(found).max())
    room[:many, :many] = matrix
    room[:many, 0] = 0.0
    assert not dense.lu(room, swaps, many)
