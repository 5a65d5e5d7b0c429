"""Arrays in blocks: parts of them, and all of them, are those of the whole array."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from mdlgen.results.stored import Block, Stored, finite


def both() -> tuple[Stored, np.ndarray]:
    """Two columns that are there at two times of six, one that is always, and one that never is."""
    rng = np.random.default_rng(1)
    whole = np.empty((6, 4, 3))
    blocks = []
    for columns, first, times in (([0, 2], 3, 2), ([1], 0, 6), ([3], 6, 0)):
        own = np.array(columns)
        rows, before, after = (rng.normal(size=(*n, len(own), 3)) for n in ((times,), (), ()))
        whole[:first, own], whole[first : first + times, own], whole[first + times :, own] = (
            before,
            rows,
            after,
        )
        blocks.append(Block(own, first, rows, before, after))
    return Stored(6, blocks), whole


@pytest.mark.parametrize(
    "key",
    [
        -1, slice(None), (slice(None), 2), (-1, 0), (4, slice(0, 3)), (slice(1, 5), [2, 0]), ([5, 0, 3], 2),
        ([1, 4], slice(2)), (slice(None), slice(None), 1), (3, 2, 1), (slice(None), 1, 0), ([0, 3], [0, 2]),
        np.array([True, False, True, False, True, True]),
        (np.array([[4], [1]]), np.array([0, 2, 1])), (..., 0), (slice(None, None, 2), slice(1, 4)), [],
    ],
)  # fmt: skip
def test_parts(key: object) -> None:
    stored, whole = both()
    assert np.array_equal(stored[key], whole[key])
    assert np.shape(stored[key]) == whole[key].shape


def test_the_whole() -> None:
    stored, whole = both()
    assert stored.shape == whole.shape and len(stored) == 6 and stored.dtype == whole.dtype
    assert np.array_equal(np.asarray(stored), whole)
    assert np.array_equal(stored - whole, 0.0 * whole) and np.array_equal(2.0 * stored, 2.0 * whole)
    assert stored.max() == whole.max() and np.array_equal(stored.mean(axis=0), whole.mean(axis=0))
    assert np.array_equal(np.linalg.norm(stored, axis=2), np.linalg.norm(whole, axis=2))
    assert np.array_equal(pickle.loads(pickle.dumps(stored)), whole)
    assert [row.sum() for row in stored] == [row.sum() for row in whole]
    assert stored.held == 8 * 3 * (2 * 2 + 6 + 2 * 4)
    assert finite(stored) and finite(whole)
    with pytest.raises(IndexError):
        _ = stored[6]
