"""How sensors and rules are written, and the line for what is wrong with one."""

from __future__ import annotations

import re
from typing import Any

import pytest

import mdlgen
from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError

REGISTER = "samples/register.yaml"
STILL = "sensors.eye.beam"


def scene(**changes: Any) -> mdlgen.Scene:
    return mdlgen.load(REGISTER).with_(changes)


def rule(**more: Any) -> dict[str, Any]:
    return {"when": "eye covered", "do": {"end": True}, **more}


def test_a_scene_with_rules_reads_back_as_it_is_written() -> None:
    one = mdlgen.load(REGISTER)
    data = one.model_dump(mode="json", exclude_none=True)
    assert mdlgen.Scene(**data).rules == one.rules
    assert mdlgen.Scene(**data).sensors == one.sensors


def test_a_command_means_a_name_a_pattern_or_a_nip() -> None:
    def ordered(name: str) -> list[str]:
        model = mdlgen.lower(scene(rules=[rule(do={"speed": {name: "5 rad/s"}})]))
        return [order.name for order in model.reactions.rules[0].orders]

    assert ordered("motor_1_left") == ["motor_1_left"]
    assert ordered("motor_*_left") == ["motor_1_left", "motor_2_left"]
    assert ordered("*_1_left") == ["motor_1_left"]  # the counter roller has no drive
    assert ordered("nip_1_left") == ["motor_1_left"]


def test_a_nip_is_pressed_as_its_force_says() -> None:
    # what the rule orders is the preload that the nip would have with that force
    def order(name: str, force: str) -> dict[str, float]:
        model = mdlgen.lower(scene(rules=[rule(do={"press": {name: force}})]))
        return {order.name: order.value for order in model.reactions.rules[0].orders}

    for force in ("3 N", "5 N", "0.2 N"):
        other = mdlgen.lower(scene(**{"nips.nip_*_*.force": force})).rollers
        exact = {r.name: r.press.preload for r in other if r.press is not None}
        assert order("nip_1_left", force) == pytest.approx({"counter_1_left": exact["counter_1_left"]})
        assert order("nip_*_left", force).keys() == {"counter_1_left", "counter_2_left"}
    assert order("counter_1_left", "5 N") == {"counter_1_left": 5.0}


def test_a_surface_goes_in_the_sense_of_its_own_drive() -> None:
    command = {"speed": {"motor_1_left": {"surface_speed": "750 mm/s", "ramp": "2 ms"}}}
    order = mdlgen.lower(scene(rules=[rule(do=command)])).reactions.rules[0].orders[0]
    assert order.value == pytest.approx(0.1) and order.ramp == 2.0
    turned = {"rules": [rule(do=command)], "parameters.speed": "-1400 mm/s"}
    assert mdlgen.lower(mdlgen.load(REGISTER).with_(turned)).reactions.rules[0].orders[0].value == -0.1


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"sensors.eye": {}}, "sensors.eye: give exactly one of beam, point and line, not none"),
        (
            {"sensors.eye": {"point": ["0 mm"] * 3}},
            "sensors.eye: a point needs a direction in which it looks, as direction: z",
        ),
        ({STILL: [["1 mm", "0 mm", "0 mm"]] * 2}, "both ends of the beam are at one place"),
        ({STILL: ["1 mm"]}, "expected two points"),
        (
            {"sensors.eye": {"line": [["0 mm"] * 3, ["0 mm", "5 mm", "0 mm"]], "direction": "y"}},
            "sensors.eye.direction: the line looks along itself, where it sees nothing",
        ),
        ({"sensors.eye.sees": ["card*"]}, "sensors.eye.sees.0: there is no part 'card*'"),
        (
            {"sensors.eye.hysteresis": "0 mm"},
            "sensors.eye.hysteresis: 0 mm is outside what is allowed: at least 0.001 mm",
        ),
        ({"rules": [rule(when="eye coverd")]}, "rules.0.when: 'eye coverd'"),
        ({"rules": [rule(when="gap(eye) < 3 ms")]}, "rules.0.when: 'gap(eye) < 3 ms': compares mm with s"),
        (
            {"rules": [rule(when="count(eye) = 1")]},
            "rules.0.when: 'count(eye) = 1': = compares nothing; write ==",
        ),
        (
            {"rules": [rule(do="stop")]},
            "rules.0.do: expected a mapping with keys of speed, press, torque, move",
        ),
        ({"require": ["sheets.note.yaw < 1 deg"]}, "in place of < and > write below and above"),
        ({"rules": [rule(do={})]}, "rules.0.do: a rule has to do something"),
        (
            {"rules": [rule(do={"speed": {"counter_1_left": "1 rad/s"}})]},
            "counter_1_left has no drive; those that have one are: motor_1_left",
        ),
        ({"rules": [rule(do={"speed": {"motr": "1 rad/s"}})]}, "there is no part 'motr'"),
        (
            {"rules": [rule(do={"speed": {"motor_1_left": {}}})]},
            "give exactly one of speed and surface_speed",
        ),
        ({"rules": [rule(do={"press": {"motor_1_left": "1 N"}})]}, "there is no part 'motor_1_left'"),
        (
            {"rules": [rule(do={"go": "wait"}), rule(**{"in": "waits"})]},
            "rules.0.do.go: there is no state of a rule's `in` 'wait'; did you mean 'waits'?",
        ),
        (
            {"rules": [rule(do={"press": {"nip_1_lef": "1 N"}})]},
            "there is no part 'nip_1_lef'; did you mean 'nip_1_left'?",
        ),
        ({"rules": [rule(when="note left")]}, "rules.0.when: note never leaves; give sheets.note out"),
        ({"require": ["note left"]}, "require.0: note never leaves"),
        ({"require": ["eie covered"]}, "require.0: there is no sensor 'eie'; did you mean 'eye'?"),
        ({"require": ["infed left"]}, "require.0: there is no sheet or stream 'infed'; there are: note"),
        ({"rules": [rule()], "run.analysis": "static"}, "rules: rules act over time"),
        ({"rules": [rule()] * 201}, "rules: 201 rules; allowed are 200"),
        ({"require": ["gap at ear below 3 mm"]}, "require.0: there is no sensor 'ear'; there are: eye"),
        ({"require": ["yaw at eye below 3 deg"]}, "of sheets that go by a sensor there are gap, speed"),
    ],
)
def test_what_is_wrong_is_said_where_it_stands(changes: dict[str, Any], line: str) -> None:
    with pytest.raises(SpecError) as raised:
        scene(**changes)
    assert line in str(raised.value)
    assert "\n" not in raised.value.message


