"""The product of a symmetric matrix of few 6 x 6 blocks and a vector."""

from __future__ import annotations

from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False, **BORROWS)
def times(a, offsets, x, y):
    """y = A x, of a symmetric matrix by the block columns of its lower half, with whole diagonal blocks.
    `offsets`: distances in nodes at which blocks are not zero, from 0 on; each column of `a` has these blocks
    alone, (nodes, 6 columns, 6 offsets rows)."""
    nodes = a.shape[0]
    y[:] = 0.0
    for j in range(nodes):
        base, col = 6 * j, a[j]
        x0, x1, x2, x3, x4, x5 = x[base], x[base + 1], x[base + 2], x[base + 3], x[base + 4], x[base + 5]
        for i in range(6):
            y[base + i] += col[0, i] * x0 + col[1, i] * x1 + col[2, i] * x2
            y[base + i] += col[3, i] * x3 + col[4, i] * x4 + col[5, i] * x5
        s0 = s1 = s2 = s3 = s4 = s5 = 0.0
        for k in range(1, offsets.size):
            if j + offsets[k] >= nodes:
                break
            low, high, at = 6 * k, 6 * k + 6, base + 6 * offsets[k]
            c0, c1, c2 = col[0, low:high], col[1, low:high], col[2, low:high]
            c3, c4, c5 = col[3, low:high], col[4, low:high], col[5, low:high]
            out, far = y[at : at + 6], x[at : at + 6]
            for r in range(6):
                v = far[r]
                s0 += c0[r] * v
                s1 += c1[r] * v
                s2 += c2[r] * v
                s3 += c3[r] * v
                s4 += c4[r] * v
                s5 += c5[r] * v
                out[r] += x0 * c0[r] + x1 * c1[r] + x2 * c2[r] + x3 * c3[r] + x4 * c4[r] + x5 * c5[r]
        y[base] += s0
        y[base + 1] += s1
        y[base + 2] += s2
        y[base + 3] += s3
        y[base + 4] += s4
        y[base + 5] += s5
