"""How the tool speaks: codes explained, near misses named, help with examples, results shown."""

from __future__ import annotations

import ast
import re
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import html
from places import ROOT
from ran import transport
from typer.testing import CliRunner

import mdlgen
from mdlgen.cli import app
from mdlgen.errors import did_you_mean
from mdlgen.explain import SCENE, TEXT
from mdlgen.paths import samples

FOUR = str(samples() / "transport_4x4.yaml")


def run(*args: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, list(args))
    return done.exit_code, done.output


def reader_codes() -> set[str]:
    """Codes that the reader of MDL gives its findings."""
    found = set()
    for path in (ROOT / "backends" / "motionview" / "reader").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            words = [a.value for a in node.args if isinstance(a, ast.Constant) and isinstance(a.value, str)]
            if name in ("Trouble", "trouble") and words:
                found.add(words[0])
            elif name == "add" and len(words) > 1 and words[0] in ("error", "warning"):
                found.add(words[1])
    return found


def test_every_code_is_explained_and_none_besides() -> None:
    found: set[str] = set()
    for path in (ROOT / "mdlgen").rglob("*.py"):
        if path.name != "explain.py":
            found |= set(re.findall(r'"(W\d{3})"', path.read_text("utf-8")))
    assert found == set(SCENE)
    assert reader_codes() == set(TEXT)


def test_explain_is_a_command() -> None:
    assert run("explain", "w104") == (0, SCENE["W104"] + "\n")
    assert run("explain", "dangling") == (0, TEXT["dangling"] + "\n")
    code, message = run("explain")
    assert code == 0 and all(name in message for name in (*SCENE, *TEXT))
    code, message = run("explain", "danglin")
    assert code == 2 and "did you mean 'dangling'?" in message


def test_near_misses_are_named() -> None:
    assert did_you_mean("Motor_1", ["motor_1", "counter"]) == "; did you mean 'motor_1'?"
    assert did_you_mean("xyz", ["motor_1"]) == ""
    for args, meant in (
        (["new", "--from", "cantilevr", "x"], "cantilever"),
        (["run", FOUR, "--solver", "latice"], "lattice"),
        (["bench", "elastic", "-o", "/nowhere"], "elastica"),
        (["check", FOUR, "--set", 'contacts.0.between=["motor_1_lef", "counter_1_left"]'], "motor_1_left"),
        (["check", FOUR, "--set", "sheets.note.material=eur1"], "eur10"),
        (["check", FOUR, "--set", "sheets.note.thicknes=1 mm"], "thickness"),
    ):
        code, message = run(*args)
        assert code == 2 and f"did you mean {meant!r}?" in message, message
        assert len(message.splitlines()) == 1


def test_check_is_a_table_on_a_terminal_and_plain_elsewhere(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    args = ["check", FOUR, "--set", "materials.eur10.E_md=40000 MPa"]
    plain = run(*args)[1]
    assert "\x1b" not in plain and "W101 materials.eur10.E_md: 40000 MPa is an unusual" in plain
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    for name, value in (("TERM", "xterm-256color"), ("COLUMNS", "90")):
        monkeypatch.setenv(name, value)
    with pytest.raises(SystemExit) as ended:
        app(args, prog_name="mdlgen")
    assert ended.value.code == 0
    coloured = capsys.readouterr().out
    message = re.sub(r"\x1b\[[0-9;]*m", "", coloured)
    assert coloured != message and max(map(len, message.splitlines())) <= 90
    cells = [line.split() for line in message.splitlines()]
    assert ["code", "where", "what", "what", "to", "do"] in cells
    # every number of the plain tables stands in these
    for line in plain.splitlines():
        if line.startswith(("  k", "  c", "  along")):
            assert line.split() in cells


@pytest.mark.parametrize("command", [c.name or c.callback.__name__ for c in app.registered_commands])  # type: ignore[union-attr]
def test_every_command_has_an_example_in_its_help(command: str) -> None:
    code, message = run(command, "--help")
    assert code == 0 and f"Example: mdlgen {command}" in message


def test_a_shell_can_complete() -> None:
    code, message = run("--help")
    assert code == 0 and "--install-completion" in message


class TestPython:
    def test_results_show_themselves_in_a_line(self) -> None:
        result = transport()
        assert repr(result) == "<Result transport_4x4, lattice, ok, 50 ms in 201 states, 49 bodies>"
        message = repr(result.model)
        assert message.startswith("<Model transport_4x4: 49 bodies, 1 sheets, 8 rollers, 1 planes, 1")
        assert repr(mdlgen.load(FOUR)).startswith(
            "<Scene transport_4x4: 1 sheets, 8 rollers, 1 planes, 7 con"
        )

    def test_a_notebook_shows_tables_with_names_escaped(self) -> None:
        result = transport()
        tree = html.fromstring(f"<div>{result._repr_html_()}</div>")
        rows = {row[0].text: [cell.text for cell in row[1:]] for row in tree.xpath(".//tr")}
        note = result.summary()["sheets"]["note"]
        x, y, z = note["travel_mm"]
        assert abs(y) < 1e-15 and rows["note"][0] == f"{x:.5g}, 0, {z:.5g}"  # round-off is shown as 0
        bad = replace(result, solver="<script>alert(1)</script>")
        assert "<script>" not in bad._repr_html_()

    def test_xarray_has_the_same_numbers_by_name(self) -> None:
        pytest.importorskip("xarray")
        result = transport()
        states = result.to_xarray()
        body = result.model.bodies.name.index("note_2_3")
        mine = states.position.sel(body="note_2_3", axis="x")
        assert np.array_equal(mine.values, result.position[:, body, 0])
        assert mine.sel(time=25.0).item() == result.position[100, body, 0]
        force = states.contact_force.sel(contact="note / motor_1_left")
        rows = list(zip(result.model.contacts.part_a, result.model.contacts.part_b, strict=True))
        assert np.array_equal(force, result.contact_force[:, rows.index(("note", "motor_1_left"))])
        assert states.position.attrs["units"] == "mm"

    def test_the_package_is_typed(self) -> None:
        assert (ROOT / "mdlgen" / "py.typed").exists()


def test_the_python_of_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert blocks
    (tmp_path / "samples").symlink_to(samples())
    monkeypatch.chdir(tmp_path)
    for block in blocks:
        names: dict[str, Any] = {}
        exec(compile(block, "README.md", "exec"), names)
        assert names["result"].ok
        assert np.array_equal(names["lead"], names["result"].position[:, 0])


def test_every_key_of_the_starter_scene_has_a_comment() -> None:
    """On its line, or on the one above; once for each key of each kind of part."""
    seen: set[tuple[str, str]] = set()
    lines = Path(FOUR).read_text("utf-8").splitlines()
    kind, bare = "", []
    for above, line in zip(["", *lines], lines, strict=False):
        if re.match(r"[a-z]+:", line):
            kind = line.partition(":")[0]
        key = re.match(r" *(?:- )?\{?([A-Za-z_]+):", line)
        if key and (kind, key[1]) not in seen:
            seen.add((kind, key[1]))
            if "#" not in line and "#" not in above:
                bare.append(f"{kind}: {key[1]}")
    # their names say it all
    named = {
        "thickness",
        "radius",
        "width",
        "mass",
        "normal",
        "size",
        "center",
        "grip",
        "support",
        "note",
        "planes",
    }
    assert [b for b in bare if b.split()[-1] not in named and not b.split()[-1].startswith("motor")] == []
