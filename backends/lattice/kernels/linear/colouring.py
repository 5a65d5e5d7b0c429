"""Colours of sheets, so that those which touch each other differ, and the couplings of each sheet."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.program.kernel import BORROWS, njit

# Columns of Colouring.spans; of Couplings.ends.
BEGIN, END = 0, 1
ONE, TWO = 0, 1


class Colouring(NamedTuple):
    """Colours of the sheets, and the corner of the rollers after elimination of the first colour."""

    spans: np.ndarray  # first node of a sheet and the first behind it, (sheets, 2).
    label: np.ndarray  # sheet of each node, by its row in spans.
    of: np.ndarray  # colour of each sheet, 0 or 1; -1: not known yet.
    found: np.ndarray  # (1,) 1 if two colours are enough.
    series: np.ndarray  # (1,) 1 if contacts act as springs in series (see in_series).
    corner: np.ndarray  # Cholesky factor, (border, border).
    begins: np.ndarray  # first coupling of a sheet in `own`, (sheets + 1,).
    own: np.ndarray  # couplings of each sheet, in their order, (2 pairs,).
    enough: np.ndarray  # squared residual at which the solve of a sheet ends, (sheets,).
    reached: np.ndarray  # first number of a sheet that each roller reaches, and the first behind them.


def colouring(label: np.ndarray, border: int, pairs: int) -> Colouring:
    """`label` is the sheet of each node, in rising order."""
    sheets = np.unique(label)
    spans = np.stack([np.searchsorted(label, sheets), np.searchsorted(label, sheets, side="right")], axis=1)
    return Colouring(
        spans.astype(np.int64),
        np.searchsorted(sheets, label).astype(np.int64),
        np.full(len(sheets), -1, np.int64),
        np.zeros(1, np.int64),
        np.zeros(1, np.int64),
        np.zeros((border, border)),
        np.zeros(len(sheets) + 1, np.int64),
        np.zeros(2 * pairs, np.int64),
        np.zeros(len(sheets)),
        np.zeros((len(sheets), border, 2), np.int64),
    )


@njit(cache=True, error_model="numpy")
def _colour(couplings):
    """Assigns colours to the sheets. Returns False where two are too few: three sheets touch each other."""
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
                one, two = label[ends[k, ONE]], label[ends[k, TWO]]
                if of[one] < 0 and of[two] >= 0:
                    one, two = two, one
                if of[one] >= 0 and of[two] < 0:
                    of[two] = 1 - of[one]
                    grew = True
                elif of[one] >= 0 and of[one] == of[two]:
                    return False
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def _list(couplings):
    """Lists the couplings of each sheet."""
    colours, ends, many = couplings.colouring, couplings.ends, couplings.many[0]
    label, begins, own = colours.label, colours.begins, colours.own
    for sheet in range(begins.size):
        begins[sheet] = 0
    for k in range(many):
        for end in range(2):
            begins[label[ends[k, end]] + 1] += 1
    for sheet in range(1, begins.size):
        begins[sheet] += begins[sheet - 1]
    for k in range(many):
        for end in range(2):
            sheet = label[ends[k, end]]
            own[begins[sheet]] = k
            begins[sheet] += 1
    for sheet in range(begins.size - 1, 0, -1):
        begins[sheet] = begins[sheet - 1]
    begins[0] = 0


@njit(cache=True, error_model="numpy", **BORROWS)
def colour(couplings):
    """Colours the sheets for the present couplings. Returns True if two colours are enough."""
    colours = couplings.colouring
    colours.found[0] = colours.series[0] = 0
    if couplings.many[0] == 0 or not _colour(couplings):
        return False
    _list(couplings)
    colours.found[0] = 1
    return True
