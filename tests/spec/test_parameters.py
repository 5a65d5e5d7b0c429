"""Parameters and formulas: what they come to, in Model and text, and what is answered to what is none."""

from __future__ import annotations

import dataclasses
import json
import os
import time
from typing import Any

import numpy as np
import pytest
from arrays import arrays
from base import BASE
from formula_trees import Known, Trees
from hypothesis import given, settings
from hypothesis import strategies as st

from mdlgen import formulas
from mdlgen.checks import lints
from mdlgen.errors import SpecError
from mdlgen.formulas import Amount, evaluated
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.fields import IDENTIFIER
from mdlgen.spec.load import load, loads
from mdlgen.spec.scene import Scene
from mdlgen.spec.schema import json_schema
from mdlgen.study import sweep
from mdlgen.units import parse_unit, unit_of
from mdlgen.verify.verification import verify

TREES = int(os.environ.get("MDLGEN_TREES", "200"))  # 1,000 before a release
FOUR = (samples() / "transport_4x4.yaml").read_text("utf-8")


def scene(parameters: dict[str, Any], values: dict[str, str | float]) -> Scene:
    """Two rollers and a sheet whose values are texts, those of a run of formulas or of numbers."""
    v = values
    roller = {"axis": "y", "width": "8 mm"}
    data = {
        **BASE,
        "parameters": parameters,
        "materials": {"paper": {**BASE["materials"]["paper"], "E_md": v["E"]}},
        "sheets": {
            "note": {**BASE["sheets"]["note"], "thickness": v["thickness"], "mass": v["mass"]}
        },
        "rollers": {
            "low": {
                **roller,
                "center": ["0 mm", "0 mm", f"-({v['radius']}) - ({v['thickness']})/2"],
                "diameter": f"2*({v['radius']})",
                "mass": "0.5 g",
                "drive": {"speed": v["rate"], "ramp": v["ramp"]},
            },
            "high": {
                **roller,
                "center": ["0 mm", "0 mm", f"({v['radius']}) + ({v['thickness']})/2"],
                "radius": v["radius"],
                "mass": v["mass"],
                "press": {"direction": "-z", "stiffness": v["k"], "preload": v["force"]},
            },
        },
        "contacts": [
            {"between": ["note", "*"], "stiffness": "300 N/mm^1.5", "friction": v["mu"],
             "smoothing": v["slow"]},
            {"between": ["low", "high"], "stiffness": "30 N/mm^1.5", "restitution": v["bounce"],
             "friction": 0},
        ],
        "run": {"duration": v["ramp"]},
    }  # fmt: skip
    return loads(json.dumps(data))


WANTED = {
    "E": ("MPa", 3500.0), "thickness": ("mm", 0.1), "mass": ("g", 0.6), "radius": ("mm", 5.0),
    "rate": ("rad/s", 0.1), "ramp": ("ms", 4.0), "k": ("N/mm", 0.3), "force": ("N", 3.0),
    "mu": ("1", 0.6), "slow": ("mm/s", 0.01), "bounce": ("1", 0.5),
}  # fmt: skip


def written(value: float, unit: str) -> str | float:
    return value if unit == "1" else f"{value / parse_unit(unit).factor!r} {unit}"


def largest(first: Model, second: Model) -> float:
    """Largest difference of two Models, in each table relative to the size of its numbers."""
    a, b = (arrays(dataclasses.replace(model, parameters=())) for model in (first, second))
    assert a.keys() == b.keys()
    worst = 0.0
    for key, value in a.items():
        assert value.shape == b[key].shape, key
        finite = np.isfinite(value)
        assert np.array_equal(finite, np.isfinite(b[key])), key
        value, other = value[finite], b[key][finite]
        place = any(word in key for word in ("position", "origin", "center", "touch", "start"))
        size = max(1.0 if place else 0.0, float(np.abs(value).max(initial=0.0)))
        difference = float(np.abs(value - other).max(initial=0.0))
        worst = max(worst, difference / size if size else difference)
    return worst


