"""`mdlgen live` follows a file: its edits, its mistakes, values that are turned, the newest of all runs."""

from __future__ import annotations

import base64
import os
import re
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from living import SMALL, Live, live, scene
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import solve
from mdlgen.spec.load import load

# Its first draft takes some seconds, the full run longer than a test waits.
LONG = ("boxes: [10, 20]", "boxes: [6, 8]"), ("duration: 50 ms", "duration: 200000 ms")


def says(spec: Path) -> list[str]:
    """The mistakes that `mdlgen check` reports."""
    done = CliRunner().invoke(app, ["check", str(spec)])
    assert done.exit_code == 2
    return done.stderr.splitlines()


def edit(spec: Path, old: str, new: str) -> None:
    """As editors save: another file in its place."""
    text = spec.read_text("utf-8")
    assert old in text
    other = spec.with_suffix(".tmp")
    other.write_text(text.replace(old, new), "utf-8")
    os.replace(other, spec)


def travel(made: Live) -> float:
    """Of the note, from the positions that the page draws [mm]."""
    animation = made.get("run")["animation"]
    place = np.frombuffer(base64.b64decode(animation["place"]), "<u2").reshape(-1, animation["bodies"], 3)
    boxes = place[:, : animation["boxes"], 0].mean(axis=1)
    return float((boxes[-1] - boxes[0]) * animation["step"][0])


def solved(spec: Path, *sets: str) -> float:
    result = solve(lower(load(spec, sets)))
    boxes = result.model.sheets[0].count
    return float((result.position[-1, :boxes, 0] - result.position[0, :boxes, 0]).mean())


def test_an_edit_is_followed_and_its_mistakes_are_at_their_lines(tmp_path: Path) -> None:
    spec = scene(tmp_path)
    with live(spec) as made:
        first = made.quiet()
        assert first["errors"] == [] and first["scene"] == "transport_nips"
        assert travel(made) == pytest.approx(solved(spec), abs=0.01)
        edit(spec, "speed: 1400.25 mm/s", "speed: 700 mm/s")
        made.until(lambda state: state["text"] != first["text"])
        made.quiet()
        assert travel(made) == pytest.approx(solved(spec), abs=0.01)
        assert made.get("text")["text"] == spec.read_text("utf-8")
        shown = made.get("state")["run"]
        # two mistakes; the run that was right stays
        edit(spec, "mass: 0.72 g", "mass: 0.72 N")
        edit(spec, "E_md: 3530 MPa", "E_md: 3530 MPas")
        state = made.until(lambda state: len(state["errors"]) == 2)
        assert [error["says"] for error in state["errors"]] == says(spec)
        lines = spec.read_text("utf-8").splitlines()
        assert "MPas" in lines[state["errors"][0]["line"] - 1]
        assert "0.72 N," in lines[state["errors"][1]["line"] - 1]
        assert made.get("state")["run"] == shown
        # what is no YAML, and no file
        edit(spec, "name: transport_nips", "name: [")
        state = made.until(lambda state: len(state["errors"]) == 1)
        assert [error["says"] for error in state["errors"]] == says(spec)
        text = spec.read_text("utf-8")
        spec.unlink()
        made.until(lambda state: state["errors"] and "cannot read" in state["errors"][0]["says"])
        for old, new in (("name: [", "name: other"), ("0.72 N", "0.72 g"), ("MPas", "MPa")):
            text = text.replace(old, new)
        spec.write_text(text, "utf-8")
        state = made.until(lambda state: state["scene"] == "other")
        assert made.quiet()["errors"] == []


def test_a_scene_that_is_wrong_from_the_start_is_followed(tmp_path: Path) -> None:
    spec = scene(tmp_path)
    edit(spec, "mass: 0.72 g", "mass: 0.72 N")
    with live(spec) as made:
        state = made.until(lambda state: bool(state["errors"]))
        assert [error["says"] for error in state["errors"]] == says(spec)
        assert made.get("controls") == [] and state["run"]["kind"] is None
        edit(spec, "mass: 0.72 N", "mass: 0.72 g")
        state = made.until(lambda state: state["run"]["kind"] == "full")
        assert state["errors"] == [] and len(made.get("controls")) > 20


def test_the_reference_solver_runs_a_scene_too(tmp_path: Path) -> None:
    """Without drafts; a newer value ends its run as well."""
    spec = scene(tmp_path, "verify/slide", ("duration: ", "duration: 10"))
    with live(spec, "--solver", "exudyn") as made:
        made.until(lambda state: state["progress"] is not None or state["run"]["kind"] == "full")
        made.turn(run__duration="5 ms")
        state = made.quiet()
        assert state["run"]["kind"] == "full" and state["command"].endswith("--solver exudyn")
        assert made.get("run")["animation"]["time"][-1] == 5.0


