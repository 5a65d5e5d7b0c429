"""The language of MDL: expressions, statements, what is kept as it stands."""

from __future__ import annotations

import math
from typing import Any

import pytest
from readings import model, read_clean

from mdlgen.backends.motionview.reader import lint, read, values


def value_of(expression: str, *statements: str) -> Any:
    """The value of an expression, through a real of a data set."""
    text = (
        *statements,
        "*DefineDataSet( def_t )",
        '*Real( r, "r", EDIT )',
        "*EndDefine()",
        '*DataSet( ds_t, "t", def_t )',
        f"*SetReal( ds_t.r, {expression} )",
    )
    return read_clean(*text)["datasets"]["ds_t"]["r"]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("1+2*3", 7),
        ("(1+2)*3", 9),
        ("-2^2", -4),
        ("2^-1", 0.5),
        ("2^3^2", 512),
        ("7-2-1", 4),
        ("8/4/2", 1),
        ("2*-3", -6),
        (".99", 0.99),
        ("4.000e+08", 4e8),
        ("1e5", 1e5),
        ("180/PI", 180 / math.pi),
        ("1 < 2 && 2 >= 2 ? 10 : 20", 10),
        ("1 == 2 || 3 != 3 ? 10 : 20", 20),
        ("1 ? 0 ? 1 : 2 : 3", 2),
        ("0 ? 1/0 : 5", 5),
        ("SQRT(16)+abs(-1)", 5),
        ("COS(0)+sin(PI/2)", 2),
        ("acos(1)+asin(0)+atan(0)", 0),
        ("max(1, 4, 2)-min(3, 2)", 2),
        ("mag({3, 0, 4})", 5),
        ("mag({3, 0, 4}-{0, 0, 4}*1)", 3),
        ("{1, 2, 3}[2]", 3),
        ('length("abc")', 3),
        ('strstr("Front", "ont")', 2),
        ('strstr("Front", "x") == -1 ? 1 : 0', 1),
        ('"a"+"b" == "ab"', True),
        ('eval("1+"+"2")', 3),
        ('{"a"} == "a" ? 1 : 2', 1),
    ],
)
def test_expressions(expression: str, expected: float) -> None:
    assert value_of(expression) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        ("1/0", "divides by zero"),
        ("sqrt(-1)", "has no value"),
        ("10^400", "too large"),
        ("(-8)^(1/3)", "no finite number"),
        ("500.e+4000", "500.e+4000 is more than the largest number"),
        ("1 + 1e400", "1e400 is more than the largest number"),
        ("1+", "a value is due here"),
        ("(1", "no closing parenthesis"),
        ("1 2", "'2' is not expected"),
        ("1 $ 2", "has no meaning"),
        ("p_nowhere.x", "there is no p_nowhere"),
        ("nonsense(1)", "no function nonsense"),
        ("{1,2,3}[3]", "no such item"),
        ("ds_t.r.value+1", "needs its own value"),
        ("P_Global_Origin + 1", "has no meaning"),
        ("B_ground.mass", "there is no B_ground"),
    ],
)
def test_expressions_that_do_not_evaluate(expression: str, message: str) -> None:
    text = model(
        "*DefineDataSet( def_t )",
        '*Real( r, "r", EDIT )',
        "*EndDefine()",
        '*DataSet( ds_t, "t", def_t )',
        f"*SetReal( ds_t.r, {expression} )",
    )
    errors = lint(text, "t.mdl").errors
    assert len(errors) == 1
    assert message in errors[0].message
    assert str(errors[0]).startswith("t.mdl:6:")


def test_the_place_of_an_error_is_that_of_its_word() -> None:
    text = model('*Point( p, "p" )', "*SetPoint( p", "         , 1+nowhere.x, 0, 0 )")
    (error,) = lint(text, "t.mdl").errors
    assert (error.place.line, error.place.column) == (4, 14)


def test_one_reason_is_reported_once() -> None:
    text = model(
        '*Point( p, "p" )',
        '*Point( q, "q" )',
        "*SetPoint( p, 1/0, 0, 0 )",
        "*SetPoint( q, p.x+1, p.x, p.x )",
    )
    assert len(lint(text).errors) == 1


def test_statements_over_lines_labels_and_case() -> None:
    found = read_clean(
        '*point( p, "a, (b) {c} `d` *e( [f]" )',
        "*SETPOINT( p, 1,",
        "           2",
        "         , 3 )",
    )
    assert found["points"] == {"p": (1, 2, 3)}


def test_text_before_and_after_the_model_is_ignored() -> None:
    text = '///\n *Point( nothing ) "\n' + model('*Point( p, "p" )', "*SetPoint( p, 1, 2, 3 )") + "*BeginX(\n"
    assert values(text)["points"] == {"p": (1, 2, 3)}


def test_unknown_statements_are_kept_and_reported() -> None:
    text = model('*Gizmo( gz, "Gizmo", 3 )', '*Output( o, "o", EXPR, `F({gz.id})`, `0`, `0`, `0`, `0`, `0` )')
    report = lint(text, "t.mdl")
    assert [f.code for f in report.findings] == ["unknown"]


def test_missing_includes_are_named_and_tolerated() -> None:
    text = model('*DefinitionInclude( "lib/a.mdl" )', '*System( sys_a, "A", def_a )', '*Point( p, "p" )')
    report = lint(text + "", "t.mdl")
    assert not report.errors
    assert any('"lib/a.mdl" is not read' in f.message for f in report.warnings)
    assert any("def_a" in f.message for f in report.warnings)


def test_without_an_include_a_missing_definition_is_an_error() -> None:
    (error,) = lint(model('*System( sys_a, "A", def_a )')).errors
    assert error.code == "dangling"


def test_a_template_is_kept_whole() -> None:
    body = '  {for (i = 0; i < 3; i++)}\n  <Simulate a="(" />\n  *Point( not_one\n  {endloop}\n'
    text = model(
        "*DefineTemplate( def_t, x )", body + "*EndDefine()", '*Template( t, "t", SOLVER_COMMAND, def_t )'
    )
    reading = read(text)
    assert not reading.report.errors
    assert reading.program.definitions["def_t"].statement is not None
    assert body in reading.program.definitions["def_t"].statement.body
