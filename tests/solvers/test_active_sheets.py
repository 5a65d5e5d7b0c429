"""Sheets that an iteration with frozen contacts has done with are left out, and the step ends the same."""

from __future__ import annotations

import numpy as np
import pytest

from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.lattice.integrate.work import arrays, control
from mdlgen.backends.lattice.kernels.integrate import active, convex, step
from mdlgen.backends.lattice.kernels.state import FASTEST, LOOSE, SOLVES, TOUGH
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import load

pytestmark = pytest.mark.usefixtures("as_python")

STEP, LIMIT = 0.1, 1e-7  # [ms], [mm/ms]
SETS = ("piles.cassette.count=7", "contacts.pick.between=[cassette_7, pick]", "probes.lead.sheet=cassette_7")


def solved(kick: float, most: int, monkeypatch: pytest.MonkeyPatch) -> tuple[np.ndarray, int, float]:
    """Velocities in the middle of the first step of a pile whose top moves at `kick` [mm/ms], how many sheets
    were left out at most, and how many linear solves it took; of `most` sheets none is left out."""
    model = lower(load(samples() / "pile.yaml", list(SETS)))
    system = build(model)
    work = arrays(model, system)
    steering = control(work)
    steering.factored[TOUGH], steering.pace[FASTEST], steering.pace[LOOSE] = 1.0, 1.0, LIMIT
    top = np.flatnonzero(system.sheets == system.sheets.max())
    work.state.v[top, 0] = work.state.u[top, 0] = kick
    work.state.v[top, 2] = work.state.u[top, 2] = -0.1 * kick
    out = []

    def left(work, z):
        active.left.py_func(work, z)
        out.append(int((work.matrix.couplings.colouring.active == active.OUT).sum()))

    monkeypatch.setattr(convex, "FEW", most)
    monkeypatch.setattr(convex, "QUIET", 0.3)  # of so few sheets it leaves some out
    monkeypatch.setattr(convex, "left", left)
    assert step.midpoint(work, 0.0, STEP, LIMIT, steering)
    return work.state.u.copy(), max(out, default=0), float(steering.counters[SOLVES])


@pytest.mark.parametrize("kick", [0.05, 0.3])
def test_a_step_ends_as_with_all_sheets(kick: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Velocities within what the iterations leave."""
    some, out, _ = solved(kick, 2, monkeypatch)
    every, none, _ = solved(kick, 99, monkeypatch)
    assert out >= 2
    assert none == 0
    assert some[:, :3] == pytest.approx(every[:, :3], abs=5.0 * LIMIT)
    assert np.abs(every[:, :3]).max() > 0.5 * kick
