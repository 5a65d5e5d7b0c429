"""Sheets in two colours, so that those which touch each other differ: every other one of a stack.

Then no two boxes of one colour are coupled but through their own sheet. What the first colour and the rollers
do is eliminated exactly, a solve with their bands each time, and the method of conjugate gradients looks for
the second colour alone. It needs half the iterations that it needs for both at once, which are no dearer.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.linear.band import solve
from mdlgen.backends.lattice.kernels.linear.dense import cholesky, cholesky_solve
from mdlgen.program.kernel import njit


class Colouring(NamedTuple):
    """Which sheet has which colour, and the rollers' corner beside the first."""

    spans: np.ndarray  # first node of a sheet and the first behind it, (sheets, 2)
    label: np.ndarray  # the sheet of each node, by its row in spans
    of: np.ndarray  # the colour of each sheet, 0 or 1; -1: not known yet
    found: np.ndarray  # (1,) whether two colours are enough
    corner: np.ndarray  # Cholesky factor, (border, border)


def colouring(label: np.ndarray, border: int) -> Colouring:
    """`label` is the sheet of each node, in rising order."""
    sheets = np.unique(label)
    spans = np.stack([np.searchsorted(label, sheets), np.searchsorted(label, sheets, side="right")], axis=1)
    return Colouring(
        spans.astype(np.int64),
        np.searchsorted(sheets, label).astype(np.int64),
        np.full(len(sheets), -1, np.int64),
        np.zeros(1, np.int64),
        np.zeros((border, border)),
    )


@njit(cache=True, error_model="numpy")
def _colour(couplings):
    """Gives the sheets colours. Returns False where two are too few: three that all touch each other."""
    label, of, ends = couplings.colouring.label, couplings.colouring.of, couplings.ends
    for sheet in range(of.size):
        of[sheet] = -1
    for first in range(of.size):
        if of[first] >= 0:
            continue
        of[first] = 0
        grew = True
        while grew:
            grew = False
            for k in range(couplings.many[0]):
                one, two = label[ends[k, 0]], label[ends[k, 1]]
                if of[one] < 0 and of[two] >= 0:
                    one, two = two, one
                if of[one] >= 0 and of[two] < 0:
                    of[two] = 1 - of[one]
                    grew = True
                elif of[one] >= 0 and of[one] == of[two]:
                    return False
    return True


@njit(cache=True, error_model="numpy")
def colour(couplings, b, d, y):
    """Colours the sheets for the couplings that there are, and factors the corner of the first colour, where
    the band of all is factored: y = A^-1 B."""
    colours = couplings.colouring
    colours.found[0] = 0
    if couplings.many[0] == 0 or not _colour(couplings):
        return
    corner = colours.corner
    for i in range(d.shape[0]):
        for j in range(i + 1):
            v = d[i, j]
            for sheet in range(colours.of.size):
                if colours.of[sheet] == 0:
                    for l in range(6 * colours.spans[sheet, 0], 6 * colours.spans[sheet, 1]):
                        v -= b[i, l] * y[j, l]
            corner[i, j] = v
    if cholesky(corner):
        colours.found[0] = 1


@njit(cache=True, error_model="numpy")
def _solve_first(a, b, y, colours, x, rollers):
    """Solves the first colour and the rollers in place."""
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 0:
            begin, end = colours.spans[sheet, 0], colours.spans[sheet, 1]
            solve(a[begin:end], x[6 * begin : 6 * end])
            for j in range(rollers.size):
                v = 0.0
                for l in range(6 * begin, 6 * end):
                    v += b[j, l] * x[l]
                rollers[j] -= v
    if rollers.size == 0:
        return
    cholesky_solve(colours.corner, rollers)
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 0:
            for j in range(rollers.size):
                v = rollers[j]
                for l in range(6 * colours.spans[sheet, 0], 6 * colours.spans[sheet, 1]):
                    x[l] -= y[j, l] * v


@njit(cache=True, error_model="numpy")
def _solve_second(a, colours, x):
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 1:
            begin, end = colours.spans[sheet, 0], colours.spans[sheet, 1]
            solve(a[begin:end], x[6 * begin : 6 * end])


