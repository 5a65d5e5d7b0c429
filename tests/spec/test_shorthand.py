"""Contacts by name, lists in `between`, and defaults: the same scene, and mistakes where they stand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML

from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.lattice.symmetry import find as symmetry
from mdlgen.checks import lints
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import loads
from mdlgen.spec.scene import Scene
from mdlgen.spec.schema import json_schema

FOUR = (samples() / "transport_4x4.yaml").read_text("utf-8")
PLAIN = loads(FOUR)
HEAD, REST = FOUR[: FOUR.index("contacts:")], FOUR[FOUR.index("run: {") :]
# each contact of the sample, with what they have in common said once
SHORT = """defaults:
  contacts: {restitution: 50 %, friction: 1.0, smoothing: 20 mm/s}
contacts:
  row_1_left: {between: [motor_1_left, counter_1_left], stiffness: 30.5 N/mm^1.5}
  row_1_right: {between: [motor_1_right, counter_1_right], stiffness: 30.5 N/mm^1.5}
  row_2_left: {between: [motor_2_left, counter_2_left], stiffness: 30.5 N/mm^1.5}
  row_2_right: {between: [motor_2_right, counter_2_right], stiffness: 30.5 N/mm^1.5}
  grip: {between: [note, ["motor_1_*", "motor_2_*"]], stiffness: 300 N/mm^1.5}
  press: {between: [["no*"], "counter_*"], stiffness: 300 N/mm^1.5, friction: 0.33}
  rest: {between: [note, support], stiffness: 100 N/mm^1.5, friction: 0.3}
