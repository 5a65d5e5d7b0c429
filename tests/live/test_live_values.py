"""What can be turned in a scene, and how values are written back: without a server."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path

import pytest
from living import scene

from mdlgen.errors import SpecError
from mdlgen.live.controls import Control, controls, of_pattern
from mdlgen.live.session import Session
from mdlgen.live.writing import still_turned, with_values
from mdlgen.paths import samples
from mdlgen.spec.document import parse
from mdlgen.spec.load import load, loads

NIPS = (samples() / "transport_nips.yaml").read_text("utf-8")
FOUR = (samples() / "transport_4x4.yaml").read_text("utf-8")


def found(text: str) -> dict[str, Control]:
    return {control.path: control for control in controls(loads(text), parse(text, "scene"))}


def test_parameters_come_first_with_their_ranges() -> None:
    ranged = "{value: 1400.25 mm/s, range: [0.6 m/s, 2 m/s]}"
    text = NIPS.replace("speed: 1400.25 mm/s", f"speed: {ranged}, half: speed/2")
    all_of = found(text)
    first = [path.removeprefix("parameters.") for path in all_of][:5]
    assert first == ["nip_force", "speed", "half", "radius", "k_note"]
    speed = all_of["parameters.speed"]
    assert (speed.number, speed.unit, speed.text) == (1400.25, "mm/s", "1400.25 mm/s")
    # in the unit of the value
    assert (speed.low, speed.high) == (pytest.approx(600.0), pytest.approx(2000.0))
    force = all_of["parameters.nip_force"]
    # half to one and a half of 3.194847641 N, on round numbers
    assert (force.low, force.high, force.step) == (1.59, 4.8, 0.01)
    half = all_of["parameters.half"]  # a formula has a field alone
    assert half.text == "speed/2" and half.number is None and half.low is None


def test_a_scene_without_parameters_has_its_values() -> None:
    all_of = found(FOUR)
    assert not any(path.startswith("parameters") for path in all_of)
    assert {
        "sheets.note.turn",
        "rollers.motor_1_left.drive.speed",
        "contacts.4.friction",
        "run.duration",
    } <= set(all_of)
    # texts that are no number, and files, are not among them
    assert not any(
        path.rpartition(".")[2] in ("name", "axis", "material", "layout", "file") for path in all_of
    )
    for control in all_of.values():
        assert control.number is not None and control.low is not None and control.high is not None
        assert control.low <= control.number <= control.high
        assert control.step == 1.0 or 100 * (control.step or 1.0) <= control.high - control.low
    boxes = all_of["sheets.note.boxes.0"]
    assert (boxes.low, boxes.high, boxes.step) == (5.0, 20.0, 1.0)
    assert all_of["contacts.4.friction"].group == "contacts.4 (note, motor_*)"
    restitution = loads(FOUR.replace("restitution: 0.5", "restitution: 0.9"))
    (top,) = {
        c.high
        for c in controls(restitution, parse(FOUR.replace("restitution: 0.5", "restitution: 0.9"), "s"))
        if c.label == "restitution"
    }
    assert top == 1.0  # which the scene allows at most


def test_one_control_for_several_values() -> None:
    control = of_pattern(FOUR, "rollers.motor_*.drive.speed")
    assert (control.path, control.group) == ("rollers.motor_*.drive.speed", "several at once")
    assert (control.number, control.unit, control.low, control.high) == (186.7, "rad/s", 93.3, 280.1)
    text = with_values(FOUR, "s", {control.path: "90 rad/s"})
    assert text == FOUR.replace("186.7 rad/s", "90 rad/s")
    for wrong in ("rollers.*.axis", "meshes.*.file", "rollers.none_*.radius", "name", "a b", "rollers", ""):
        with pytest.raises(SpecError):
            of_pattern(FOUR, wrong)


def test_every_value_can_be_set_by_its_path() -> None:
    for text in (NIPS, FOUR):
        for path, control in found(text).items():
            changed = loads(text, "scene", [f"{path}={control.text}"])
            assert changed == loads(text), path


def test_only_the_values_change() -> None:
    text = with_values(
        FOUR, "s", {"rollers.motor_1_left.drive.speed": "90 rad/s", "sheets.note.boxes.1": "12"}
    )
    old, new = FOUR.splitlines(), text.splitlines()
    assert len(old) == len(new)
    assert [(a, b) for a, b in zip(old, new, strict=True) if a != b] == [
        ("    boxes: [10, 20]               # the grid; [1, 1] is a rigid block",
         "    boxes: [10, 12]               # the grid; [1, 1] is a rigid block"),
        ("    drive: {speed: 186.7 rad/s, ramp: 5 ms}   # leave it out, and the roller turns freely",
         "    drive: {speed: 90 rad/s, ramp: 5 ms}   # leave it out, and the roller turns freely"),
    ]  # fmt: skip


def test_the_range_of_a_parameter_stays() -> None:
    text = NIPS.replace("speed: 1400.25 mm/s", "speed: {value: 1400.25 mm/s, range: [0.6 m/s, 2 m/s]}  ")
    assert with_values(text, "s", {"parameters.speed": "900 mm/s"}) == text.replace("1400.25", "900")


def test_line_ends_quotes_and_json_stay() -> None:
    windows = FOUR.replace("\n", "\r\n")
    assert with_values(windows, "s", {"run.duration": "20 ms"}) == windows.replace("50 ms", "20 ms")
    quoted = FOUR.replace("thickness: 0.1 mm", "thickness: '0.1 mm'  ")
    changed = with_values(quoted, "s", {"sheets.note.thickness": "0.2 mm"})
    assert changed == quoted.replace("'0.1 mm'", "'0.2 mm'")
    data = json.dumps(parse(FOUR, "s").data, indent=1)
    written = with_values(data, "s", {"run.duration": "20 ms", "sheets.note.boxes.0": "4"})
    assert json.loads(written)["run"] == {"duration": "20 ms"} and json.loads(written)["sheets"]["note"][
        "boxes"
    ] == [4, 20]
    assert len(written.splitlines()) == len(data.splitlines())


def test_a_part_that_is_made_is_written_out_with_the_comments() -> None:
    """One of the nips of a `repeat`: there is no place for its value alone."""
    path = "nips.nip_1_left.force"
    text = with_values(NIPS, "s", {path: "2 N"})
    assert loads(text).nips["nip_1_left"].force == pytest.approx(2.0)
    assert "# weight" not in text and "# The note of transport_4x4 between the same four pairs" in text
    assert "# paper Table 2, edge-to-edge" in text


def test_what_the_file_changes_is_turned_no_more() -> None:
    turned = {"parameters.speed": "900 mm/s", "parameters.radius": "8 mm", "run.duration": "20 ms"}
    after = NIPS.replace("radius: 7.5 mm", "radius: 7 mm").replace("run: {duration: 50 ms}", "")
    assert still_turned(NIPS, after, turned) == {"parameters.speed": "900 mm/s"}
    assert still_turned(NIPS, "name: [", turned) == turned


def test_a_file_that_was_edited_is_not_written_over(tmp_path: Path) -> None:
    async def write() -> None:
        session = Session(spec)
        session.text, session.turned = spec.read_text("utf-8"), {"parameters.speed": "900 mm/s"}
        spec.write_text(edited, "utf-8")
        session.write()

    spec = scene(tmp_path)
    edited = spec.read_text("utf-8") + "# a thought\n"
    with pytest.raises(SpecError, match="has been edited meanwhile"):
        asyncio.run(write())
    assert spec.read_text("utf-8") == edited


def test_a_scene_that_would_be_wrong_is_not_written(tmp_path: Path) -> None:
    async def write() -> None:
        session = Session(spec)
        session.text, session.turned = text, {"sheets.note.thickness": "1 m"}
        session.write()

    spec = scene(tmp_path)
    text = spec.read_text("utf-8")
    with pytest.raises(SpecError, match="thickness"):
        asyncio.run(write())
    assert spec.read_text("utf-8") == text and load(spec)
