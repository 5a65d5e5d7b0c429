"""The command that runs a scene: its files, its exit codes, an interrupt."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from called import Run, files
from synthetic import moving

from mdlgen import registry
from mdlgen.backend import Backend
from mdlgen.cli import shell
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.io.store import load
from mdlgen.results.result import Result

FOUR = samples() / "transport_4x4.yaml"
SMALL = ["--set", "sheets.note.boxes=[2,3]"]
DROP = [str(samples() / "verify" / "drop.yaml"), "--set", "run.duration=60 ms"]


class Fake:
    """A solver that answers at once."""

    def __init__(self, error: float = 0.0, status: str = "ok"):
        self.error, self.status = error, status

    def solve(self, model: Model, progress: object = None, step: float | None = None) -> Result:
        print("a solver that talks")
        found = moving(model, shift=0.0 if step else self.error).failed(self.status)
        return replace(found, steps=200 if step else 100)


def test_run_writes_all_files(mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
    ended = mdl("run", FOUR, *SMALL)
    assert ended.code == 0
    # lints come first, here of boxes that are too long for their rollers
    assert {line.partition(" ")[0] for line in ended.err.splitlines()} == {"W104"}
    names = ["result.h5", "series.csv", "summary.json"]
    assert files(tmp_path) == [f"out/transport_4x4/{n}" for n in names]
    assert "travel (70, 0, 0) mm" in ended.out and "talks" not in ended.out
    assert mdl("run", FOUR, *SMALL, "-q", "-o", "quiet").out == ""


def test_the_page_is_written_when_asked_for_and_anew_where_there_is_one(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
    page = tmp_path / "d" / "report.html"
    mdl("run", FOUR, *SMALL, "-o", "d")
    assert not page.exists()
    mdl("run", FOUR, *SMALL, "-o", "d", "--page")
    old = page.read_text("utf-8")
    mdl("run", FOUR, *SMALL, "--set", "name=other", "-o", "d")
    assert "<title>transport_4x4" in old and "<title>other" in page.read_text("utf-8")


def test_pictures_are_drawn_when_asked_for_and_anew_where_there_are_some(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
    mdl("run", FOUR, *SMALL, "-o", "d", "--pictures")
    old = (tmp_path / "d" / "report.png").read_bytes()
    assert old.startswith(b"\x89PNG") and (tmp_path / "d" / "strain.png").exists()
    mdl("run", FOUR, *SMALL, "--set", "name=other", "-o", "d")
    new = (tmp_path / "d" / "report.png").read_bytes()
    assert new.startswith(b"\x89PNG") and new != old
    (tmp_path / "d" / "strain.png").unlink()
    mdl("report", "d", "--pictures")
    assert (tmp_path / "d" / "report.png").read_bytes() == new and (tmp_path / "d" / "strain.png").exists()


def test_a_run_that_ends_early_is_written_and_marked(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What there is up to then takes the place of the run before; text and page begin with the mark."""
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
    mdl("run", FOUR, *SMALL, "-o", "d")
    why = "Newton at 3 ms in box note_1_1"

    def solve(model: Model, *_: object, **__: object) -> Result:
        whole = moving(model)
        names = ("time", "position", "rotation", "velocity", "spin", "contact_force")
        part = {name: getattr(whole, name)[:4] for name in names}
        return replace(whole, **part, contact_torque=None, contact_friction=None, status=why)

    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=solve))
    ended = mdl("run", FOUR, *SMALL, "--set", 'require=["no jam"]', "-o", "d", "--page")
    record = json.loads((tmp_path / "d" / "summary.json").read_text())
    mark = f"ended early, at {record['t_end_ms']:.6g} of {record['duration_ms']:g} ms: {why}"
    assert ended.code == 4 and ended.out.splitlines()[0] == mark == record["mark"]
    assert "FAIL  no jam: not known" in ended.out
    assert f"{mark}; the files in d hold what there is up to then" in ended.err
    page = (tmp_path / "d" / "report.html").read_text("utf-8")
    assert 0 < page.index(why) < page.index("<nav")
    assert load(tmp_path / "d").status == why and record["status"] == why
    assert len((tmp_path / "d" / "series.csv").read_text().splitlines()) == 5
    assert mdl("report", "d").code == 0 and why in (tmp_path / "d" / "report.html").read_text("utf-8")


def test_a_missed_tolerance_is_exit_5_and_keeps_the_files(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # 1 mm of 70: 1.4 %
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake(error=1.0).solve))
    ended = mdl("run", FOUR, *SMALL, "-o", "d", "--check-step")
    assert ended.code == 5
    assert "is 1.4 %, above run.tolerance 0.1 %" in ended.err and "files in d hold" in ended.err
    assert ended.out.startswith("inaccurate: the error estimate of rollers.counter_1_left.slide is 1.4 %")
    record = json.loads((tmp_path / "d" / "summary.json").read_text())
    assert record["error_estimate"] == pytest.approx(1 / 70, rel=1e-9)
    assert record["status"] == "inaccurate" and load(tmp_path / "d").usable
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake(error=0.01).solve))
    assert mdl("run", FOUR, *SMALL, "-o", "d", "--check-step").code == 0


