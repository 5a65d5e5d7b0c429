"""Stability of a static balance: the number of unstable directions, and the load at which it is lost."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from mdlgen.backends.lattice.kernels.tuning import STANDING_HALVINGS
from mdlgen.model.tables import Floats


def falling(band: Floats, border: Floats, corner: Floats) -> int:
    """Number of directions in which a balance is unstable, from the signs of the pivots of the stiffness that
    the kernel `stands` returns; 1 where they are not known."""
    from scipy.sparse.linalg import splu

    try:
        factor = splu(
            whole(band, border, corner),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError:  # exactly singular
        return 1
    if not np.array_equal(factor.perm_r, factor.perm_c):
        return 1
    return max(1, int((factor.U.diagonal() < 0.0).sum()))


def whole(band: Floats, border: Floats, corner: Floats) -> Any:
    """The whole matrix of a band of blocks (see kernels.linear.band) and its border, a scipy csc_matrix."""
    from scipy.sparse import bmat, coo_matrix

    nodes = len(band)
    place = np.indices(band.shape)
    row, column = 6 * place[0] + place[2], 6 * place[0] + place[1]
    inside = (row >= column) & (row < 6 * nodes)
    lower = coo_matrix((band[inside], (row[inside], column[inside])), shape=(6 * nodes, 6 * nodes))
    square = lower + lower.T
    square.setdiag(lower.diagonal())
    return bmat([[square, border.T], [border, corner]] if len(corner) else [[square]], format="csc")


def reason(ways: int, begins: float) -> str:
    """Reason why a balance is no result: it is unstable in `ways` directions, above a part of the load."""
    which = "one direction" if ways == 1 else f"{ways} directions"
    return (
        f"the balance is unstable: it falls in {which}, above {100 * begins:.3g} % of the load; "
        "a small load aside leads to one that stands"
    )


def begins(stable: Callable[[float], bool]) -> float:
    """Part of the load above which no balance is stable; `stable(level)`: true if one is found and stable."""
    low, high = 0.0, 1.0
    for _ in range(STANDING_HALVINGS):
        level = 0.5 * (low + high)
        low, high = (level, high) if stable(level) else (low, level)
    return 0.5 * (low + high)
