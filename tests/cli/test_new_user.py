"""Three scenes as a new user writes them: what was rejected is read or answered, what was hidden is said.

A ticket in a channel, a sheet of A4 off a stack, a worn note. Eight spellings were refused, and three
mistakes were reported by nothing.
"""

from __future__ import annotations

import pytest

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import loads
from mdlgen.spec.scene import Scene

TICKET = """\
name: ticket
materials: {card: {E_md: 3500 N/mm2, E_cd: 2000 N/mm2, D_md: 2 N*mm, D_cd: 1 N*mm}}
sheets:
  ticket: {material: card, size: [60 mm, 30 mm], thickness: 0.2 mm, grammage: 160 g/m^2, boxes: [12, 1]}
rollers:
  motor:
    center: [20 mm, 0 mm, -10.08 mm]
    axis: y
    diameter: 20 mm
    width: 10 mm
    mass: 5 g
    drive: {surface_speed: 450 mm/s, direction: +x, ramp: 3 ms}
  idler:
    center: [20 mm, 0 mm, 10.1 mm]
    axis: y
    diameter: 20 mm
    width: 10 mm
    mass: 2 g
    press: {direction: -z, stiffness: 0.5 N/mm, preload: 4 N}
planes:
  table: {center: [0 mm, 0 mm, -1.1 mm], normal: z, along: x, size: [30 mm, 30 mm, 2 mm]}
  stop: {center: [90 mm, 0 mm, 0 mm], normal: -x, along: y, size: [40 mm, 10 mm, 2 mm]}
contacts:
  - {between: [ticket, motor], stiffness: 400 N/mm^1.5, friction: 90 %}
  - {between: [ticket, idler], stiffness: 400 N/mm^1.5, friction: 40 %}
  - {between: [motor, idler], stiffness: 400 N/mm^1.5, friction: 90 %}
  - {between: [ticket, [table, stop]], stiffness: 100 N/mm^1.5, friction: 20 %, restitution: 20 %}
run: {duration: 5 ms}
"""


def changed(old: str, new: str) -> Scene:
    assert TICKET.count(old) == 1, old
    return loads(TICKET.replace(old, new))


def codes(scene: Scene) -> list[str]:
    return [lint.code for lint in scene.check()]


def test_what_a_new_user_writes_is_a_scene_without_findings() -> None:
    scene = loads(TICKET)
    assert codes(scene) == []
    result = mdlgen.solve(lower(scene))
    # 450 mm/s, after a ramp of 3 ms
    assert result.ok and result.rollers["motor"].speed == pytest.approx(45.0, rel=1e-9)


def test_rejected_1_grammage_in_place_of_mass() -> None:
    assert loads(TICKET).sheets["ticket"].mass == pytest.approx(0.288, rel=1e-12)


def test_rejected_2_diameter_in_place_of_radius() -> None:
    assert loads(TICKET).rollers["motor"].radius == 10.0


def test_rejected_3_surface_speed_with_a_direction() -> None:
    drive = loads(TICKET).rollers["motor"].drive
    assert drive is not None and drive.speed == pytest.approx(0.045, rel=1e-12)
    back = changed("direction: +x", "direction: -x").rollers["motor"].drive
    assert back is not None and back.speed == pytest.approx(-0.045, rel=1e-12)


def test_rejected_4_percent_where_a_ratio_is_meant() -> None:
    scene = loads(TICKET)
    assert scene.contacts[0].friction.static == 0.9 and scene.contacts[3].restitution == 0.2


def test_rejected_5_a_unit_without_its_power_sign() -> None:
    assert loads(TICKET).materials["card"].E_md == 3500.0


def test_rejected_6_a_decimal_comma_is_answered_with_what_is_meant() -> None:
    with pytest.raises(SpecError, match=r"sheets\.ticket\.thickness: .*0\.2 mm"):
        changed("thickness: 0.2 mm", "thickness: '0,2 mm'")


def test_rejected_7_a_fixed_plane_needs_no_mass() -> None:
    assert "mass" not in TICKET[TICKET.index("planes:") : TICKET.index("contacts:")]
    assert loads(TICKET).planes["table"].press is None


