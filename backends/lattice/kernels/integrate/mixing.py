"""Anderson's mixing of Newton's changes where contacts stand in the matrix of a step.

There the tangent is not the whole derivative (see integrate.tangent): friction has the limit that its normal
force had an iteration ago, and a factor is used again. So changes fall by some part in each iteration, and in
a nip that friction wedges they do not fall at all: what friction does to the normal force comes back, in a
few motions at a time. Mixing takes the sum of the last iterations that leaves the least of all their changes
(Walker, Ni, SIAM J. Numer. Anal. 49, 1715). With the last two alone such a nip goes back and forth in
another direction.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.linear.dense import cholesky, cholesky_solve
from mdlgen.backends.lattice.kernels.tuning import ALIKE, LEAST_MIXED, MIXED, MOST_MIXED, TURNING_COUNTS
from mdlgen.program.kernel import BORROWS, njit

# Rows of Matrix.mixing: the change and the velocities of the iteration before, and how changes and velocities
# differed from one to the next.
FOUND, BEFORE, DIFFERENCES = 0, 1, 2
ROWS = DIFFERENCES + 2 * MIXED


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, **BORROWS)
def _dot(a, b, turning):
    """Of changes of `turning` numbers of nodes, and of a border."""
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
    """Keeps a number as it is now, and how it differs from that before."""
    difference[i] = now - kept[i]
    kept[i] = now


@njit(cache=True, error_model="numpy", **BORROWS)
def _note(matrix, state, last):
    """Keeps the change and the velocities, and how they differ from those of the iteration before."""
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
    """Mixes a change, that is to be taken off the velocities, with those of the last `depth` of `many`
    iterations before it, whose convex problems were alike."""
    res, resb, mixing = matrix.res, matrix.resb, matrix.mixing
    gram, (parts, scales) = matrix.gram, matrix.parts
    size, kept = res.size, min(many, depth)
    # before the first there is nothing: the row is filled again before it is used
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