def test_values_are_turned_and_stay_where_the_file_is_edited(tmp_path: Path) -> None:
    spec = scene(tmp_path)
    with live(spec, "--set", "parameters.radius=8 mm") as made:
        made.quiet()
        made.turn(parameters__speed="800 mm/s")
        state = made.quiet()
        assert state["turned"] == {"parameters.speed": "800 mm/s"}
        assert travel(made) == pytest.approx(
            solved(spec, "parameters.radius=8 mm", "parameters.speed=800 mm/s"), abs=0.01
        )
        edit(spec, "mass: 0.72 g", "mass: 0.80 g")
        state = made.until(lambda s: s["text"] != state["text"])
        assert state["turned"] == {"parameters.speed": "800 mm/s"}
        # one that is edited has the value of the file
        edit(spec, "speed: 1400.25 mm/s", "speed: 500 mm/s")
        state = made.until(lambda s: s["turned"] == {})
        made.quiet()
        assert travel(made) == pytest.approx(solved(spec, "parameters.radius=8 mm"), abs=0.01)
        # a value that is wrong says so at its path, and None is that of the file
        made.turn(sheets__note__mass="0.1 N")
        (error,) = made.quiet()["errors"]
        assert error["path"] == "sheets.note.mass" and "wrong unit" in error["says"]
        made.turn(sheets__note__mass=None)
        assert made.until(lambda s: not s["errors"] and s["busy"] is None)["turned"] == {}


def test_one_slider_turns_several_values(tmp_path: Path) -> None:
    spec = scene(tmp_path, "transport_4x4")
    path = "rollers.motor_*.drive.speed"
    with live(spec) as made:
        made.quiet()
        assert made.post("turn", {"values": {path: "90 rad/s"}})[0] == 409
        assert made.post("add", {"path": "rollers.*.axis"})[0] == 409
        assert made.post("add", {"path": path}) == (200, {})
        assert made.get("controls")[-1]["path"] == path
        assert made.post("turn", {"values": {path: "90 rad/s"}}) == (200, {})
        assert made.quiet()["command"] == f"mdlgen run {spec} --set 'rollers.motor_*.drive.speed=90 rad/s'"
        assert travel(made) == pytest.approx(solved(spec, f"{path}=90 rad/s"), abs=0.01)
        # it follows the file, and goes with what it meets
        edit(spec, "186.7 rad/s", "100 rad/s")
        made.until(lambda _: made.get("controls")[-1]["number"] == 100.0)
        assert made.post("write", {}) == (200, {})
        assert "100 rad/s" not in spec.read_text("utf-8") and spec.read_text("utf-8").count("90 rad/s") == 4


def test_a_file_that_the_scene_names_is_followed(tmp_path: Path) -> None:
    spec = scene(tmp_path, "pick", ("run: {", "run: {print_step: 1 ms, "))
    shape = (samples() / "meshes" / "lobe.obj").read_text("utf-8")
    (tmp_path / "meshes").mkdir()
    for file in (samples() / "meshes").iterdir():
        (tmp_path / "meshes" / file.name).write_bytes(file.read_bytes())
    with live(spec) as made:
        before = made.until(lambda state: state["run"]["kind"] is not None)
        (tmp_path / "notes.txt").write_text("of no concern")
        time.sleep(0.5)
        assert made.get("state")["text"] == before["text"]
        (tmp_path / "meshes" / "lobe.obj").write_text("f 1 2 3\n", "utf-8")
        state = made.until(lambda state: bool(state["errors"]))
        assert [error["says"] for error in state["errors"]] == says(spec)
        (tmp_path / "meshes" / "lobe.obj").write_text(shape, "utf-8")
        made.until(lambda state: not state["errors"])


def test_the_newest_value_wins(tmp_path: Path) -> None:
    """A run of minutes goes on; values that are turned meanwhile end it, and the last one is shown."""
    spec = scene(tmp_path, "transport_nips", *LONG)
    with live(spec) as made:
        made.until(lambda state: state["progress"] is not None)
        (worker,) = made.children()
        began = time.monotonic()
        for speed in (500, 600, 700, 800):
            made.turn(parameters__speed=f"{speed} mm/s")
        made.turn(parameters__speed="900 mm/s", run__duration="6 ms")
        state = made.quiet()
        took = time.monotonic() - began
        assert state["turned"] == {"parameters.speed": "900 mm/s", "run.duration": "6 ms"}
        assert made.get("run")["animation"]["time"][-1] == 6.0
        assert travel(made) == pytest.approx(
            solved(spec, "parameters.speed=900 mm/s", "run.duration=6 ms"), abs=0.01
        )
        # at most two drafts were waited for; the process is the same one
        assert took < 30.0 and made.children() == [worker]


