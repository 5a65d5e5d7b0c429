"""Anderson mixing of Newton's changes where contacts are in the matrix of a step.

There the tangent is not the whole derivative (see integrate.tangent): the limit of friction is that of the
normal force one iteration ago, and a factor is reused. So convergence is linear. In a nip that friction
wedges, iterations do not converge at all: the effect of friction on the normal force feeds back, in a few
modes at a time. Mixing takes the combination of the last iterations with the least change
(Walker, Ni, SIAM J. Numer. Anal. 49, 1715). With the last two alone, such a nip oscillates in another mode.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.linear.dense import cholesky, cholesky_solve
from mdlgen.backends.lattice.kernels.tuning import ALIKE, LEAST_MIXED, MIXED, MOST_MIXED, TURNING_COUNTS
from mdlgen.program.kernel import BORROWS, njit

# Rows of Matrix.mixing: the change and the velocities of the iteration before, then the differences of
# changes and of velocities between consecutive iterations.
FOUND, BEFORE, DIFFERENCES = 0, 1, 2
ROWS = DIFFERENCES + 2 * MIXED


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, **BORROWS)
def _dot(a, b, turning):
    """Weighted scalar product of two changes: `turning` numbers of nodes, then those of the border."""
    shifts = turns = 0.0
    for k in range(turning // 6):
        i = 6 * k
        shifts += a[i] * b[i] + a[i + 1] * b[i + 1] + a[i + 2] * b[i + 2]
        turns += a[i + 3] * b[i + 3] + a[i + 4] * b[i + 4] + a[i + 5] * b[i + 5]
    for i in range(turning, a.size):
        shifts += a[i] * b[i]
    return shifts + TURNING_COUNTS * turns


@njit(cache=True, error_model="numpy", forceinline=True)
def _renew(kept, difference, i, now):
    """Stores a number, and its difference from the one before."""
    difference[i] = now - kept[i]
    kept[i] = now


@njit(cache=True, error_model="numpy", **BORROWS)
def _note(matrix, state, last):
    """Stores the change and the velocities, and their differences from those of the iteration before."""
    res, resb, mixing, u, ub = matrix.res, matrix.resb, matrix.mixing, state.u, state.ub
    found, before, size = mixing[FOUND], mixing[BEFORE], res.size
    less, moved = mixing[DIFFERENCES + last], mixing[DIFFERENCES + MIXED + last]
    for i in range(size):
        _renew(found, less, i, res[i])
        _renew(before, moved, i, u[i // 6, i % 6])
    for i in range(resb.size):
        _renew(found, less, size + i, resb[i])
        _renew(before, moved, size + i, ub[i])


@njit(cache=True, error_model="numpy", **BORROWS)
def mix(matrix, state, many, depth):
    """Mixes a change, which is to be subtracted from the velocities, with those of the last `depth` of `many`
    iterations before it, whose convex problems were alike."""
    res, resb, mixing = matrix.res, matrix.resb, matrix.mixing
    gram, (parts, scales) = matrix.gram, matrix.parts
    size, kept = res.size, min(many, depth)
    # the first iteration has none before it: its row is filled again before it is used
    _note(matrix, state, (many - 1) % MIXED)
    if kept == 0:
        return
    gram[:] = 0.0
    for i in range(MIXED):
        gram[i, i] = 1.0
        parts[i] = 0.0
    for i in range(kept):
        own = mixing[DIFFERENCES + (many - 1 - i) % MIXED]
        square = _dot(own, own, size)
        scales[i] = 1.0 / math.sqrt(square) if square > 0.0 else 0.0
        parts[i] = scales[i] * _dot(own, mixing[FOUND], size)
        gram[i, i] += ALIKE
        for j in range(i):
            other = mixing[DIFFERENCES + (many - 1 - j) % MIXED]
            gram[i, j] = scales[i] * scales[j] * _dot(own, other, size)
    if not cholesky(gram):
        return
    cholesky_solve(gram, parts)
    for k in range(kept):
        row = DIFFERENCES + (many - 1 - k) % MIXED
        part, less, moved = scales[k] * parts[k], mixing[row], mixing[row + MIXED]
        if depth == 1:
            part = min(max(part, LEAST_MIXED), MOST_MIXED)
        for i in range(size):
            res[i] += part * (moved[i] - less[i])
        for i in range(resb.size):
            resb[i] += part * (moved[size + i] - less[size + i])