@njit(cache=True, error_model="numpy")
def _across(b, couplings, source, p, rollers, q, rollers_q):
    """Adds to q what the colour `source`, and the rollers if it is the first, do to the other one."""
    colours, ends, blocks, many = couplings.colouring, couplings.ends, couplings.blocks, couplings.many[0]
    for k in range(many):
        one, two = 6 * ends[k, 0], 6 * ends[k, 1]
        block = blocks[k]
        if colours.of[colours.label[ends[k, 0]]] == source:
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
    for sheet in range(colours.of.size):
        if colours.of[sheet] != 1:
            continue
        for j in range(rollers.size):
            v, far = 0.0, rollers[j]
            for l in range(6 * colours.spans[sheet, 0], 6 * colours.spans[sheet, 1]):
                if source == 1:
                    v += b[j, l] * p[l]
                else:
                    q[l] += b[j, l] * far
            rollers_q[j] += v


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def _dot(colours, p, q):
    """Of the second colour."""
    total = 0.0
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 1:
            for l in range(6 * colours.spans[sheet, 0], 6 * colours.spans[sheet, 1]):
                total += p[l] * q[l]
    return total


@njit(cache=True, error_model="numpy")
def solve_coloured(a, b, y, couplings, res, resb, most, least):
    """Solves band, border and couplings in place, where the sheets have two colours.

    The method ends after `most` iterations, or where the square of the residual, measured
    with the preconditioner, is `least` of what it was.
    """
    colours, room, size = couplings.colouring, couplings.room, res.size
    r, z, p, own, w = room[0, :size], room[1, :size], room[2, :size], room[3, :size], room[4, :size]
    wb = room[4, size:]
    none = room[3, size:]
    for l in range(size):
        r[l], w[l] = res[l], 0.0
    # the first colour as if the second stood still, and what that does to the second
    _solve_first(a, b, y, colours, res, resb)
    none[:] = 0.0
    _across(b, couplings, 0, res, resb, w, none)
    for sheet in range(colours.of.size):
        for l in range(6 * colours.spans[sheet, 0], 6 * colours.spans[sheet, 1]):
            second = colours.of[sheet] == 1
            r[l] = r[l] - w[l] if second else 0.0
            z[l] = p[l] = own[l] = r[l]
            if second:
                res[l] = 0.0
    _solve_second(a, colours, z)
    for l in range(size):
        p[l] = z[l]
    left = _dot(colours, r, z)
    first = left
    for _ in range(most):
        if not left > least * first:
            break
        # what the first colour does where the second moves by p, and what that does to the second
        for l in range(size):
            w[l] = 0.0
        wb[:] = 0.0
        _across(b, couplings, 1, p, wb, w, wb)
        _solve_first(a, b, y, colours, w, wb)
        q = z
        for l in range(size):
            q[l] = 0.0
        _across(b, couplings, 0, w, wb, q, none)
        for l in range(size):
            q[l] = own[l] - q[l]
        along = _dot(colours, p, q)
        if not along > 0.0:
            break
        part = left / along
        for sheet in range(colours.of.size):
            if colours.of[sheet] == 1:
                for l in range(6 * colours.spans[sheet, 0], 6 * colours.spans[sheet, 1]):
                    r[l] -= part * q[l]
                    res[l] += part * p[l]
                    z[l] = r[l]
            else:
                for l in range(6 * colours.spans[sheet, 0], 6 * colours.spans[sheet, 1]):
                    res[l] -= part * w[l]
        for j in range(resb.size):
            resb[j] -= part * wb[j]
        _solve_second(a, colours, z)
        after = _dot(colours, r, z)
        turn, left = after / left, after
        for sheet in range(colours.of.size):
            if colours.of[sheet] == 1:
                for l in range(6 * colours.spans[sheet, 0], 6 * colours.spans[sheet, 1]):
                    p[l] = z[l] + turn * p[l]
                    own[l] = r[l] + turn * own[l]
