"""Runs of Exudyn that end early, and states of rest that do not stand."""

from __future__ import annotations

import numpy as np
from asked import as_asked
from by_exudyn import CANTILEVER, POST, run

from mdlgen.backends.exudyn_local import assemble, solve
from mdlgen.backends.exudyn_local.shipped import jacobian
from mdlgen.model.lower import lower
from mdlgen.spec.load import load, loads


def test_a_state_that_goes_non_finite_ends_with_a_reason(monkeypatch):
    """Nips at steps of 5 ms: Exudyn's sparse factor would end the process on such a stiffness."""
    found = []

    def seen(*args):
        jacobian(*args)
        found.append(np.isfinite(args[-1]).all())

    monkeypatch.setattr(assemble, "jacobian", seen)
    sets = ("run.duration=50 ms", "run.print_step=0.5 ms", "run.step=5 ms", "run.prune=false")
    result = solve(lower(load("samples/transport_4x4.yaml", (*sets, "sheets.note.boxes=[4,6]"))))
    assert not all(found)
    assert not as_asked(result) and result.status


def test_a_long_run_has_no_estimate():
    """Two runs of 40 ms of the transport would take too long; one of 2 ms is estimated."""
    from mdlgen.backends.exudyn_local.solve import ESTIMATED
    from mdlgen.backends.exudyn_local.state import workspace
    from mdlgen.backends.exudyn_local.step import choose_steps, cost
    from mdlgen.backends.exudyn_local.system import build

    model = lower(load("samples/transport_4x4.yaml", ["run.duration=40 ms"]))
    system, _ = build(model)
    assert cost(system, choose_steps(model, system, workspace(system))[0]) > ESTIMATED
    short = run("samples/transport_4x4.yaml", "run.duration=2 ms", "sheets.note.boxes=[4,6]")
    assert short.error_estimate is not None and short.error_estimate <= short.model.run.tolerance


def test_a_pressed_roller_that_runs_away_meets_nothing():
    """It leaves its bounds until there is no further pair to choose."""
    text = POST.replace("axis: z", "axis: y, press: {direction: -z, stiffness: 0 N/mm, preload: 0.5 N}")
    result = solve(lower(loads(text, overrides=["sheets.block.velocity=[0 m/s, 0 m/s, 0 m/s]"])))
    assert as_asked(result), result.status
    post = result.model.roller("post")
    assert result.position[-1, post.body, 2] < post.center[2] - 10.0
    assert len(result.model.pairs) == result.model.pairs.possible


def test_a_static_run_is_at_rest():
    result = run(CANTILEVER, "sheets.note.boxes=[1,20]", "sheets.note.velocity=[1 m/s, 0 m/s, 0 m/s]")
    assert not result.velocity.any()
    assert result.energy.kinetic == 0.0
