"""The engineer's words of a scene: each means what the plain value means, and is answered where it cannot."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import loads
from mdlgen.spec.scene import Scene
from mdlgen.spec.schema import json_schema

FOUR = (samples() / "transport_4x4.yaml").read_text("utf-8")


def changed(*pairs: tuple[str, str]) -> str:
    text = FOUR
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def scene(*pairs: tuple[str, str], sets: tuple[str, ...] = ()) -> Scene:
    return loads(changed(*pairs), "s.yaml", sets)


def refused(*pairs: tuple[str, str], sets: tuple[str, ...] = ()) -> SpecError:
    with pytest.raises(SpecError) as raised:
        scene(*pairs, sets=sets)
    assert raised.value.others == ()
    return raised.value


PLAIN = loads(FOUR)
RADIUS = "radius: 7.5 mm"
MASS = "mass: 0.72 g "
SPEED = "drive: {speed: 186.7 rad/s, ramp: 5 ms}"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (RADIUS, "diameter: 15 mm"),
        ("friction: 0.33", "friction: 33 %"),
        ("restitution: 0.5", "restitution: 50%"),
        ("ratio: 0.12", "ratio: 12 %"),
        ("E_md: 3530 MPa", "E_md: 3530 N/mm2"),
        ("size: [227 mm, 300 mm, 10 mm]", "size: [300 mm, 227 mm, 10 mm]\n    along: y"),
        ("size: [227 mm, 300 mm, 10 mm]", "size: [227 mm, 300 mm, 10 mm]\n    along: -x"),
    ],
)
def test_it_is_the_same_scene(old: str, new: str) -> None:
    assert scene((old, new)) == PLAIN


def test_mass_from_grammage_and_density() -> None:
    area = 67.0 * 127.0  # mm^2
    by_area = scene((MASS, "grammage: 80 g/m^2 ")).sheets["note"].mass
    assert by_area == pytest.approx(80e-6 * area, rel=1e-15)  # a product of three
    by_volume = scene((MASS, "density: 0.8 g/cm^3 ")).sheets["note"].mass
    assert by_volume == pytest.approx(0.8e-3 * area * 0.1, rel=1e-15)
    wide = scene((MASS, "grammage: 80 g/m^2 "), sets=("sheets.note.size.0=134 mm",))
    assert wide.sheets["note"].mass == pytest.approx(2 * by_area, rel=1e-15)


def test_set_takes_the_other_word_away() -> None:
    assert (
        scene((RADIUS, "diameter: 15 mm"), sets=("rollers.motor_1_left.radius=8 mm",))
        .rollers["motor_1_left"]
        .radius
        == 8.0
    )
    assert scene(sets=("sheets.note.grammage=80 g/m^2",)).sheets["note"].mass != PLAIN.sheets["note"].mass
    drive = (
        scene(
            (SPEED, "drive: {surface_speed: 1 m/s, direction: x}"),
            sets=("rollers.motor_1_left.drive.speed=1 rad/s",),
        )
        .rollers["motor_1_left"]
        .drive
    )
    assert drive is not None and drive.speed == 1e-3


def test_a_fixed_plane_needs_no_mass_and_a_pressed_one_does() -> None:
    light = scene(("    mass: 681 g\n", ""))
    assert light.planes["support"].mass == 1.0 and light.rollers == PLAIN.rollers
    press = "    press: {direction: z, stiffness: 1 N/mm, preload: 1 N}\n"
    assert "its mass counts" in refused(("    mass: 681 g\n", press)).message


def speed_of(center: str, axis: str, direction: str) -> float | None:
    """rad/s of a roller of radius 7.5 mm with a surface speed of 1.5 m/s."""
    made = scene(
        ("center: [13.5 mm, -20.5 mm, -7.5016 mm]", f"center: {center}"),
        ("axis: y", f"axis: {axis}"),
        (SPEED, f"drive: {{surface_speed: 1.5 m/s, direction: {direction}}}"),
        ("  - {between: [motor_1_left, counter_1_left]", "  - {between: [motor_1_right, counter_2_left]"),
    )
    drive = made.rollers["motor_1_left"].drive
    assert drive is not None and drive.surface_speed is None and drive.direction is None
    return None if drive.speed is None else 1e3 * drive.speed


BELOW, ABOVE = "[13.5 mm, -20.5 mm, -7.5 mm]", "[13.5 mm, -20.5 mm, 7.5 mm]"


@pytest.mark.parametrize(
    ("center", "axis", "direction", "speed"),
    [
        (BELOW, "y", "+x", 200.0),  # w x r = (0, 200, 0) x (0, 0, 7.5) = (1500, 0, 0) mm/s
        (BELOW, "y", "-x", -200.0),
        (BELOW, "-y", "x", -200.0),
        (ABOVE, "y", "x", -200.0),
        (BELOW, "y", "[2, 1, 0]", 200.0),
        (BELOW, "x", "y", -200.0),  # (-200, 0, 0) x (0, 0, 7.5) = (0, 1500, 0) mm/s
    ],
)
def test_surface_speed(center: str, axis: str, direction: str, speed: float) -> None:
    assert speed_of(center, axis, direction) == pytest.approx(speed, rel=1e-12)  # a quotient in other units


@pytest.mark.parametrize(
    ("direction", "center", "text"),
    [
        ("y", BELOW, "its surface moves along x or -x, not that way; write like direction: x"),
        ("[-1, 3, 0]", BELOW, "its surface moves along -x or x, not that way; write like direction: -x"),
        (
            "x",
            "[13.5 mm, -20.5 mm, -40 mm]",
            "no sheet that it has a contact with lies next to it at the start; give speed in place of "
            "surface_speed and direction, as speed: 200 rad/s or -200 rad/s",
        ),
    ],
)
def test_a_surface_speed_that_is_not_clear(direction: str, center: str, text: str) -> None:
    with pytest.raises(SpecError, match="motor_1_left") as error:
        speed_of(center, "y", direction)
    assert text in error.value.message
    assert error.value.path == ("rollers", "motor_1_left", "drive", "direction")


def test_a_word_that_is_misspelt_is_all_that_is_missing() -> None:
    assert "did you mean 'grammage'?" in refused(("mass: 0.72 g", "gramage: 84 g/m^2")).message
    axis = refused(("    axis: y ", "    axis: Y "))
    assert "'Y' is not a direction" in axis.message and axis.message.endswith("; did you mean y?")


def test_each_direction_that_a_surface_has_not_is_reported() -> None:
    text = FOUR.replace(SPEED, "drive: {surface_speed: 1.5 m/s, direction: y}")
    with pytest.raises(SpecError) as error:
        loads(text)
    found = [error.value, *error.value.others]
    assert len(found) == 4 and all("write like direction: x" in e.message for e in found)
    # about an axis aslant, and about the normal of the sheet
    with pytest.raises(SpecError, match=r"along \[0.7071, -0.7071, 0\] or \[-0.7071, 0.7071, 0\]"):
        speed_of(BELOW, "[1, 1, 0]", "[1, 1, 0]")
    with pytest.raises(SpecError, match="motor_1_left faces the sheet with its end"):
        speed_of(BELOW, "z", "x")


def test_a_sheet_that_comes_later_passes_between_the_rollers_of_a_nip() -> None:
    down = ("center: [0 mm, 0 mm, 0 mm]", "center: [0 mm, 0 mm, 300 mm]")
    made = scene(down, (SPEED, "drive: {surface_speed: 1.5 m/s, direction: x}"))
    drive = made.rollers["motor_1_left"].drive
    assert drive is not None and drive.speed == pytest.approx(0.2, rel=1e-12)  # a quotient


@pytest.mark.parametrize("angles", [(0, 0, 0), (30, 0, 0), (20, -40, 70), (100, 10, -5)])
def test_the_normal_is_that_of_the_model(angles: tuple[int, int, int]) -> None:
    turned = f"rotation=[{angles[0]} deg,{angles[1]} deg,{angles[2]} deg]"
    made = loads((samples() / "verify" / "flip.yaml").read_text("utf-8"), "s", [f"sheets.block.{turned}"])
    # products of sines and cosines
    np.testing.assert_allclose(made.sheets["block"].normal, lower(made).sheets[0].rotation[:, 2], atol=1e-15)


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        (RADIUS, "radius: 7.5 mm\n    diameter: 15 mm", "radius and diameter are both given"),
        (RADIUS, "diameter: 15", "expected text with a unit like '15 mm'"),
        (RADIUS, "diameter: -15 mm", "more than 0 mm"),
        (MASS, "grammage: 80 g ", "expected a unit like 'g/m^2'"),
        (MASS, "mass: 1 g\n    density: 1 g/cm^3 ", "mass and density are given"),
        ("friction: 0.33", 'friction: "0,33"', "write 0.33"),
        ("friction: 0.33", "friction: a lot", "is not a friction; give a number"),
        ("restitution: 0.5", "restitution: 150 %", "150 % is outside what is allowed: 0 to 1"),
        ("restitution: 0.5", 'restitution: "0,5"', "write 0.5; allowed: 0 to 1"),
        (SPEED, "drive: {surface_speed: 1 m/s}", "surface_speed needs a direction"),
        (SPEED, "drive: {speed: 1 rad/s, direction: x}", "direction goes with surface_speed"),
        (SPEED, "drive: {surface_speed: 1 m/s, speed: 1 rad/s, direction: x}", "give exactly one of speed"),
        ("normal: z", "normal: z\n    along: [1, 1, 0]", "lie along [1, 0, 0] or [0, 1, 0]"),
    ],
)
def test_what_cannot_be_meant(old: str, new: str, text: str) -> None:
    assert text in refused((old, new)).message


def test_the_schema_knows_them() -> None:
    models = json_schema()["$defs"]
    *ways, none = models["Sheet"]["oneOf"]  # none of them in a part of what a pile makes
    assert [way["required"] for way in ways] == [["mass"], ["grammage"], ["density"]]
    assert none == {"not": {"anyOf": ways}}
    assert [kind["type"] for kind in models["Contact"]["properties"]["restitution"]["anyOf"]] == [
        "number",
        "string",
    ]
    assert math.isclose(models["Contact"]["properties"]["restitution"]["anyOf"][0]["maximum"], 1.0)
