"""Products with a block of 6 x 6 that couples two nodes; it stands column by column."""

from __future__ import annotations

from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy", forceinline=True)
def six(v, at):
    """Six numbers of a vector."""
    return v[at], v[at + 1], v[at + 2], v[at + 3], v[at + 4], v[at + 5]


@njit(cache=True, error_model="numpy", forceinline=True)
def column(block, c, x):
    """A column of a block times x."""
    col = block[c]
    return col[0] * x[0] + col[1] * x[1] + col[2] * x[2] + col[3] * x[3] + col[4] * x[4] + col[5] * x[5]


@njit(cache=True, error_model="numpy", forceinline=True)
def row(v, block, i, x):
    """v, and a row of a block times x."""
    v = v + block[0, i] * x[0] + block[1, i] * x[1] + block[2, i] * x[2]
    return v + block[3, i] * x[3] + block[4, i] * x[4] + block[5, i] * x[5]
