"""The equations of sheets that touch, solved for every other sheet, against a dense solve."""

from __future__ import annotations

import numpy as np
import pytest

from mdlgen.backends.lattice.kernels.linear import coupled, two_colour
from mdlgen.backends.lattice.kernels.linear.band import PAD, factor
from mdlgen.backends.lattice.kernels.linear.bordered import eliminate

pytestmark = pytest.mark.usefixtures("as_python")

NODES, BORDER = 4, 2  # of a sheet; unknowns of rollers


def equations(touch: list[tuple[int, int]], seed: int) -> tuple:
    """A positive matrix of three sheets, two rollers and the couplings of `touch`, pairs of sheets: the
    whole, and the factored band, border and corner with what eliminates them, and the couplings."""
    rng = np.random.default_rng(seed)
    size = 6 * 3 * NODES
    whole = np.zeros((size + BORDER, size + BORDER))
    reach = NODES - 1
    for sheet in range(3):
        own = slice(6 * NODES * sheet, 6 * NODES * (sheet + 1))
        part = rng.normal(size=(6 * NODES, 6 * NODES))
        whole[own, own] = part @ part.T + np.eye(6 * NODES)
    label = np.repeat(np.arange(3), NODES)
    made = coupled.couplings(20, label, BORDER)
    for one, two in touch:
        for node in (0, 2):
            # as a contact does: its blocks on both boxes, and what couples them
            ends = NODES * one + node, NODES * two + 3 - node
            way = rng.normal(size=(2, 3, 6))
            stiff = 30.0 * rng.uniform(0.1, 1.0, 3)
            k = int(made.many[0])
            made.ends[k] = ends
            made.blocks[k] = -((way[0].T * stiff) @ way[1]).T  # column by column
            made.many[0] += 1
            places = [slice(6 * end, 6 * end + 6) for end in ends]
            for p in range(2):
                whole[places[p], places[p]] += (way[p].T * stiff) @ way[p]
            whole[places[0], places[1]] = made.blocks[k].T
            whole[places[1], places[0]] = made.blocks[k]
    # rollers touch all sheets
    across = rng.normal(size=(BORDER, size))
    whole[size:, :size], whole[:size, size:] = across, across.T
    whole[size:, size:] = 3.0 * across @ across.T + np.eye(BORDER)
    band = np.zeros((3 * NODES, 6, 6 * (reach + 1) + PAD))
    for n in range(3 * NODES):
        for block in range(min(reach + 1, NODES - n % NODES)):
            rows, columns = slice(6 * (n + block), 6 * (n + block) + 6), slice(6 * n, 6 * n + 6)
            band[n, :, 6 * block : 6 * block + 6] = whole[rows, columns].T
    corner, y = np.zeros((BORDER, BORDER)), np.zeros((BORDER, size))
    d = whole[size:, size:].copy()
    assert factor(band) and eliminate(band, across, d, y, corner)
    two_colour.colour(made, across, d, y)
    return whole, (band, across, y, corner), made


@pytest.mark.parametrize("seed", range(4))
def test_every_other_sheet_is_solved_with_the_rest_eliminated(seed: int) -> None:
    whole, (band, across, y, _), made = equations([(0, 1), (1, 2)], seed)
    assert made.colouring.found[0] == 1 and made.colouring.of.tolist() == [0, 1, 0]
    right = np.random.default_rng(seed + 10).normal(size=len(whole))
    res, rollers = right[:-BORDER].copy(), right[-BORDER:].copy()
    two_colour.solve_coloured(band, across, y, made, res, rollers, 200, 1e-26)
    wanted = np.linalg.solve(whole, right)
    assert np.abs(np.concatenate([res, rollers]) - wanted).max() < 1e-9 * np.abs(wanted).max()


def test_sheets_that_all_touch_each_other_are_solved_at_once() -> None:
    whole, (band, across, y, corner), made = equations([(0, 1), (1, 2), (2, 0)], 1)
    assert made.colouring.found[0] == 0
    right = np.random.default_rng(5).normal(size=len(whole))
    res, rollers = right[:-BORDER].copy(), right[-BORDER:].copy()
    coupled.solve_coupled(band, across, y, corner, made, res, rollers)
    # as far as an iteration of Newton's method needs it
    left = whole @ np.concatenate([res, rollers]) - right
    before = right @ np.linalg.solve(whole, right)
    assert left @ np.linalg.solve(whole, left) < 0.1 * before
