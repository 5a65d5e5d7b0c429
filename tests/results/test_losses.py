"""Energy that drives bring in and that contacts take, part by part, against closed forms, in both solvers."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from nip import FORTH_AND_BACK
from ran import ran, solved
from test_torques import ALPHA, INERTIA, MU, PAIR, PRELOAD, R_TOP, SOLVERS, R

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.io.series import series
from mdlgen.results.losses import summed
from mdlgen.results.result import Result
from mdlgen.results.verdict import judge
from mdlgen.spec.load import loads

STEADY = "rollers.motor.drive={speed: 100 rad/s}"


def run(text: str, solver: str, *overrides: str) -> Result:
    return solved(lower(loads(text, "losses", overrides)), solver)


def powers(result: Result) -> dict[int, np.ndarray]:
    assert result.losses is not None
    return result.losses.rows


@pytest.mark.parametrize("solver", SOLVERS)
def test_rolling_resistance_takes_f_n_along_the_way(solver: str) -> None:
    """Two rollers that roll on each other: f N v, v the speed of their surfaces."""
    f, speed = 0.05, 0.1 * R
    result = run(PAIR, solver, f"contacts.0.rolling_resistance={f}", STEADY)
    lost = powers(result)[0]
    late = result.time > 15.0
    assert lost[late] == pytest.approx(f * PRELOAD * speed, rel=1e-3)
    # nothing else takes energy here, also while the free one gets up to speed
    assert summed(result, lost)[-1] == pytest.approx(result.energy.dissipated, rel=1e-5)
    record = result.summary()
    assert record["rollers"]["motor"]["energy"]["friction_n_mm"] == pytest.approx(
        summed(result, lost)[-1] / 2
    )
    assert record["energy"]["friction"] == pytest.approx(summed(result, lost)[-1])


@pytest.mark.parametrize("solver", SOLVERS)
def test_surfaces_that_slip_take_mu_n_along_their_slip(solver: str) -> None:
    result = run(PAIR, solver, "rollers.top.drive={speed: 50 rad/s}")
    lost = powers(result)[0]
    late = result.time > 12.0
    assert lost[late] == pytest.approx(MU * PRELOAD * (0.1 * R + 0.05 * R_TOP), rel=1e-3)
    assert summed(result, lost)[-1] == pytest.approx(result.energy.dissipated, rel=1e-6)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_block_that_slides_to_rest_loses_its_kinetic_energy(solver: str) -> None:
    """mu m g s = m v^2 / 2, all of it at the plane."""
    sets = ["sheets.block.velocity.0=0.5 m/s", "run.duration=180 ms"]
    result = solved(mdlgen.lower(mdlgen.load(samples() / "verify" / "slide.yaml", sets)), solver)
    record = result.summary()
    way = record["sheets"]["block"]["travel_mm"][0]
    lost = record["planes"]["floor"]["energy"]["friction_n_mm"]
    assert lost == pytest.approx(0.3 * 10.0 * 9.81e-3 * way, rel=2e-3)  # smoothing at the end of the way
    assert lost == pytest.approx(0.5 * 10.0 * 0.5**2, rel=5e-4)
    assert record["sheets"]["block"]["energy"]["friction_n_mm"] == lost
    assert record["sheets"]["block"]["energy"]["kinetic_n_mm"] == pytest.approx(-1.25, rel=1e-3)
    assert record["energy"]["other_losses"] == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_drive_gives_what_the_inertia_behind_it_takes(solver: str) -> None:
    """(I + I_top (R/R_top)^2) w^2 / 2, and its torque over its angle."""
    result = run(PAIR, solver)
    both = INERTIA + 0.5 * 10.0 * R_TOP**2 * (R / R_TOP) ** 2
    energy = both * 0.1**2 / 2
    given = series(result)["motor.driven_energy_n_mm"]
    # half of the torque at the corner of the ramp, over 0.05 ms, in one of the solvers
    assert given[-1] == pytest.approx(energy, rel=0.01)
    ramp = result.time < 9.5
    angle = 0.5 * ALPHA * result.time**2
    assert given[ramp] == pytest.approx(both * ALPHA * angle[ramp], rel=0.01, abs=0.02 * energy)
    record = result.summary()
    assert record["rollers"]["motor"]["energy"]["driven_n_mm"] == given[-1]
    assert record["energy"]["drives_unseen"] == pytest.approx(0.0, abs=0.01 * energy)
    assert "driven_energy_n_mm" not in " ".join(c for c in series(result) if c.startswith("top"))


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_roller_that_rubs_or_rolls_on_a_sheet(solver: str) -> None:
    """On a sheet that is held mu N w R; on one that it takes along f N along the way."""
    held = run(
        FORTH_AND_BACK,
        solver,
        "sheets.note.clamp={edge: x_min}",
        "rollers.motor.drive={speed: 50 rad/s, ramp: 2 ms}",
    )
    late = held.time > 15.0
    expected = 0.8 * held.contact_force[late, 0] * 0.05 * 7.5
    assert powers(held)[0][late] == pytest.approx(expected, rel=2e-3)  # the held note stretches a little
    rolling = run(FORTH_AND_BACK, solver, "contacts.0.rolling_resistance=0.05")
    speed = np.abs(rolling.spin[:, rolling.model.roller("motor").body, 1]) * 7.5
    way = np.trapezoid(0.05 * rolling.contact_force[:, 0] * speed, rolling.time)
    # and some slip as it speeds up
    assert summed(rolling, powers(rolling)[0])[-1] == pytest.approx(way, rel=0.01)
    assert rolling.summary()["energy"]["friction"] == pytest.approx(rolling.energy.dissipated, rel=0.01)


def test_energies_are_saved_required_and_shown(tmp_path: Path) -> None:
    asked = 'require=["rollers.motor.energy.driven below 1 N*mm", "sheets.note.energy.kinetic above 1 N*mm"]'
    result = run(FORTH_AND_BACK, "lattice", asked)
    assert [one.passed for one in judge(result, result.summary())] == [True, False]
    result.save(tmp_path)
    again = Result.load(tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["energy"] == again.summary()["energy"]
    columns = (tmp_path / "series.csv").read_text().splitlines()[0].split(",")
    assert {"motor.driven_energy_n_mm", "motor.friction_loss_n_mm", "idler.friction_loss_n_mm"} <= set(
        columns
    )
    page = result.report(tmp_path / "page.html").read_text("utf-8")
    for words in ("Energy that each drive has given", "lost by friction and rolling", 'id="energies"'):
        assert words in page


def test_an_arm_has_its_angle() -> None:
    """Turned by it about the pivot, the roller's centre is where it is."""
    result = ran("peel")
    roller = result.model.roller("reject")
    assert roller.arm is not None
    record = result.summary()["rollers"]["reject"]
    angle = np.radians(record["arm_deg"])
    begun = roller.center - roller.arm.pivot
    turned = np.cos(angle) * begun + np.sin(angle) * np.cross(roller.axis, begun)
    along = roller.axis * (begun @ roller.axis) * (1.0 - np.cos(angle))
    assert roller.arm.pivot + turned + along == pytest.approx(result.position[-1, roller.body], abs=1e-6)
    over = series(result)["reject.arm_deg"]
    assert (record["max_arm_deg"], record["min_arm_deg"]) == (over.max(), over.min())
    assert over.max() - over.min() > 0.01
