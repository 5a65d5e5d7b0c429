"""A symmetric band of 6 x 6 blocks: Cholesky factors and solves, on one thread and without allocation.

Block column j holds rows j ... j + reach as an array (6 columns, 6 (reach + 1) + PAD rows). Rows are
contiguous in memory, so that the inner loops run over them, eight at a time in a factor. PAD rows of zeros
let these loops run in whole vectors: the scalar remainder of a short loop costs as much as its vector part.
Only the lower half of the diagonal blocks counts. A factor stores the inverses of its diagonal blocks in
their place. That makes a solve faster: its six numbers of a block are independent products, and not a chain
of substitutions.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.lattice.kernels.linear.eight import EIGHT, take_off, times_triangle
from mdlgen.program.kernel import BORROWS, njit

PAD = 16
_VECTOR = 8


def empty(nodes: int, reach: int) -> np.ndarray:
    """A band of zeros, (nodes, 6, 6 (reach + 1) + PAD)."""
    return np.zeros((nodes, 6, 6 * (reach + 1) + PAD))


@njit(cache=True, error_model="numpy", boundscheck=False, forceinline=True)
def _diagonal(col):
    """The inverse of the Cholesky factor of a column's diagonal block, a lower triangle, in its place.
    Returns False where a pivot is not positive."""
    for c in range(6):
        pivot = col[c, c]
        for l in range(c):
            pivot -= col[l, c] * col[l, c]
        if not pivot > 0.0:
            return False
        inverse = 1.0 / math.sqrt(pivot)
        col[c, c] = inverse
        for r in range(c + 1, 6):
            v = col[c, r]
            for l in range(c):
                v -= col[l, r] * col[l, c]
            col[c, r] = v * inverse
    for c in range(6):
        for r in range(c + 1, 6):
            v = 0.0
            for l in range(c, r):
                v -= col[l, r] * col[c, l]
            col[c, r] = v * col[r, r]
    return True


@njit(cache=True, error_model="numpy", boundscheck=False, **BORROWS)
def factor(a):
    """Cholesky factor in place. Returns False where a pivot is not positive."""
    nodes, blocks = a.shape[0], (a.shape[2] - PAD) // 6
    for j in range(nodes):
        col = a[j]
        if not _diagonal(col):
            return False
        for at in range(6, 6 * blocks, EIGHT):
            times_triangle(col, at)
        # subtract their products from the columns behind
        for block in range(1, min(blocks, nodes - j)):
            target = a[j + block]
            for to in range(0, 6 * (blocks - block), EIGHT):
                take_off(col, 6 * block + to, 6 * block, target, to)
    return True


@njit(cache=True, error_model="numpy", boundscheck=False, forceinline=True)
def _forward(col, x, base):
    """Multiplies six numbers of x, in place, by the inverse of a diagonal block."""
    x0, x1, x2, x3, x4, x5 = x[base], x[base + 1], x[base + 2], x[base + 3], x[base + 4], x[base + 5]
    c0, c1, c2, c3, c4, c5 = col[0], col[1], col[2], col[3], col[4], col[5]
    y5 = (c0[5] * x0 + c1[5] * x1) + (c2[5] * x2 + c3[5] * x3) + (c4[5] * x4 + c5[5] * x5)
    y4 = (c0[4] * x0 + c1[4] * x1) + (c2[4] * x2 + c3[4] * x3) + c4[4] * x4
    y3 = (c0[3] * x0 + c1[3] * x1) + (c2[3] * x2 + c3[3] * x3)
    y2 = (c0[2] * x0 + c1[2] * x1) + c2[2] * x2
    y0, y1 = c0[0] * x0, c0[1] * x0 + c1[1] * x1
    x[base], x[base + 1], x[base + 2], x[base + 3], x[base + 4], x[base + 5] = y0, y1, y2, y3, y4, y5
    return y0, y1, y2, y3, y4, y5


@njit(
    cache=True,
    error_model="numpy",
    fastmath={"contract", "reassoc"},
    boundscheck=False,
    forceinline=True,
    **BORROWS,
)
def _down(col, x, base, length):
    """Forward step of one block column."""
    x0, x1, x2, x3, x4, x5 = _forward(col, x, base)
    end = 6 + length
    c0, c1, c2 = col[0, 6:end], col[1, 6:end], col[2, 6:end]
    c3, c4, c5 = col[3, 6:end], col[4, 6:end], col[5, 6:end]
    out = x[base + 6 : base + end]
    for r in range(length):
        out[r] -= x0 * c0[r] + x1 * c1[r] + x2 * c2[r] + x3 * c3[r] + x4 * c4[r] + x5 * c5[r]


@njit(
    cache=True,
    error_model="numpy",
    fastmath={"contract", "reassoc"},
    boundscheck=False,
    forceinline=True,
    **BORROWS,
)
def _down_two(col, x, y, base, length):
    """The same for two right-hand sides."""
    x0, x1, x2, x3, x4, x5 = _forward(col, x, base)
    y0, y1, y2, y3, y4, y5 = _forward(col, y, base)
    end = 6 + length
    c0, c1, c2 = col[0, 6:end], col[1, 6:end], col[2, 6:end]
    c3, c4, c5 = col[3, 6:end], col[4, 6:end], col[5, 6:end]
    one, two = x[base + 6 : base + end], y[base + 6 : base + end]
    for r in range(length):
        v0, v1, v2, v3, v4, v5 = c0[r], c1[r], c2[r], c3[r], c4[r], c5[r]
        one[r] -= x0 * v0 + x1 * v1 + x2 * v2 + x3 * v3 + x4 * v4 + x5 * v5
        two[r] -= y0 * v0 + y1 * v1 + y2 * v2 + y3 * v3 + y4 * v4 + y5 * v5


@njit(
    cache=True,
    error_model="numpy",
    fastmath={"contract", "reassoc"},
    boundscheck=False,
    forceinline=True,
    **BORROWS,
)
def _up(col, x, base, length):
    """Backward step of one block column."""
    end = 6 + length
    c0, c1, c2 = col[0, 6:end], col[1, 6:end], col[2, 6:end]
    c3, c4, c5 = col[3, 6:end], col[4, 6:end], col[5, 6:end]
    behind = x[base + 6 : base + end]
    # zeros of the precision of x: otherwise sums of single precision would be computed in double
    s0 = s1 = s2 = s3 = s4 = s5 = x[base] - x[base]
    for r in range(length):
        v = behind[r]
        s0 += c0[r] * v
        s1 += c1[r] * v
        s2 += c2[r] * v
        s3 += c3[r] * v
        s4 += c4[r] * v
        s5 += c5[r] * v
    x0, x1, x2 = x[base] - s0, x[base + 1] - s1, x[base + 2] - s2
    x3, x4, x5 = x[base + 3] - s3, x[base + 4] - s4, x[base + 5] - s5
    # times the transposed inverse of the diagonal block
    d0, d1, d2, d3, d4, d5 = col[0], col[1], col[2], col[3], col[4], col[5]
    x[base] = (d0[0] * x0 + d0[1] * x1) + (d0[2] * x2 + d0[3] * x3) + (d0[4] * x4 + d0[5] * x5)
    x[base + 1] = (d1[1] * x1 + d1[2] * x2) + (d1[3] * x3 + d1[4] * x4) + d1[5] * x5
    x[base + 2] = (d2[2] * x2 + d2[3] * x3) + (d2[4] * x4 + d2[5] * x5)
    x[base + 3] = (d3[3] * x3 + d3[4] * x4) + d3[5] * x5
    x[base + 4] = d4[4] * x4 + d4[5] * x5
    x[base + 5] = d5[5] * x5


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def _lengths(a):
    """Rows of a column behind its own block, in whole vectors; the first node where fewer are left."""
    nodes, blocks = a.shape[0], (a.shape[2] - PAD) // 6
    length = 2 * _VECTOR * ((6 * blocks - 6 + 2 * _VECTOR - 1) // (2 * _VECTOR))
    return length, nodes - (length + 11) // 6


@njit(cache=True, error_model="numpy", boundscheck=False, **BORROWS)
def solve(a, x, first=0):
    """Solves in place with a factor; x (6 nodes,), which is zero before node `first`."""
    nodes = a.shape[0]
    length, short = _lengths(a)
    for j in range(first, nodes):
        _down(a[j], x, 6 * j, length if j < short else min(length, 6 * (nodes - j) - 6))
    for j in range(nodes - 1, -1, -1):
        _up(a[j], x, 6 * j, length if j < short else min(length, 6 * (nodes - j) - 6))


@njit(cache=True, error_model="numpy", boundscheck=False, **BORROWS)
def solve_single(a, x, short):
    """As solve, with a factor in single precision, computed in that precision: a conversion to double would
    take longer than the solve. `short`: scratch, as long as x."""
    for i in range(x.size):
        short[i] = x[i]
    solve(a, short)
    for i in range(x.size):
        x[i] = short[i]


@njit(cache=True, error_model="numpy", boundscheck=False, **BORROWS)
def solve_six(a, x, first=0):
    """Solves for six right-hand sides at once, x (6, 6 nodes). A column is read from memory once for all, and
    in the forward step into registers once for two."""
    nodes = a.shape[0]
    length, short = _lengths(a)
    for j in range(first, nodes):
        many = length if j < short else min(length, 6 * (nodes - j) - 6)
        for q in range(0, 6, 2):
            _down_two(a[j], x[q], x[q + 1], 6 * j, many)
    for j in range(nodes - 1, -1, -1):
        many = length if j < short else min(length, 6 * (nodes - j) - 6)
        for q in range(6):
            _up(a[j], x[q], 6 * j, many)
