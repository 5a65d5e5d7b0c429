"""The equations of sheets that touch, solved for every other sheet, against a dense solve."""

from __future__ import annotations

import numpy as np
import pytest
from matrices import bare_matrix, exact

from mdlgen.backends.lattice.kernels import tuning
from mdlgen.backends.lattice.kernels.linear import colouring, coupled, two_colour
from mdlgen.backends.lattice.kernels.linear.band import PAD
from mdlgen.backends.lattice.kernels.linear.sheets import eliminate_sheets, factor_sheets
from mdlgen.backends.lattice.kernels.state import Matrix

pytestmark = pytest.mark.usefixtures("as_python")

NODES, BORDER = 4, 2  # of a sheet; unknowns of rollers


def equations(touch: list[tuple[int, int]], seed: int) -> tuple[np.ndarray, Matrix]:
    """A positive matrix of three sheets, two rollers and the couplings of `touch`, pairs of sheets: the
    whole, and the same as a step has it, factored."""
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
    made = exact(made)
    matrix = bare_matrix(band, made, across, whole[size:, size:].copy(), np.zeros((0, 6, 0)))
    colouring.colour(made)
    assert factor_sheets(matrix, False) and eliminate_sheets(matrix)
    assert two_colour.corner_of_first(matrix)
    return whole, matrix


def solved(matrix: Matrix) -> np.ndarray:
    return np.concatenate([matrix.res, matrix.resb])


@pytest.mark.parametrize("seed", range(4))
def test_every_other_sheet_is_solved_with_the_rest_eliminated(seed: int) -> None:
    whole, matrix = equations([(0, 1), (1, 2)], seed)
    colouring = matrix.couplings.colouring
    assert colouring.found[0] == 1 and colouring.of.tolist() == [0, 1, 0]
    assert colouring.begins.tolist() == [0, 2, 6, 8]
    assert colouring.own[:8].tolist() == [0, 1, 0, 1, 2, 3, 2, 3]
    right = np.random.default_rng(seed + 10).normal(size=len(whole))
    matrix.res[:], matrix.resb[:] = right[:-BORDER], right[-BORDER:]
    two_colour.solve_coloured(matrix, 200, 1e-26)
    wanted = np.linalg.solve(whole, right)
    assert np.abs(solved(matrix) - wanted).max() < 1e-9 * np.abs(wanted).max()


@pytest.mark.parametrize("seed", range(4))
def test_no_more_is_left_of_a_sheet_than_is_enough(seed: int) -> None:
    """And the method ends there: with a tenth of what it began with it goes a few times, with all not once,
    and the second colour stays as it was."""
    whole, matrix = equations([(0, 1), (1, 2)], seed)
    colouring = matrix.couplings.colouring
    right = np.random.default_rng(seed + 10).normal(size=len(whole))
    wanted = np.linalg.solve(whole, right)
    left = []
    for enough in (0.0, 1e-4, 1e-2, 1e30):
        matrix.res[:], matrix.resb[:] = right[:-BORDER], right[-BORDER:]
        colouring.enough[:] = enough
        two_colour.solve_coloured(matrix, 200, 1e-26)
        missed = solved(matrix) - wanted
        left.append(float(missed @ whole @ missed))
        assert enough == 1e30 or left[-1] <= 10.0 * enough + 1e-16
        second = matrix.res[6 * NODES : 12 * NODES]
        assert second.any() == (enough < 1e30)
    assert left == sorted(left) and left[1] > 1e3 * left[0]


def test_sheets_that_all_touch_each_other_are_solved_at_once() -> None:
    whole, matrix = equations([(0, 1), (1, 2), (2, 0)], 1)
    assert matrix.couplings.colouring.found[0] == 0
    right = np.random.default_rng(5).normal(size=len(whole))
    matrix.res[:], matrix.resb[:] = right[:-BORDER], right[-BORDER:]
    coupled.solve_coupled(matrix, tuning.LINEAR_LEFT)
    # as far as an iteration of Newton's method needs it
    left = whole @ solved(matrix) - right
    before = right @ np.linalg.solve(whole, right)
    assert left @ np.linalg.solve(whole, left) < 0.1 * before
