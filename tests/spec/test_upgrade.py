"""A contact says its friction; scenes of older versions are rewritten with what they meant."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.errors import SpecError
from mdlgen.paths import samples
from mdlgen.spec.load import loads
from mdlgen.spec.upgrade import upgraded

SAMPLES = sorted(samples().rglob("*.yaml"))
FOUR = (samples() / "transport_4x4.yaml").read_text("utf-8")
OLD = FOUR.replace(", friction: 1.0", "").replace(", friction: 0.33", "")


def test_a_contact_without_friction_is_refused_with_what_to_write() -> None:
    with pytest.raises(SpecError) as raised:
        loads(OLD, "old.yaml")
    errors = [raised.value, *raised.value.others]
    assert [".".join(map(str, e.path)) for e in errors] == [f"contacts.{k}" for k in range(6)]
    assert "the key 'friction' is missing; write like friction: 0.5, or 0 where there is none" in str(
        raised.value
    )
    assert "mdlgen upgrade" in str(raised.value)


def test_an_old_scene_is_what_it_was() -> None:
    text, changes = upgraded(OLD, "old.yaml")
    assert str(changes[0]) == f"old.yaml:{changes[0].place.line}: contacts.0: friction: 0"
    scene = loads(text)
    assert [c.friction.static for c in scene.contacts] == [0.0] * 6 + [0.3]
    # nothing else is touched: comments, order, form
    assert text.replace("friction: 0, stiffness", "stiffness") == OLD
    assert upgraded(text, "old.yaml") == (text, [])


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda p: p.stem)
def test_no_sample_needs_it(sample: Path) -> None:
    text = sample.read_text("utf-8")
    assert upgraded(text, str(sample)) == (text, [])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (
            "contacts:\n  - between: [a, b]  # why\n    stiffness: 2 N/mm^1.5\n",
            "contacts:\n  - between: [a, b]  # why\n    friction: 0\n    stiffness: 2 N/mm^1.5\n",
        ),
        (
            "contacts:\r\n  grip:\r\n    between: [a, b]\r\n    stiffness: 2 N/mm^1.5\r\n",
            "contacts:\r\n  grip:\r\n    between: [a, b]\r\n    friction: 0\r\n    stiffness: 2 N/mm^1.5\r\n",
        ),
        (
            "contacts: [{stiffness: 1 N, between: [a, b]}, {between: [a, c]}]",
            "contacts: [{friction: 0, stiffness: 1 N, between: [a, b]}, {friction: 0, between: [a, c]}]",
        ),
        ("defaults: {contacts: {friction: 1}}\ncontacts: [{between: [a, b]}]", None),
        ("contacts: 3", None),
        ("- a", None),
    ],
)
def test_each_form_of_a_contact(old: str, new: str | None) -> None:
    assert upgraded(old, "f")[0] == (new or old)


def test_json_stays_json() -> None:
    old = {"contacts": [{"between": ["a", "b"], "stiffness": "3 N"}, {"between": ["a", "c"], "friction": 1}]}
    made = json.loads(upgraded(json.dumps(old), "f.json")[0])
    assert made["contacts"][0]["friction"] == 0 and made["contacts"][1] == old["contacts"][1]


def test_the_command(tmp_path: Path) -> None:
    file = tmp_path / "old.yaml"
    file.write_text(OLD)
    run = CliRunner().invoke
    seen = run(app, ["upgrade", str(file), "--check"])
    assert seen.exit_code == 3 and "contacts.5: friction: 0" in seen.output and file.read_text() == OLD
    assert run(app, ["upgrade", str(file)]).exit_code == 0
    loads(file.read_text())
    again = run(app, ["upgrade", str(file)])
    assert again.exit_code == 0 and "nothing to write" in again.output


@pytest.mark.parametrize("command", ["check", "run"])
def test_strict_takes_lints_as_errors(command: str, tmp_path: Path) -> None:
    odd = ["--set", "materials.eur10.E_md=3.53 MPa", "--set", "rollers.motor_1_left.drive.ramp=90 ms"]
    args = [command, str(samples() / "transport_4x4.yaml"), *odd, "--strict", "-q"]
    run = CliRunner().invoke(app, [*args, *(["-o", str(tmp_path / "out")] if command == "run" else [])])
    assert run.exit_code == 2 and "W101 materials.eur10.E_md" in run.output and "W113" in run.output
    assert not (tmp_path / "out").exists()


def test_strict_of_a_scene_without_lints_is_as_without() -> None:
    run = CliRunner().invoke(app, ["check", str(samples() / "transport_4x4.yaml"), "--strict"])
    assert run.exit_code == 0