def trees(seed: int) -> tuple[Scene, Scene]:
    """One scene in formulas, and in the numbers that they have."""
    made = Trees(seed)
    found: dict[str, Known] = {name: made.near(unit, value) for name, (unit, value) in WANTED.items()}
    numbers = {name: written(found[name].value, unit) for name, (unit, _) in WANTED.items()}
    parameters = {name: known.text for name, (_, known) in made.parameters.items()}
    return scene(parameters, {n: k.text for n, k in found.items()}), scene({}, numbers)


@pytest.mark.parametrize("part", range(10))
def test_a_model_from_formulas_is_the_one_from_numbers(part: int) -> None:
    """Random trees of parameters, the same ones every time, a tenth of them for each case."""
    for seed in range(part, TREES, 10):
        given, plain = trees(seed)
        # each of up to 30 operations rounds once; a touching position is a difference of two radii
        assert largest(lower(given), lower(plain)) < 1e-11, seed


@pytest.mark.parametrize("seed", range(4))
def test_a_text_has_the_formulas_and_follows_each_parameter(seed: int) -> None:
    given, _ = trees(seed)
    found = verify(given, lower(given))
    assert [str(d) for d in found.all_differences()] == []
    # text and Model compute in other units, and so round apart
    assert found.perturbed is not None and found.perturbed.largest < 1e-12
    assert found.perturbed.values >= len(given.parameters) + 40


SHORT = FOUR.replace("speed: 186.7 rad/s", "speed: v/r").replace("radius: 7.5 mm", "radius: r")
SHORT += "parameters: {v: 1400 mm/s, r: 7.5 mm}\n"


def refused(text: str, sets: tuple[str, ...] = ()) -> SpecError:
    with pytest.raises(SpecError) as raised:
        loads(text, "s.yaml", sets)
    return raised.value


def test_speed_over_radius_is_a_rate_and_set_and_the_text_turn_it() -> None:
    found = loads(SHORT, "s", ["parameters.v=900 mm/s"]).rollers["motor_1_left"].drive
    assert found is not None and found.speed == pytest.approx(0.12, rel=1e-15)
    text = emitter("motionview").emit(lower(loads(SHORT)))
    assert "*SetReal( ds_parameters.real_v, 1400.0 )" in text
    assert (
        "*SetReal( ds_motor_2_left.real_omega, ds_parameters.real_v.value/ds_parameters.real_r.value )"
        in text
    )
    faster = emitter("motionview").read(text.replace("real_v, 1400.0", "real_v, 2800.0")).values
    assert faster["datasets"]["ds_motor_2_left"]["real_omega"] == pytest.approx(2800 / 7.5, rel=1e-15)


FEW = ["sheets.note.boxes=[5,6]"]  # each is read back several times


def test_masses_are_in_kg_and_angles_in_degrees_in_a_text() -> None:
    text = FOUR.replace("mass: 0.88 g", "mass: heavy/2").replace("turn: 0 deg", "turn: asin(tip/4)*2")
    text = text.replace("preload: 3.19 N", "preload: 3.18 N + heavy*9.81 m/s^2/2")
    scene = loads(text + "parameters: {heavy: 1.76 g, tip: 0.5, more: 3 deg}\n", "s", FEW)
    model = lower(scene)
    said = emitter("motionview").emit(model)
    values = emitter("motionview").read(said).values["datasets"]
    assert values["ds_parameters"] == {"real_heavy": 0.00176, "real_tip": 0.5, "real_more": 3.0}
    assert values["ds_motor_1_left"]["real_M"] == pytest.approx(0.00088, rel=1e-15)
    assert values["ds_note"]["real_turn"] == pytest.approx(2 * np.degrees(np.arcsin(0.125)), rel=1e-14)
    assert '"Parameter more (deg); no value of this text follows from it", NO_EDIT' in said
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []


