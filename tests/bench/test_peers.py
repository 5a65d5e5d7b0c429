"""Other tools beside ours in the bench: that they run the same scene, and what is said where they cannot."""

from __future__ import annotations

import json

import numpy as np
import pytest
from asked import as_asked
from typer.testing import CliRunner

from mdlgen.bench import peers, process
from mdlgen.bench.case import Run
from mdlgen.bench.peers import PEERS, exudyn_script, mujoco_flex
from mdlgen.bench.peers.scene import Motion, anchor, lanes
from mdlgen.bench.row import Outcome
from mdlgen.bench.run import bench
from mdlgen.bench.suites import cases, transport
from mdlgen.bench.suites.transport import peer
from mdlgen.cli import app
from mdlgen.errors import RefusedError, SpecError
from mdlgen.results.result import Result

SHORT = Run("transport_4x4", ("run.duration=3 ms", "run.print_step=0.1 ms"), 0.1)
SOLVERS = {"mujoco": mujoco_flex.solve, "exudyn-script": exudyn_script.solve}
needs_mujoco = pytest.mark.skipif(not peers.installed(), reason="the extra `peers` is not installed")


@pytest.fixture(params=[pytest.param("mujoco", marks=needs_mujoco), "exudyn-script"])
def moved(request: pytest.FixtureRequest) -> Result:
    return SOLVERS[request.param](SHORT.model())


def test_a_peer_draws_the_sheet_as_the_drive_says(moved):
    assert as_asked(moved), moved.status
    assert moved.time == pytest.approx(np.arange(31) * 0.1, abs=1e-6)
    boxes = moved.model.sheets[0].count
    travel = (moved.position[-1] - moved.model.bodies.position)[:boxes].mean(axis=0)
    # 186.7 rad/s after 5 ms on 7.5 mm: 1.26 mm in 3 ms; a soft contact lags by some hundredths of a mm
    assert travel[0] == pytest.approx(0.1867 * 7.5 * 3.0**2 / 10, abs=0.1)
    assert abs(travel[1]) < 0.01 and abs(travel[2]) < 0.1
    # the sheet stays a sheet
    apart = np.linalg.norm(np.diff(moved.position[-1, :10], axis=0), axis=1)
    assert apart == pytest.approx(np.full(9, 6.7), abs=0.05)


def test_a_peer_refuses_what_it_is_not_written_for():
    for change in ("sheets.note.turn=10 deg", "sheets.note.clamp={edge: y_min, length: 0 mm}"):
        with pytest.raises(RefusedError, match=r"written for a flat sheet"):
            exudyn_script.solve(Run("transport_4x4", (change,)).model())


@needs_mujoco
def test_mujoco_refuses_a_step_that_misses_the_stored_times():
    with pytest.raises(RefusedError, match="is no part of"):
        mujoco_flex.solve(SHORT.model(), step=0.03)


def test_the_spring_of_a_pressed_roller_has_its_preload_where_it_touches():
    roller = SHORT.model().roller("counter_1_left")
    assert roller.press is not None
    end, length = anchor(roller)
    touching = roller.center + roller.press.touch * roller.press.direction
    pressed = length - np.linalg.norm(touching - end)
    assert pressed * roller.press.stiffness == pytest.approx(roller.press.preload, rel=1e-12)


def test_a_roller_stands_on_two_rows_of_boxes():
    model = SHORT.model()
    found = lanes(model, model.roller("motor_1_right"))
    # 18 to 23 mm, with an edge of boxes at 19.05 mm
    assert [lane.row for lane in found] == [12, 13]
    assert [lane.share for lane in found] == pytest.approx([0.21, 0.79])
    assert [lane.offset for lane in found] == pytest.approx([-1.975, 0.525])


def test_the_error_of_the_mean_displacement_stands_by_itself():
    model = SHORT.model()
    times, start = np.array([0.0, 1.0]), model.bodies.position[:200]
    still = Motion(times, np.stack([start, start]), 0.1, 10, 1.0, 0.0).result(model, "a", "ok")
    # half of the boxes 1 mm up, half of them 1 mm down: no mean displacement
    up = np.where(np.arange(200) % 2, 1.0, -1.0)[:, None] * (0.0, 0.0, 1.0)
    bent = Motion(times, np.stack([start, start + up]), 0.1, 10, 1.0, 0.0).result(model, "b", "ok")
    position, mean = peer(bent, still)
    assert position.error == pytest.approx(np.sqrt(0.5) / 12.7)  # of a tenth of the sheet's length
    assert mean.error == pytest.approx(0.0, abs=1e-12)
    assert mean.quantity.startswith("mean displacement")


