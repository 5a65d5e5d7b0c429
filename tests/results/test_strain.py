"""What joints bear: closed forms, the force law itself, and what is reported of it."""

from __future__ import annotations

import gc
import json
import math
import weakref
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from synthetic import moving, small_model

import mdlgen
from mdlgen.mechanics.bushing import bushing
from mdlgen.mechanics.frame import Frame
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.report.figures.maps import strain_map
from mdlgen.report.text import summary_text
from mdlgen.results import strain
from mdlgen.results.io import store
from mdlgen.results.result import Result
from mdlgen.results.strain import Strains, sheet_joints, strains
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")

STRIP = """
name: strip
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {m: {E_md: 100 MPa, E_cd: 50 MPa, D_md: 2 N*mm, D_cd: 2 N*mm}}
sheets:
  strip: {material: m, size: [60 mm, 20 mm], thickness: 0.1 mm, mass: 1 g, boxes: [6, 2]}
run: {analysis: static, tolerance: 1e-6}
"""
CLAMPED = 'sheets.strip.clamp={edge: x_min, length: "0 mm"}'
OPPOSITE = {"x_min": "x_max", "x_max": "x_min", "y_min": "y_max", "y_max": "y_min"}


def strip(*sets: str) -> Model:
    return lower(loads(STRIP, "strip", sets))


def solved(*sets: str) -> Strains:
    result = mdlgen.solve(strip(*sets), "lattice")
    assert result.ok, result.status
    assert result.strains is not None
    return result.strains


def placed(model: Model, position: np.ndarray, turn: Rotation) -> Result:
    """A result of one state: centres (n, 3) and rotations from the start."""
    result = moving(model, times=2, speed=0.0)
    result.position[:] = position
    start = Rotation.from_matrix(model.bodies.rotation)
    result.rotation[:] = np.roll((turn * start).as_quat(), 1, axis=1)
    return result


def found(result: Result) -> Strains:
    message = strains(result)
    assert message is not None
    return message


# ---------------------------------------------------------------- closed forms


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center"])
@pytest.mark.parametrize(("clamp", "modulus"), [("x_min", 100), ("x_max", 100), ("y_min", 50), ("y_max", 50)])
def test_a_pulled_strip_has_the_strain_of_its_stress_in_every_joint(
    layout: str, clamp: str, modulus: float
) -> None:
    message = solved(
        f"sheets.strip.layout={layout}",
        f'sheets.strip.clamp={{edge: {clamp}, length: "0 mm"}}',
        f"loads=[{{sheet: strip, edge: {OPPOSITE[clamp]}, stress: 1 MPa}}]",
        "sheets.strip.rotation=[20 deg, -40 deg, 130 deg]",
    )
    along = message.joints.axis == (0 if clamp[0] == "x" else 1)
    assert along.sum() == 12  # 5 x 2 and 2 hinges, or 6 and 6
    # sigma / E; the balance of the solver is good to 1e-9 of the force
    np.testing.assert_allclose(message.stretch.value[along], 1 / modulus, rtol=1e-6)
    np.testing.assert_allclose(message.squeeze.value[along], 1 / modulus, rtol=1e-6)
    assert np.abs(message.stretch.value[~along]).max() < 1e-9
    assert np.abs(message.curvature.value).max() < 1e-9 and np.abs(message.twist.value).max() < 1e-9


def test_a_strip_that_hangs_bears_the_weight_below() -> None:
    result = mdlgen.solve(lower(mdlgen.load(samples() / "verify" / "hanging.yaml")))
    message = found(result)
    along = message.joints.axis == 0
    below = 100.0 - message.joints.at[along, 0]  # mm of strip
    # rho g l / E, with the mass of whole boxes below the joint
    np.testing.assert_allclose(message.stretch.value[along], 1000 * 9.81 * below * 1e-3 / 100e6, rtol=1e-6)


@pytest.mark.parametrize("count", [6, 30])
@pytest.mark.parametrize("turn", ["0 deg", "35 deg"])
def test_a_strip_rolled_to_a_circle_has_one_curvature(count: int, turn: str) -> None:
    """The end moment 2 pi D W / L (oracles.md) closes the strip; the sheet bends towards -z of its axes."""
    moment = 2 * math.pi * 2.0 * 20 / 60
    message = solved(
        f"sheets.strip.boxes=[{count},2]",
        f"sheets.strip.turn={turn}",
        CLAMPED,
        f'loads=[{{sheet: strip, edge: x_max, moment: ["0 N*mm", "{moment!r} N*mm", "0 N*mm"]}}]',
    )
    along = message.joints.axis == 0
    np.testing.assert_allclose(message.curvature.value[along], -2 * math.pi / 60, rtol=1e-6)
    assert np.abs(message.curvature.value[~along]).max() < 1e-9
    assert np.abs(message.twist.value).max() < 1e-9


