"""The band and its border sheet by sheet: nothing in the band couples two sheets, so threads share them."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels import parallel
from mdlgen.backends.lattice.kernels.linear.band import factor, solve
from mdlgen.backends.lattice.kernels.linear.colouring import BEGIN, END
from mdlgen.backends.lattice.kernels.linear.dense import cholesky, cholesky_solve, copy
from mdlgen.backends.lattice.kernels.parallel import begin, finish, take
from mdlgen.program.kernel import BORROWS, njit

# Of Pool.given: whether masses and bushings are yet to be added.
INNER = 5


@njit(cache=True, error_model="numpy", **BORROWS)
def _add_inner(a, inner, offsets):
    """Adds masses and bushings (state.Matrix) to a band of which the diagonal blocks alone are known."""
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
def factor_part(pool, matrix, sheet):
    """Factors the band of a sheet."""
    span = matrix.couplings.colouring.spans[sheet]
    a = matrix.band[span[BEGIN] : span[END]]
    if pool.given[INNER] != 0.0:
        _add_inner(a, matrix.inner[span[BEGIN] : span[END]], matrix.offsets)
    pool.failed[sheet] = 0 if factor(a) else 1


@njit(cache=True, error_model="numpy", **BORROWS)
def factor_sheets(pool, matrix, inner):
    """Cholesky factor of the band in place, as band.factor; `inner`: of its diagonal blocks and the band of
    masses and bushings together."""
    many = pool.failed.size
    pool.given[INNER] = 1.0 if inner else 0.0
    begin(pool, parallel.FACTOR, many)
    sheet = take(pool)
    while sheet >= 0:
        factor_part(pool, matrix, sheet)
        sheet = take(pool)
    finish(pool, many)
    failed = 0
    for k in range(many):
        failed += pool.failed[k]
    return failed == 0


@njit(cache=True, error_model="numpy", **BORROWS)
def eliminate_part(pool, matrix, sheet):
    """Rows of Y = A^-1 B in the columns of a sheet, and what they take off the corner; which numbers of it
    the rollers reach; its factor in single precision."""
    span, shares = matrix.couplings.colouring.spans[sheet], pool.shares
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
            shares[sheet, i, j] = v


@njit(cache=True, error_model="numpy", **BORROWS)
def eliminate_sheets(pool, matrix):
    """As bordered.eliminate, from the factor of the band."""
    many, corner, d = pool.failed.size, matrix.schur, matrix.corner
    begin(pool, parallel.ELIMINATE, many)
    sheet = take(pool)
    while sheet >= 0:
        eliminate_part(pool, matrix, sheet)
        sheet = take(pool)
    finish(pool, many)
    for i in range(d.shape[0]):
        for j in range(d.shape[0]):
            v = 0.0
            if i >= j:
                for k in range(many):
                    v += pool.shares[k, i, j]
            corner[i, j] = d[i, j] - v
    return cholesky(corner)


@njit(cache=True, error_model="numpy", **BORROWS)
def solve_part(pool, matrix, sheet):
    """Solves with the band of a sheet, in the second vector of the couplings."""
    span, b, x = matrix.couplings.colouring.spans[sheet], matrix.border, matrix.couplings.room[1]
    start, end = 6 * span[BEGIN], 6 * span[END]
    solve(matrix.band[span[BEGIN] : span[END]], x[start:end])
    for j in range(b.shape[0]):
        v = 0.0
        for l in range(start, end):
            v += b[j, l] * x[l]
        pool.shares[sheet, j, 0] = v


@njit(cache=True, error_model="numpy", **BORROWS)
def solve_sheets(pool, matrix):
    """As bordered.solve_bordered, in the second vector of the couplings."""
    many, y = pool.failed.size, matrix.eliminated
    size = matrix.res.size
    res, resb = matrix.couplings.room[1, :size], matrix.couplings.room[1, size:]
    begin(pool, parallel.SOLVE, many)
    sheet = take(pool)
    while sheet >= 0:
        solve_part(pool, matrix, sheet)
        sheet = take(pool)
    finish(pool, many)
    for j in range(resb.size):
        for k in range(many):
            resb[j] -= pool.shares[k, j, 0]
    cholesky_solve(matrix.schur, resb)
    for j in range(resb.size):
        v = resb[j]
        if v != 0.0:
            for l in range(size):
                res[l] -= y[j, l] * v
