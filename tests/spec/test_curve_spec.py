"""Measured curves in the spec: what is taken, from where, and what is refused with its place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mdlgen.errors import SpecError
from mdlgen.spec.curve import BYTES, Curve
from mdlgen.spec.limits import DEFAULT
from mdlgen.spec.load import load, loads
from mdlgen.spec.schema import json_schema, model_at

SCENE = """name: pull
materials:
  m: {{curve_md: {curve}, E_cd: 1 GPa, D_md: 1 N*mm, D_cd: 1 N*mm}}
sheets:
  s: {{material: m, size: [10 mm, 10 mm], thickness: 1 mm, mass: 1 g, boxes: [2, 1]}}
"""
THREE = ((0.0, 0.0), (0.01, 3.0), (0.02, 5.0))


def curve_of(text: str) -> Curve:
    found = loads(SCENE.format(curve=text)).materials["m"].curve_md
    assert found is not None
    return found


def refused(text: str) -> SpecError:
    with pytest.raises(SpecError) as raised:
        loads(SCENE.format(curve=text))
    assert "\n" not in str(raised.value)
    return raised.value


@pytest.mark.parametrize(
    "text",
    [
        "[[0, 0 MPa], [0.01, 3 MPa], [0.02, 5 MPa]]",
        "[[0, 0 Pa], [1 %, 3e6 Pa], ['2%', 5 N/mm^2]]",
        "{points: [[0, 0 MPa], [1 %, 3 MPa], [2 %, 5 MPa]]}",
        "{points: [[0, 0 MPa], [1 %, 3 MPa], [2 %, 5 MPa]], interpolation: pchip, extrapolate: linear}",
    ],
)
def test_points_are_taken_in_all_their_forms(text: str) -> None:
    found = curve_of(text)
    assert found.points == THREE
    assert found.modulus == 300.0
    assert found.extrapolate == ("linear" if "linear" in text else "refuse")


@pytest.mark.parametrize(
    ("text", "path", "words"),
    [
        ("[[0, 0 MPa], [0.02, 5]]", "curve_md.1.1", "no unit"),
        ("{points: [[0, 0 MPa], [0.02, 5]]}", "curve_md.points.1.1", "no unit"),
        ("[[0, 0 MPa], [0.02, 5 mm]]", "curve_md.1.1", "wrong unit"),
        ("[[0, 0 MPa], [2, 5 MPa]]", "curve_md.1.0", "200 %"),
        ("[[0, 0 MPa], [0.02 mm, 5 MPa]]", "curve_md.1.0", "is not a strain"),
        ("[[0, 0 MPa], [true, 5 MPa]]", "curve_md.1.0", "is not a strain"),
        ("[[0, 0 MPa], [-0.02, 5 MPa]]", "curve_md.1.0", "in tension alone"),
        ("[[0, 0 MPa], [0.02, -5 MPa]]", "curve_md.1.1", "at least 0 MPa"),
        ("[[0, 0 MPa], 3]", "curve_md.1", "[strain, stress]"),
        ("[[0, 0 MPa], [0.02, 5 MPa, 1]]", "curve_md.1", "[strain, stress]"),
        ("[[0, 0 MPa], [0.02, 5 MPa], [0.02, 6 MPa]]", "curve_md", "point 2: the strain 0.02"),
        ("[[0, 0 MPa], [0.02, 5 MPa], [0.03, 4 MPa]]", "curve_md", "point 2: the stress falls"),
        ("[[0, 0 MPa], [0.02, 0 MPa], [0.03, 4 MPa]]", "curve_md", "slope above 0"),
        ("[[0, 1 MPa], [0.02, 5 MPa]]", "curve_md", "[0, 0 MPa]"),
        ("[[0, 0 MPa]]", "curve_md", "two points"),
        ("[]", "curve_md", "two points"),
        ("7", "curve_md", "expected a list"),
        ("{}", "curve_md", "exactly one of points and file"),
        ("{points: [], file: x.csv}", "curve_md", "exactly one of points and file"),
        ("{file: x.csv}", "curve_md", "itself read from a file"),
        ("{points: [[0, 0 MPa], [1 %, 5 MPa]], interpolation: cubic}", "interpolation", "pchip"),
        ("{points: [[0, 0 MPa], [1 %, 5 MPa]], extrapolate: flat}", "extrapolate", "refuse"),
        ("{points: [[0, 0 MPa], [1 %, 5 MPa]], extrapolat: linear}", "extrapolat", "extrapolate"),
    ],
)
def test_what_is_no_curve_is_refused_with_its_place(text: str, path: str, words: str) -> None:
    error = refused(text)
    assert words in error.message
    assert error.path is not None and ".".join(map(str, error.path)).endswith(path)
    assert error.place is not None and error.place.line == 3 and error.place.column > 8


def test_points_of_all_curves_are_limited_and_the_limit_can_be_raised() -> None:
    points = "[" + ", ".join(f"[{k / 100!r}, {k} MPa]" for k in range(20)) + "]"
    both = SCENE.format(curve=points).replace("E_cd: 1 GPa", f"curve_cd: {points}")
    for few, path in ((19, "curve_md"), (39, "curve_cd")):
        with pytest.raises(SpecError, match=rf"{path}: .* --limit points={few // 20 * 20 + 20} raises"):
            loads(both, limits=DEFAULT.raised([f"points={few}"]))
    assert loads(both, limits=DEFAULT.raised(["points=40"])).materials["m"].curve_cd


@pytest.mark.parametrize("given", ["", "E_md: 1 GPa, curve_md: [[0, 0 MPa], [1 %, 3 MPa]],"])
def test_a_modulus_or_a_curve(given: str) -> None:
    text = SCENE.format(curve="X").replace("curve_md: X,", given)
    with pytest.raises(SpecError, match="exactly one of them"):
        loads(text)


def test_setting_one_takes_the_other_away() -> None:
    plain = loads(SCENE.format(curve="[[0, 0 MPa], [1 %, 3 MPa]]"), overrides=["materials.m.E_md=5 MPa"])
    assert plain.materials["m"].moduli == (5.0, 1000.0)
    bent = loads(
        SCENE.format(curve="[[0, 0 MPa], [1 %, 3 MPa]]"),
        overrides=["materials.m.curve_cd=[[0, 0 MPa], [1 %, 7 MPa]]"],
    )
    assert bent.materials["m"].moduli == pytest.approx((300.0, 700.0))


# -- files


def from_file(folder: Path, text: str, name: str = "md.csv") -> Curve:
    place = folder / name
    place.parent.mkdir(exist_ok=True)
    place.write_text(text)
    spec = folder / "pull.yaml"
    spec.write_text(SCENE.format(curve=f"{{file: {name}}}"))
    found = load(spec).materials["m"].curve_md
    assert found is not None and found.file == name
    return found


@pytest.mark.parametrize(
    "text",
    [
        "0,0 MPa\n0.01,3 MPa\n0.02,5 MPa\n",
        "# of the lab\n\nstrain [%],stress [MPa]\n0,0\n1,3\n2,5\n",
        "Strain;Stress (kPa)\r\n0;0\r\n0.01;3000\r\n0.02;5000\r\n",
        '"strain","stress"\n0,0 Pa\n1 %,3 MPa\n2 %,5 MPa\n',
        "\ufeff0\t0 MPa\n0.01\t3 MPa\n0.02\t5 MPa",
    ],
)
def test_a_file_is_read_in_all_its_forms(tmp_path: Path, text: str) -> None:
    for name in ("md.csv", "curves/md.csv"):
        assert np.array(from_file(tmp_path, text, name).points) == pytest.approx(np.array(THREE))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("0,0 MPa\n0.01,3\n", "md.csv:2: 3 has no unit"),
        ("0,0 MPa\n0.01\n", "md.csv:2: expected strain and stress, got 1"),
        ("0,0 MPa\nabc,3 MPa\n", "md.csv:2: 'abc' is not a strain"),
        ("strain [mm],stress [MPa]\n0,0\n", "md.csv:1: strain in 'mm'"),
        ("0,0 MPa\n0.01,nan MPa\n", "md.csv:2: "),
        ("nan,0 MPa\n0.01,3 MPa\n", "md.csv:1: "),
        ("", "two points"),
        ("0,0 MPa\n" * (DEFAULT.points + 1), "--limit points=10001 raises"),
        ("#" * (BYTES * DEFAULT.points + 1), "--limit points=10001 raises"),
    ],
)
def test_a_file_that_is_none_is_reported_with_its_line(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(SpecError) as raised:
        from_file(tmp_path, text)
    assert words in raised.value.message and "\n" not in str(raised.value)
    assert raised.value.place is not None and raised.value.place.line == 3


@pytest.mark.parametrize(
    "name", ["../md.csv", "a/../../md.csv", "/etc/passwd", "..\\\\md.csv", "none.csv", "."]
)
def test_a_file_stands_with_the_spec(tmp_path: Path, name: str) -> None:
    (tmp_path / "md.csv").write_text("0,0 MPa\n0.01,3 MPa\n")
    inside = tmp_path / "scene"
    inside.mkdir()
    spec = inside / "pull.yaml"
    spec.write_text(SCENE.format(curve=f"{{file: '{name}'}}"))
    with pytest.raises(SpecError):
        load(spec)


def test_a_link_does_not_lead_out(tmp_path: Path) -> None:
    (tmp_path / "md.csv").write_text("0,0 MPa\n0.01,3 MPa\n")
    inside = tmp_path / "scene"
    inside.mkdir()
    (inside / "md.csv").symlink_to(tmp_path / "md.csv")
    (inside / "pull.yaml").write_text(SCENE.format(curve="{file: md.csv}"))
    with pytest.raises(SpecError, match="leads out"):
        load(inside / "pull.yaml")


# -- schema


def test_the_schema_has_both_forms() -> None:
    whole, plain = json_schema()["$defs"]["Curve"]["anyOf"]
    assert plain["type"] == "array" and whole["type"] == "object"
    assert {"points", "file", "interpolation", "extrapolate"} == set(whole["properties"])
    assert whole["oneOf"] == [{"required": ["points"]}, {"required": ["file"]}]
    assert "required" not in whole
    assert model_at(("materials", "m", "curve_md")) is Curve
