"""Speeds of rollers over time: spec, text, deck and both solvers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from nip import FORTH_AND_BACK
from ran import solved

import mdlgen
from mdlgen.checks import lints
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Floats
from mdlgen.registry import emitter
from mdlgen.results.compare import compare, travel
from mdlgen.results.result import Result
from mdlgen.spec.load import load
from mdlgen.verify.verification import verify

GIVEN = np.array([[0.0, 0.0], [5.0, 0.1], [8.0, 0.1], [12.0, -0.06]])
SOLVERS = ("lattice", "exudyn")


def scene(folder: Path, *overrides: str) -> mdlgen.Scene:
    file = folder / "prof.yaml"
    file.write_text(FORTH_AND_BACK)
    return load(file, overrides)


def spin(result: Result, name: str) -> Floats:
    """Of a roller about its axis [rad/ms]."""
    roller = result.model.roller(name)
    return result.spin[:, roller.body] @ roller.axis


# -- profiles


def test_the_law_is_linear_between_corners_and_constant_beyond(tmp_path: Path) -> None:
    motor = lower(scene(tmp_path)).roller("motor")
    assert np.array_equal(motor.corners, GIVEN) and motor.speed == 0.1
    times = np.array([-1.0, 0.0, 2.5, 5.0, 6.0, 9.0, 11.0, 12.0, 99.0])
    due = [0.0, 0.0, 0.05, 0.1, 0.1, 0.06, -0.02, -0.06, -0.06]
    assert np.allclose(motor.prescribed(times), due, rtol=0, atol=1e-16)
    # areas of a triangle, a rectangle, two triangles: 0.25, 0.3, 0.125 and -0.045
    angles = motor.turned(np.array([0.0, 5.0, 8.0, 10.5, 12.0, 14.0]))
    assert np.allclose(angles, [0.0, 0.25, 0.55, 0.675, 0.63, 0.51], rtol=0, atol=1e-15)
    late = lower(scene(tmp_path, "rollers.motor.drive={profile: [[3 ms, -5 rad/s], [4 ms, 7 rad/s]]}"))
    assert np.allclose(late.roller("motor").prescribed(np.array([0.0, 3.5, 9.0])), [-0.005, 0.001, 0.007])


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_roller_turns_as_its_profile_says_and_takes_the_sheet_along(tmp_path: Path, solver: str) -> None:
    result = solved(lower(scene(tmp_path)), solver)
    motor = result.model.roller("motor")
    assert np.abs(spin(result, "motor") - motor.prescribed(result.time)).max() <= 1e-15
    path = 7.55 * motor.turned(result.time)  # of the middle of the sheet, on the roller
    moved = result.sheet_motion(0)[0][:, 0]
    assert path.max() == pytest.approx(7.55 * 0.675, rel=1e-3)
    assert np.abs(moved - moved[0] - path).max() < 0.02 * path.max()
    assert abs(result.energy.balance_error) < (2e-3 if solver == "lattice" else 0.01)


def test_both_solvers_agree_about_a_profile(tmp_path: Path) -> None:
    model = lower(scene(tmp_path))
    one, two = (solved(model, solver) for solver in SOLVERS)
    assert compare(two, one).relative < 3e-3
    assert one.energy.driven == pytest.approx(float(two.energy.driven), rel=3e-3)


def test_a_ramp_written_as_a_profile_is_the_same_run(tmp_path: Path) -> None:
    ramp = lower(scene(tmp_path, "rollers.motor.drive={speed: 80 rad/s, ramp: 3 ms}"))
    profile = lower(scene(tmp_path, "rollers.motor.drive={profile: [[0 ms, 0 rad/s], [3 ms, 80 rad/s]]}"))
    assert np.array_equal(ramp.pairs.low, profile.pairs.low) and len(ramp.pairs) == len(profile.pairs)
    assert np.array_equal(solved(ramp, "lattice").position, solved(profile, "lattice").position)


def test_bounds_cover_a_profile_that_comes_back(tmp_path: Path) -> None:
    """600 mm/s forth and back again: at the end the sheet is where it began."""
    forth = "rollers.motor.drive={profile: [[0 ms, 80 rad/s], [9 ms, 80 rad/s], [11 ms, -80 rad/s]]}"
    model = lower(scene(tmp_path, forth, "run.margin=0.5 mm"))
    boxes = slice(model.sheets[0].first, model.sheets[0].first + model.sheets[0].count)
    reach = (model.pairs.high - model.bodies.position)[boxes, 0]
    assert reach.min() > 7.5 * 0.08 * 9.5
    result = solved(model, "lattice")
    assert abs(travel(result)[0]) < 0.6 and np.ptp(result.sheet_motion(0)[0][:, 0]) > 5.0


@pytest.mark.parametrize("corners", [2, 5, 16])
def test_text_deck_and_model_have_one_law(tmp_path: Path, corners: int) -> None:
    rng = np.random.default_rng(corners)
    times = np.cumsum(rng.uniform(0.1, 3.0, corners))
    speeds = rng.uniform(-200, 200, corners).tolist()
    given = [[f"{t!r} ms", f"{w!r} rad/s"] for t, w in zip(times.tolist(), speeds, strict=True)]
    made = scene(tmp_path, f"rollers.motor.drive={{profile: {given}}}", "run.duration=50 ms")
    found = verify(made, lower(made))
    assert [str(d) for d in found.all_differences()] == []
    assert all(c.largest <= 1e-12 for kinds in found.kinds.values() for c in kinds.values())
    assert found.perturbed is not None and found.perturbed.largest <= 1e-12
    assert not [name for name in found.perturbed.shown_only if name.startswith("ds_motor")]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("real_w_2, 100.0 )", "real_w_2, 100.0001 )"),
        ("real_t_3, 0.012 )", "real_t_3, 0.01200001 )"),
        ("({ds_motor.real_t_2.value}-TIME)", "({ds_motor.real_t_3.value}-TIME)"),
        ("*MAX(0,1-MAX(0,({ds_motor.real_t_1", "*(1-MAX(0,({ds_motor.real_t_1"),  # before the corner
        ("{ds_motor.real_w_3.value}", "-60.0"),  # right once, and not parametric
        ("-{ds_motor.real_t_2.value})", "-0.008)"),
    ],
)
def test_another_law_in_the_text_is_caught(tmp_path: Path, old: str, new: str) -> None:
    made = scene(tmp_path)
    model = lower(made)
    text = emitter("motionview").emit(model)
    assert text.count(old) >= 1
    file = tmp_path / "prof.mdl"
    file.write_text(text.replace(old, new, 1))
    assert not verify(made, model, text=file).ok


@pytest.mark.parametrize(
    ("drive", "where", "message"),
    [
        ("{profile: [[0 ms, 0 rad/s], [0 ms, 1 rad/s]]}", "motor.drive", "the time 0 ms is not above"),
        ("{profile: [[5 ms, 0 rad/s], [4 ms, 1 rad/s]]}", "motor.drive", "not above the one before, 5 ms"),
        ("{speed: 1 rad/s, profile: [[0 ms, 0 rad/s]]}", "motor.drive", "exactly one of speed and profile"),
        ("{ramp: 1 ms, profile: [[0 ms, 0 rad/s]]}", "motor.drive", "ramp goes with speed"),
        ("{ramp: 1 ms}", "motor.drive", "exactly one of speed and profile"),
        ("{profile: []}", "motor.drive", "0 corners"),
        (f"{{profile: {[[f'{k} ms', '1 rad/s'] for k in range(65)]}}}", "motor.drive", "65 corners; allowed"),
        ("{profile: [[0 ms]]}", "profile.0", "expected [time, speed]"),
        ("{profile: [[-1 ms, 0 rad/s]]}", "profile.0.0", "at least 0 ms"),
        ("{profile: [[0 ms, 0 mm/s]]}", "profile.0.1", "rad/s"),
    ],
)  # fmt: skip
def test_a_bad_profile_is_reported_in_one_line(tmp_path: Path, drive: str, where: str, message: str) -> None:
    with pytest.raises(SpecError) as error:
        scene(tmp_path, f"rollers.motor.drive={drive}")
    assert where in str(error.value) and message in str(error.value) and "\n" not in str(error.value)


def test_setting_one_law_removes_the_other(tmp_path: Path) -> None:
    drive = scene(tmp_path, "rollers.motor.drive.speed=3 rad/s").rollers["motor"].drive
    assert drive is not None and drive.profile is None and drive.speed == 0.003


@pytest.mark.parametrize(
    ("code", "where", "override"),
    [
        ("W108", "drive.profile", "rollers.motor.drive={profile: [[0 ms, 0 rad/s], [9 ms, 0 rad/s]]}"),
        ("W113", "drive.profile.1", "rollers.motor.drive={profile: [[0 ms, 9 rad/s], [21 ms, 0 rad/s]]}"),
        ("W117", "one_way.direction", "rollers.motor.one_way={direction: -1, torque: 1 N*mm}"),
    ],
)
def test_an_odd_drive_is_reported(tmp_path: Path, code: str, where: str, override: str) -> None:
    said = [lint for lint in lints(lower(scene(tmp_path, override))) if lint.code == code]
    assert [lint.where for lint in said] == [f"rollers.motor.{where}"]
