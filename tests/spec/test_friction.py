"""How friction is written: its forms, what goes together, and the line for what does not."""

from __future__ import annotations

import pytest

import mdlgen
from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.spec.friction import Friction


def lowered(name: str, *sets: str):
    return mdlgen.lower(mdlgen.load(name, list(sets)))


SLIDE, STACK, NIP = "samples/verify/slide.yaml", "samples/stack.yaml", "samples/transport_4x4.yaml"


@pytest.mark.parametrize(
    "given",
    [
        0.4,
        [0.4, 0.5],
        {"front": 0.4, "back": 0.5},
        {"mu": 0.4, "scatter": {"deviation": "5 %", "length": "10 mm"}},
        {"static": 0.5, "kinetic": 0.3, "stribeck_velocity": "50 mm/s"},
        {"speed": [["1 mm/s", 0.5], ["100 mm/s", 0.4]]},
        {"md": 0.3, "cd": 0.4, "speed": [["1 mm/s", 0.5], ["100 mm/s", 0.4]]},
        {"mu": 0.4, "pressure": {"at": "5 kPa", "exponent": -0.2}, "sticking": "40 N/mm"},
    ],
)
def test_a_friction_reads_back_as_it_is_written(given: object) -> None:
    one = Friction.model_validate(given)
    for unset in (True, False):
        data = one.model_dump(mode="json", exclude_none=True, exclude_unset=unset)
        assert Friction.model_validate(data) == one
    scene = mdlgen.load(SLIDE).with_({"contacts.0.friction": given})
    assert mdlgen.Scene(**scene.model_dump(mode="json", exclude_none=True)).contacts[0].friction == one


def test_two_points_of_a_table_are_two_coefficients() -> None:
    """So that texts have them, too."""
    table = lowered(SLIDE, "contacts.0.friction={speed: [[1 mm/s, 0.5], [100 mm/s, 0.4]]}")
    plain = lowered(
        SLIDE,
        "contacts.0.friction={static: 0.5, dynamic: 0.4, stiction_velocity: 1 mm/s,"
        " friction_velocity: 100 mm/s}",
    )
    assert table.contacts.frictions is None
    assert mdlgen.emit(table, "motionview") == mdlgen.emit(plain, "motionview")


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ("{md: 0.4}", r"cd is missing, as in \{md: 0.5, cd: 0.4\}"),
        ("{static: 0.4}", "dynamic is missing, as in"),
        ("{scatter: {deviation: 0.1, length: 3 mm}}", "no coefficient is given; give one of mu, static and"),
        ("{mu: 0.3, md: 0.4, cd: 0.5}", "mu and md/cd say it twice"),
        ("{md: 0.4, cd: 0.5, front: 0.4, back: 0.5}", "md/cd and front/back at once are not modelled"),
        ("{md: 0, cd: 0.5}", "neither may be 0 alone"),
        ("{md: 0.4, cd: 0.5, sticking: 40 N/mm}", "sticking does not go with md and cd"),
        ("{dynamic: 0.3, kinetic: 0.3, static: 0.4}", "kinetic and dynamic are the same"),
        ("{speed: [[1 mm/s, 0.5]]}", "1 points; allowed 2 to 8"),
        ("{speed: [[9 mm/s, 0.5], [1 mm/s, 0.4]]}", "1 mm/s is not above the speed before, 9 mm/s"),
        ("{speed: [0.5, 0.4]}", r"expected \[slip speed, coefficient\], as \['10 mm/s', 0.4\], got 0.5"),
        ("{speed: [[1 mm/s, 0], [9 mm/s, 0.4]]}", "the first coefficient is 0"),
        ("{speed: [[1 mm/s, 0.5], [9 mm/s, 0.4]], friction_velocity: 9 mm/s}", "speeds of its own"),
        (
            "{static: 0.4, dynamic: 0.3, friction_velocity: 9 mm/s, stribeck_velocity: 9 mm/s}",
            "stribeck_velocity or friction_velocity, not both",
        ),
        ("{mu: 0.3, pressure: {at: 5, exponent: -0.1}}", "5 has no unit"),
        ("{mu: 0.3, pressure: {at: 5 kPa, exponent: -1}}", "outside what is allowed: -0.9 to 1"),
        ("{mu: 0.3, scatter: {deviation: 2, length: 3 mm}}", "outside what is allowed: 0 to 0.5"),
        ("[0.4, 0.5, 0.6]", r"not a friction; give a number, \[md, cd\], or static and dynamic"),
    ],
)
def test_a_wrong_friction_has_one_line(given: str, line: str) -> None:
    with pytest.raises(SpecError, match=line) as found:
        mdlgen.load(SLIDE, [f"contacts.0.friction={given}"])
    assert found.value.path[:3] == ("contacts", 0, "friction")
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("sample", "given", "line"),
    [
        (STACK, "[0.4, 0.5]", r"friction by direction \(md, cd\) is of a sheet on a part of the machine"),
        (STACK, "{front: 0.4, back: 0.5}", "friction by face .* two sheets; give mu"),
        (STACK, "{static: 0.4, dynamic: 0.3, stribeck_velocity: 1 m/s}", "stribeck_velocity is not modelled"),
        (
            STACK,
            "{speed: [[1 mm/s, 1], [2 mm/s, 1], [3 mm/s, 2]]}",
            "speed is not modelled in the contact of",
        ),
        (NIP, "[0.4, 0.5]", "friction by direction .* is of a sheet, and the contact of .* has none"),
        (NIP, "{mu: 1, scatter: {deviation: 0.1, length: 3 mm}}", "scatter over a sheet is of a sheet"),
    ],
)
def test_what_a_pair_does_not_have_is_refused_by_name(sample: str, given: str, line: str) -> None:
    scene = mdlgen.load(sample)
    sheets, rollers = set(scene.sheets), set(scene.rollers)
    wanted = sheets if sample == STACK else rollers
    index = next(i for i, a, b in scene.contact_pairs() if a in wanted and b in wanted)
    with pytest.raises(SpecError, match=line) as found:
        lowered(sample, f"contacts.{index}.friction={given}")
    assert found.value.path[:3] == ("contacts", index, "friction")


