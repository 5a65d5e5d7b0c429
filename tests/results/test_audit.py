"""The energy audit: what means something is caught, what a note makes as it comes to rest is not."""

from __future__ import annotations

import re

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.backends.lattice import run
from mdlgen.model.lower import lower
from mdlgen.results import audit
from mdlgen.results.result import Energy
from mdlgen.spec.load import load

WEIGHT = 0.72 * 9.81e-3  # of a note [N]


def stacked(boxes: str, *overrides: str):
    fine = [f"sheets.note_{k}.boxes={boxes}" for k in range(5)]
    return lower(load("samples/stack.yaml", [*fine, "run.duration=5 ms", *overrides]))


def thrown(*overrides: str):
    """A block that falls on a plane and bounces off without a loss."""
    sets = ["contacts.0.restitution=1", "sheets.block.velocity=[0 m/s, 0 m/s, -1 m/s]"]
    sets += ["sheets.block.center=[0 mm, 0 mm, 5.05 mm]", "run.duration=2 ms"]
    return lower(load("samples/verify/drop.yaml", [*sets, *overrides]))


def test_what_is_unseen_is_the_weight_over_the_tolerated_lift() -> None:
    model = stacked("[3,4]")
    assert audit.unseen(model) == pytest.approx(5 * WEIGHT * 1e-3 * 12.7, rel=1e-12)
    assert audit.scale(model, 0.0, 0.0, 0.0, 0.0) == pytest.approx(5 * WEIGHT * 0.635, rel=1e-12)
    # what passes through counts where it is more
    assert audit.scale(model, 1.0, 2.0, 3.0, -4.0) == 4.0
    assert audit.unseen(lower(load("samples/stack.yaml", ["gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"]))) == 0.0
    # a clamped edge is not lifted
    held = lower(load("samples/cantilever.yaml", ["sheets.note.clamp.length=63.5 mm"]))
    assert audit.unseen(held) == pytest.approx(0.5 * WEIGHT * held.run.tolerance * 12.7, rel=1e-9)


@pytest.mark.parametrize("step", ["0.1 ms", "0.05 ms"])
def test_five_flat_notes_come_to_rest_at_a_forced_step(step: str) -> None:
    result = mdlgen.solve(stacked("[10,20]", f"run.step={step}"), "lattice")
    assert as_asked(result), result.status
    assert np.abs(result.position[-1] - result.model.bodies.position).max() < 0.02  # mm
    assert result.energy.scale == pytest.approx(5 * WEIGHT * 0.635, rel=1e-9)


COARSE = (0.02, 0.1, 0.2, 0.4, 0.5)  # ms; the impact lasts for 0.6 ms


def test_an_elastic_impact_at_coarse_steps_is_right() -> None:
    """Steps are halved in it by the energy that they would make."""
    for step in COARSE:
        result = mdlgen.solve(thrown(f"run.step={step} ms", "run.tolerance=1e-2"), "lattice")
        assert as_asked(result), result.status
        assert float(result.velocity[-1, 0, 2]) == pytest.approx(1.0, abs=0.02)


def test_an_elastic_impact_at_coarse_steps_is_right_or_caught_and_the_advice_helps(monkeypatch) -> None:
    """Where nothing but the audit looks at energy."""
    monkeypatch.setattr(run, "MAY_MAKE", 0.0)
    caught = 0
    for step in COARSE:
        result = mdlgen.solve(thrown(f"run.step={step} ms", "run.tolerance=1e-2"), "lattice")
        if result.usable:
            assert float(result.velocity[-1, 0, 2]) == pytest.approx(1.0, abs=0.02)
            continue
        caught += 1
        record = re.match(r"([\d.e+-]+) N mm of energy (came from nowhere|got lost), ", result.status)
        assert record and "leave out run.step" in result.status
        assert float(record[1]) == pytest.approx(
            abs(result.energy.balance_error) * result.energy.scale, rel=0.01
        )
    assert caught
    monkeypatch.undo()
    helped = mdlgen.solve(thrown("run.tolerance=1e-2"), "lattice")
    assert as_asked(helped), helped.status


def test_the_message_names_the_sum() -> None:
    model = thrown("run.step=0.1 ms")
    bad = Energy(balance_error=0.5, scale=0.2)
    message = audit.reason(model, bad, 0.1)
    assert message is not None and message.startswith(
        "0.1 N mm of energy came from nowhere, 50 % of 0.2 N mm"
    )
    assert audit.reason(model, Energy(balance_error=-0.5, scale=0.2), 0.1) is None  # an integrator that damps
    lost = audit.reason(model, Energy(balance_error=-0.5, scale=0.2), 0.1, audit.LOSS)
    assert lost is not None and "0.1 N mm of energy got lost" in lost
    # what the law of nips makes leaves a result that is marked, up to a quarter of the scale
    for part, none in ((0.019, True), (0.021, True), (0.24, True), (0.26, False)):
        nips = Energy(balance_error=0.0, scale=0.2, dissipated=-0.2 * part)
        assert (audit.made_by_nips(nips) is None) == (part < 0.02)
        assert (audit.reason(model, nips, 0.1) is None) == none
    found = audit.reason(thrown(), bad, 0.1)
    assert found is not None and found.endswith("give a run.step of 0.025 ms")
