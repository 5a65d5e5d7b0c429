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
        return moving(model, shift=0.0 if step else self.error).failed(self.status)


def test_run_writes_all_files(mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
    ended = mdl("run", FOUR, *SMALL)
    assert ended.code == 0
    # lints come first, here of boxes that are too long for their rollers
    assert {line.partition(" ")[0] for line in ended.err.splitlines()} == {"W104"}
    names = ["report.html", "result.h5", "series.csv", "summary.json"]
    assert files(tmp_path) == [f"out/transport_4x4/{n}" for n in names]
    assert "travel (70, 0, 0) mm" in ended.out and "talks" not in ended.out
    assert mdl("run", FOUR, *SMALL, "-q", "-o", "quiet").out == ""


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


def test_a_failed_run_writes_nothing(mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        registry, "solver", lambda name: Backend(solve=Fake(status="Newton at 3 ms in box note_1_1").solve)
    )
    ended = mdl("run", FOUR, *SMALL, "-o", "d")
    assert (ended.code, ended.out) == (4, "")
    *lints, reason = ended.err.splitlines()
    assert "Newton at 3 ms in box note_1_1" in reason and all(lint.startswith("W104 ") for lint in lints)
    assert files(tmp_path) == [] and not (tmp_path / "d").exists()


def test_a_failed_run_leaves_the_old_result(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake().solve))
    mdl("run", FOUR, *SMALL, "-o", "d")
    old = {n: (tmp_path / n).read_bytes() for n in files(tmp_path)}
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake(status="no").solve))
    assert mdl("run", FOUR, *SMALL, "-o", "d").code == 4
    assert {n: (tmp_path / n).read_bytes() for n in files(tmp_path)} == old


def test_a_missed_tolerance_is_exit_5_and_keeps_the_files(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # 1 mm of 70: 1.4 %
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake(error=1.0).solve))
    ended = mdl("run", FOUR, *SMALL, "-o", "d", "--check-step")
    assert ended.code == 5
    assert "above run.tolerance 0.001" in ended.err and "d" in ended.err
    record = json.loads((tmp_path / "d" / "summary.json").read_text())
    assert record["error_estimate"] == pytest.approx(1 / 70, rel=1e-9)
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake(error=0.01).solve))
    assert mdl("run", FOUR, *SMALL, "-o", "d", "--check-step").code == 0


def test_an_error_that_is_not_known_is_exit_5_and_keeps_the_files(
    mdl: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    why = "the error is not known: a run at twice the step fails: 5 % of energy got lost"

    def solve(model: Model, *_: object, **__: object) -> Result:
        return replace(moving(model), error_estimate_of="sheets.note.position", error_unknown=why)

    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=solve))
    ended = mdl("run", FOUR, *SMALL, "-o", "d")
    assert ended.code == 5 and f"{why}; the files in d hold this result" in ended.err
    assert f"\n{why}\n" in ended.out and why in (tmp_path / "d" / "report.html").read_text("utf-8")
    assert json.loads((tmp_path / "d" / "summary.json").read_text())["error_unknown"] == why
    assert load(tmp_path / "d").error_unknown == why


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