def test_pressure_is_refused_under_rollers_and_statics_have_scatter_alone() -> None:
    scene = mdlgen.load(NIP)
    index = next(i for i, a, b in scene.contact_pairs() if a in scene.sheets and b in scene.rollers)
    pressure = "{mu: 0.3, pressure: {at: 5 kPa, exponent: -0.1}}"
    with pytest.raises(SpecError, match="the area of a nip is not that of its boxes"):
        lowered(NIP, f"contacts.{index}.friction={pressure}")
    static = "run.analysis=static"
    for given in ("[0.3, 0.4]", "{front: 0.3, back: 0.4}", pressure):
        with pytest.raises(SpecError, match="is not modelled in a static analysis; give mu"):
            lowered(SLIDE, f"contacts.0.friction={given}", static)
    lowered(SLIDE, "contacts.0.friction={mu: 1, scatter: {deviation: 0.1, length: 3 mm}}", static)


@pytest.mark.parametrize("output", ["motionview", "motionsolve", "msolve"])
@pytest.mark.parametrize(
    ("given", "what"),
    [
        ("[0.3, 0.4]", "friction by direction"),
        ("{front: 0.3, back: 0.4}", "friction by face"),
        ("{static: 0.4, dynamic: 0.3, stribeck_velocity: 9 mm/s}", "friction by a curve over the slip speed"),
        ("{mu: 0.3, pressure: {at: 5 kPa, exponent: -0.1}}", "friction by pressure"),
        ("{mu: 0.3, scatter: {deviation: 0.1, length: 3 mm}}", "scatter of friction"),
    ],
)
def test_texts_refuse_what_altair_does_not_document(output: str, given: str, what: str) -> None:
    model = lowered(SLIDE, f"contacts.0.friction={given}")
    with pytest.raises(RefusedError, match=f"the contact of block and floor has {what}, which"):
        mdlgen.emit(model, output)


def test_boxes_that_are_too_large_for_the_scatter_are_named() -> None:
    scatter = "contacts.0.friction={mu: 0.3, scatter: {deviation: 20 %, length: 3 mm}}"
    found = {lint.code: lint for lint in lints(lowered(SLIDE, scatter))}
    assert "20 x 20 mm, is larger than the length 3 mm of its scatter" in found["W140"].message
    assert "boxes deviate by 4.9 %, not by 20 %" in found["W140"].message
    fine = {lint.code for lint in lints(lowered(SLIDE, scatter, "sheets.block.boxes=[14, 14]"))}
    assert "W140" not in fine
