"""One convention for all commands: short options, help that is not cut, JSON where a person reads a table,
what a shell completes, and old spellings that still hold."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

import mdlgen
from mdlgen.cli import app, completion
from mdlgen.paths import samples

GROUP: Any = typer.main.get_command(app)
FOUR, INCLINE = (str(samples() / f"{name}.yaml") for name in ("transport_4x4", "verify/incline"))
FRICTION = "contacts.0.friction"
SHORT = ["--set", "run.duration=2 ms"]


def run(*args: str) -> tuple[int, str, str]:
    done = CliRunner().invoke(app, list(args))
    return done.exit_code, done.stdout, done.stderr


def found(*args: str) -> Any:
    code, out, err = run(*args, "--json")
    assert code == 0, err
    return json.loads(out)


def test_version() -> None:
    assert run("--version")[:2] == (0, f"mdlgen {mdlgen.__version__}\n")


@pytest.mark.parametrize("command", [(), *((name,) for name in GROUP.commands)])
def test_h_is_help(command: tuple[str, ...]) -> None:
    code, out, _ = run(*command, "-h")
    assert code == 0 and out == run(*command, "--help")[1]


def test_the_list_of_commands_is_not_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    lines = run("--help")[1].partition("Commands:")[2].splitlines()
    assert len([line for line in lines if line.strip()]) == len(GROUP.commands)
    assert not any(line.endswith("...") for line in lines)


def test_the_names_of_options_mean_the_same_everywhere() -> None:
    for name, command in GROUP.commands.items():
        of = {option: p for p in command.params for option in p.opts}
        assert "--quiet" in of and "--verbose" in of, name
        if "-o" in of:
            assert of["--output"] is of["-o"], name
            # the place of the main result: one file, or a folder of several
            several = name in ("run", "bench", "sweep", "optimize")
            assert of["-o"].metavar == "DIR" if several else of["-o"].metavar.startswith("FILE"), name


def test_json_of_a_run_is_its_summary(tmp_path: Path) -> None:
    message = found("run", INCLINE, *SHORT, "-o", str(tmp_path))
    assert message == json.loads((tmp_path / "summary.json").read_text())


def test_json_of_lint(tmp_path: Path) -> None:
    text = tmp_path / "a.mdl"
    assert run("mdl", INCLINE, "-o", str(text))[0] == 0
    clean = found("lint", str(text))
    assert (clean["errors"], clean["findings"]) == (0, []) and clean["statements"] > 50
    text.write_text(text.read_text().replace("*EndMDL()", "*Nonsense( a )\n*EndMDL()"))
    record = found("lint", str(text))
    assert [f["code"] for f in record["findings"]] == ["unknown"] and record["warnings"] == 1
    assert run("lint", str(text), "--json", "--values", "-")[0] == 2


def test_json_of_a_sweep(tmp_path: Path) -> None:
    over = ["--over", f"{FRICTION}=[0.1, 0.3]", "--workers", "1", "-o", str(tmp_path / "s")]
    record = found("sweep", INCLINE, *SHORT, *over)
    assert (record["cases"], record["failed"]) == (2, 0)
    assert [row["values"] for row in record["rows"]] == [[[FRICTION, "0.1"]], [[FRICTION, "0.3"]]]
    assert all(Path(file).is_file() for file in record["files"])


def test_the_schema_goes_to_a_file_as_it_is_printed(tmp_path: Path) -> None:
    code, printed, _ = run("schema")
    code_of_file, out, err = run("schema", "-o", str(tmp_path / "s.json"))
    assert code == code_of_file == 0 and out == "" and "wrote" in err
    assert (tmp_path / "s.json").read_text() == printed
    assert run("schema", "-o", "-")[1] == printed


def test_json_of_a_list_and_of_codes() -> None:
    assert "transport_4x4" in found("new", "--list")
    assert list(found("explain", "W104")) == ["W104"]
    assert {"W104", "dangling"} <= set(found("explain"))


@pytest.fixture(scope="module")
def searched(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    folder = tmp_path_factory.mktemp("search")
    vary = ["--vary", f"{FRICTION}=0.1:0.3", "--minimise", "(sheets.block.speed_mm_per_s.x - 1)**2"]
    files = ["-o", str(folder / "a"), "--mdl", str(folder / "best.mdl")]
    return folder, found("optimize", INCLINE, *SHORT, *vary, "--most", "4", *files)


def test_json_of_a_search(searched: tuple[Path, dict[str, Any]]) -> None:
    folder, record = searched
    assert record["runs"] == 4 and record["set"][0].startswith(f"{FRICTION}=")
    assert (folder / "best.mdl").is_file() and (folder / "a" / "table.csv").is_file()


def test_a_search_goes_on_by_its_folder_alone(searched: tuple[Path, dict[str, Any]]) -> None:
    folder, record = searched
    again = found("optimize", "--resume", str(folder / "a"))
    assert again["best"]["values"] == record["best"]["values"] and again["runs"] == 4
    code, _, err = run("optimize", "--resume", str(folder / "a"), "--set", "run.duration=3 ms")
    assert code == 2 and "takes scene, values, goal and solver" in err
    for words in ([INCLINE], []):
        code, _, err = run("optimize", *words)
        assert code == 2 and len(err.splitlines()) == 1


def test_old_spellings_of_a_search_hold_with_a_notice(tmp_path: Path) -> None:
    words = ["optimize", INCLINE, *SHORT, "--vary", f"{FRICTION}=0.1:0.3", "--most", "2"]
    words += ["--minimise", "sheets.block.speed_mm_per_s.x"]
    mdl, folder = str(tmp_path / "best.mdl"), str(tmp_path / "t")
    code, _, err = run(*words, "-o", mdl, "--folder", folder)
    assert code == 0 and Path(mdl).is_file() and Path(folder, "table.csv").is_file()
    assert f"write --mdl {mdl}" in err and f"write -o {folder}" in err
    assert run(*words, "-o", folder, "--folder", folder)[0] == 2
    assert run(*words, "-o", mdl, "--mdl", mdl)[0] == 2


class TestCompletion:
    def test_paths_of_a_scene(self) -> None:
        from ruamel.yaml import YAML

        scene = YAML(typ="safe").load(Path(FOUR).read_text())

        def offered(text: str) -> list[str]:
            return completion.paths(scene, text)

        assert offered("she") == ["sheets."]
        assert offered("sheets.") == ["sheets.note."]
        assert offered("sheets.note.la") == ["sheets.note.layout="]
        assert {"sheets.note.grading.", "sheets.note.center="} <= set(offered("sheets.note."))
        assert offered("contacts.6.stiff") == ["contacts.6.stiffness="]
        assert offered("sheets.note.layout=e") == ["sheets.note.layout=edge_to_edge"]
        assert offered("run.prune=") == ["run.prune=true", "run.prune=false"]
        assert offered("run.analysis=") == ["run.analysis=transient", "run.analysis=static"]
        assert offered("materials.eur10.damping.rot") == ["materials.eur10.damping.rotation="]
        assert offered("nonsense.") == offered("sheets.none.nonsense.x.") == []

    def test_names(self) -> None:
        assert completion.solvers("la") == ["lattice"] and "auto" in completion.solvers("")
        assert completion.every_solver("") == ["lattice", "exudyn"]
        assert completion.sample_names("verify/dr") == ["verify/drop"]
        assert completion.fits("damping.t") == ["damping.time"]
        assert completion.codes("W13") == [f"W13{k}" for k in range(10)]
        assert completion.suites("val") == ["validation"]
        assert completion.methods("o") == ["optuna"] and completion.sheets_only("") == ["sheets"]
        assert completion.limits("bo") == ["boxes="]

    @pytest.mark.parametrize(
        ("line", "offers"),
        [
            (f"mdlgen run {FOUR} --solver la", "lattice"),
            (f"mdlgen run {FOUR} --set sheets.note.the", ""),
            (f"mdlgen run {FOUR} --set sheets.note.thi", "sheets.note.thickness="),
            ("mdlgen run nowhere.yaml --set run.du", "run.duration="),
            ("mdlgen explain W10", "W104"),
            ("mdlgen new --from can", "cantilever"),
            ("mdlgen calibrate x.yaml --fit D_", "D_cd"),
            # bash takes `=` as the end of a word, and replaces what stands behind it
            (f"mdlgen run {FOUR} --set run.analysis = st", "static"),
            (f"mdlgen run {FOUR} --set run.analysis =", "transient"),
            (f"mdlgen run --set run.step = 1 {FOUR} --set sheets.note.layout = pl", "plate"),
            (f"mdlgen run {FOUR} --solver = la", "lattice"),
            (f"mdlgen run {FOUR} --set = run.analysis = st", "static"),
            (f"mdlgen run {FOUR} --set run.analysis = none", ""),
        ],
    )
    def test_a_shell_is_offered_them(self, line: str, offers: str) -> None:
        words = {"COMP_WORDS": line, "COMP_CWORD": str(len(line.split()) - 1)}
        done = subprocess.run(
            [sys.executable, "-c", "import sys; sys.argv[0] = 'mdlgen'; from mdlgen.cli import main; main()"],
            env={**os.environ, "_MDLGEN_COMPLETE": "complete_bash", **words},
            capture_output=True,
            text=True,
            check=False,
        )
        assert (offers in done.stdout.split()) if offers else done.stdout.strip() == "", done
