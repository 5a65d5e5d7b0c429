"""An array in blocks, for values of bodies that are present for a part of a run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mdlgen.model.tables import Floats, Ints


class Block(NamedTuple):
    """Columns with one value for each of some consecutive times, and constant before and after them."""

    columns: Ints  # (n,)
    first: int  # index of the first of these times
    rows: Floats  # (times, n, width)
    before: Floats  # (n, width)
    after: Floats


class Stored(np.lib.mixins.NDArrayOperatorsMixin):
    """An array (t, bodies, width) that takes the memory of its blocks alone.

    Parts of it by stored times and bodies, `stored[at, bodies]`, are arrays. All else is that of the whole
    array, which is made for it each time: arithmetic, methods of arrays, functions of numpy.
    """

    def __init__(self, times: int, blocks: Sequence[Block]):
        """Each column in one of the blocks."""
        self._blocks = tuple(blocks)
        count = sum(len(block.columns) for block in blocks)
        self.shape = (times, count, *blocks[0].rows.shape[2:])
        self.ndim, self.dtype = len(self.shape), np.dtype(float)
        self._of, self._place = np.zeros(count, int), np.zeros(count, int)
        for number, block in enumerate(blocks):
            self._of[block.columns], self._place[block.columns] = number, np.arange(len(block.columns))

    def __len__(self) -> int:
        return self.shape[0]

    @property
    def held(self) -> int:
        """Bytes that it takes."""
        return sum(
            array.nbytes for block in self._blocks for array in (block.rows, block.before, block.after)
        )

    @property
    def finite(self) -> bool:
        """True if all its numbers are finite."""
        return all(np.isfinite(array).all() for block in self._blocks for array in block[2:])

    def __getitem__(self, key: Any) -> Any:
        keys = key if isinstance(key, tuple) else (key,)
        known = [isinstance(k, (int, np.integer, slice)) for k in keys]
        arrays = [isinstance(k, (list, np.ndarray)) for k in keys]
        if not all(a or b for a, b in zip(known, arrays, strict=True)):
            return np.asarray(self)[key]
        if arrays[:2] == [True, True] and not any(arrays[2:]):
            return self._paired(*keys)
        if sum(arrays) > 1:
            return np.asarray(self)[key]
        at = np.arange(self.shape[0])[keys[0]]
        of = np.arange(self.shape[1])[keys[1]] if len(keys) > 1 else np.arange(self.shape[1])
        if np.ndim(at) > 1 or np.ndim(of) > 1:
            return np.asarray(self)[key]
        found = self._taken(np.atleast_1d(at), np.atleast_1d(of))
        found = found.reshape(*np.shape(at), *np.shape(of), *self.shape[2:])
        kept = (slice(None),) * (np.ndim(at) + np.ndim(of))
        return found[(*kept, *keys[2:])] if len(keys) > 2 else found

    def _paired(self, one: Any, two: Any, *rest: Any) -> Floats:
        """At times and of columns that are arrays both, as numpy pairs them."""
        at, of = np.arange(self.shape[0])[np.asarray(one)], np.arange(self.shape[1])[np.asarray(two)]
        times, when = np.unique(at, return_inverse=True)
        columns, where = np.unique(of, return_inverse=True)
        return self._taken(times, columns)[(when.reshape(at.shape), where.reshape(of.shape), *rest)]

    def _taken(self, at: Ints, of: Ints) -> Floats:
        """At some stored times, of some columns."""
        found = np.empty((len(at), len(of), *self.shape[2:]))
        number = self._of[of]
        for k in np.unique(number).tolist():
            block, mine = self._blocks[k], np.flatnonzero(number == k)
            own, end = self._place[of[mine]], block.first + len(block.rows)
            early, late = at < block.first, at >= end
            here = ~early & ~late
            part = found if len(mine) == len(of) else np.empty((len(at), len(mine), *self.shape[2:]))
            part[early], part[late] = block.before[own], block.after[own]
            part[here] = block.rows[at[here] - block.first][:, own]
            if part is not found:
                found[:, mine] = part
        return found

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Floats:
        whole = self._taken(np.arange(self.shape[0]), np.arange(self.shape[1]))
        return whole if dtype is None else whole.astype(dtype, copy=False)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **named: Any) -> Any:
        return getattr(ufunc, method)(
            *(np.asarray(i) if isinstance(i, Stored) else i for i in inputs), **named
        )

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(np.asarray(self), name)


def finite(array: Any) -> bool:
    """True if all numbers of an array, or of a Stored, are finite."""
    return array.finite if isinstance(array, Stored) else bool(np.isfinite(array).all())
