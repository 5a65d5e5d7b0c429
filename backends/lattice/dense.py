"""A small dense matrix: LU factors and solves."""

from __future__ import annotations

from numba import njit


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False)
def lu(jac, swaps, many):
    """Factors in place, with row exchange, four columns at a time. Returns False where that fails."""
    for j in range(0, many, 4):
        end = min(j + 4, many)
        for k in range(j, end):
            best, at = abs(jac[k, k]), k
            for i in range(k + 1, many):
                if abs(jac[i, k]) > best:
                    best, at = abs(jac[i, k]), i
            if not (best > 0.0 and best < 1e300):
                return False
            swaps[k] = at
            if at != k:
                for c in range(many):
                    jac[k, c], jac[at, c] = jac[at, c], jac[k, c]
            inverse = 1.0 / jac[k, k]
            for i in range(k + 1, many):
                f = jac[i, k] * inverse
                jac[i, k] = f
                for c in range(k + 1, end):
                    jac[i, c] -= f * jac[k, c]
        if end == many:
            break
        # the rows of these four, then all below them
        r0, r1, r2, r3 = jac[j, end:many], jac[j + 1, end:many], jac[j + 2, end:many], jac[j + 3, end:many]
        for k in range(1, 4):
            row = jac[j + k, end:many]
            for l in range(k):
                f, other = jac[j + k, j + l], jac[j + l, end:many]
                for c in range(row.size):
                    row[c] -= f * other[c]
        for i in range(end, many):
            f0, f1, f2, f3 = jac[i, j], jac[i, j + 1], jac[i, j + 2], jac[i, j + 3]
            row = jac[i, end:many]
            for c in range(row.size):
                row[c] -= f0 * r0[c] + f1 * r1[c] + f2 * r2[c] + f3 * r3[c]
    return True


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def lu_solve(jac, swaps, b, many):
    """Solves in place with the factors."""
    for i in range(many):
        at = swaps[i]
        b[i], b[at] = b[at], b[i]
    for i in range(many):
        row, v = jac[i], b[i]
        for c in range(i):
            v -= row[c] * b[c]
        b[i] = v
    for i in range(many - 1, -1, -1):
        row, v = jac[i], b[i]
        for c in range(i + 1, many):
            v -= row[c] * b[c]
        b[i] = v / row[i]
