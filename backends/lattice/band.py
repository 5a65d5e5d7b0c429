"""A symmetric band of 6 x 6 blocks: Cholesky factors and solves, on one thread and without allocation.

Block column j holds rows j ... j + reach as an array (6 columns, 6 (reach + 1) rows); rows stand together in
memory, so that the inner loops run over them. Only the lower half of the diagonal blocks counts.
"""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False)
def factor(a):
    """Cholesky factor in place, a (nodes, 6, 6 (reach + 1)). Returns False where a pivot is not positive."""
    nodes, height = a.shape[0], a.shape[2]
    for j in range(nodes):
        col = a[j]
        # the six columns themselves
        for c in range(6):
            for l in range(c):
                f = col[l, c]
                for r in range(c, height):
                    col[c, r] -= f * col[l, r]
            pivot = col[c, c]
            if not pivot > 0.0:
                return False
            pivot = 1.0 / math.sqrt(pivot)
            for r in range(c, height):
                col[c, r] *= pivot
        # what they take off the columns behind: six at once, so that each entry is read and written once
        last = min(height // 6, nodes - j)
        for block in range(1, last):
            begin = 6 * block
            length = height - begin
            target = a[j + block]
            for c in range(6):
                f0, f1, f2 = col[0, begin + c], col[1, begin + c], col[2, begin + c]
                f3, f4, f5 = col[3, begin + c], col[4, begin + c], col[5, begin + c]
                out = target[c]
                s0, s1, s2 = col[0, begin:], col[1, begin:], col[2, begin:]
                s3, s4, s5 = col[3, begin:], col[4, begin:], col[5, begin:]
                for r in range(length):
                    out[r] -= f0 * s0[r] + f1 * s1[r] + f2 * s2[r] + f3 * s3[r] + f4 * s4[r] + f5 * s5[r]
    return True


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False)
def solve(a, x, first=0):
    """Solves in place with a factor; x (6 nodes,), which is zero before node `first`."""
    nodes, height = a.shape[0], a.shape[2]
    for j in range(first, nodes):
        col, base = a[j], 6 * j
        end = min(height, 6 * (nodes - j))
        for c in range(6):
            v = x[base + c] / col[c, c]
            x[base + c] = v
            for r in range(c + 1, 6):
                x[base + r] -= v * col[c, r]
        x0, x1, x2 = x[base], x[base + 1], x[base + 2]
        x3, x4, x5 = x[base + 3], x[base + 4], x[base + 5]
        c0, c1, c2, c3, c4, c5 = col[0], col[1], col[2], col[3], col[4], col[5]
        for r in range(6, end):
            x[base + r] -= x0 * c0[r] + x1 * c1[r] + x2 * c2[r] + x3 * c3[r] + x4 * c4[r] + x5 * c5[r]
    for j in range(nodes - 1, -1, -1):
        col, base = a[j], 6 * j
        end = min(height, 6 * (nodes - j))
        c0, c1, c2, c3, c4, c5 = col[0], col[1], col[2], col[3], col[4], col[5]
        s0 = s1 = s2 = s3 = s4 = s5 = 0.0
        for r in range(6, end):
            v = x[base + r]
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
            x[base + c] = v / col[c, c]