"""
TEXT = HEAD + SHORT + REST


def refused(*pairs: tuple[str, str], sets: tuple[str, ...] = ()) -> SpecError:
    text = TEXT
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new, 1)
    with pytest.raises(SpecError) as raised:
        loads(text, "s.yaml", sets)
    assert raised.value.others == ()
    return raised.value


def plain(scene: Scene) -> Scene:
    """Without what only the short text has."""
    contacts = tuple(contact.model_copy(update={"name": None}) for contact in scene.contacts)
    return scene.model_copy(update={"contacts": contacts, "defaults": None})


def test_the_short_text_is_the_same_scene() -> None:
    short = loads(TEXT)
    assert [c.name for c in short.contacts][4:] == ["grip", "press", "rest"]
    assert short.contact_pairs() == PLAIN.contact_pairs()
    between = [{"between": c.between} for c in PLAIN.contacts]
    same = [c.model_copy(update=b) for c, b in zip(plain(short).contacts, between, strict=True)]
    assert plain(short).model_copy(update={"contacts": tuple(same)}) == PLAIN


def test_set_and_lints_use_the_name() -> None:
    scene = loads(TEXT, "s", ["contacts.grip.stiffness=200 N/mm^1.5", "contacts.row_*.friction=0.5"])
    assert scene.contacts[4].stiffness == 200.0
    assert [c.friction.static for c in scene.contacts] == [0.5] * 4 + [1.0, 0.33, 0.3]
    found = lints(lower(loads(TEXT, "s", ["contacts.press.stiffness=100 N/mm^1.5"])))
    assert "contacts.press.stiffness" in {lint.where for lint in found}
    assert loads(TEXT, "s", ["defaults.contacts.friction=0.7"]).contacts[0].friction.static == 0.7


def test_names_of_contacts_do_not_hide_a_mirror_image() -> None:
    model, unnamed = lower(loads(TEXT)), lower(PLAIN)
    mirror = symmetry.find(model, build(model))
    assert mirror is not None
    # an unnamed scene has the same one
    plain_mirror = symmetry.find(unnamed, build(unnamed))
    assert plain_mirror is not None
    np.testing.assert_array_equal(mirror.image, plain_mirror.image)


def test_defaults_of_rollers() -> None:
    text = FOUR.replace("    radius: 7.5 mm\n    width: 5 mm\n", "").replace("    width: 5 mm\n", "")
    text = text.replace(", damping_ratio: 0.05, free_length: 6 mm}", "}")
    short = "defaults: {rollers: {diameter: 15 mm, width: 5 mm}}\n"
    # counters keep a radius of their own beside the default diameter
    assert plain(loads(text + short)) == PLAIN


def test_a_mapping_is_filled_key_by_key_and_null_leaves_it_out() -> None:
    text = FOUR.replace("press: {direction: -z, ", "press: {")
    none = text.replace("ramp: 5 ms}", "ramp: 5 ms}\n    press: null")
    assert plain(loads(none + "defaults: {rollers: {press: {direction: -z}}}\n")) == PLAIN


@pytest.mark.parametrize(
    ("old", "new", "path", "text"),
    [
        (
            "smoothing: 20 mm/s}",
            "smoothing: 20 mm}",
            "defaults.contacts.smoothing",
            "expected a unit like 'mm/s'",
        ),
        (
            "{restitution: 50 %",
            "{restitutio: 50 %",
            "defaults.contacts.restitutio",
            "did you mean 'restitution'",
        ),
        ("note, support]", "note, suport]", "contacts.rest.between.1", "did you mean 'support'"),
        ('["no*"]', '["no*", x]', "contacts.press.between.0.1", "there is no part 'x'"),
        ('["no*"]', "[]", "contacts.press.between", "or lists of them"),
        ("stiffness: 100 N/mm^1.5", "stiffnes: 100 N/mm^1.5", "contacts.rest.stiffnes", "mean 'stiffness'"),
        ("  grip:", "  9grip:", "contacts.9grip", "is not a name"),
        ("[note, support]", '[note, "motor_1*"]', "contacts.rest.between", "already has contacts.grip"),
    ],
)
def test_a_mistake_is_where_it_stands(old: str, new: str, path: str, text: str) -> None:
    error = refused((old, new))
    assert ".".join(map(str, error.path)) == path and text in error.message
    line = TEXT[: TEXT.index(old)].count("\n") + 1
    assert error.place is not None and error.place.line == line


def test_set_of_a_contact_that_is_not_there() -> None:
    error = refused(sets=("contacts.gripp.friction=0.5",))
    assert error.message.startswith(
        "there is no 'gripp' in contacts; did you mean 'grip'? there are: row_1_left"
    )


def test_the_schema_knows_them() -> None:
    schema = json_schema()
    assert [way["type"] for way in schema["properties"]["contacts"]["anyOf"]] == ["array", "object"]
    defaults = schema["$defs"]["Defaults"]["properties"]
    known = schema["$defs"]["Contact"]["properties"]
    for name, ref in defaults["contacts"]["properties"].items():
        assert ref == {"$ref": f"#/$defs/Contact/properties/{name}"} and name in known
    assert (
        "between" not in defaults["contacts"]["properties"] and "radius" in defaults["rollers"]["properties"]
    )


def test_the_json_schema_knows_the_short_forms() -> None:
    schema = json_schema()
    models = schema["$defs"]
    number, text, two, both = models["Contact"]["properties"]["friction"]["anyOf"]
    assert (number["type"], text["type"], both) == ("number", "string", {"$ref": "#/$defs/Friction"})
    assert two["items"]["anyOf"] == [number, text]
    # of a nip the preload follows from its force
    press = models["Nip"]["properties"]["upper"]["properties"]["press"]["anyOf"][0]
    assert "preload" in press["properties"] and not {"preload", "direction"} & set(press["required"])
    assert {"preload", "direction"} <= set(models["Press"]["required"])


WHOLE = """
name: s
materials: {p: {E_md: 2000 MPa, E_cd: 2000 MPa, D_md: 0.3 N*mm, D_cd: 0.3 N*mm}}
sheets: {n: {material: p, size: [80 mm, 50 mm], thickness: 0.1 mm, mass: 1 g, boxes: [4, 3]}}
rollers: {m: {center: [0 mm, 0 mm, -5 mm], axis: y, radius: 5 mm, width: 8 mm, mass: 10 g}}
contacts: {grip: {between: [n, m], stiffness: 300 N/mm^1.5, friction: 0.5}}
run: {duration: 1 ms}
"""
NIP = """
nips: {e: {at: [30 mm, 0 mm, 0 mm], force: 2 N, lower: {radius: 6 mm, width: 8 mm, mass: 9 g},
  upper: {radius: 4 mm, width: 8 mm, mass: 4 g, press: {stiffness: 0.3 N/mm}}}}