def test_rejected_8_the_sides_of_a_plane_are_named() -> None:
    scene = loads(TICKET)
    # 40 mm along y and 10 mm along z, whatever order the face has of its own
    (stop,) = (p for p in lower(scene).planes if p.name == "stop")
    sides = lower(scene).bodies.rotation[stop.body]
    reach = {axis: abs(sides[axis, 0]) * stop.size[0] + abs(sides[axis, 1]) * stop.size[1] for axis in (1, 2)}
    assert reach == {1: pytest.approx(40.0), 2: pytest.approx(10.0)}
    with pytest.raises(SpecError, match="the sides of this plate lie along"):
        changed("along: y", "along: x")


def test_hidden_1_a_friction_left_out_is_an_error() -> None:
    with pytest.raises(SpecError, match=r"the key 'friction' is missing; write like friction: 0\.5, or 0"):
        changed(", friction: 40 %}", "}")


def test_hidden_2_a_roller_that_turns_the_wrong_way_is_a_finding() -> None:
    scene = changed("direction: +x", "direction: -x")
    (lint,) = scene.check()
    assert (lint.code, lint.where) == ("W124", "rollers.motor.drive") and "away from stop" in lint.message


def test_hidden_3_a_stop_plate_that_stands_crosswise_is_a_finding() -> None:
    scene = changed("along: y, size: [40 mm, 10 mm, 2 mm]", "size: [10 mm, 40 mm, 2 mm]")
    (lint,) = scene.check()
    assert (lint.code, lint.where) == ("W135", "planes.stop.size")
    assert "40 mm tall and 10 mm wide" in lint.message and lint.remedy.endswith("along: y")
    # a pin is as wide as tall
    assert codes(changed("along: y, size: [40 mm, 10 mm, 2 mm]", "size: [10 mm, 10 mm, 2 mm]")) == []


WRONG = """\
name: bad
materials: {p: {E_md: 3 GPa, E_cd: 2}}
sheets:
  note_1: {material: q, size: [60 mm, 40 mm], thicknes: 0.1 mm, mass: 0.3 g, boxes: [3, 2]}
rollers:
  motor: {center: [0 mm, 0 mm], axis: w, radius: 7,5 mm, width: 8 mm, mass: 1 kgg, drive: {speed: 60 mm/s}}
contacts:
  - {between: [note, motor], stiffness: 300 N/mm, friction: 2000, restitution: 1.5}
"""


def test_all_mistakes_at_once_by_place_each_with_what_is_allowed_and_a_corrected_example() -> None:
    with pytest.raises(SpecError) as raised:
        loads(WRONG, "bad.yaml")
    errors = [raised.value, *raised.value.others]
    assert [str(error).removeprefix("bad.yaml:") for error in errors] == [
        "2:36: materials.p.E_cd: 2 has no unit; expected text with a unit like '2 MPa'",
        "4:22: sheets.note_1.material: there is no material 'q'; there are: p",
        "4:47: sheets.note_1.thicknes: unknown key 'thicknes'; did you mean 'thickness'?",
        "6:19: rollers.motor.center: expected a list of 3 quantities like '1 mm', got ['0 mm', '0 mm']",
        "6:39: rollers.motor.axis: 'w' is not a direction; allowed: x, y, z, -x, -y, -z or a vector "
        "[1, 0, 0]",
        "6:52: rollers.motor.5 mm: unknown key '5 mm': a comma ends the value before it; decimals are "
        "written with a point; write radius: 7.5 mm",
        "6:77: rollers.motor.mass: unknown unit 'kgg' in 'kgg'; expected a unit like 'g', as '1 g'",
        "6:99: rollers.motor.drive.speed: '60 mm/s' has the wrong unit; expected a unit like 'rad/s', "
        "as '60 rad/s'",
        "8:16: contacts.0.between.0: there is no part 'note'; did you mean 'note_1'? there are: note_1, "
        "motor",
        "8:41: contacts.0.stiffness: '300 N/mm' has the wrong unit; expected a unit like 'N/mm^1.5', "
        "as '300 N/mm^1.5'",
        "8:61: contacts.0.friction: 2000 is outside what is allowed: 0 to 1000, as 0.5",
        "8:80: contacts.0.restitution: 1.5 is outside what is allowed: 0 to 1, as 0.5",
    ]
    # each with its line and a caret below it
    line, caret = errors[0].marked.splitlines()
    assert line.strip() == WRONG.splitlines()[1] and line[caret.index("^")] == "2"


def test_set_of_a_part_that_there_is_not_says_what_there_is() -> None:
    with pytest.raises(SpecError, match=r"there is no 'note' in sheets; .*there are: note_1, note_2"):
        mdlgen.load(samples() / "feeder.yaml", ["sheets.note.boxes=[2,2]"])
