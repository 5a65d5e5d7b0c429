"""The suite `core`: its scenes, their finer runs, and its table."""

from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner

from mdlgen.bench.campaign.drawn_run import DrawnRun
from mdlgen.bench.campaign.scene import drawn
from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.core_table import HEAD, cells
from mdlgen.bench.reference import file_of
from mdlgen.bench.row import Outcome, rows
from mdlgen.bench.suites import cases
from mdlgen.bench.suites.core import DRAWN, SEED
from mdlgen.cli import app


def test_ten_scenes_of_a_campaign_are_of_ten_kinds() -> None:
    kinds = [kind for kind, _ in DRAWN.values()]
    assert len(set(kinds)) == len(kinds) == 10
    assert [drawn(SEED, number).kind for number in DRAWN] == kinds


def test_finer_runs_are_of_the_same_scene_and_have_files_of_their_own(tmp_path: Path) -> None:
    made = cases("core", "lattice", ("exudyn", "lattice"), quick=False)
    assert len(made) == len({case.name for case in made}) == 17
    assert cases("core", "exudyn", ("exudyn", "lattice"), quick=False) == []
    files = set()
    for case in made:
        if case.reference is None:
            assert case.name.startswith("feeder")
            continue
        finer = case.reference.run
        assert case.run.step is None and finer.step is not None and finer.step < 0.02
        assert type(finer) is type(case.run) and finer.sample == case.run.sample
        files.add(file_of(case.reference, "mdlgen.backends.lattice", tmp_path))
    assert len(files) == 15


def test_a_drawn_scene_takes_a_step() -> None:
    run = DrawnRun("campaign_23", step=0.05, seed=SEED, number=23)
    assert run.model().run.step == 0.05 and run.text().startswith("name: gate")
    assert run.command("lattice") == "mdlgen bench campaign --seed 1 --only 23 --solver lattice"


def test_the_table_shows_what_a_scene_took() -> None:
    case = BenchCase("core", "x", Run("stack"), lambda result, reference: [])
    counts = {
        "planned": 100.0,
        "given_up": 2.0,
        "factors": 7.0,
        "solves": 9.0,
        "state": float(0xABCDEF1234567),
    }
    done = Outcome("ok", [Finding("energy balance", 1e-3, None, counts)], 0.1, 110, iterations=220, cpu=0.5)
    shown = dict(zip(HEAD, cells(rows(case, "lattice", done)[0]), strict=True))
    expected = {"steps": "110", "planned": "100", "given up": "2", "iterations per step": "2", "factors": "7"}
    assert expected.items() <= shown.items()
    assert shown["solves"] == "9" and shown["processor time"] == "500 ms" and shown["state"] == "abcdef"
    failed = dict(zip(HEAD, cells(rows(case, "lattice", Outcome("too deep"))[0]), strict=True))
    assert failed["status"] == "**failed**" and failed["factors"] == failed["state"] == ""


def test_quick_and_beside_end_to_end(tmp_path: Path) -> None:
    """The same state next to itself: rows agree in all but times."""
    root = Path(__file__).resolve().parents[2]
    words = ["bench", "core", "--quick", "--repeat", "1", "--solver", "lattice", "-o", str(tmp_path)]
    ended = CliRunner().invoke(app, [*words, "--beside", str(root)])
    assert ended.exit_code == 0, ended.output
    found = json.loads((tmp_path / "bench.json").read_text())["rows"]
    assert len(found) == 6
    for own, other in zip(found[::2], found[1::2], strict=True):
        assert other["solver"] == "lattice, beside" and own["details"] == other["details"]
        assert own["cpu_s"] > 0 and own["error"] <= own["tolerance"]
    assert "| given up |" in (tmp_path / "bench.md").read_text()
