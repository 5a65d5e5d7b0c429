"""A symmetric band of 6 x 6 blocks: Cholesky factors and solves, on one thread and without allocation.

Block column j holds rows j ... j + reach as an array (6 columns, 6 (reach + 1) + PAD rows); rows stand
together in memory, so that the inner loops run over them. PAD rows of zeros let these loops run in whole
vectors: what is left over at the end of a short loop costs as much as its middle. Only the lower half of the
diagonal blocks counts. A factor has the inverse of its pivots on the diagonal.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.program.kernel import BORROWS, njit

PAD = 16
_VECTOR = 8


def empty(nodes: int, reach: int) -> np.ndarray:
    """A band of zeros, (nodes, 6, 6 (reach + 1) + PAD)."""
    return np.zeros((nodes, 6, 6 * (reach + 1) + PAD))


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False, **BORROWS)
def factor(a):
    """Cholesky factor in place. Returns False where a pivot is not positive."""
    nodes, blocks = a.shape[0], (a.shape[2] - PAD) // 6
    height = _VECTOR * ((6 * blocks + _VECTOR - 1) // _VECTOR)
    for j in range(nodes):
        col = a[j]
        # the six columns themselves; what stands above their diagonal is worked on and never read
        for c in range(6):
            mine = col[c]
            for l in range(c):
                f, other = col[l, c], col[l]
                for r in range(height):
                    mine[r] -= f * other[r]
            pivot = mine[c]
            if not pivot > 0.0:
                return False
            pivot = 1.0 / math.sqrt(pivot)
            for r in range(height):
                mine[r] *= pivot
        # what they take off the columns behind, two at a time, so that each entry is read once for both
        for block in range(1, min(blocks, nodes - j)):
            begin = 6 * block
            target = a[j + block]
            length = _VECTOR * ((6 * (blocks - block) + _VECTOR - 1) // _VECTOR)
            end = begin + length
            s0, s1, s2 = col[0, begin:end], col[1, begin:end], col[2, begin:end]
            s3, s4, s5 = col[3, begin:end], col[4, begin:end], col[5, begin:end]
            for c in range(0, 6, 2):
                f0, f1, f2, f3, f4, f5 = s0[c], s1[c], s2[c], s3[c], s4[c], s5[c]
                g0, g1, g2 = s0[c + 1], s1[c + 1], s2[c + 1]
                g3, g4, g5 = s3[c + 1], s4[c + 1], s5[c + 1]
                one, two = target[c], target[c + 1]
                for r in range(length):
                    v0, v1, v2, v3, v4, v5 = s0[r], s1[r], s2[r], s3[r], s4[r], s5[r]
                    one[r] -= f0 * v0 + f1 * v1 + f2 * v2 + f3 * v3 + f4 * v4 + f5 * v5
                    two[r] -= g0 * v0 + g1 * v1 + g2 * v2 + g3 * v3 + g4 * v4 + g5 * v5
        for c in range(6):
            col[c, c] = 1.0 / col[c, c]
    return True


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
    for c in range(6):
        v = x[base + c] * col[c, c]
        x[base + c] = v
        for r in range(c + 1, 6):
            x[base + r] -= v * col[c, r]
    x0, x1, x2, x3, x4, x5 = x[base], x[base + 1], x[base + 2], x[base + 3], x[base + 4], x[base + 5]
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
    for c in range(6):
        v, w = x[base + c] * col[c, c], y[base + c] * col[c, c]
        x[base + c], y[base + c] = v, w
        for r in range(c + 1, 6):
            x[base + r] -= v * col[c, r]
            y[base + r] -= w * col[c, r]
    x0, x1, x2, x3, x4, x5 = x[base], x[base + 1], x[base + 2], x[base + 3], x[base + 4], x[base + 5]
    y0, y1, y2, y3, y4, y5 = y[base], y[base + 1], y[base + 2], y[base + 3], y[base + 4], y[base + 5]
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
    s0 = s1 = s2 = s3 = s4 = s5 = 0.0
    for r in range(length):
        v = behind[r]
        s0 += c0[r] * v
        s1 += c1[r] * v
        s2 += c2[r] * v
        s3 += c3[r] * v
        s4 += c4[r] * v
        s5 += c5[r] * v
    x[base] -= s0
    x[base + 1] -= s1
    x[base + 2] -= s2
    x[base + 3] -= s3
    x[base + 4] -= s4
    x[base + 5] -= s5
    for c in range(5, -1, -1):
        v = x[base + c]
        for r in range(c + 1, 6):
            v -= col[c, r] * x[base + r]
        x[base + c] = v * col[c, c]


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
def solve_six(a, x, first=0):
    """Solves for six right-hand sides at once, x (6, 6 nodes): a column is read from memory once for all, and
    on the way down into registers once for two."""
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