def test_the_sheets_alone_have_the_parameters_that_they_use() -> None:
    scene = loads(SHORT.replace("mass: 0.72 g", "mass: 1.7 g/cm^3*r^3"), "s", [*FEW, "loads=[]"])
    for only in (None, "sheets"):
        found = verify(scene, lower(scene), only=only)
        assert [str(d) for d in found.all_differences()] == []
    text = emitter("motionview").emit(lower(loads(SHORT)), only="sheets")
    assert "ds_parameters" not in text


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("v/r", "v + r", "a sum needs one unit, not mm/s and mm"),
        ("v/r", "v*r", "has the unit mm^2*s^-1; expected a unit like 'rad/s'"),
        ("v/r", "'max(v, 3 N)'", "max() needs one unit, not mm/s and N"),
        ("v/r", "v/rr", "there is no parameter 'rr'; did you mean 'r'? there are: v, r"),
        ("v/r", "v/(r - r)", "a division by zero"),
        ("v/r", "v^r", "an exponent has no unit, not mm"),
        ("v/r", "sin(r)", "sin() takes an angle, not mm"),
        ("v/r", "sqrt(-v)", "math domain error"),
        ("v/r", "abs/r", "abs is a function; write abs(...)"),
        ("v/r", "v/mm", "the unit mm has no number; write 1 mm"),
        ("v/r", "v//r", "FloorDiv is not allowed"),
        ("v/r", "v.real/r", "is not a number with a unit"),
        ("v: 1400", "mm: 3 N, v: 1400", "mm is the name of a unit; give the parameter another, as mm_1"),
        ("v: 1400", "sqrt: 3 N, v: 1400", "sqrt is the name of a function; give the parameter another"),
        ("v: 1400", "V: 3 N, v: 1400", "the name 'v' is used twice (also V)"),
        ("v: 1400", "time: 3 s, v: 1400", "reserves"),
        ("v: 1400 mm/s", "v: u*2, u: v/2", "v -> u -> v: it follows from itself"),
        ("v: 1400 mm/s", "v: 1400 mms", "unknown unit 'mms'"),
        ("v: 1400 mm/s", "v: [1]", "[1] is not a value; write like 3 N"),
    ],
)
def test_a_mistake_in_a_formula_is_one_line_where_it_stands(old: str, new: str, text: str) -> None:
    error = refused(SHORT.replace(old, new, 1))
    assert text in error.message and "\n" not in str(error)
    assert error.others == () and error.place is not None and error.place.file == "s.yaml"
    line = SHORT[: SHORT.index(old)].count("\n") + 1
    assert error.place.line == line


UNIT_NAMES = (
    "mm",
    "N",
    "g",
    "s",
    "rad",
    "MPa",
    "mm/s",
    "rad/s",
    "N/mm",
    "N*mm/rad",
    "N/mm^1.5",
    "Hz",
    "kg/m^3",
)


@given(st.sampled_from(UNIT_NAMES), st.sampled_from(UNIT_NAMES), st.sampled_from("+-"))
def test_an_error_of_units_names_both(one: str, other: str, sign: str) -> None:
    text = f"2 {one} {sign} 3 {other}"
    a, b = (unit_of(parse_unit(unit).dimension) for unit in (one, other))
    if a == b:
        assert evaluated(text, {}).unit == a
        return
    with pytest.raises(ValueError) as raised:
        evaluated(text, {})
    assert f"not {a} and {b}" in str(raised.value)