@pytest.mark.parametrize("solver", PEERS)
def test_the_cases_of_a_peer_are_the_scene_of_ours_and_share_its_reference(solver):
    made, ours = (cases("transport", name, ("exudyn", "lattice"), False) for name in (solver, "lattice"))
    assert {case.reference for case in made} == {ours[0].reference}
    assert {case.run.overrides for case in made} == {ours[0].run.overrides}
    assert {case.run.command(solver) for case in made} == {f"mdlgen bench transport --solver {solver}"}


def test_peers_run_transport_alone_and_after_ours(tmp_path, monkeypatch):
    monkeypatch.setattr(process, "run", lambda task, checkout=None: Outcome("ok", [], 0.1, 1, 1.0))
    monkeypatch.setattr("mdlgen.bench.run.installed", lambda: True)
    heard: list[str] = []
    bench(["impact", "transport"], tmp_path, quick=True, say=heard.append)
    order = [line.split(" ", 1)[1].split(":")[0] for line in heard if "/" in line.split(" ")[0]]
    assert order[-2:] == [f"transport, {name}" for name in PEERS]
    assert not [line for line in order if line.startswith("impact") and line.split(", ")[1] in PEERS]


def test_where_mujoco_is_not_installed_that_is_said(tmp_path, monkeypatch):
    monkeypatch.setattr(process, "run", lambda task, checkout=None: Outcome("ok", [], 0.1, 1, 1.0))
    monkeypatch.setattr("mdlgen.bench.run.installed", lambda: False)
    heard: list[str] = []
    bench(["transport"], tmp_path, quick=True, say=heard.append)
    assert peers.MISSING in heard and not [line for line in heard if "transport, mujoco" in line]
    with pytest.raises(SpecError, match=r"pip install 'mdlgen\[peers\]'"):
        bench(["transport"], tmp_path, quick=True, peers=True)
    monkeypatch.setattr(mujoco_flex, "import_module", _missing)
    with pytest.raises(RefusedError, match="MuJoCo is not installed"):
        mujoco_flex.solve(SHORT.model())


def _missing(name: str) -> None:
    raise ModuleNotFoundError(name)


def test_no_peers_leaves_them_out(tmp_path, monkeypatch):
    monkeypatch.setattr(process, "run", lambda task, checkout=None: Outcome("ok", [], 0.1, 1, 1.0))
    heard: list[str] = []
    bench(["transport"], tmp_path, quick=True, say=heard.append, peers=False)
    assert not [line for line in heard if any(name in line for name in PEERS)]


def test_a_peer_that_fails_is_no_failure_of_the_bench(tmp_path, monkeypatch):
    monkeypatch.setattr(process, "run", lambda task, checkout=None: Outcome("stopped at 3 ms"))
    found = bench(["transport"], tmp_path, ["exudyn-script"], quick=True)
    assert [row.status for row in found.rows] == ["failed"] and not found.failed


@pytest.mark.parametrize("solver", [pytest.param("mujoco", marks=needs_mujoco), "exudyn-script"])
def test_a_row_of_a_peer_end_to_end(tmp_path, monkeypatch, solver):
    monkeypatch.setattr(transport, "OTHER_FINEST", 0.05)  # the reference need not be the bench's own
    ended = CliRunner().invoke(
        app, ["bench", "transport", "--quick", "--repeat", "1", "--solver", solver, "-o", str(tmp_path)]
    )
    assert ended.exit_code == 0, ended.output
    rows = json.loads((tmp_path / "bench.json").read_text())["rows"]
    assert [row["quantity"].partition(",")[0] for row in rows] == ["position", "mean displacement"]
    for row in rows:
        assert row["status"] == "ok" and row["solver"] == solver and row["wall_s"] > 0
        assert row["error"] < 0.05
        assert row["command"].endswith(f"--solver {solver} --quick")
