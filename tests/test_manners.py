"""How the tool speaks: codes explained, near misses named, help with examples, results shown."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.errors import did_you_mean
from mdlgen.explain import SCENE, TEXT
from mdlgen.paths import samples

ROOT = Path(__file__).parent.parent
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
    assert set(re.findall(r'"(W\d{3})"', (ROOT / "mdlgen" / "checks.py").read_text("utf-8"))) == set(SCENE)
    assert reader_codes() == set(TEXT)


def test_explain_is_a_command() -> None:
    assert run("explain", "w104") == (0, SCENE["W104"] + "\n")
    assert run("explain", "dangling") == (0, TEXT["dangling"] + "\n")
    code, told = run("explain")
    assert code == 0 and all(name in told for name in (*SCENE, *TEXT))
    code, told = run("explain", "danglin")
    assert code == 2 and "did you mean 'dangling'?" in told


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
        code, told = run(*args)
        assert code == 2 and f"did you mean {meant!r}?" in told, told
        assert len(told.splitlines()) == 1


@pytest.mark.parametrize("command", [c.name or c.callback.__name__ for c in app.registered_commands])  # type: ignore[union-attr]
def test_every_command_has_an_example_in_its_help(command: str) -> None:
    code, told = run(command, "--help")
    assert code == 0 and f"Example: mdlgen {command}" in told


def test_a_shell_can_complete() -> None:
    code, told = run("--help")
    assert code == 0 and "--install-completion" in told