HOSTILE = (
    "(" * 500 + "v" + ")" * 500,
    "-" * 900 + "v",
    "+".join(["v"] * 600),
    "v" * 5000,
    "(" * 90 + "v" + ")^2" * 90,
    "9^9^9^9^9", "9**9**9", "2^1e9", "v^1e308", "(1e308*10)*v/r", "1e308^64", "v^-1e300",
    "__import__('os').system('true')", "v.__class__", "(lambda: v)()", "[v for v in v]", "v[0]", "v; v",
    "{v}", "f'{v}'", "v if v else r", "v and r", "v < r", "v := 1", "min(v)", "sqrt(v, v)", "abs(*v)",
    "min(v, r=3)", "max" + "(v, max" * 40 + ")" * 41, "0x10*v", "1_000*v", "1j*v", "v/r\n+ v", "v/r # v",
    "nan*v",
    "v/r" + " " * 3000 + "+ v", "1 mm^99*v", "(1 mm)^(16.5)", "µ*v", "v\0/r", "`v`", "${v}", "v/r`+`",
)  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_a_hostile_formula_ends_with_one_line(text: str) -> None:
    begin = time.process_time()
    error = refused(SHORT, (f"rollers.motor_1_left.drive.speed={json.dumps(text)}",))
    assert time.process_time() - begin < 2.0  # as a good one, on a slow machine
    for message in (error, *error.others):
        assert "\n" not in str(message) and len(str(message)) < 600
    assert "rollers.motor_1_left.drive.speed" in str(error)


AMOUNTS = {"v": Amount(1.4, parse_unit("mm/s").dimension), "r": Amount(7.5, parse_unit("mm").dimension)}


@settings(max_examples=1000)
@given(st.text(alphabet="vr mNs/*^+-().,0123456789eqminaxsqrtbp\u00b2", max_size=60))
def test_any_text_is_a_finite_amount_or_one_line(text: str) -> None:
    if not formulas.is_formula(text, AMOUNTS):
        return
    try:
        found = evaluated(text, AMOUNTS)
    except ValueError as error:
        assert "\n" not in str(error) and len(str(error)) < 500
    else:
        assert np.isfinite(found.value) and all(np.isfinite(power) for power in found.dimension)


def test_a_long_chain_of_parameters_is_refused_before_it_is_followed() -> None:
    chain = {f"p_{k}": f"p_{k + 1}*2" for k in range(200)} | {"p_200": "3 N"}
    error = refused(FOUR + f"parameters: {json.dumps(chain)}\n")
    assert "follows from more than 50 others" in error.message


def test_a_parameter_that_is_set_is_one_that_there_is() -> None:
    """A new one alone changes nothing: its name is misspelt."""
    text = FOUR + "parameters: {speed: 1400 mm/s, r: 7.5 mm}\n"
    drive = "rollers.motor_1_left.drive.speed=speed/r"
    with pytest.raises(SpecError) as error:
        loads(text, "s", [drive, "parameters.sped=900 mm/s"])
    message = "parameters.sped: there is no 'sped' in parameters; did you mean 'speed'? there are: speed, r;"
    assert message in str(error.value) and error.value.others == ()
    with pytest.raises(SpecError, match="there are: none"):
        loads(FOUR, "s", ["parameters.wide=6 mm"])
    used = ["parameters.wide=6 mm", "parameters.half=wide/2", "rollers.counter_1_left.width=half"]
    assert loads(FOUR, "s", used).rollers["counter_1_left"].width == 3.0
    # one of the text that nothing follows from is a lint
    assert loads(text, "s", ["parameters.speed=900 mm/s"]).amounts["speed"].value == 0.9


def test_formulas_beside_other_words_for_a_value() -> None:
    """A value that is worked out from another one follows it, too."""
    text = FOUR.replace("mass: 0.72 g", "grammage: heavy").replace("radius: 5 mm", "diameter: wide")
    text = text.replace("{speed: 186.7 rad/s,", "{surface_speed: v, direction: +x,")
    scene = loads(text + "parameters: {heavy: 84 g/m^2, wide: 10 mm, v: 1.4 m/s}\n", "s", FEW)
    assert scene.formulas[("sheets", "note", "mass")] == "(67 mm)*(127 mm)*(heavy)"
    assert scene.formulas[("rollers", "counter_1_left", "radius")] == "(wide)/2"
    assert scene.formulas[("rollers", "motor_1_left", "drive", "speed")] == "(v)/(7.5 mm)"
    found = verify(scene, lower(scene))
    assert [str(d) for d in found.all_differences()] == []


