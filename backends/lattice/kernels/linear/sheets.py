"""The band and its border sheet by sheet: nothing in the band couples two sheets."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.linear.band import factor, solve
from mdlgen.backends.lattice.kernels.linear.colouring import BEGIN, END
from mdlgen.backends.lattice.kernels.linear.dense import cholesky, cholesky_solve, copy
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _add_inner(a, inner, offsets):
    """Adds masses and bushings (state.Matrix) to a band in which only the diagonal blocks are set."""
    for n in range(a.shape[0]):
        for c in range(6):
            col, own = a[n, c], inner[n, c]
            for r in range(6):
                col[r] += own[r]
            for r in range(6, col.size):
                col[r] = 0.0
            for k in range(1, offsets.size):
                at = 6 * offsets[k]
                for r in range(6):
                    col[at + r] = own[6 * k + r]


@njit(cache=True, error_model="numpy", **BORROWS)
def factor_sheets(matrix, inner):
    """Cholesky factor of the band in place, as band.factor; `inner`: of its diagonal blocks and the band of
    masses and bushings together. Returns False where a sheet's is not positive."""
    spans, positive = matrix.couplings.colouring.spans, True
    for sheet in range(spans.shape[0]):
        low, high = spans[sheet]
        a = matrix.band[low:high]
        if inner:
            _add_inner(a, matrix.inner[low:high], matrix.offsets)
        positive = factor(a) and positive
    return positive


@njit(cache=True, error_model="numpy", **BORROWS)
def _eliminate(matrix, sheet):
    """Computes the rows of Y = A^-1 B in the columns of a sheet, and adds B Y to the lower half of `schur`.
    Also sets the numbers of the sheet that the rollers reach, and its factor in single precision."""
    span, taken = matrix.couplings.colouring.spans[sheet], matrix.schur
    reached = matrix.couplings.colouring.reached
    b, y = matrix.border, matrix.eliminated
    start, end = 6 * span[BEGIN], 6 * span[END]
    copy(matrix.single_factor[span[BEGIN] : span[END]], matrix.band[span[BEGIN] : span[END]])
    for j in range(b.shape[0]):
        first, last = start, end
        while first < end and b[j, first] == 0.0:
            first += 1
        while last > first and b[j, last - 1] == 0.0:
            last -= 1
        reached[sheet, j, BEGIN], reached[sheet, j, END] = first, last
    for j in range(b.shape[0]):
        first, last = reached[sheet, j]
        for l in range(start, end):
            y[j, l] = b[j, l]
        if first < last:
            solve(matrix.band[span[BEGIN] : span[END]], y[j, start:end], (first - start) // 6)
        for i in range(j, b.shape[0]):
            v = 0.0
            if first < last:
                for l in range(reached[sheet, i, BEGIN], reached[sheet, i, END]):
                    v += b[i, l] * y[j, l]
            taken[i, j] += v


@njit(cache=True, error_model="numpy", **BORROWS)
def eliminate_sheets(matrix):
    """As bordered.eliminate, from the factor of the band."""
    corner, d = matrix.schur, matrix.corner
    corner[:] = 0.0
    for sheet in range(matrix.couplings.colouring.spans.shape[0]):
        _eliminate(matrix, sheet)
    for i in range(d.shape[0]):
        for j in range(d.shape[0]):
            corner[i, j] = d[i, j] - corner[i, j]
    return cholesky(corner)


@njit(cache=True, error_model="numpy", **BORROWS)
def solve_sheets(matrix):
    """As bordered.solve_bordered, in the second vector of the couplings."""
    spans, b, y, size = matrix.couplings.colouring.spans, matrix.border, matrix.eliminated, matrix.res.size
    res, resb = matrix.couplings.room[1, :size], matrix.couplings.room[1, size:]
    for sheet in range(spans.shape[0]):
        low, high = spans[sheet]
        solve(matrix.band[low:high], res[6 * low : 6 * high])
        for j in range(resb.size):
            v = 0.0
            for l in range(6 * low, 6 * high):
                v += b[j, l] * res[l]
            resb[j] -= v
    cholesky_solve(matrix.schur, resb)
    for j in range(resb.size):
        v = resb[j]
        if v != 0.0:
            for l in range(size):
                res[l] -= y[j, l] * v
