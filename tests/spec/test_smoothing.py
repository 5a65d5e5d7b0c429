"""The smoothing of a contact that gives none follows the speeds of the scene; older scenes keep theirs."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import mdlgen
from mdlgen.backends.motionview.writer.script import companion
from mdlgen.cli import app
from mdlgen.errors import SpecError
from mdlgen.lints.smoothing import notice, smoothings
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import loads
from mdlgen.spec.scene import Scene
from mdlgen.spec.upgrade import upgraded
from mdlgen.verify.verification import verify

TEXT = """\
name: fast
materials: {p: {E_md: 3 GPa, E_cd: 2 GPa, D_md: 1 N*mm, D_cd: 1 N*mm}}
sheets:
  one: {material: p, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [3, 2]}
  two: {material: p, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [3, 2], center: [0 mm, 0 mm, 0.11 mm]}
rollers:
  motor: {center: [0 mm, 0 mm, -10.04 mm], axis: y, radius: 10 mm, width: 30 mm, mass: 9 g, drive: {speed: 70 rad/s}}
  idler: {center: [0 mm, 0 mm, 10.15 mm], axis: y, radius: 10 mm, width: 30 mm, mass: 9 g}
contacts:
  - {between: [one, motor], stiffness: 300 N/mm^1.5, friction: 0.5}
  - {between: [two, idler], stiffness: 300 N/mm^1.5, friction: {static: 0.5, dynamic: 0.3}}
  - {between: [one, two], stiffness: 300 N/mm^1.5, friction: 0.3}
  - {between: [motor, idler], stiffness: 300 N/mm^1.5, friction: 0, smoothing: 3 mm/s}
