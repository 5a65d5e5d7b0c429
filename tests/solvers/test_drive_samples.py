"""The heads of the samples of motors and torque limiters say what they show; here is that it does."""

from __future__ import annotations

import numpy as np
import pytest
import ran
from axles import spin

from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.motors import axle_torque
from mdlgen.results.result import RUBS, Result
from mdlgen.spec.load import load

# One pass at a fixed step: no estimate, and a third of the time.
STEP = "run.step=0.05 ms"


def solved(name: str, *sets: str) -> Result:
    return ran.solved(lower(load(samples() / f"{name}.yaml", sets)), "lattice")


def kinds(result: Result) -> set[str]:
    return {event["kind"] for event in result.events}


def test_a_motor_runs_where_its_line_meets_a_braked_nip() -> None:
    result = solved("stall", STEP)
    late = result.time > 50.0
    # 50 (1 - 6/12) rad/s, less what friction creeps by: 0.6 N of 1 N at a smoothing of 2 mm/s, in both nips
    assert spin(result, "pull")[late].mean() == pytest.approx(0.025, rel=5e-3)
    torque = axle_torque(result, result.model.roller("pull"))
    assert torque is not None and torque[late].mean() == pytest.approx(6.0, rel=5e-3)
    assert "stall" not in kinds(result)
    assert all(row["passed"] for row in result.summary()["verdict"]["requirements"])


def test_a_weaker_motor_stalls_and_the_verdict_says_so() -> None:
    result = solved("stall", STEP, "rollers.pull.drive.motor.torque=1 N*mm")
    (stall,) = (event for event in result.events if event["kind"] == "stall")
    assert stall["roller"] == "pull" and stall["torque_n_mm"] == pytest.approx(4.0, rel=0.01)
    record = result.summary()
    assert record["rollers"]["pull"]["stalled"] and not record["verdict"]["passed"]
    assert any(text.startswith("motor at pull") for text in record["verdict"]["events"])


def test_a_retard_roller_holds_the_second_note_and_turns_along_with_one() -> None:
    result = solved("retard", STEP)
    time, lower_ = result.time, result.sheet_motion(0)[0][:, 0]
    assert "double_feed" not in kinds(result)
    first = time < 50.0
    assert np.ptp(lower_[first]) < 0.1  # while the upper one goes by more than 20 mm
    assert np.ptp(result.sheet_motion(1)[0][first, 0]) > 20.0
    assert np.abs(spin(result, "retard")[first]).max() < 2e-3
    (slip,) = (event for event in result.events if event["kind"] == "limiter_slips")
    assert slip["time_ms"] == pytest.approx(57.0, abs=2.0)
    # with one note it turns along, and holds that back with torque over radius
    row = list(zip(result.model.contacts.part_a, result.model.contacts.part_b, strict=True))
    assert result.contact_friction is not None
    late = (time > 65.0) & (time < 80.0)
    held = np.abs(result.contact_friction[late, row.index(("note_1", "retard")), RUBS])
    assert held.mean() == pytest.approx(0.6, rel=0.01)
    assert spin(result, "retard")[late].min() > 0.99 * 0.05


def test_a_weak_limiter_lets_both_notes_go() -> None:
    assert "double_feed" in kinds(solved("retard", STEP, "rollers.retard.limiter.torque=2 N*mm"))
