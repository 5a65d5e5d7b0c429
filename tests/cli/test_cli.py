"""The command line: exit codes, streams, files."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from called import Run, files

import mdlgen
from mdlgen import registry
from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model
from mdlgen.paths import samples

FOUR = samples() / "transport_4x4.yaml"
SMALL = ["--set", "sheets.note.boxes=[2,3]"]
DROP = [str(samples() / "verify" / "drop.yaml"), "--set", "run.duration=60 ms"]


# ---------------------------------------------------------------- bad scenes

TEXT = FOUR.read_text("utf-8")


def changed(old: str, new: str) -> tuple[str, int, int]:
    """The sample with the first `old` changed, and where it stands (line, column from 1)."""
    at = TEXT.index(old)
    before = TEXT[:at]
    return TEXT.replace(old, new, 1), before.count("\n") + 1, at - before.rfind("\n")


BAD = {
    "misspelt key": (*changed("thickness: 0.1 mm", "thicknes: 0.1 mm"), "did you mean 'thickness'?"),
    "missing unit": (*changed("0.72 g", "0.72"), "0.72 has no unit; expected text with a unit like '0.72 g'"),
    "wrong unit": (*changed("0.72 g", "0.72 mm"), "expected a unit like 'g'"),
    "a name twice": (*changed("motor_1_right:", "motor_1_left:"), "stands twice"),
    "a name twice in another case": (*changed("counter_1_left:\n", "NOTE:\n"), "used twice"),
    "unknown part": (*changed("[note, support]", "[note, suport]"), "there is no part 'suport'"),
    "too large a number": (*changed("friction: 0.33", "friction: 1e400"), "not finite"),
    "too large a quantity": (*changed("0.72 g", "1e400 g"), "not finite"),
    "not YAML": (*changed("planes:", "planes: ]["), "not YAML"),
    "not a scene": ("PK\x03\x04 binary", 1, 1, "not YAML"),
}


@pytest.mark.parametrize("command", ["check", "mdl", "run"])
@pytest.mark.parametrize("case", BAD)
def test_a_bad_scene_ends_with_one_line(mdl: Run, tmp_path: Path, command: str, case: str) -> None:
    text, line, _, words = BAD[case]
    (tmp_path / "bad.yaml").write_text(text, "utf-8")
    ended = mdl(command, "bad.yaml")
    assert ended.code == 2
    assert ended.out == ""
    lines = ended.err.splitlines()
    assert len(lines) == 1, ended.err
    place = re.match(r"bad\.yaml:(\d+):(\d+): ", lines[0])
    assert place, lines[0]
    # the name that stands twice is reported at the second place, and a pair's name inside its list
    assert abs(int(place[1]) - line) <= (1 if case.startswith("a name twice") else 0), lines[0]
    assert int(place[2]) >= 1
    assert words in lines[0]
    assert "Traceback" not in ended.err
    assert files(tmp_path) == ["bad.yaml"]


def test_the_place_is_that_of_the_value(mdl: Run, tmp_path: Path) -> None:
    text, line, column = changed("0.72 g", "0.72")
    (tmp_path / "bad.yaml").write_text(text, "utf-8")
    assert mdl("check", "bad.yaml").err.startswith(
        f"bad.yaml:{line}:{column}: sheets.note.mass: 0.72 has no unit"
    )


def test_a_real_process_says_the_same(tmp_path: Path) -> None:
    (tmp_path / "bad.yaml").write_text(TEXT.replace("0.72 g", "0.72"), "utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "mdlgen", "run", "bad.yaml"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert re.fullmatch(r"bad\.yaml:\d+:\d+: sheets\.note\.mass: .*\n", done.stderr)
    assert files(tmp_path) == ["bad.yaml"]


def test_set_is_reported_by_its_option(mdl: Run) -> None:
    ended = mdl("check", FOUR, "--set", "sheets.note.mass=0.72")
    assert ended.code == 2
    assert ended.err.startswith("--set sheets.note.mass:1:1: sheets.note.mass: 0.72 has no unit")


def test_a_missing_file(mdl: Run) -> None:
    ended = mdl("check", "none.yaml")
    assert (ended.code, ended.err) == (3, "none.yaml: cannot read: No such file or directory\n")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (("chek", "x"), "mdlgen: No such command 'chek'. Did you mean 'check'"),
        (("run", "x.yaml", "--xyzzy"), "mdlgen run: No such option: --xyzzy; mdlgen run --help"),
        (("mdl",), "mdlgen mdl: Missing argument 'SPEC'; mdlgen mdl --help"),
        (("run", "x.yaml", "--checkpoint", "soon"), "mdlgen run: Invalid value for '--checkpoint': "),
    ],
)
def test_a_wrong_call_is_reported_in_one_line(mdl: Run, call: tuple[str, ...], message: str) -> None:
    ended = mdl(*call)
    assert ended.code == 2 and ended.out == ""
    assert ended.err.startswith(message) and len(ended.err.splitlines()) == 1


def test_a_file_name_cannot_make_two_lines(mdl: Run) -> None:
    assert len(mdl("check", "none\nthere.yaml").err.splitlines()) == 1


@pytest.mark.parametrize("args", [["nonsense"], ["check"], ["check", "x", "--nonsense"], ["new"]])
def test_usage_errors(mdl: Run, args: list[str]) -> None:
    ended = mdl(*args)
    assert (ended.code, ended.out) == (2, "")
    assert ended.err


@pytest.mark.parametrize("command", ["new", "check", "mdl", "run", "schema"])
def test_help_has_an_example(mdl: Run, command: str) -> None:
    ended = mdl(command, "--help")
    assert ended.code == 0
    assert f"Example: mdlgen {command}" in " ".join(ended.out.split())


def test_a_refusal_of_a_backend_has_its_place(mdl: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    class Refuses:
        def emit(self, model: Model, **options: object) -> str:
            raise RefusedError("no such thing in MDL", ("sheets", "note", "surface"))

    monkeypatch.setattr(registry, "emitter", lambda name: Refuses())
    ended = mdl("mdl", FOUR)
    assert ended.code == 2
    assert re.fullmatch(
        rf"{re.escape(str(FOUR))}:\d+:\d+: sheets\.note\.surface: no such thing in MDL\n", ended.err
    )


def test_an_internal_error_is_one_line(mdl: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(name: str) -> None:
        raise ZeroDivisionError("all\nwrong")

    monkeypatch.setattr(registry, "emitter", broken)
    ended = mdl("mdl", FOUR)
    assert ended.code == 1
    assert ended.err == "mdlgen: internal error: ZeroDivisionError: all wrong (-v shows the traceback)\n"
    assert "Traceback" in mdl("mdl", FOUR, "-v").err


# ---------------------------------------------------------------- new, check, schema


def test_new_copies_a_sample_and_never_overwrites(mdl: Run, tmp_path: Path) -> None:
    ended = mdl("new", "mine")
    assert (ended.code, ended.out) == (0, "mine/transport_4x4.yaml\n")
    assert (tmp_path / "mine" / "transport_4x4.yaml").read_bytes() == FOUR.read_bytes()
    (tmp_path / "mine" / "transport_4x4.yaml").write_text("edited")
    assert mdl("new", "mine").code == 3
    assert (tmp_path / "mine" / "transport_4x4.yaml").read_text() == "edited"
    assert mdl("new", "mine", "--from", "verify/drop").code == 0
    assert mdl("check", "mine/drop.yaml").code == 0


@pytest.mark.parametrize("sample", ["nonsense", "../README", "/etc/passwd", ""])
def test_new_knows_only_samples(mdl: Run, tmp_path: Path, sample: str) -> None:
    ended = mdl("new", "mine", "--from", sample)
    assert ended.code == 2 and "transport_4x4" in ended.err
    assert files(tmp_path) == []


def test_new_lists_every_sample(mdl: Run) -> None:
    ended = mdl("new", "--list")
    names = [line.split()[0] for line in ended.out.splitlines()]
    root = samples()
    assert names == [p.relative_to(root).with_suffix("").as_posix() for p in sorted(root.rglob("*.yaml"))]


def test_new_into_a_file(mdl: Run, tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("a file")
    assert mdl("new", "mine").code == 3


def test_check_tells_tables_counts_and_lints(mdl: Run) -> None:
    message = mdl("check", FOUR, "--set", "rollers.motor_1_left.drive.speed=0 rad/s").out
    assert "10 x 20 = 200 boxes" in message
    assert re.search(r"k +167\.28 +58\.717 +1672\.8", message)
    assert "1804 pairs of bodies possible" in message
    assert "W108 rollers.motor_1_left.drive.speed" in message
    assert mdl("check", FOUR, "-q").out == ""


@pytest.mark.filterwarnings("error")  # a warning would stand on standard error
def test_schema_is_json(mdl: Run) -> None:
    assert "sheets" in json.loads(mdl("schema").out)["properties"]


# ---------------------------------------------------------------- mdl


def test_mdl_writes_the_text_and_the_script(mdl: Run, tmp_path: Path) -> None:
    ended = mdl("mdl", FOUR, *SMALL)
    assert (ended.code, ended.out, ended.err) == (0, "", "wrote transport_4x4.mdl\n")
    assert files(tmp_path) == ["transport_4x4.mdl"]
    model = mdlgen.lower(mdlgen.load(FOUR, ["sheets.note.boxes=[2,3]"]))
    assert (tmp_path / "transport_4x4.mdl").read_text("ascii") == mdlgen.emit(model)
    assert mdl("mdl", FOUR, *SMALL, "--script").code == 0
    assert files(tmp_path) == ["transport_4x4.mdl", "transport_4x4_mview.py"]
    ended = mdl("mdl", FOUR, *SMALL, "--set-contact")
    (reason,) = registry.emitter("motionview").companion_reasons(model, set_contact=True)
    assert reason in ended.err


def test_mdl_for_a_version_of_motionview(mdl: Run, tmp_path: Path) -> None:
    for target in ("2021", "2025"):
        assert mdl("mdl", FOUR, *SMALL, "--target", target, "-o", f"{target}.mdl", "-q").code == 0
        assert mdl("verify", FOUR, *SMALL, "--text", f"{target}.mdl", "--no-perturb", "-q").code == 0
    older, newer = ((tmp_path / f"{target}.mdl").read_text() for target in ("2021", "2025"))
    assert ", gbox_note_0_0, false, BODY" in older and ", gbox_note_0_0, BODY" in newer
    assert "Target : MotionView 2025" in newer
    ended = mdl("mdl", FOUR, *SMALL, "--target", "2019")
    assert ended.code == 2 and "there are: 2021, 2025" in ended.err


def test_mdl_names_its_files(mdl: Run, tmp_path: Path) -> None:
    assert mdl("mdl", FOUR, *SMALL, "-o", "a.mdl", "--companion", "b.py", "-q").err == ""
    assert files(tmp_path) == ["a.mdl", "b.py"]
    assert mdl("mdl", FOUR, *SMALL, "-o", "c.mdl", "--companion", "c.mdl").code == 3
    assert files(tmp_path) == ["a.mdl", "b.py"]


def test_mdl_to_standard_output(mdl: Run, tmp_path: Path) -> None:
    ended = mdl("mdl", FOUR, *SMALL, "-o", "-")
    assert ended.out.count("*BeginMDL") == 1 and ended.out.endswith("\n")
    assert ended.err == "" and files(tmp_path) == []
    ended = mdl("mdl", FOUR, *SMALL, "-o", "-", "--script")
    assert "--companion FILE" in ended.err
    assert files(tmp_path) == []


def test_mdl_without_need_of_a_script(mdl: Run, tmp_path: Path) -> None:
    ended = mdl("mdl", samples() / "cantilever.yaml", "--set", "sheets.note.boxes=[2,3]")
    assert ended.err == "wrote cantilever.mdl\n"
    assert files(tmp_path) == ["cantilever.mdl"]


@pytest.mark.parametrize("target", ["missing/a.mdl", "folder", "link.mdl"])
def test_mdl_to_a_bad_place_leaves_nothing(mdl: Run, tmp_path: Path, target: str) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "real.mdl").write_text("mine")
    (tmp_path / "link.mdl").symlink_to("real.mdl")
    ended = mdl("mdl", FOUR, *SMALL, "-o", target)
    assert ended.code == 3 and len(ended.err.splitlines()) == 1
    assert target != "missing/a.mdl" or ended.err.endswith("cannot write: there is no folder missing\n")
    assert (tmp_path / "real.mdl").read_text() == "mine"
    assert files(tmp_path) == ["link.mdl", "real.mdl"]


def cpu_of(*args: str) -> float:
    """Processor time of a whole process [s]: wall time would measure who else is on the machine."""
    before = os.times()
    subprocess.run([sys.executable, *args], check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    return after.children_user - before.children_user + after.children_system - before.children_system


def test_mdl_is_a_small_multiple_of_importing_its_libraries() -> None:
    libraries = ("-c", "import jinja2, numpy, pydantic, ruamel.yaml, typer")
    ours = ("-m", "mdlgen", "mdl", str(FOUR), "-o", "-", "-q")
    # the least of each: other work on the machine only adds to both
    own, least = (min(cpu_of(*command) for _ in range(4)) for command in (ours, libraries))
    # measured 2.5 (0.6 to 0.9 s); a solver's import alone would add 3
    assert own / least < 4.0


# ---------------------------------------------------------------- lint


def test_lint_reads_what_mdl_writes(mdl: Run, tmp_path: Path) -> None:
    assert mdl("mdl", FOUR, *SMALL, "-o", "note.mdl").code == 0
    ended = mdl("lint", "note.mdl", "--values", "note.json")
    assert (ended.code, ended.out.count("0 errors, 0 warnings")) == (0, 1)
    found = json.loads((tmp_path / "note.json").read_text())
    assert len(found["bushings"]) == 14
    assert found["bodies"]["b_note_0_0"]["mass"] == pytest.approx(0.72e-3 / 6)


def test_lint_places_errors_and_ends_with_2(mdl: Run, tmp_path: Path) -> None:
    (tmp_path / "bad.mdl").write_text('*BeginMDL( m, "m" )\n  *Body( b, "b", p_none, , , , )\n*EndMDL()\n')
    ended = mdl("lint", "bad.mdl", "-q")
    assert ended.code == 2
    assert re.match(r"bad\.mdl:2:\d+: error: ", ended.out)
    assert mdl("lint", "none.mdl").code == 3


# ---------------------------------------------------------------- run
