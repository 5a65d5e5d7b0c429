"""Contacts between boxes of two sheets in the matrix of a step.

Such boxes are far apart in the band, at places that change as the sheets slide. So the band holds the part of
a contact on each of its boxes alone, and the blocks that couple the two form a list. Their sum is positive
definite, and the band with its border dominates it. With these as preconditioner the method of conjugate
gradients needs a few iterations, each of which costs a solve with the band. In most scenes half of these are
enough (see two_colour).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.linear.bordered import solve_bordered
from mdlgen.backends.lattice.kernels.linear.colouring import ONE, TWO, Colouring, colouring
from mdlgen.backends.lattice.kernels.linear.dense import copy
from mdlgen.backends.lattice.kernels.linear.sheets import solve_sheets
from mdlgen.backends.lattice.kernels.linear.two_colour import solve_coloured
from mdlgen.backends.lattice.kernels.tuning import LINEAR_MOST
from mdlgen.mechanics.vector import mat, matmul, transpose_matmul
from mdlgen.program.kernel import BORROWS, njit


class Couplings(NamedTuple):
    """Pairs of nodes that a contact couples, and work arrays of the solver."""

    many: np.ndarray  # (1,) number of pairs.
    ends: np.ndarray  # nodes, (pairs, 2).
    blocks: np.ndarray  # rows of the first, columns of the second, column by column, (pairs, 6, 6).
    # Blocks in single precision, which is read in half the time: action of the second on the first, and its
    # transpose, the action of the first on the second, (pairs, 2, 6, 6).
    single: np.ndarray
    beside: np.ndarray  # part of each diagonal block that is not in the band, (nodes, 6, 6); see in_series.
    through: np.ndarray  # (nodes, 2) scratch: stiffness of the contacts at each face.
    room: np.ndarray  # vectors of all unknowns, (5, 6 nodes + border).
    short: np.ndarray  # scratch of single precision, (6 nodes,).
    colouring: Colouring  # colours of the sheets.


def couplings(pairs: int, label: np.ndarray, border: int) -> Couplings:
    """`label` is the sheet of each node."""
    nodes = len(label)
    return Couplings(
        np.zeros(1, np.int64),
        np.zeros((pairs, 2), np.int64),
        np.zeros((pairs, 6, 6)),
        np.zeros((pairs, 2, 6, 6), np.float32),
        np.zeros((nodes, 6, 6)),
        np.zeros((nodes, 2)),
        np.zeros((5, 6 * nodes + border)),
        np.zeros(6 * nodes, np.float32),
        colouring(label, border, pairs),
    )


@njit(cache=True, error_model="numpy", **BORROWS)
def couplings_in_box_axes(nodes, r, couplings):
    """Turns the blocks from global axes to those of their boxes."""
    for k in range(couplings.many[0]):
        one, two = mat(r, nodes[couplings.ends[k, ONE]]), mat(r, nodes[couplings.ends[k, TWO]])
        block, single = couplings.blocks[k], couplings.single[k]
        for p in range(0, 6, 3):
            for q in range(0, 6, 3):
                # rows of the first
                x = (block[q, p], block[q + 1, p], block[q + 2, p])
                y = (block[q, p + 1], block[q + 1, p + 1], block[q + 2, p + 1])
                z = (block[q, p + 2], block[q + 1, p + 2], block[q + 2, p + 2])
                turned = transpose_matmul(one, matmul((*x, *y, *z), two))
                for i in range(3):
                    for j in range(3):
                        block[q + j, p + i] = turned[3 * i + j]
                        single[ONE, q + j, p + i] = single[TWO, p + i, q + j] = turned[3 * i + j]


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def _dot(a, b):
    total = 0.0
    for i in range(a.size):
        total += a[i] * b[i]
    return total


@njit(cache=True, error_model="numpy")
def _couple(couplings, p, q):
    """Adds the product of the blocks and p to q."""
    for k in range(couplings.many[0]):
        a, b = 6 * couplings.ends[k, ONE], 6 * couplings.ends[k, TWO]
        block = couplings.blocks[k]
        for c in range(6):
            v, far = 0.0, p[b + c]
            for i in range(6):
                q[a + i] += block[c, i] * far
                v += block[c, i] * p[a + i]
            q[b + c] += v


@njit(cache=True, error_model="numpy")
def solve_coupled(matrix, least):
    """Solves band, border and couplings in place, as bordered.solve_bordered does without the last; `least`:
    see LINEAR_LEFT."""
    couplings, res, resb = matrix.couplings, matrix.res, matrix.resb
    if couplings.many[0] == 0:
        solve_bordered(matrix.band, matrix.border, matrix.eliminated, matrix.schur, res, resb)
        return
    if couplings.colouring.found[0] == 1:
        solve_coloured(matrix, LINEAR_MOST, least)
        return
    many = res.size
    r, z, p, own, q = couplings.room
    copy(r[:many], res)
    copy(r[many:], resb)
    copy(z, r)
    solve_sheets(matrix)
    copy(p, z)
    copy(own, r)  # product of band and border with p
    res[:] = 0.0
    resb[:] = 0.0
    left = _dot(r, z)
    first = left
    for _ in range(LINEAR_MOST):
        if not left > least * first:
            break
        copy(q, own)
        _couple(couplings, p, q)
        along = _dot(p, q)
        if not along > 0.0:
            break
        part = left / along
        for i in range(r.size):
            r[i] -= part * q[i]
        for i in range(many):
            res[i] += part * p[i]
        for i in range(resb.size):
            resb[i] += part * p[many + i]
        copy(z, r)
        solve_sheets(matrix)
        after = _dot(r, z)
        turn, left = after / left, after
        for i in range(r.size):
            p[i] = z[i] + turn * p[i]
            own[i] = r[i] + turn * own[i]
