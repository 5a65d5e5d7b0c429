"""A small dense matrix: its factors and solves."""

from __future__ import annotations

import math

from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def copy(into, of):
    """Copies a whole array of up to three dimensions. It uses loops: slice assignment would compile an error
    path that formats strings, which a shipped program may not contain."""
    if into.ndim == 1:
        for i in range(into.shape[0]):
            into[i] = of[i]
    elif into.ndim == 2:
        for i in range(into.shape[0]):
            for j in range(into.shape[1]):
                into[i, j] = of[i, j]
    else:
        for i in range(into.shape[0]):
            for j in range(into.shape[1]):
                for k in range(into.shape[2]):
                    into[i, j, k] = of[i, j, k]


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False, **BORROWS)
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
        # the rows of these four, then all below them, two at a time: both use each number that is read
        r0, r1, r2, r3 = jac[j, end:many], jac[j + 1, end:many], jac[j + 2, end:many], jac[j + 3, end:many]
        l10, l20, l21 = jac[j + 1, j], jac[j + 2, j], jac[j + 2, j + 1]
        l30, l31, l32 = jac[j + 3, j], jac[j + 3, j + 1], jac[j + 3, j + 2]
        for c in range(many - end):
            v0 = r0[c]
            v1 = r1[c] - l10 * v0
            v2 = r2[c] - l20 * v0 - l21 * v1
            r1[c], r2[c] = v1, v2
            r3[c] -= l30 * v0 + l31 * v1 + l32 * v2
        for i in range(end, many - 1, 2):
            f0, f1, f2, f3 = jac[i, j], jac[i, j + 1], jac[i, j + 2], jac[i, j + 3]
            g0, g1, g2, g3 = jac[i + 1, j], jac[i + 1, j + 1], jac[i + 1, j + 2], jac[i + 1, j + 3]
            one, two = jac[i, end:many], jac[i + 1, end:many]
            for c in range(many - end):
                v0, v1, v2, v3 = r0[c], r1[c], r2[c], r3[c]
                one[c] -= f0 * v0 + f1 * v1 + f2 * v2 + f3 * v3
                two[c] -= g0 * v0 + g1 * v1 + g2 * v2 + g3 * v3
        if (many - end) % 2 == 1:
            last = jac[many - 1]
            f0, f1, f2, f3 = last[j], last[j + 1], last[j + 2], last[j + 3]
            one = last[end:many]
            for c in range(many - end):
                one[c] -= f0 * r0[c] + f1 * r1[c] + f2 * r2[c] + f3 * r3[c]
    return True


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False, **BORROWS)
def lu_solve_transposed(jac, swaps, b, many):
    """Solves with the transpose of what was factored, in place."""
    for i in range(many):
        v = b[i] / jac[i, i]
        b[i] = v
        row, behind = jac[i, i + 1 : many], b[i + 1 : many]
        for c in range(row.size):
            behind[c] -= v * row[c]
    for i in range(many - 1, 0, -1):
        v, row, before = b[i], jac[i, :i], b[:i]
        for c in range(row.size):
            before[c] -= v * row[c]
    for i in range(many - 1, -1, -1):
        at = swaps[i]
        b[i], b[at] = b[at], b[i]


@njit(cache=True, error_model="numpy")
def cholesky(a):
    """Factors a symmetric matrix in its lower half. Returns False where a pivot is not positive."""
    many = a.shape[0]
    for j in range(many):
        for k in range(j):
            for i in range(j, many):
                a[i, j] -= a[i, k] * a[j, k]
        if not a[j, j] > 0.0:
            return False
        pivot = math.sqrt(a[j, j])
        for i in range(j, many):
            a[i, j] /= pivot
    return True


@njit(cache=True, error_model="numpy")
def cholesky_solve(a, x):
    """Solves in place with such a factor."""
    many = a.shape[0]
    for j in range(many):
        for k in range(j):
            x[j] -= a[j, k] * x[k]
        x[j] /= a[j, j]
    for j in range(many - 1, -1, -1):
        for k in range(j + 1, many):
            x[j] -= a[k, j] * x[k]
        x[j] /= a[j, j]
