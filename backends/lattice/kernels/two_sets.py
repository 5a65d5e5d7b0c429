"""Sheets in two sets, so that those which touch each other are in different ones: every other one of a stack.

Then no two boxes of one set are coupled but through their own sheet. What the first set and the rollers do is
eliminated exactly, a solve with their bands each time, and the method of conjugate gradients looks for the
second set alone. It needs half the rounds that it needs for both at once, which are no dearer.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.band import solve
from mdlgen.backends.lattice.kernels.dense import cholesky, cholesky_solve
from mdlgen.program.kernel import njit


class Sets(NamedTuple):
    """Which sheet is in which set, and the rollers' corner beside the first."""

    spans: np.ndarray  # first node of a sheet and the first behind it, (sheets, 2)
    of: np.ndarray  # the set of each sheet, 0 or 1; -1: not known yet
    dealt: np.ndarray  # (1,) whether there are two such sets
    corner: np.ndarray  # Cholesky factor, (border, border)


def sets(label: np.ndarray, border: int) -> Sets:
    """`label` is the sheet of each node, in rising order."""
    sheets = np.unique(label)
    spans = np.stack([np.searchsorted(label, sheets), np.searchsorted(label, sheets, side="right")], axis=1)
    return Sets(
        spans.astype(np.int64),
        np.full(len(sheets), -1, np.int64),
        np.zeros(1, np.int64),
        np.zeros((border, border)),
    )


@njit(cache=True, error_model="numpy")
def _sheet(spans, node):
    for sheet in range(spans.shape[0]):
        if node < spans[sheet, 1]:
            return sheet
    return -1


@njit(cache=True, error_model="numpy")
def _deal(sets, ends, many):
    """Puts the sheets into sets. Returns False where that is impossible: three that all touch each other."""
    of = sets.of
    for sheet in range(of.size):
        of[sheet] = -1
    for first in range(of.size):
        if of[first] >= 0:
            continue
        of[first] = 0
        grew = True
        while grew:
            grew = False
            for k in range(many):
                one, two = _sheet(sets.spans, ends[k, 0]), _sheet(sets.spans, ends[k, 1])
                if of[one] < 0 and of[two] >= 0:
                    one, two = two, one
                if of[one] >= 0 and of[two] < 0:
                    of[two] = 1 - of[one]
                    grew = True
                elif of[one] >= 0 and of[one] == of[two]:
                    return False
    return True


@njit(cache=True, error_model="numpy")
def deal(sets, ends, many, b, d, y):
    """Deals the sheets out for the couplings ends[:many], and factors the corner of the first set, where the
    band of all is factored: y = A^-1 B."""
    sets.dealt[0] = 0
    if many == 0 or not _deal(sets, ends, many):
        return
    corner = sets.corner
    for i in range(d.shape[0]):
        for j in range(i + 1):
            v = d[i, j]
            for sheet in range(sets.of.size):
                if sets.of[sheet] == 0:
                    for l in range(6 * sets.spans[sheet, 0], 6 * sets.spans[sheet, 1]):
                        v -= b[i, l] * y[j, l]
            corner[i, j] = v
    if cholesky(corner):
        sets.dealt[0] = 1


@njit(cache=True, error_model="numpy")
def _solve_first(a, b, y, sets, x, rollers):
    """Solves the first set and the rollers in place."""
    for sheet in range(sets.of.size):
        if sets.of[sheet] == 0:
            begin, end = sets.spans[sheet, 0], sets.spans[sheet, 1]
            solve(a[begin:end], x[6 * begin : 6 * end])
            for j in range(rollers.size):
                v = 0.0
                for l in range(6 * begin, 6 * end):
                    v += b[j, l] * x[l]
                rollers[j] -= v
    if rollers.size == 0:
        return
    cholesky_solve(sets.corner, rollers)
    for sheet in range(sets.of.size):
        if sets.of[sheet] == 0:
            for j in range(rollers.size):
                v = rollers[j]
                for l in range(6 * sets.spans[sheet, 0], 6 * sets.spans[sheet, 1]):
                    x[l] -= y[j, l] * v


@njit(cache=True, error_model="numpy")
def _solve_second(a, sets, x):
    for sheet in range(sets.of.size):
        if sets.of[sheet] == 1:
            begin, end = sets.spans[sheet, 0], sets.spans[sheet, 1]
            solve(a[begin:end], x[6 * begin : 6 * end])


