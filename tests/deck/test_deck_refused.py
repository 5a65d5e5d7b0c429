"""Decks that are refused: hostile, malformed, of scenes that a deck cannot say."""

from __future__ import annotations

import json
import re

import pytest
from decks import FOUR, SHORT_SPRING, SMALL, deck_of, model_of, small_deck

from mdlgen.backends import motionsolve
from mdlgen.backends.motionsolve.writer.environment import comment
from mdlgen.errors import MdlgenError, RefusedError, SpecError


def test_a_spring_shorter_than_its_compression_is_refused_by_name() -> None:
    model = model_of(FOUR, SMALL, SHORT_SPRING)
    with pytest.raises(RefusedError, match="spring of roller counter_") as error:
        motionsolve.check(model)
    assert error.value.path[0] == "rollers" and error.value.path[2:] == ("press", "free_length")


def test_names_that_would_meet_are_refused() -> None:
    contact = 'contacts=[{"between":["motor_1_left","counter_1_left"],"stiffness":"1 N/mm^1.5","friction":0}]'
    fine = json.loads(
        '{"center":["500 mm","0 mm","0 mm"],"axis":"y","radius":"1 mm","width":"1 mm","mass":"1 g"}'
    )
    twin = f"rollers.counter_1_left_carrier={json.dumps(fine)}"
    with pytest.raises(SpecError, match="would be called"):
        motionsolve.emit(model_of(FOUR, SMALL, contact, twin))


def test_what_is_pasted_is_escaped_and_cannot_end_a_comment() -> None:
    assert "--" not in comment("a --> b")
    from mdlgen.backends.motionsolve.writer.environment import environment

    assert environment().from_string("{{ x }}").render(x='"<&>') == "&#34;&lt;&amp;&gt;"


LAUGHS = (
    '<?xml version="1.0"?>\n<!DOCTYPE x [<!ENTITY a "ha">'
    + "".join(f'<!ENTITY {b} "{f"&{a};" * 20}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True))
    + "]>\n<MultiBodySystem>&i;</MultiBodySystem>"
)
OUTSIDE = '<!DOCTYPE x [<!ENTITY f SYSTEM "file:///etc/passwd">]>\n<MultiBodySystem><Model>&f;</Model></MultiBodySystem>'
HOSTILE = {
    "nothing": "",
    "words": "hello",
    "half": '<?xml version="1.0"?>\n<MultiBodySystem>\n<Model>',
    "another root": "<html/>",
    "no model": "<MultiBodySystem><Command/></MultiBodySystem>",
    "no command": "<MultiBodySystem><Model/></MultiBodySystem>",
    "no run": "<MultiBodySystem><Model/><Command/></MultiBodySystem>",
    "laughs": LAUGHS,
    "outside": OUTSIDE,
    "outside by a parameter": '<!DOCTYPE x SYSTEM "http://127.0.0.1:9/x.dtd">\n<MultiBodySystem/>',
    "entity that is not there": "<MultiBodySystem><Model>&what;</Model></MultiBodySystem>",
    "another encoding": '<?xml version="1.0" encoding="UTF-16"?><MultiBodySystem/>',
    "null": "<MultiBodySystem>\x00</MultiBodySystem>",
    "surrogate": "<MultiBodySystem>\ud800</MultiBodySystem>",
    "deep": "<MultiBodySystem>" + "<Model>" * 100_000,
    "an attribute twice": '<MultiBodySystem a="1" a="2"/>',
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_deck_ends_in_one_line(name: str) -> None:
    with pytest.raises(SpecError) as error:
        _ = motionsolve.read(HOSTILE[name], "bad.xml").values
    assert re.match(r"bad\.xml:\d+: ", str(error.value)), str(error.value)
    assert "\n" not in str(error.value) and "root:" not in str(error.value)
    problems = motionsolve.validate(HOSTILE[name], "bad.xml")
    assert problems and all(re.match(r"bad\.xml:\d+: ", problem) for problem in problems)


ATTRIBUTES = (
    "id mass cg_id pos_x a00 expr kx preload length i_graphics_id penalty cff_type joint_id expr2 comment "
    "ends_type end_time num_marker_row grav_x val_type"
)


@pytest.mark.parametrize("attribute", ATTRIBUTES.split())
@pytest.mark.parametrize(
    "value", ["", "x", "1e999", "nan", "-1", "99999999999999999999", "1_0", "&#10;", "0x10"]
)
def test_a_wrong_attribute_never_ends_in_a_traceback(attribute: str, value: str) -> None:
    text = re.sub(rf'(\n +{attribute} +)= "[^"]*"', rf'\1= "{value}"', small_deck())
    assert text != small_deck()
    try:
        _ = motionsolve.read(text, "bad.xml").values
    except MdlgenError as error:
        assert re.match(r"bad\.xml:\d+: ", str(error))
    for problem in motionsolve.validate(text, "bad.xml"):
        assert re.match(r"bad\.xml:\d+: ", problem)


@pytest.mark.parametrize(
    "attribute", ["cg_id", "body_id", "kx", "type", "joint_id", "penalty", "expr3", "end_time"]
)
def test_a_missing_attribute_never_ends_in_a_traceback(attribute: str) -> None:
    text = re.sub(rf'\n +{attribute} += "[^"]*"', "", small_deck())
    assert text != small_deck()
    assert motionsolve.validate(text)
    if attribute != "end_time":
        with pytest.raises(SpecError, match=rf"<deck>:\d+: .*{attribute} is missing"):
            _ = motionsolve.read(text).values


def test_two_of_a_name_are_refused() -> None:
    text = deck_of("surface").replace("<!-- MODEL.b_note_1_0 -->", "<!-- MODEL.b_note_0_0 -->")
    with pytest.raises(SpecError, match="name is taken"):
        _ = motionsolve.read(text).values