def test_a_run_that_cannot_be_stopped_is_ended_with_its_process(tmp_path: Path) -> None:
    """Its process is ended, and another one runs the newest value."""
    spec = scene(
        tmp_path,
        "transport_nips",
        *SMALL,
    )
    with live(spec) as made:
        made.quiet()
        (worker,) = made.children()
        os.kill(worker, 19)  # it stands still: nothing that is sent is heard
        made.turn(parameters__speed="900 mm/s")
        made.until(lambda state: state["busy"] is not None)
        time.sleep(0.5)  # a draft has a moment
        made.turn(parameters__speed="950 mm/s")
        state = made.quiet()
        assert state["turned"] == {"parameters.speed": "950 mm/s"}
        assert travel(made) == pytest.approx(solved(spec, "parameters.speed=950 mm/s"), abs=0.01)
        assert worker not in made.children() and len(made.children()) == 1


def test_a_worker_that_is_killed_is_reported_and_replaced(tmp_path: Path) -> None:
    spec = scene(tmp_path, "transport_nips", *LONG)
    with live(spec) as made:
        made.until(lambda state: state["progress"] is not None)
        (worker,) = made.children()
        os.kill(worker, 9)
        state = made.until(lambda state: bool(state["errors"]))
        assert "the process of the run has ended" in state["errors"][0]["says"]
        made.turn(run__duration="6 ms")
        assert made.quiet()["errors"] == []


def test_a_long_run_grows_on_the_page(tmp_path: Path) -> None:
    spec = scene(tmp_path, "transport_nips", *LONG)
    with live(spec) as made:
        ends: list[float] = []
        numbers = set()
        end = time.monotonic() + 120.0
        while len(set(ends)) < 4 and time.monotonic() < end:
            state = made.get("state")
            if state["run"]["kind"] == "part" and state["run"]["number"] not in numbers:
                numbers.add(state["run"]["number"])
                animation = made.get("run")["animation"]
                ends.append(animation["time"][-1])
                assert len(animation["time"]) <= 81  # a part is small however long the run is
                progress: Any = state["progress"]
                assert progress is None or 0.0 < progress["time"] <= progress["end"] == 200000.0
            time.sleep(0.05)
        assert ends == sorted(ends) and len(set(ends)) == 4


def test_a_requirement_has_its_verdict(tmp_path: Path) -> None:
    spec = scene(tmp_path)
    spec.write_text(spec.read_text("utf-8") + "require: [no jam, speed above 2000 mm/s]\n", "utf-8")
    with live(spec) as made:
        made.quiet()
        html = made.get("run")["html"]
        assert "FAIL</b> speed above 2000 mm/s" in html["headline"] and "pass</b> no jam" in html["headline"]


def test_a_rule_s_delay_is_turned(tmp_path: Path) -> None:
    """The mark of the rule and the note's way follow, and the file has the delay where it is written."""
    look, eye = "when: eye covered, after: look, do", "[[70 mm, 0 mm, -5 mm], [70 mm, 0 mm, 5 mm]]"
    near = eye.replace("70 mm", "40 mm")
    changes = ((look, look.replace("look", "3 ms")), (eye, near), ("boxes: [10, 10]", "boxes: [2, 2]"))
    spec = scene(tmp_path, "register", *changes, ("duration: 150 ms", "duration: 20 ms"))
    with live(spec) as made:
        made.quiet()
        control = next(c for c in made.get("controls") if c["path"] == "rules.0.after")
        assert (control["group"], control["number"], control["unit"]) == ("rules.0 (eye covered)", 3.0, "ms")
        marks, ways = [_mark(made)], [travel(made)]
        made.turn(rules__0__after="7 ms")
        state = made.quiet()
        assert state["turned"] == {"rules.0.after": "7 ms"} and state["errors"] == []
        marks.append(_mark(made))
        ways.append(travel(made))
        assert made.post("write", {}) == (200, {})
    assert marks[1] - marks[0] == pytest.approx(4.0, abs=0.01)
    # 4 ms more at 1400 mm/s; the eye sees the edge at the same time
    assert ways[1] - ways[0] == pytest.approx(4.0 * 1.4, abs=0.05)
    assert ways[1] == pytest.approx(solved(spec), abs=0.01)
    assert look.replace("look", "7 ms") in spec.read_text("utf-8")


def _mark(made: Live) -> float:
    """When the page says that rule 0 acted [ms]."""
    (time,) = re.findall(
        r'data-time="([\d.]+)"><line class="mark"[^>]*/>.{0,80}<title>rule 0',
        made.get("run")["html"]["events"],
    )
    return float(time)


def test_a_static_scene_is_run_without_a_draft(tmp_path: Path) -> None:
    spec = scene(tmp_path, "cantilever", ("name: cantilever", "name: cantilever"))
    with live(spec) as made:
        state = made.quiet()
        assert state["run"]["status"] == "ok" and made.get("run")["animation"]["static"]