@njit(cache=True, error_model="numpy")
def _across(b, sets, ends, blocks, many, source, p, rollers, q, rollers_q):
    """Adds to q what the set `source`, and the rollers if it is the first, do to the other one."""
    for k in range(many):
        one, two = 6 * ends[k, 0], 6 * ends[k, 1]
        block = blocks[k]
        if sets.of[_sheet(sets.spans, ends[k, 0])] == source:
            for c in range(6):
                v = 0.0
                for i in range(6):
                    v += block[c, i] * p[one + i]
                q[two + c] += v
        else:
            for c in range(6):
                far = p[two + c]
                for i in range(6):
                    q[one + i] += block[c, i] * far
    for sheet in range(sets.of.size):
        if sets.of[sheet] != 1:
            continue
        for j in range(rollers.size):
            v, far = 0.0, rollers[j]
            for l in range(6 * sets.spans[sheet, 0], 6 * sets.spans[sheet, 1]):
                if source == 1:
                    v += b[j, l] * p[l]
                else:
                    q[l] += b[j, l] * far
            rollers_q[j] += v


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def _dot(sets, p, q):
    """Of the second set."""
    total = 0.0
    for sheet in range(sets.of.size):
        if sets.of[sheet] == 1:
            for l in range(6 * sets.spans[sheet, 0], 6 * sets.spans[sheet, 1]):
                total += p[l] * q[l]
    return total


@njit(cache=True, error_model="numpy")
def solve_sets(a, b, y, sets, ends, blocks, many, room, res, resb, rounds, least):
    """Solves band, border and couplings in place, where the sheets are dealt out.

    `room` (5, unknowns). The method ends after so many rounds, or where the square of the residual, measured
    with the preconditioner, is `least` of what it was.
    """
    size = res.size
    r, z, p, own, w = room[0, :size], room[1, :size], room[2, :size], room[3, :size], room[4, :size]
    wb = room[4, size:]
    none = room[3, size:]
    for l in range(size):
        r[l], w[l] = res[l], 0.0
    # the first set as if the second stood still, and what that does to the second
    _solve_first(a, b, y, sets, res, resb)
    none[:] = 0.0
    _across(b, sets, ends, blocks, many, 0, res, resb, w, none)
    for sheet in range(sets.of.size):
        for l in range(6 * sets.spans[sheet, 0], 6 * sets.spans[sheet, 1]):
            second = sets.of[sheet] == 1
            r[l] = r[l] - w[l] if second else 0.0
            z[l] = p[l] = own[l] = r[l]
            if second:
                res[l] = 0.0
    _solve_second(a, sets, z)
    for l in range(size):
        p[l] = z[l]
    left = _dot(sets, r, z)
    first = left
    for _ in range(rounds):
        if not left > least * first:
            break
        # what the first set does where the second moves by p, and what that does to the second
        for l in range(size):
            w[l] = 0.0
        wb[:] = 0.0
        _across(b, sets, ends, blocks, many, 1, p, wb, w, wb)
        _solve_first(a, b, y, sets, w, wb)
        q = z
        for l in range(size):
            q[l] = 0.0
        _across(b, sets, ends, blocks, many, 0, w, wb, q, none)
        for l in range(size):
            q[l] = own[l] - q[l]
        along = _dot(sets, p, q)
        if not along > 0.0:
            break
        part = left / along
        for sheet in range(sets.of.size):
            if sets.of[sheet] == 1:
                for l in range(6 * sets.spans[sheet, 0], 6 * sets.spans[sheet, 1]):
                    r[l] -= part * q[l]
                    res[l] += part * p[l]
                    z[l] = r[l]
            else:
                for l in range(6 * sets.spans[sheet, 0], 6 * sets.spans[sheet, 1]):
                    res[l] -= part * w[l]
        for j in range(resb.size):
            resb[j] -= part * wb[j]
        _solve_second(a, sets, z)
        after = _dot(sets, r, z)
        turn, left = after / left, after
        for sheet in range(sets.of.size):
            if sets.of[sheet] == 1:
                for l in range(6 * sets.spans[sheet, 0], 6 * sets.spans[sheet, 1]):
                    p[l] = z[l] + turn * p[l]
                    own[l] = r[l] + turn * own[l]
