"""Runs of a sheet in a nip with a rubber cover: its speed, its force and its energy."""

from __future__ import annotations

import numpy as np
import pytest
import ran

import mdlgen
from mdlgen.paths import samples
from mdlgen.results.torques import drive_torque

SURFACE = 400.0  # of the undeformed cover [mm/s]


def solved(solver, *sets):
    model = mdlgen.lower(mdlgen.load(samples() / "rubber_nip.yaml", sets))
    return ran.solved(model, solver)


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_sample_runs_as_its_comment_says(solver):
    result = solved(solver, "run.duration=15 ms", "run.tolerance=0.01")
    summary = result.summary()
    cover = result.model.roller("feed_lower").cover
    speed = summary["sheets"]["note"]["speed_mm_per_s"][0]
    assert speed == pytest.approx(1.0196 * SURFACE, rel=1e-3)  # a change of the force by 4 %
    assert summary["rollers"]["feed_upper"]["omega_rad_per_s"] * -8.0 == pytest.approx(speed, rel=2e-3)
    assert summary["rollers"]["feed_lower"]["nip_width_mm"] == pytest.approx(2.0 * cover.half, rel=0.03)
    assert summary["rollers"]["feed_lower"]["nip_force_n"] == pytest.approx(10.0, rel=0.04)
    # power of the drive is what the sheet and the free roller have, and what is lost
    assert summary["energy"]["balance_error"] < 0.01


@pytest.mark.parametrize("boxes", [[5, 3], [14, 8]])
def test_force_and_speed_are_the_same_on_other_grids(boxes):
    result = solved("lattice", "run.duration=15 ms", "run.tolerance=0.01", f"sheets.note.boxes={boxes}")
    rows = result.contact_force[:, 0]
    assert float(rows[len(rows) // 2 :].mean()) == pytest.approx(10.1, rel=0.03)
    assert result.summary()["sheets"]["note"]["speed_mm_per_s"][0] == pytest.approx(
        1.0196 * SURFACE, rel=2e-3
    )


def test_foam_is_slower_than_its_surface():
    result = solved(
        "lattice", "run.duration=15 ms", "run.tolerance=0.01", "nips.feed.lower.cover.poisson=0.3"
    )
    gain = result.model.roller("feed_lower").cover.gain
    speed = result.summary()["sheets"]["note"]["speed_mm_per_s"][0]
    assert gain < -0.03
    assert speed == pytest.approx((1.0 + gain) * SURFACE, rel=3e-3)


def test_a_drive_that_pulls_a_load_gives_its_power_to_the_sheet():
    """A force against the sheet: torque times spin is force times speed, at the ratio of the cover."""
    pull = "loads=[{sheet: note, at: [0 mm, 0 mm], force: [-1 N, 0 N, 0 N]}]"
    free = "nips.feed.upper.contact.friction=0"
    result = solved("lattice", "run.duration=15 ms", "run.tolerance=0.01", pull, free)
    summary = result.summary()
    roller = summary["rollers"]["feed_lower"]
    speed = summary["sheets"]["note"]["speed_mm_per_s"][0]
    ratio = speed / SURFACE
    assert 1.015 < ratio < 1.02
    steady = result.time > 8.0
    torque = np.mean(np.abs(drive_torque(result, result.model.roller("feed_lower"))[steady]))
    assert torque == pytest.approx(
        1.0 * 10.0 * 1.0196, rel=0.01
    )  # 10 N mm would be that of the core's radius
    assert summary["energy"]["balance_error"] < 0.01
    assert roller["speed_ratio"] == pytest.approx(1.0196, abs=1e-3)
