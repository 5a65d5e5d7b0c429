"""Bordered systems: the band of the nodes, bordered by the unknowns of rollers, with contacts in the
matrix."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.linear.band import solve
from mdlgen.backends.lattice.kernels.linear.dense import cholesky, cholesky_solve, copy
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def eliminate(a, b, d, y, corner):
    """Y = A^-1 B (rows of y) and the factored corner D - B Y. Returns False where that is singular."""
    many = d.shape[0]
    copy(corner, d)
    for j in range(many):
        first = 0
        while first < b.shape[1] and b[j, first] == 0.0:
            first += 1
        copy(y[j], b[j])
        if first < b.shape[1]:
            solve(a, y[j], first // 6)
            for i in range(j, many):
                v = 0.0
                for l in range(b.shape[1]):
                    v += b[i, l] * y[j, l]
                corner[i, j] -= v
    return cholesky(corner)


@njit(cache=True, error_model="numpy")
def solve_bordered(a, b, y, corner, res, resb):
    """Solves band and border in place."""
    solve(a, res)
    m = resb.size
    for j in range(m):
        v = resb[j]
        for l in range(res.size):
            v -= b[j, l] * res[l]
        resb[j] = v
    cholesky_solve(corner, resb)
    for j in range(m):
        v = resb[j]
        if v != 0.0:
            for l in range(res.size):
                res[l] -= y[j, l] * v
