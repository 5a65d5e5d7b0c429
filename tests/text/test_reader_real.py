"""The reader of MDL against a deck that MotionView itself exported."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest
from places import REAL

from mdlgen.backends.motionview.reader import Report, read

# A deck shows eight digits, so half a unit of the last one.
DECK = 5e-8
real = pytest.mark.skipif(not REAL.is_dir(), reason="the real pair lies outside of the repository")


class Deck:
    """What a solver deck states, by the full name in the comment above each element."""

    def __init__(self, file: Path):
        parser = ET.XMLParser(target=ET.TreeBuilder(insert_comments=True))
        self.elements: list[tuple[str, str, dict[str, str]]] = []
        name = ""
        for element in ET.parse(file, parser).getroot().iter():
            if element.tag is ET.Comment:
                text = (element.text or "").strip()
                name = text.removeprefix("MODEL.") if text.startswith("MODEL") else ""
            else:
                self.elements.append((str(element.tag), name, dict(element.attrib)))
                name = ""
        self.markers = {a["id"]: (n, a) for t, n, a in self.elements if t == "Reference_Marker"}

    def named(self, tag: str, *without: str) -> dict[str, dict[str, str]]:
        """Elements that have a name, but for those that a missing include makes."""
        found = {n: a for t, n, a in self.elements if t == tag and n}
        return {n: a for n, a in found.items() if not any(part in n for part in without)}


def numbers(attributes: dict[str, str], keys: str, default: str = "0") -> list[float]:
    return [float(attributes.get(key, default)) for key in keys.split()]


def same(found: Any, due: list[float]) -> bool:
    return found == pytest.approx(due, rel=DECK, abs=1e-7)


@pytest.fixture(scope="module")
def pair() -> tuple[dict[str, Any], Report, Deck]:
    file = REAL / "tire_test_rig.mdl"
    reading = read(file.read_text(), file.name)
    return reading.values, reading.report, Deck(REAL / "tire_test_rig.xml")


PRIVATE = "ts_Tire."  # a system whose definition only MotionView has


@real
def test_the_real_file_lints(pair: tuple[dict[str, Any], Report, Deck]) -> None:
    _, report, _ = pair
    assert not report.errors
    assert any("sysDefTire.mdl" in f.message for f in report.warnings)
    assert {f.code for f in report.warnings}.isdisjoint(("unknown", "unread", "standard", "attachment"))


@real
def test_every_marker_of_the_deck(pair: tuple[dict[str, Any], Report, Deck]) -> None:
    found, _, deck = pair
    bodies = {a["id"]: n for n, a in deck.named("Body_Rigid").items()}
    compared = 0
    for name, marker in deck.named("Reference_Marker", PRIVATE).items():
        x, z = numbers(marker, "a00 a10 a20"), numbers(marker, "a02 a12 a22")
        place, x = numbers(marker, "pos_x pos_y pos_z"), x if any(x) else [1, 0, 0]
        z = z if any(z) else [0, 0, 1]
        if name.endswith("_center_marker"):
            graphic = found["graphics"][name.removesuffix("_center_marker")]
            assert graphic["body"] == bodies[marker["body_id"]]
            assert same(graphic.get("center", graphic.get("start")), place), name
            axis = graphic["axis"] if "axis" in graphic else graphic.get("axes", ((), (), z))[2]
            assert same(axis, z), name
        elif name != "Global_Frame":
            own = found["markers"][name]
            assert own["body"] == bodies[marker["body_id"]]
            assert own["label"] == marker["label"]
            assert same(own["origin"], place), name
            assert same(own["axes"][0], x), name
            assert same(own["axes"][2], z), name
        compared += 1
    assert compared == 37
    assert set(found["markers"]) <= set(deck.named("Reference_Marker"))


@real
def test_every_body_of_the_deck(pair: tuple[dict[str, Any], Report, Deck]) -> None:
    found, _, deck = pair
    bodies = deck.named("Body_Rigid", PRIVATE, "B_Ground")
    assert set(bodies) == set(found["bodies"])
    for name, body in bodies.items():
        own = found["bodies"][name]
        assert own["label"] == body["label"]
        assert same([own["mass"]], numbers(body, "mass")), name
        due = numbers(body, " ".join(f"inertia_{k}" for k in ("xx", "yy", "zz", "xy", "yz", "xz")))
        assert same(own["inertia"], due), name
        assert same(own["cm"], numbers(deck.markers[body["cg_id"]][1], "pos_x pos_y pos_z")), name
    assert round(found["bodies"]["sys_comp_testrig.b_rig_body"]["mass"], 4) == 56.1168
    assert round(found["bodies"]["sys_comp_testrig.b_wheel_hub"]["mass"], 5) == 4.62992


@real
def test_every_graphic_of_the_deck(pair: tuple[dict[str, Any], Report, Deck]) -> None:
    found, _, deck = pair
    graphics = deck.named("Post_Graphic", PRIVATE)
    assert set(graphics) == set(found["graphics"])
    for name, graphic in graphics.items():
        own = found["graphics"][name]
        if graphic["type"] == "Frustum":
            due = numbers(graphic, "bottom_radius top_radius length")
            assert same((*own["radii"], own["length"]), due), name
        elif graphic["type"] == "Sphere":
            assert same([own["radius"]], numbers(graphic, "radius")), name
        else:
            assert graphic["type"] == "BoxDefinedFromCenter"
            assert same(own["lengths"], numbers(graphic, "length_x length_y length_z")), name


@real
def test_every_joint_and_motion_of_the_deck(pair: tuple[dict[str, Any], Report, Deck]) -> None:
    found, _, deck = pair
    joints = deck.named("Constraint_Joint", PRIVATE)
    assert {n: a["type"] for n, a in joints.items()} == {n: j["type"] for n, j in found["joints"].items()}
    for name, joint in joints.items():
        ends = tuple(deck.markers[joint[k]][0] for k in ("i_marker_id", "j_marker_id"))
        assert found["joints"][name]["markers"] == ends
    motions = deck.named("Motion_Joint", PRIVATE)
    assert set(motions) == set(found["motions"])
    ids = {a["id"]: n for n, a in joints.items()}
    for name, motion in motions.items():
        own = found["motions"][name]
        assert (own["joint"], own["value"]) == (ids[motion["joint_id"]], motion["expr"])
        assert (own["quantity"][0], own["freedom"][0]) == (motion["val_type"], motion["motion_type"])


@real
def test_data_set_values_stand_in_the_deck(pair: tuple[dict[str, Any], Report, Deck]) -> None:
    """The template of the test writes them, with six digits, into the commands of the deck."""
    found, _, deck = pair
    (inputs,) = (d for n, d in found["datasets"].items() if n.startswith("ana_"))
    commands = [a for t, _, a in deck.elements if t == "Motion_Joint" and "label" not in a]
    assert f"{inputs['long_vel'] * 1e6 / 3600:.6g}" == commands[0]["expr"]
    assert f"{inputs['wheel_omega']:.6g}" == commands[1]["expr"]
    forces = [
        a["val_expression"] for t, _, a in deck.elements if t == "Force_Scalar_TwoBody" and "label" not in a
    ]
    assert [f"{load:.6g}" for load in inputs["tbl_vert_frc_table"]["load"]] == [f.split()[0] for f in forces]
    ends = [
        a["end_time"] for t, _, a in deck.elements if t == "Simulate" and a["analysis_type"] == "Transient"
    ]
    steady, cycle = inputs["steady_state_time"], inputs["cycle_time"]
    assert [float(e) for e in ends] == [steady, steady + cycle, 2 * steady + cycle, 2 * (steady + cycle)]