@pytest.mark.parametrize("clamp", list(OPPOSITE))
def test_a_strip_that_droops_bends_away_from_its_normal(clamp: str) -> None:
    message = solved(
        f'sheets.strip.clamp={{edge: {clamp}, length: "0 mm"}}',
        f"loads=[{{sheet: strip, edge: {OPPOSITE[clamp]}, force: [0 N, 0 N, -0.005 N]}}]",
    )
    along = message.joints.axis == (0 if clamp[0] == "x" else 1)
    assert (message.curvature.value[along] < 0).all()
    hinge = np.array([name.split("_")[1] == "c" for name in message.joints.name])
    # the moment is the greatest at the clamp: M / (D W) with the arm that is left of the bent strip
    assert np.abs(message.curvature.value[along]).argmax() in np.flatnonzero(hinge[along])


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center"])
def test_a_rigid_motion_bears_nothing(layout: str) -> None:
    model = strip(f"sheets.strip.layout={layout}", "sheets.strip.rotation=[70 deg, 10 deg, -160 deg]")
    result = moving(model, times=40, speed=0.0)
    random = np.random.default_rng(3)
    for t, (turn, shift) in enumerate(
        zip(Rotation.random(40, rng=3), random.normal(size=(40, 3)), strict=True)
    ):
        state = placed(model, turn.apply(model.bodies.position.copy()) + 100 * shift, turn)
        # q and -q are one rotation
        result.position[t], result.rotation[t] = state.position[0], state.rotation[0] * random.choice([-1, 1])
    message = found(result)
    for peak in (message.stretch, message.squeeze, message.curvature, message.twist):
        # round-off of positions of some 100 mm, over joints of 10 mm
        assert np.abs(peak.value).max() < 1e-13


def test_a_twisted_strip_has_its_twist() -> None:
    model = strip("sheets.strip.boxes=[6,1]")
    angle = 0.01 * model.bodies.position[:, 0]  # rad, about x
    message = found(placed(model, model.bodies.position, Rotation.from_rotvec(np.outer(angle, [1, 0, 0]))))
    # not more exact than the angle of a quaternion
    np.testing.assert_allclose(message.twist.value, 0.01, rtol=1e-12)
    assert np.abs(message.curvature.value).max() < 1e-15


