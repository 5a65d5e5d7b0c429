"""Tables of records that were read back: a row of numbers and words for each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mdlgen.verify.tables import Table

_NAN = float("nan")
Row = tuple[list[Any], tuple[str, ...]]  # numbers, words


def table_of(records: Mapping[str, Any], row: Callable[[str, Any], Row], width: int) -> Table:
    """A row for each record by its name, of `width` numbers; nan where it has others."""
    numbers = np.full((len(records), width), _NAN)
    words = []
    for k, (name, record) in enumerate(records.items()):
        values, said = row(name, record)
        if len(values) == width:
            numbers[k] = [v if isinstance(v, (float, int)) else _NAN for v in values]
        words.append(said)
    columns = tuple(str(k) for k in range(width))
    return Table(tuple(records), columns, numbers, np.zeros_like(numbers), tuple(words))


def flat(axes: Any) -> list[float]:
    """All components of vectors, one after the other."""
    return [v for axis in axes for v in axis]
