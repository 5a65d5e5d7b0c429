"""Two sheets in stiff contact: what stands beside the band of the second changes no solution, and makes the
method of conjugate gradients short."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from matrices import bare_matrix, exact

from mdlgen.backends.lattice.kernels.linear import colouring, coupled, two_colour
from mdlgen.backends.lattice.kernels.linear.band import PAD
from mdlgen.backends.lattice.kernels.linear.in_series import in_series
from mdlgen.backends.lattice.kernels.linear.sheets import eliminate_sheets, factor_sheets
from mdlgen.backends.lattice.kernels.state import Matrix

pytestmark = pytest.mark.usefixtures("as_python")

BOXES, PITCH, MASS = 12, 6.0, 0.004


def _hat(d: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -d[2], d[1]], [d[2], 0.0, -d[0]], [-d[1], d[0], 0.0]])


def _moves(arm: np.ndarray) -> np.ndarray:
    """The velocity of a place of a body, by the six of the body, (3, 6)."""
    return np.hstack([np.eye(3), -_hat(arm)])


def _bushings() -> np.ndarray:
    """Masses of a sheet, a row of boxes, and springs between neighbours, (6 BOXES, 6 BOXES)."""
    whole = np.zeros((6 * BOXES, 6 * BOXES))
    for n in range(BOXES):
        own = slice(6 * n, 6 * n + 6)
        whole[own, own] += np.diag([MASS] * 3 + [MASS * PITCH**2 / 12.0] * 3)
        if n + 1 < BOXES:
            half = np.array([0.5 * PITCH, 0.0, 0.0])
            g = np.zeros((6, 6 * BOXES))
            g[:3, own], g[3:, 6 * n + 3 : 6 * n + 6] = _moves(half), np.eye(3)
            far = slice(6 * n + 6, 6 * n + 12)
            g[:3, far], g[3:, 6 * n + 9 : 6 * n + 12] = -_moves(-half), -np.eye(3)
            whole += g.T @ np.diag([0.5, 0.5, 0.5, 0.02, 0.02, 0.02]) @ g
    return whole


def equations(stiff: float, series: bool, shift: float) -> tuple[np.ndarray, Matrix]:
    """Two such sheets, the upper one shifted along the lower one, with a contact at the four corners of each
    overlap, as a whole, and as a step has it, factored."""
    size = 6 * BOXES
    places = np.zeros((2 * BOXES, 3))
    places[:BOXES, 0] = places[BOXES:, 0] = PITCH * np.arange(BOXES)
    places[BOXES:] += shift, 0.0, 0.1
    whole = np.zeros((2 * size, 2 * size))
    whole[:size, :size] = whole[size:, size:] = inner = _bushings()
    band = np.zeros((2 * BOXES, 6, 12 + PAD))
    made = coupled.couplings(4 * BOXES, np.repeat([0, 1], BOXES), 0)
    contacts = np.zeros_like(whole)
    for upper in range(BOXES):
        for lower in (upper, upper + 1):
            if lower == BOXES:
                continue
            middles = places[BOXES + upper, 0], places[lower, 0]
            left, right = max(middles) - 0.5 * PITCH, min(middles) + 0.5 * PITCH
            if not right > left:
                continue
            k = int(made.many[0])
            made.ends[k] = lower, BOXES + upper
            made.many[0] += 1
            for x in (left, right):
                for y in (-2.0, 2.0):
                    at, n = np.array([x, y, 0.05]), np.array([0.1, 0.0, 1.0])
                    g = np.zeros((3, 2 * size))
                    g[:, 6 * lower : 6 * lower + 6] = _moves(at - places[lower])
                    far = 6 * (BOXES + upper)
                    g[:, far : far + 6] = -_moves(at - places[BOXES + upper])
                    own = stiff * (np.outer(n, n) + 0.1 * np.eye(3))
                    contacts += g.T @ own @ g
                    block = g[:, 6 * lower : 6 * lower + 6].T @ own @ g[:, far : far + 6]
                    made.blocks[k] += block.T
    for n in range(2 * BOXES):
        own = slice(6 * n, 6 * n + 6)
        band[n, :, :6] = contacts[own, own].T
    masses = np.zeros((2 * BOXES, 6, 12))
    for n in range(2 * BOXES):
        for block in range(min(2, BOXES - n % BOXES)):
            i, j = 6 * (n % BOXES), 6 * (n % BOXES + block)
            masses[n, :, 6 * block : 6 * block + 6] = inner[j : j + 6, i : i + 6].T
    made = exact(made)
    matrix = bare_matrix(band, made, np.zeros((0, 2 * size)), np.zeros((0, 0)), masses)
    assert colouring.colour(made)
    if series:
        bodies = np.rec.array(np.full(2 * BOXES, MASS, np.dtype([("mass", "f8")])))
        turned = np.tile(np.eye(3).ravel(), (2 * BOXES, 1))
        motion = SimpleNamespace(x=places, r=turned)
        in_series(bodies, np.arange(2 * BOXES), motion, matrix)
        made.colouring.series[0] = 1
    assert factor_sheets(matrix, True) and eliminate_sheets(matrix)
    assert two_colour.corner_of_first(matrix)
    return whole + contacts, matrix


def _left(stiff: float, series: bool, shift: float, most: int) -> float:
    """What is left of a solution after so many iterations, as a part."""
    whole, matrix = equations(stiff, series, shift)
    right = np.random.default_rng(3).normal(size=len(whole))
    matrix.res[:] = right
    two_colour.solve_coloured(matrix, most, 0.0)
    missed = matrix.res - (wanted := np.linalg.solve(whole, right))
    return float(np.sqrt(missed @ whole @ missed / (wanted @ whole @ wanted)))


@pytest.mark.parametrize("shift", [0.0, 1.3])
@pytest.mark.parametrize("series", [False, True])
def test_the_solution_is_that_of_the_whole(series: bool, shift: float) -> None:
    assert _left(0.3, series, shift, 200) < 1e-9


@pytest.mark.parametrize("stiff", [0.03, 0.3, 3.0, 30.0])
def test_sheets_that_move_as_one_take_few_iterations(stiff: float) -> None:
    """Ten to ten thousand times as stiff as the inertia of a box: six iterations are enough for any of them,
    where they took more the stiffer they were."""
    assert _left(stiff, True, 0.0, 6) < 2e-3 < 0.05 * _left(stiff, False, 0.0, 6)


@pytest.mark.parametrize("shift", [0.3, 1.3])
def test_sheets_whose_boxes_do_not_lie_on_each_other_gain_less(shift: float) -> None:
    """There two contacts of a box resist bending."""
    assert _left(0.3, True, shift, 24) < 0.1 * _left(0.3, False, shift, 24)


def test_what_stands_beside_the_band_leaves_a_mass_in_series() -> None:
    """Of a contact on a box, with the mass of the other one behind it, K m/(K + m) is left of K."""
    whole, matrix = equations(30.0, True, 0.0)
    beside = matrix.couplings.beside
    assert not beside[:BOXES].any()  # the first colour is eliminated as it is
    for n in range(BOXES, 2 * BOXES):
        i = 6 * (n - BOXES)
        contact = whole[6 * n : 6 * n + 6, 6 * n : 6 * n + 6] - _bushings()[i : i + 6, i : i + 6]
        stiff = np.trace(contact[:3, :3])
        left = contact - beside[n].T
        assert np.allclose(left, left.T) and np.linalg.eigvalsh(left)[0] > -1e-9 * stiff
        assert np.trace(left[:3, :3]) == pytest.approx(1.0 / (1.0 / stiff + 1.0 / (3.0 * MASS)))