@pytest.mark.parametrize(("layout", "most"), [("edge_to_edge", 0.02), ("center_to_center", 0.0)])
def test_a_turn_in_the_plane_pulls_one_corner(layout: str, most: float) -> None:
    """Two boxes, 10 by 20 mm, turned by t about the middle of their shared edge: 2 sin(t/2) 10 / 10."""
    model = strip(
        "sheets.strip.size=[20 mm, 20 mm]", "sheets.strip.boxes=[2,1]", f"sheets.strip.layout={layout}"
    )
    turn = Rotation.from_rotvec([[0, 0, 0], [0, 0, 2 * math.asin(0.01)]])
    message = found(placed(model, turn.apply(model.bodies.position.copy()), turn))
    assert message.stretch.value == pytest.approx([most], abs=1e-14)
    assert message.squeeze.value == pytest.approx([-most], abs=1e-14)


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center"])
def test_it_is_what_the_force_law_measures(layout: str) -> None:
    """From the energy of the solvers' own bushing with one spring of stiffness 1 at a time."""
    model = strip(
        f"sheets.strip.layout={layout}",
        "sheets.strip.boxes=[3,2]",
        "sheets.strip.rotation=[30 deg, 50 deg, 70 deg]",
        'sheets.strip.clamp={edge: y_max, length: "0 mm"}',
    )
    bodies, bushings = model.bodies, model.bushings
    random = np.random.default_rng(5)
    turn = Rotation.from_rotvec(random.normal(scale=0.6, size=(6, 3)))
    place = bodies.position + random.normal(scale=0.5, size=(6, 3))
    message = found(placed(model, place, turn))

    def measured(row: int, spring: int) -> float:
        ends: list[Any] = []
        for body in (bushings.a[row], bushings.b[row]):
            now = Rotation.identity() if body < 0 else turn[body]
            center = np.zeros(3) if body < 0 else bodies.position[body]
            arm = now.apply(bushings.origin[row] - center)
            frame = (now.as_matrix() @ bushings.axes[row]).ravel()
            at = center if body < 0 else place[body]
            ends += [Frame(tuple(at), tuple(frame), (0.0,) * 3, (0.0,) * 3), tuple(arm)]
        stiffness = tuple(float(k == spring) for k in range(6))
        zero = (0.0,) * 3
        return math.sqrt(2 * bushing(*ends, stiffness[:3], stiffness[3:], zero, zero)[3])

    joints = message.joints
    for k, name in enumerate(joints.name):
        rows = [r for r, other in enumerate(bushings.name) if other == name or other[:-2] == name]
        axis = joints.axis[k]
        strain_ = [measured(r, axis) / joints.length[k] for r in rows]
        most = max(abs(message.stretch.value[k]), abs(message.squeeze.value[k]))
        assert most == pytest.approx(max(strain_), rel=1e-9)
        least = [abs(v) for v in (message.stretch.value[k], message.squeeze.value[k])]
        assert sorted(least) == pytest.approx(sorted(strain_ * (2 // len(strain_))), rel=1e-9)
        bend = measured(rows[0], 4 if axis == 0 else 3) / joints.length[k]
        assert abs(message.curvature.value[k]) == pytest.approx(bend, rel=1e-9)
        twist = measured(rows[0], 3 if axis == 0 else 4) / joints.length[k]
        assert abs(message.twist.value[k]) == pytest.approx(twist, rel=1e-9)


# ---------------------------------------------------------------- joints and peaks


def test_joints_are_pairs_with_their_length_and_place() -> None:
    model = strip(
        'sheets.strip.clamp={edge: x_max, length: "10 mm"}', "sheets.strip.center=[5 mm, 6 mm, 7 mm]"
    )
    joints = sheet_joints(model)
    # 4 x 2 along x between 5 free columns, 5 along y, 2 hinges: two bushings each
    assert len(joints) == 8 + 5 + 2 == len(model.bushings) // 2
    table = {name: k for k, name in enumerate(joints.name)}
    assert joints.at[table["strip_x_0_0"]] == pytest.approx([-20, -5])
    assert joints.at[table["strip_y_0_0"]] == pytest.approx([-25, 0])
    assert joints.at[table["strip_c_4_1"]] == pytest.approx([20, 5])
    assert joints.length[table["strip_x_0_0"]] == joints.length[table["strip_y_0_0"]] == pytest.approx(10)
    assert joints.length[table["strip_c_4_1"]] == pytest.approx(5)
    assert joints.way[table["strip_c_4_1"]] == -1


def test_supports_are_no_joints() -> None:
    model = small_model('supports=[{sheet: note, at: ["0 mm", "0 mm"], fix: [z]}]')
    assert len(model.bushings) > 2 * len(sheet_joints(model)) == 14


def test_joints_are_worked_out_once_for_each_model_and_go_with_it() -> None:
    model = small_model()
    joints = sheet_joints(model)
    assert sheet_joints(model) is joints
    assert sheet_joints(replace(model)) is not joints
    left = weakref.ref(joints)
    del model, joints
    gc.collect()
    assert left() is None


@pytest.mark.parametrize("kept", [0, 10_000])
@pytest.mark.parametrize("chunk", [1, 3, 10_000])
def test_peaks_have_sign_and_time_however_they_are_sought(
    chunk: int, kept: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(strain, "_CHUNK", chunk)
    monkeypatch.setattr(strain, "_KEPT", kept)
    model = strip("sheets.strip.boxes=[3,1]", "run.analysis=transient", "run.duration=10 ms")
    result = moving(model, times=11, speed=0.0)
    result.position[:, 2, 0] += 0.2 * np.array([0, 1, 2, 3, 4, 3, 2, 1, 0, -3, 0])
    bent = Rotation.from_rotvec(np.outer([0, 0, 0, 0.1, 0, 0, -0.3, 0, 0, 0.2, 0], [0, 1, 0]))
    result.rotation[:, 0] = np.roll(bent.as_quat(), 1, axis=1)
    message = found(result)
    assert message.joints.name == ("strip_x_0_0", "strip_x_1_0")
    assert (message.stretch.value[1], message.stretch.at[1]) == (pytest.approx(0.8 / 20), 4.0)
    assert (message.squeeze.value[1], message.squeeze.at[1]) == (pytest.approx(-0.6 / 20), 9.0)
    # box 0 turned by -0.3 about y: from it to box 1 the sheet turns by 0.3, away from the normal
    assert (message.curvature.value[0], message.curvature.at[0]) == (pytest.approx(-0.3 / 20), 6.0)


# ---------------------------------------------------------------- what is reported


def test_the_summary_names_the_worst_joint(tmp_path: Path) -> None:
    result = mdlgen.solve(
        strip(
            CLAMPED,
            "loads=[{sheet: strip, edge: x_max, stress: 2 MPa}]",
            "gravity=[0 m/s^2, 0 m/s^2, -1 m/s^2]",
        )
    )
    result.save(tmp_path)
    record = json.loads((tmp_path / "summary.json").read_text())["sheets"]["strip"]
    assert set(record["strain"]) == {"max_md", "max_cd", "min_md", "min_cd", "at_mm", "at_ms", "joint"}
    assert set(record["curvature"]) == {"max_md_per_mm", "max_cd_per_mm", "at_mm", "at_ms", "joint"}
    assert set(record["twist"]) == {"max_per_mm", "at_mm", "at_ms", "joint"}
    # the pull, and the bend at the clamp
    assert record["strain"]["max_md"] == pytest.approx(0.02, rel=1e-2)
    assert record["curvature"]["joint"].startswith("strip_c_0_") and record["curvature"]["at_mm"][0] == -30
    kept = store.read(tmp_path)
    joints = kept["joints/name"]
    assert len(joints) == 12 + 6 == len(kept["joints/strain_max"])
    most = int(np.argmax(kept["joints/strain_max"]))
    assert joints[most] == record["strain"]["joint"]
    assert kept["joints/at"][most] == pytest.approx(record["strain"]["at_mm"])
    assert kept["joints/curvature"].min() == pytest.approx(-record["curvature"]["max_md_per_mm"])
    assert kept["joints/curvature_at"].shape == kept["joints/length"].shape == (18,)


def test_a_limit_gives_a_margin() -> None:
    result = mdlgen.solve(strip(CLAMPED, "loads=[{sheet: strip, edge: x_max, stress: 2 MPa}]"), "lattice")
    # those along y, whose kind is 1, follow no curve
    limit = np.where(result.model.bushings.kind == 1, np.nan, 0.05)
    message = strains(result, limit)
    assert message is not None and message.margin is not None
    np.testing.assert_allclose(message.margin[message.joints.axis == 0], 1 - 0.02 / 0.05, rtol=1e-6)
    assert np.isnan(message.margin[message.joints.axis == 1]).all()
    result.__dict__["strains"] = message
    bearing = result.summary()["sheets"]["strip"]["strain"]
    assert bearing["margin"] == pytest.approx(0.6, rel=1e-6)
    assert bearing["margin_joint"] in message.joints.name
    assert "margin" in store._joints(result)
    text = summary_text(result.summary())
    assert "strain up to 0.02 (strip_" in text and "60% left to the curve's end" in text


def test_a_single_box_bears_nothing_and_has_its_files(tmp_path: Path) -> None:
    model = lower(mdlgen.load(samples() / "verify" / "drop.yaml"))
    result = moving(model)
    assert result.strains is None
    record = result.summary()["sheets"]["block"]
    assert (record["strain"], record["curvature"], record["twist"]) == (None, None, None)
    result.save(tmp_path)
    assert "joints/name" not in store.read(tmp_path)
    assert strain_map(result).startswith(b"\x89PNG\r\n\x1a\n")


def test_the_map_is_the_same_twice_and_tells_a_bent_from_a_flat_sheet() -> None:
    flat = moving(strip())
    bent = mdlgen.solve(strip(CLAMPED, "gravity=[0 m/s^2, 0 m/s^2, -9.81 m/s^2]"), "lattice")
    assert strain_map(flat) == strain_map(flat) and strain_map(bent) == strain_map(bent)
    assert strain_map(flat) != strain_map(bent)


def test_compression_takes_of_the_margin_too() -> None:
    # a third of the stress at which the strip buckles, pi^2 D / (4 L^2 s)
    sets = (CLAMPED, "loads=[{sheet: strip, edge: x_max, stress: -0.005 MPa}]")
    result = mdlgen.solve(strip(*sets), "lattice")
    message = strains(result, np.full(len(result.model.bushings), 1e-3))
    assert message is not None and message.margin is not None
    np.testing.assert_allclose(message.margin[message.joints.axis == 0], 1 - 5e-5 / 1e-3, rtol=1e-6)