run: {duration: 5 ms}
"""  # noqa: E501


def speeds(*sets: str) -> list[float]:
    """Of each contact [mm/s]."""
    return [item["mm_per_s"] for item in smoothings(lower(loads(TEXT, overrides=sets)))]


@pytest.mark.parametrize(
    ("sets", "expected"),
    [
        ([], 7.0),  # 1 % of 70 rad/s 10 mm
        (["rollers.motor.drive.speed=-70 rad/s"], 7.0),
        (["rollers.motor.drive={surface_speed: 450 mm/s, direction: x}"], 4.5),
        (["rollers.motor.drive={profile: [[0 ms, 0 rad/s], [2 ms, -90 rad/s], [3 ms, 20 rad/s]]}"], 9.0),
        (["rollers.motor.rim={sectors: [{from: 0 deg, to: 90 deg, radius: 11 mm}]}"], 7.7),
        (["rollers.motor.drive.speed=1 rad/s"], 1.0),
        (["rollers.motor.drive.speed=900 rad/s"], 20.0),
        (["rollers.motor.drive=null"], 1.0),
        (["sheets.two.velocity=[0 m/s, 1.2 m/s, -0.5 m/s]"], 13.0),
        (["rollers.motor.drive=null", "sheets.one.velocity=[0.4 m/s, 0 m/s, 0 m/s]"], 4.0),
    ],
)
def test_one_percent_of_the_fastest(sets: list[str], expected: float) -> None:
    assert speeds(*sets) == pytest.approx([expected, expected, 1.0, 3.0], rel=1e-12)


def test_a_pattern_that_meets_two_sheets_has_the_finer_value() -> None:
    given = 'contacts=[{between: [one, "*"], stiffness: 300 N/mm^1.5, friction: 0.5}]'
    assert speeds(given) == [1.0]


def test_friction_speeds_follow_too() -> None:
    table = lower(loads(TEXT)).contacts
    np.testing.assert_allclose(table.stiction_velocity[:2], 7e-3)
    np.testing.assert_allclose(table.friction_velocity[:2], [7e-3, 10.5e-3])
    # what the user gave for full slip is not passed by what follows
    own = "contacts.0.friction={static: 0.5, dynamic: 0.3, friction_velocity: 2 mm/s}"
    table = lower(loads(TEXT, overrides=[own])).contacts
    assert table.stiction_velocity[0] == table.friction_velocity[0] == 2e-3
    assert table.smoothing[0] == pytest.approx(7e-3)
    with pytest.raises(SpecError, match="is below the stiction velocity 5 mm/s"):
        loads(TEXT, overrides=[own, "contacts.0.smoothing=5 mm/s"])


def test_it_follows_a_value_that_is_changed() -> None:
    scene = loads(TEXT)
    faster = scene.with_({"rollers.motor.drive.speed": "140 rad/s"})
    assert lower(faster).contacts.smoothing[0] == pytest.approx(14e-3)
    assert "smoothing" not in faster.to_yaml().replace("smoothing: 3 mm/s", "")
    made = Scene.model_validate(scene.model_dump()).with_({"rollers.motor.drive.speed": "140 rad/s"})
    assert lower(made).contacts.smoothing[0] == pytest.approx(14e-3)


def test_check_and_run_say_so(tmp_path: Path) -> None:
    file = tmp_path / "fast.yaml"
    file.write_text(TEXT)
    ended = CliRunner().invoke(app, ["check", str(file)])
    assert "smoothing 7 mm/s, from the speeds of the scene: contacts 0, 1\n" in ended.stdout
    assert "smoothing 1 mm/s: contact 2\n" in ended.stdout
    said = "contacts 0, 1: smoothing is left out and follows from the speeds of the scene, 7 mm/s; up to"
    assert said in ended.stderr and "mdlgen upgrade FILE" in ended.stderr
    as_json: Any = json.loads(CliRunner().invoke(app, ["check", str(file), "--json"]).stdout)
    assert as_json["smoothing"][1] == {"contact": "1", "mm_per_s": pytest.approx(7.0), "follows": True}
    ran = CliRunner().invoke(
        app, ["run", str(file), "-o", str(tmp_path / "out"), "--set", "run.duration=0.05 ms"]
    )
    assert ran.exit_code == 0 and said in ran.stderr
    # nothing is said where nothing changed
    assert notice(lower(loads(TEXT, overrides=["rollers.motor.drive=null"]))) == ""


def test_upgrade_writes_what_it_was() -> None:
    old = TEXT.replace(", friction: 0.5}", "}")
    text, changes = upgraded(old, "old.yaml")
    assert [(".".join(map(str, c.path)), c.key, c.value) for c in changes] == [
        ("contacts.0", "friction", "0"),
        ("contacts.0", "smoothing", "1 mm/s"),
        ("contacts.1", "smoothing", "1 mm/s"),
    ]
    assert all(c.place.line == old.split("\n").index("contacts:") + 2 + c.path[1] for c in changes)  # type: ignore[operator]
    model = lower(loads(text))
    np.testing.assert_allclose(model.contacts.smoothing, [1e-3, 1e-3, 1e-3, 3e-3])
    assert not model.following and upgraded(text, "old.yaml") == (text, [])
    still = TEXT.replace("drive: {speed: 70 rad/s}", "drive: {speed: 2 rad/s}")
    assert upgraded(still, "old.yaml") == (still, [])


def test_upgrade_keeps_the_form() -> None:
    at = TEXT.index("contacts:")
    rest = TEXT[TEXT.index("run:") :]
    block = "contacts:\n  grip:\n    between: [one, motor]  # why\n    stiffness: 300 N/mm^1.5\n"
    made = block.replace("    stiff", "    friction: 0\n    smoothing: 1 mm/s\n    stiff")
    assert upgraded(TEXT[:at] + block + rest, "f")[0] == TEXT[:at] + made + rest
    text = json.dumps(loads(TEXT).model_dump(mode="json", exclude_defaults=True))
    found = json.loads(upgraded(text, "f.json")[0])
    assert [c.get("smoothing") for c in found["contacts"]] == ["1 mm/s", "1 mm/s", None, "3 mm/s"]


def test_what_is_given_by_default_is_not_written() -> None:
    text = TEXT.replace("contacts:\n", "defaults: {contacts: {smoothing: 4 mm/s}}\ncontacts:\n")
    assert upgraded(text, "f") == (text, [])


def test_text_deck_and_script_have_the_same_value() -> None:
    scene = loads(TEXT)
    model = lower(scene)
    for written in (mdlgen.emit(model, "motionsolve"), companion(model) or ""):
        found = {round(float(v), 9) for v in re.findall(r'normal_trans_vel"?\s*[=:] "?([0-9.]+)', written)}
        assert found == {7.0, 1.0, 3.0}
    message = verify(scene, model)
    assert not message.differences and message.perturbed is not None and message.perturbed.largest < 1e-9


def test_in_a_text_it_follows_parameters() -> None:
    """A formula of the speeds there, too: verify changes each parameter and compares all numbers."""
    scene = loads(
        "parameters: {v: 700 mm/s, r: 10 mm}\n"
        + TEXT.replace("speed: 70 rad/s", "speed: v/r").replace("radius: 10 mm", "radius: r")
    )
    model = lower(scene)
    smooth = {p.data_set: p.formula for p in model.parameters if p.member == "v_n"}
    assert smooth["contact_0"] == "max(1 mm/s, min(20 mm/s, 0.01*abs(v/r)*(r)))" and not smooth["contact_2"]
    message = verify(scene, model)
    assert not message.differences and message.perturbed is not None and message.perturbed.largest < 1e-9


def test_old_scenes_of_the_repository_say_what_they_mean() -> None:
    for file in sorted(samples().rglob("*.yaml")):
        assert not lower(mdlgen.load(file)).following, file