def test_an_error_that_is_not_known_is_exit_5_and_keeps_the_files(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    why = "the error is not known: a run at twice the step fails: 5 % of energy got lost"

    def solve(model: Model, *_: object, **__: object) -> Result:
        return replace(moving(model), error_estimate_of="sheets.note.position", error_unknown=why)

    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=solve))
    ended = mdl("run", FOUR, *SMALL, "-o", "d", "--page")
    assert ended.code == 5 and f"{why}; the files in d hold this result" in ended.err
    assert f"\n{why}\n" in ended.out and why in (tmp_path / "d" / "report.html").read_text("utf-8")
    assert json.loads((tmp_path / "d" / "summary.json").read_text())["error_unknown"] == why
    assert load(tmp_path / "d").error_unknown == why


@pytest.mark.parametrize(
    ("limit", "error", "code", "verdict"),
    [
        (10.0, 0.0, 0, "pass  "),
        (0.03, 0.01, 0, "pass, but within the error  "),
        (10.0, 1.0, 5, "pass  "),
        (3.0, 1.0, 5, "pass, but within the error  "),
        (-3.0, 1.0, 5, "FAIL, but within the error  "),
        (-10.0, 1.0, 6, "FAIL  "),
        (-0.03, 0.01, 6, "FAIL, but within the error  "),
    ],
)
def test_a_requirement_is_judged_with_the_error_of_the_run(
    limit: float, error: float, code: int, verdict: str,
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    """The sheet goes along x; a coarser run has it lifted by the error, of which the tolerance
    allows 0.07 mm. The margin of doubt is four times that."""
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake(error=error).solve))
    text = f"sheets.note.travel.z below {limit} mm"
    require = f'require=["{text}"]'
    ended = mdl("run", FOUR, *SMALL, "--set", require, "-o", "d", "--check-step", "--page")
    assert ended.code == code, ended.err
    assert f"\n{verdict}{text}" in ended.out
    row = json.loads((tmp_path / "d" / "summary.json").read_text())["verdict"]["requirements"][0]
    assert row["doubtful"] == ("within the error" in verdict)
    assert ("but within the error" in (tmp_path / "d" / "report.html").read_text("utf-8")) == row["doubtful"]
    assert load(tmp_path / "d").verdict[0].doubtful == row["doubtful"]


def test_an_unknown_solver_is_refused_before_anything_runs(mdl: Run, tmp_path: Path) -> None:
    ended = mdl("run", FOUR, "--solver", "adams")
    assert ended.code == 2 and "there are: auto, exudyn" in ended.err
    assert files(tmp_path) == []


def test_a_bad_folder_is_refused_before_the_run(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(name: str) -> None:
        raise AssertionError("the solver was asked for")

    monkeypatch.setattr(registry, "solver", never)
    (tmp_path / "taken").write_text("mine")
    for target in ("taken", "taken/below"):
        assert mdl("run", FOUR, "-o", target).code == 3
    assert (tmp_path / "taken").read_text() == "mine"


def test_run_drop(mdl: Run, tmp_path: Path) -> None:
    ended = mdl("run", *DROP, "-o", "d", "--check-step")
    # the first run of all has a line on what is prepared or compiled
    assert ended.code == 0 and set(ended.err.splitlines()) <= {shell.COMPILING, shell.PREPARING}
    record = json.loads((tmp_path / "d" / "summary.json").read_text())
    assert record["status"] == "ok"
    # free fall: g t^2 / 2; the integrator is exact for a parabola but for Newton's tolerance
    assert record["sheets"]["block"]["travel_mm"] == pytest.approx([0, 0, -9.81e-3 * 60**2 / 2], abs=1e-6)
    assert record["error_estimate"] < 1e-6


def test_run_cantilever(mdl: Run, tmp_path: Path) -> None:
    coarse = ["--set", "sheets.note.boxes=[2,20]"]
    ended = mdl("run", samples() / "cantilever.yaml", *coarse, "-o", "d", "--check-step")
    assert ended.code == 0 and "static" in ended.err
    record = json.loads((tmp_path / "d" / "summary.json").read_text())
    assert record["error_estimate"] is None
    # 76.53 mm is the heavy elastica; 20 boxes along the length give 0.2 %
    assert record["probes"]["tip"]["displacement_mm"][2] == pytest.approx(-76.53, rel=0.005)


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_an_interrupt_ends_with_130_and_writes_nothing(tmp_path: Path) -> None:
    args = [sys.executable, "-m", "mdlgen", "run", str(FOUR), "-o", "d", "--solver", "exudyn"]
    process = subprocess.Popen(args, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(5.0)  # past the imports and the compiled kernels, into the steps
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out) == (130, "")
    assert "Traceback" not in err
    assert files(tmp_path) == []


def test_compiling_is_reported_once_loading_is_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On no terminal one line, from the first part that is compiled on."""
    import logging

    lines: list[str] = []
    monkeypatch.setattr(shell, "say", lines.append)
    with shell.progress_bar(quiet=False, twice=False) as progress:
        assert progress is None
        assert lines == []
        for done in range(1, 4):
            logging.getLogger("mdlgen.compiling").info("%d", done, extra={"parts": done})
    assert lines == [shell.COMPILING]
    logging.getLogger("mdlgen.compiling").info("%d", 9, extra={"parts": 9})
    assert lines == [shell.COMPILING]