def test_units_of_conditions_are_checked_beside_other_mistakes() -> None:
    wrong = {"sheets.note.velocity": [1, "0 m/s", "0 m/s"]}
    for when, said in (("time > 0", "as 0 s"), ("gap(eye) < 3 ms", "compares mm with s")):
        with pytest.raises(SpecError) as raised:
            scene(rules=[rule(when=when)], **wrong)
        assert "velocity.0" in str(raised.value)
        assert [said in str(other) for other in raised.value.others] == [True]
    # names and parameters are not known while values are wrong
    with pytest.raises(SpecError) as raised:
        scene(rules=[rule(when="gap(eye) < span")], **wrong)
    assert not raised.value.others


@pytest.mark.parametrize("output", ["motionview", "motionsolve", "msolve"])
def test_texts_refuse_rules_and_name_sensors(output: str) -> None:
    model = mdlgen.lower(mdlgen.load(REGISTER))
    with pytest.raises(
        RefusedError, match=re.escape("rules.0 (when eye covered) acts on what the sheets do")
    ):
        mdlgen.emit(model, output)
    text = mdlgen.emit(mdlgen.lower(scene(rules=[])), output)
    assert "sensors, which act on nothing (eye)" in text


@pytest.mark.parametrize(
    ("changes", "codes"),
    [
        ({}, set()),
        ({STILL: [["900 mm", "0 mm", "-5 mm"], ["900 mm", "0 mm", "5 mm"]]}, {"W165", "W167"}),
        ({"rules": [rule(when="time > 200 ms")]}, {"W165"}),
        # shorter than a thousandth of the run, at times that no grid has
        ({"rules": [rule(when="time > 71.3021 ms and time < 71.3022 ms")]}, set()),
        ({"rules": [rule(when="2*time == 142.6042 ms")]}, set()),
        ({"rules": [rule(when="time > 71.3022 ms and time < 71.3021 ms")]}, {"W165"}),
        ({"rules": [rule(when="not eye covered")]}, set()),
        ({"rules": [rule(**{"in": "a"}), rule(**{"in": "b"})]}, {"W165"}),
        ({"rules": [rule(**{"in": "a", "do": {"go": "b"}}), rule(**{"in": "b"})]}, set()),
        ({"rules": [rule(**{"in": "a", "do": {"go": "done"}})]}, {"W189"}),
        ({"rules": [rule(**{"in": "a", "do": {"go": "done"}}), rule()]}, set()),
        (
            {
                "rules": [
                    rule(do={"speed": {"motor_1_left": "1 rad/s"}}),
                    rule(do={"speed": {"motor_*_left": "2 rad/s"}}),
                ]
            },
            {"W166"},
        ),
    ],
)
def test_lints(changes: dict[str, Any], codes: set[str]) -> None:
    found = {lint.code for lint in lints(mdlgen.lower(scene(**changes)))}
    assert found & {"W165", "W166", "W167", "W189"} == codes