def test_the_schema_has_them_as_texts() -> None:
    schema = json_schema()
    values = schema["properties"]["parameters"]["patternProperties"][IDENTIFIER.pattern]["anyOf"]
    assert [value["type"] for value in values] == ["string", "number", "object"] and values[0]["examples"]
    assert set(values[2]["properties"]) == {"value", "range"}
    contact = schema["$defs"]["Contact"]["properties"]
    assert {kind["type"] for kind in contact["restitution"]["anyOf"]} == {"number", "string"}
    assert contact["stiffness"]["type"] == "string" and "pattern" not in contact["stiffness"]


def test_lints_of_a_parameter_without_use_and_of_values_that_a_text_does_not_follow() -> None:
    text = SHORT.replace("{v: 1400", "{spare: 2 N, v: 1400")
    text = text.replace("turn: 0 deg", "clamp: {edge: x_min, length: r*0.0}")
    found = {lint.code: lint for lint in lints(lower(loads(text)))}
    assert found["W127"].where == "parameters.spare"
    assert found["W128"].where == "sheets.note.clamp.length" and "does not follow r" in found["W128"].message
    assert not {"W127", "W128"} & {lint.code for lint in lints(lower(loads(SHORT)))}
    # a text refuses what comes in and leaves, so that its values are in none
    for sample in ("stream", "sorter", "register"):
        assert "W128" not in {lint.code for lint in lints(lower(load(samples() / f"{sample}.yaml")))}
    stream = ["parameters.each=60 ms", "streams.infeed.every=each", "streams.infeed.jitter=each/60"]
    found = {lint.code for lint in lints(lower(load(samples() / "stream.yaml", stream)))}
    assert not {"W127", "W128"} & found


def test_a_sweep_goes_over_a_parameter() -> None:
    cases, _ = sweep.over(["parameters.v=900 mm/s:1400 mm/s:3"], None, 0)
    rates = [loads(SHORT, "s", case.overrides).rollers["motor_1_left"].drive for case in cases]
    assert [rate and round(1e3 * (rate.speed or 0.0) * 7.5) for rate in rates] == [900, 1150, 1400]


def ranged(entry: str, *sets: str) -> Scene:
    text = (samples() / "transport_nips.yaml").read_text("utf-8")
    assert "speed: 1400.25 mm/s" in text
    return loads(text.replace("speed: 1400.25 mm/s", f"speed: {entry}"), "scene", sets)


def test_a_parameter_may_have_the_range_of_its_slider() -> None:
    plain, found = ranged("1400.25 mm/s"), ranged("{value: 1400.25 mm/s, range: [600 mm/s, 2 m/s]}")
    assert plain.ranges == {} and found.ranges == {"speed": (0.6, 2.0)}
    assert found.rollers == plain.rollers
    # --set is of the value, and the range stays where it is
    slow = found.with_({"parameters.speed": "700 mm/s"})
    assert slow.ranges == found.ranges and slow.amounts["speed"].value == pytest.approx(0.7)
    assert "speed: {value: 700 mm/s, range: [600 mm/s, 2 m/s]}" in slow.to_yaml()


@pytest.mark.parametrize(
    "entry, said",
    [
        ("{value: 1 m/s, range: [1 N, 2 N]}", "parameters.speed.range: the range has N, its value mm/s"),
        ("{value: 1 m/s, range: [1 m/s]}", "parameters.speed.range: ['1 m/s'] is not a range"),
        ("{value: 1 m/s, range: [3 m/s, 2 m/s]}", "the first value of a range is below the second"),
        ("{value: 1 m/s, rang: [1 m/s, 2 m/s]}", "is not a value; write like 3 N, or {value: 3 N, range:"),
        ("{value: 1 mmm/s, range: [1 m/s, 2 m/s]}", "parameters.speed: unknown unit 'mmm'"),
    ],
)
def test_a_wrong_range_is_one_line_where_it_stands(entry: str, said: str) -> None:
    with pytest.raises(SpecError) as error:
        ranged(entry)
    assert said in str(error.value) and str(error.value).startswith("scene:5:")
