"""Mixing of changes, for iterations of which some motions come back larger than they went."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from mdlgen.backends.lattice.kernels.integrate.mixing import ROWS, mix
from mdlgen.backends.lattice.kernels.tuning import MIXED

pytestmark = pytest.mark.usefixtures("as_python")

NODES, BORDER = 4, 2
SIZE = 6 * NODES + BORDER


def _left(grows: list[float], iterations: int, depth: int = MIXED) -> float:
    """How far velocities are from the solution after so many iterations, each of which takes off what a
    linear map makes of it: all but a part of some motions, which are given."""
    rng = np.random.default_rng(5)
    motions = np.linalg.qr(rng.normal(size=(SIZE, SIZE)))[0][:, : len(grows)]
    # not at right angles, as friction that wedges
    motions = motions + 0.3 * rng.normal(size=motions.shape) / SIZE**0.5
    back = motions @ np.diag(grows) @ np.linalg.pinv(motions)
    solution = rng.normal(size=SIZE)
    state = SimpleNamespace(u=np.zeros((NODES, 6)), ub=np.zeros(BORDER))
    matrix = SimpleNamespace(
        res=np.zeros(6 * NODES),
        resb=np.zeros(BORDER),
        mixing=np.full((ROWS, SIZE), np.nan),
        gram=np.zeros((MIXED, MIXED)),
        parts=np.zeros((2, MIXED)),
    )
    matrix.mixing[:2] = 0.0
    for iteration in range(iterations):
        u = np.concatenate([state.u.ravel(), state.ub])
        change = (u - solution) - back @ (u - solution)
        matrix.res[:], matrix.resb[:] = change[:-BORDER], change[-BORDER:]
        if depth:
            mix(matrix, state, iteration, depth)
        state.u -= matrix.res.reshape(NODES, 6)
        state.ub -= matrix.resb
    u = np.concatenate([state.u.ravel(), state.ub])
    return float(np.linalg.norm(u - solution) / np.linalg.norm(solution))


@pytest.mark.parametrize(
    "grows", [[-1.5], [-2.0, 0.9], [-1.4, -1.1, 0.95], [-3.0, -1.2, 0.5, 0.8], [-1.5, -1.3, -1.1, 0.7, 0.9]]
)
def test_motions_that_come_back_larger_end(grows: list[float]) -> None:
    """One iteration more for each of them, and one for the rest; so many motions are mixed."""
    assert len(grows) <= MIXED
    assert _left(grows, len(grows) + 2) < 1e-4
    assert _left(grows, len(grows) + 2, depth=0) > 0.3


def test_of_two_motions_that_come_back_one_is_mixed_away() -> None:
    """With one iteration before, as where there is no air."""
    assert _left([-1.5], 4, depth=1) < 1e-4
    assert _left([-1.5, 0.95], 6, depth=1) > 10.0 * _left([-1.5, 0.95], 6)


def test_what_falls_by_itself_stays_as_it_is() -> None:
    assert _left([0.0], 1, depth=0) < 1e-12
    assert _left([0.0], 4) < 1e-12


def test_more_motions_than_are_mixed_still_fall() -> None:
    grows = [-1.2, -1.1, -1.05, 0.9, 0.95, 0.8, -0.9]
    assert _left(grows, 25) < 1e-4 < _left(grows, 25, depth=0)