"""


def flagged(text: str, *changes: tuple[str, str]) -> bool:
    """Whether an editor that has the schema marks a scene."""
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return not Draft202012Validator(json_schema()).is_valid(YAML(typ="safe").load(text))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (", mass: 10 g", ""),
        (", friction: 0.5", ""),
        (", radius: 5 mm", ""),
        (", radius: 5 mm", ", radius: 5 mm, diameter: 10 mm"),
        ("center: [0 mm, 0 mm, -5 mm], ", ""),
        ("between: [n, m], ", ""),
    ],
)
def test_the_schema_requires_what_a_scene_must_have(old: str, new: str) -> None:
    assert not flagged(WHOLE)
    assert flagged(WHOLE, (old, new))
    given = "defaults: {rollers: {mass: 1 g, radius: 5 mm}, contacts: {friction: 0.1}}\n"
    alone = old.startswith(("center", "between")) or new != ""
    assert flagged(WHOLE + given, (old, new)) is alone


def test_the_schema_takes_a_part_of_what_a_nip_makes() -> None:
    parts = (
        ("rollers: {m:", "rollers: {e_upper: {mass: 3 g}, m:"),
        ("{grip:", "{e_upper: {friction: 1}, grip:"),
    )
    assert flagged(WHOLE, *parts)
    assert not flagged(WHOLE + NIP, *parts)
    assert flagged(WHOLE + NIP, ("rollers: {m:", "rollers: {e_upper: {width: 3}, m:"))


@pytest.mark.parametrize("path", sorted(samples().rglob("*.yaml")), ids=lambda path: path.stem)
def test_the_schema_takes_every_sample(path: Path) -> None:
    scene = YAML(typ="safe").load(path.read_text("utf-8"))
    found = [error.message for error in Draft202012Validator(json_schema()).iter_errors(scene)]
    assert "sheets" not in scene or found == []


ROW = """
name: row
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {p: {E_md: 2000 MPa, E_cd: 2000 MPa, D_md: 0.3 N*mm, D_cd: 0.3 N*mm}}
sheets: {n: {material: p, size: [80 mm, 50 mm], thickness: 0.1 mm, mass: 1 g, boxes: [4, 3]}}
rollers:
  "m*_l": {center: [-20 mm, 0 mm, -5.1 mm], axis: y, diameter: 10 mm, width: 8 mm, mass: 10 g,
    repeat: {count: 3, step: [15 mm, 0 mm, 0 mm]}}
nips:
  grip: {at: [30 mm, 0 mm, 0 mm], force: 2 N,
    lower: {name: low, diameter: 12 mm, width: 8 mm, mass: 9 g,
      drive: {surface_speed: 0.4 m/s, direction: +x}, contact: {stiffness: 300 N/mm^1.5, friction: 1}},
    upper: {name: top, diameter: 8 mm, width: 8 mm, mass: 4 g,
      contact: {stiffness: 300 N/mm^1.5, friction: 1}}}
contacts: [{between: [n, "m*"], stiffness: 300 N/mm^1.5, friction: 0.5}]
run: {duration: 1 ms}
"""


def test_a_roller_of_a_row_takes_a_value_of_its_own() -> None:
    scene = loads(ROW, "row", ("rollers.m2_l.radius=4 mm", "rollers.m2_l.mass=7 g"))
    assert {name: roller.radius for name, roller in scene.rollers.items() if name.startswith("m")} == {
        "m1_l": 5.0,
        "m2_l": 4.0,
        "m3_l": 5.0,
    }
    assert [scene.rollers[f"m{k}_l"].mass for k in (1, 2, 3)] == [10.0, 7.0, 10.0]
    assert scene.rollers["m3_l"].center[0] == 10.0


def test_patterns_meet_the_rollers_that_a_row_makes() -> None:
    scene = loads(ROW, "row", ("rollers.m?_l.width=6 mm",))
    assert [scene.rollers[f"m{k}_l"].width for k in (1, 2, 3)] == [6.0, 6.0, 6.0]
    assert [loads(ROW, "row", ("rollers.m*.width=5 mm",)).rollers[f"m{k}_l"].width for k in (1, 2, 3)] == [
        5.0
    ] * 3


def test_a_mistake_in_a_value_of_one_is_reported_at_it() -> None:
    with pytest.raises(SpecError, match=r"rollers\.m2_l\.radius"):
        loads(ROW, "row", ("rollers.m2_l.radius=4 N",))


def test_what_says_the_same_otherwise_goes_in_nips_too() -> None:
    """The drive's surface_speed and direction, and the diameter."""
    scene = loads(ROW, "row", ("rollers.low.drive.speed=60 rad/s", "rollers.low.radius=7 mm"))
    assert scene.rollers["low"].drive.speed == pytest.approx(0.06)
    assert scene.rollers["low"].radius == 7.0
