"""Anderson's mixing of Newton's changes, of depth one, where contacts stand in the matrix of a step.

There the tangent is not the whole derivative (see integrate.tangent), and its factor is used again. So
changes fall by some part in each iteration, or two boxes in a nip take turns. Mixing takes the change of the
last two iterations that leaves the least of both, which needs a third fewer factors.
"""

from __future__ import annotations

from mdlgen.program.kernel import BORROWS, njit

# What turning counts in the mixing of changes [mm^2], and how much of them is mixed.
TURNS, LEAST_MIXED, MOST_MIXED = 10.0, -5.0, 0.9


@njit(cache=True, error_model="numpy", **BORROWS)
def mix(matrix, again):
    """Anderson's mixing of depth one: of the changes of two iterations with one factor (`again`), the one
    that leaves the least. Kept for the next iteration."""
    res, resb, many = matrix.res, matrix.resb, matrix.res.size
    found, taken = matrix.mixing
    along = square = 0.0
    if again:
        for i in range(many):
            weight = 1.0 if i % 6 < 3 else TURNS
            less = res[i] - found[i]
            along += weight * res[i] * less
            square += weight * less * less
        for i in range(resb.size):
            less = resb[i] - found[many + i]
            along += resb[i] * less
            square += less * less
    part = min(max(along / square, LEAST_MIXED), MOST_MIXED) if square > 0.0 else 0.0
    for i in range(many):
        new = res[i]
        res[i] -= part * (taken[i] + new - found[i])
        found[i], taken[i] = new, res[i]
    for i in range(resb.size):
        new = resb[i]
        resb[i] -= part * (taken[many + i] + new - found[many + i])
        found[many + i], taken[many + i] = new, resb[i]
