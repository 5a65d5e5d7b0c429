"""The reader of MDL: against a deck that MotionView itself exported, and against texts of our own."""

from __future__ import annotations

import json
import math
import re
import time
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest
from places import GOLDEN, REAL

import mdlgen
from mdlgen.backends.motionview.reader import Report, lint, read, values
from mdlgen.errors import SpecError
from mdlgen.paths import samples

# A deck shows eight digits, so half a unit of the last one.
DECK = 5e-8


def model(*statements: str) -> str:
    return "\n".join(('*BeginMDL( m, "m" )', *statements, "*StandardInclude(FILE)", "*EndMDL()", ""))


def read_clean(*statements: str) -> dict[str, Any]:
    """Values of a text without errors."""
    reading = read(model(*statements), "t.mdl")
    found, report = reading.values, reading.report
    assert not report.errors, [str(f) for f in report.errors]
    return found


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


# ---------------------------------------------------------------- expressions


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


def test_one_reason_is_told_once() -> None:
    text = model(
        '*Point( p, "p" )',
        '*Point( q, "q" )',
        "*SetPoint( p, 1/0, 0, 0 )",
        "*SetPoint( q, p.x+1, p.x, p.x )",
    )
    assert len(lint(text).errors) == 1


# ---------------------------------------------------------------- lexical rules


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


def test_unknown_statements_are_kept_and_told() -> None:
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


# ---------------------------------------------------------------- geometry


def test_points_may_come_in_any_order_and_lean_on_single_coordinates() -> None:
    found = read_clean(
        "*SetPoint( a, b.y+1, 0, 0 )",
        "*SetPoint( b, 5, 7, a.x )",
        '*Point( a, "a" )',
        '*Point( b, "b" )',
    )
    assert found["points"] == {"a": (8, 0, 0), "b": (5, 7, 8)}


@pytest.mark.parametrize(
    ("orientation", "x", "z"),
    [
        ("TWOAXES, ZX, DXDYDZ, 0, 0, 2, DXDYDZ, 1, 1, 5", (0.5**0.5, 0.5**0.5, 0), (0, 0, 1)),
        ("TWOAXES, YZ, DXDYDZ, 0.0, -1, 0, DXDYDZ, 0, 0, 1", (-1, 0, 0), (0, 0, 1)),
        ("TWOAXES, XZ, POINT, p_a, VECTOR, V_Global_Z", (1, 0, 0), (0, 0, 1)),
        ("TWOAXES, ZY, VECTOR, v, VECTOR, Global_Frame.xaxis", (0, 0, 1), (0, 1, 0)),
        ("ONEAXIS, Z, POINT, p_a", (0, 1, 0), (1, 0, 0)),
        ("ONEAXIS, Z, DXDYDZ, 0, 0, -3", (1, 0, 0), (0, 0, -1)),
        ("ONEAXIS, Z, VECTOR, v", (-1, 0, 0), (0, 1, 0)),
        ("ANGLES, Global_Frame, 90, 0, 0", (0, 1, 0), (0, 0, 1)),
        ("ANGLES, Global_Frame, 0, 90, 0", (1, 0, 0), (0, -1, 0)),
        ("ANGLES, Global_Frame, 90, 90, 90", (0, 0, 1), (1, 0, 0)),
    ],
)
def test_orientation(orientation: str, x: tuple[float, ...], z: tuple[float, ...]) -> None:
    found = read_clean(
        '*Point( p, "p" )',
        '*Point( p_a, "a" )',
        '*Vector( v, "v" )',
        '*Marker( mrk, "m", B_Ground, p )',
        "*SetPoint( p, 1, 2, 3 )",
        "*SetPoint( p_a, 9, 2, 3 )",
        "*SetVector( v, 0, 4, 0 )",
        f"*SetOrientation( mrk, {orientation} )",
    )["markers"]["mrk"]
    assert found["origin"] == (1, 2, 3)
    assert found["axes"][0] == pytest.approx(x, abs=1e-15)
    assert found["axes"][2] == pytest.approx(z, abs=1e-15)


def test_a_place_in_the_axes_of_a_marker() -> None:
    found = read_clean(
        '*Point( p, "p" )',
        '*Point( q, "q" )',
        '*Marker( mrk, "m", B_Ground, p )',
        "*SetPoint( p, 10, 0, 0 )",
        "*SetOrientation( mrk, TWOAXES, ZX, DXDYDZ, 0, 0, 1, DXDYDZ, 0, 1, 0 )",
        "*SetPoint( q, loc_rel_to( {1, 2+0, 3}, mrk )[0], loc_rel_to( {1, 2, 3}, mrk )[1]",
        "         , mrk.yaxis.x+Global_Frame.origin.x )",
    )
    assert found["points"]["q"] == pytest.approx((8, 1, -1), abs=1e-15)


def test_boxes_cylinders_and_spheres() -> None:
    found = read_clean(
        '*Point( p, "p" )',
        '*Point( q, "q" )',
        '*Body( b, "b", p )',
        "*SetPoint( p, 1, 0, 0 )",
        "*SetPoint( q, 1, 0, 8 )",
        "*SetBodyInertia( b, 1, 1, 1, 1 )",
        '*Graphic( g1, "g", BOX, b, CENTER, p, ZX, VECTOR, V_Global_Z, VECTOR, V_Global_X, 2, 4, 6, 3 )',
        '*Graphic( g2, "g", BOX, b, CORNER, p, ZX, VECTOR, V_Global_Z, VECTOR, V_Global_X, 2, 4, 6, 3 )',
        '*Graphic( g3, "g", BOX, b, FACE, p, ZX, q, VECTOR, V_Global_X, 2, 4, 3 )',
        '*Graphic( g4, "g", CYLINDER, b, p, POINT, q, 5, g4.r1, , 2, CAPBOTH, 3 )',
        '*Graphic( g5, "g", CYLINDER, b, p, VECTOR, V_Global_Y, 5, 3, 10, -10/2, CAPBEGIN, 3 )',
        '*Graphic( g6, "g", SPHERE, b, q, g1.r1+2, 3 )'
        if False
        else '*Graphic( g6, "g", SPHERE, b, q, 2, 3 )',
    )["graphics"]
    assert (found["g1"]["center"], found["g1"]["lengths"]) == ((1, 0, 0), (2, 4, 6))
    assert found["g2"]["center"] == (2, 2, 3)
    assert (found["g3"]["center"], found["g3"]["lengths"]) == ((1, 0, 4), (2, 4, 8))
    assert (found["g4"]["start"], found["g4"]["axis"], found["g4"]["length"]) == ((1, 0, 2), (0, 0, 1), 8)
    assert (found["g4"]["radii"], found["g5"]["radii"]) == ((5, 5), (5, 3))
    assert (found["g5"]["start"], found["g5"]["axis"]) == ((1, -5, 0), (0, 1, 0))
    assert (found["g6"]["center"], found["g6"]["radius"]) == ((1, 0, 8), 2)


def test_mass_from_graphics() -> None:
    """A box of 1000 mm3 and a cone that is twice as long as wide; closed forms of a textbook."""
    found = read_clean(
        '*Point( p, "p" )',
        '*Body( b, "b", p )',
        '*Body( b2, "b", p )',
        "*SetPoint( p, 0, 0, 0 )",
        "*Set( b.inertia_props_from_graphic, true )",
        "*Set( b2.inertia_props_from_graphic, true )",
        '*Graphic( g, "g", BOX, b, CENTER, p, ZX, VECTOR, V_Global_X, VECTOR, V_Global_Y, 5, 10, 20, 3 )',
        '*Graphic( g2, "g", CYLINDER, b2, p, VECTOR, V_Global_Z, 10, 0, 20, 0, CAPBOTH, 3 )',
    )["bodies"]
    mass = 7.86e-3
    assert found["b"]["mass"] == pytest.approx(mass)
    # Z of the box lies along x, X along y: lengths are 20, 5 and 10 along x, y and z
    squares = (5**2 + 10**2, 20**2 + 10**2, 20**2 + 5**2)
    assert found["b"]["inertia"][:3] == pytest.approx([mass * s / 12 for s in squares])
    cone = 7.86e-6 * math.pi * 100 * 20 / 3
    assert found["b2"]["mass"] == pytest.approx(cone)
    assert found["b2"]["cm"] == pytest.approx((0, 0, 5))
    assert found["b2"]["inertia"][2] == pytest.approx(0.3 * cone * 100)
    assert found["b2"]["inertia"][0] == pytest.approx(cone * (3 / 20 * 100 + 3 / 80 * 400))


# ---------------------------------------------------------------- pairs, joints, bushings, springs

PAIR = (
    '*PointPair( p_hub, "Hub" )',
    '*PointPair( p_end, "End" )',
    '*PointPair( p_up, "Up" )',
    "*SetPoint( p_hub, LEFT, 100, -50, 10 )",
    "*SetPoint( p_end, LEFT, p_hub.l.x+30, p_hub.l.y-40, p_hub.l.z )",
    "*SetPoint( p_up.l, 100, -50, 90 )",
    '*BodyPair( b_arm, "Arm", p_hub, , , ,  )',
    '*BodyPair( b_rod, "Rod", p_end, , , ,  )',
    "*SetBodyInertia( b_arm, LEFT, 2, 10, 20, 25, 1, 2, 3 )",
    "*SetBodyInertia( b_rod, LEFT, 1, 1, 1, 1 )",
)


def test_pairs_are_mirrored_about_xz_and_the_left_one_leads() -> None:
    found = read_clean(*PAIR, "*SetPoint( p_up.r, 7, 7, 7 )")
    assert found["points"]["p_end.l"] == (130, -90, 10)
    assert found["points"]["p_end.r"] == (130, 90, 10)
    assert found["points"]["p_up.r"] == (100, 50, 90)
    arm = found["bodies"]["b_arm.r"]
    assert (arm["label"], arm["mass"], arm["cm"]) == ("Arm-right", 2, (100, 50, 10))
    assert arm["inertia"] == (10, 20, 25, -1, -3, 2)  # products with y change sign


def test_pair_properties_in_any_order() -> None:
    found = read_clean(
        *PAIR,
        '*MarkerPair( mrk, "M", b_arm, p_hub )',
        '*Point( q, "q" )',
        "*SetPoint( q, mrk.origin.l.y, mrk.l.origin.y, b_arm.cm.r.origin.y )",
        "*SetOrientation( b_arm.cm.l, TWOAXES, ZX, POINT, p_end.l, POINT, p_up.l )",
        "*SetOrientation( mrk, , ONEAXIS, Z, DXDYDZ, 1, 0, 0, ONEAXIS, Z, DXDYDZ, 0, 1, 0 )",
    )
    assert found["points"]["q"] == (-50, -50, 50)
    left, right = found["markers"]["b_arm.cm.l"]["axes"], found["markers"]["b_arm.cm.r"]["axes"]
    assert left[2] == pytest.approx((0.6, -0.8, 0))
    assert right[2] == pytest.approx((0.6, 0.8, 0))
    assert (left[0], right[0]) == ((0, 0, 1), (0, 0, 1))
    assert found["markers"]["mrk.r"]["axes"][2] == (0, 1, 0)


BUSH = (
    "LIN, 1, LIN, 2, LIN, 3, LIN, 4, LIN, 5, LIN, 6, LIN, 7*180/PI, LIN, 8, LIN, 9, LIN, 10, LIN, 11, LIN, 12"
    ", 0, 0, 5, 0, 0, 0"
)


def test_bushings_of_pairs() -> None:
    found = read_clean(
        *PAIR,
        '*BushPair( bsh, "Bush", b_arm, b_rod, p_hub )',
        f"*SetBush( bsh, LEFT, {BUSH} )",
        "*SetOrientation( bsh, LEFT, ONEAXIS, Z, POINT, p_end.l )",
    )
    left, right = found["bushings"]["bsh.l"], found["bushings"]["bsh.r"]
    assert (left["k"], left["c"]) == ((1, 2, 3), (4, 5, 6))
    assert left["kt"] == pytest.approx((7 * 180 / math.pi, 8, 9))
    assert (right["ct"], right["force"]) == ((10, 11, 12), (0, 0, 5))
    assert left["bodies"] == ("b_arm.l", "b_rod.l")
    assert right["axes"][2] == pytest.approx((0.6, 0.8, 0))
    assert right["axes"][0] == pytest.approx((-0.8, 0.6, 0))  # level: global Z x Z
    assert found["markers"]["bsh.j.r"]["body"] == "b_rod.r"


def test_a_compliant_joint_is_a_bushing() -> None:
    found = read_clean(
        *PAIR,
        '*BallJointPair( j, "J", b_arm, b_rod, p_end, ALLOW_COMPLIANCE )',
        f"*SetBush( j.bush, LEFT, {BUSH} )",
        "*SetOrientation( j.bush, LEFT, TWOAXES, ZY, POINT, p_hub.l, VECTOR, V_Global_Z )",
        '*RevJoint( j2, "J2", b_arm.l, b_rod.l, j.i.origin.l, VECTOR, j.l.i.yaxis )',
        "*if( j.isbush == true )",
        '*FixedJointPair( j3, "J3", j.b1, B_Ground, p_hub )',
        "*endif()",
    )
    assert set(found["bushings"]) == {"j.bush.l", "j.bush.r"}
    assert set(found["joints"]) == {"j2", "j3.l", "j3.r"}
    assert found["joints"]["j2"]["origin"] == (130, -90, 10)
    assert found["joints"]["j2"]["axis"] == pytest.approx((0, 0, 1))
    assert found["joints"]["j3.r"]["bodies"] == ("b_arm.r", "B_Ground")


def test_compliance_may_be_switched_off() -> None:
    joint = '*BallJointPair( j, "J", b_arm, b_rod, p_end, ALLOW_COMPLIANCE )'
    found = read_clean(*PAIR, joint, '*SetOption( Op_Compliant, "No" )')
    assert (set(found["joints"]), found["bushings"]) == ({"j.l", "j.r"}, {})


def test_only_the_active_analysis_counts() -> None:
    found = read_clean(
        "*DefineAnalysis( def_ana )",
        '*Point( p, "p" )',
        "*SetPoint( p, 1, 2, 3 )",
        "*EndDefine()",
        '*Analysis( one, "One", def_ana )',
        '*Analysis( two, "Two", def_ana )',
        "*SetActiveAnalysis( two )",
    )
    assert found["points"] == {"two.p": (1, 2, 3)}


def test_kinds_of_joints() -> None:
    found = read_clean(
        '*Point( p, "p" )',
        '*Point( q, "q" )',
        '*Body( b, "b", p )',
        "*SetBodyInertia( b, 1, 1, 1, 1 )",
        "*SetPoint( p, 0, 0, 0 )",
        "*SetPoint( q, 0, 10, 0 )",
        '*CylJoint( c, "c", b, B_Ground, p, POINT, q )',
        '*TransJoint( t, "t", b, B_Ground, p, VECTOR, V_Global_Y )',
        '*FixedJoint( f, "f", b, B_Ground, p )',
        '*UJoint( u, "u", b, B_Ground, p, SHAFT, POINT, q, CROSSPIN, VECTOR, V_Global_X )',
        '*UJoint( u2, "u", b, B_Ground, p, SHAFT, POINT, q, SHAFT, VECTOR, V_Global_Z )',
        '*CVJoint( cv, "cv", b, B_Ground, p, POINT, q, VECTOR, V_Global_Z )',
        '*InlineJoint( il, "il", b, B_Ground, p, ORIGIN, POINT, q )',
        '*PerpAxesJoint( pa, "pa", b, B_Ground, p, VECTOR, V_Global_X, VECTOR, V_Global_Y )',
        '*Motion( mot, "mot", JOINT, t, TRANS )',
        "*SetMotion( mot, VEL, EXPR, `{1/4}*TIME+{c.i.idstring}` )",
        '*Coupler( cp, "cp", 2JOINT, c, t, TRANS, TRANS )',
        "*SetCoupler( cp, -3.7 )",
    )
    types = {name: joint["type"] for name, joint in found["joints"].items()}
    assert types == {
        **{"c": "CYLINDRICAL", "t": "TRANSLATIONAL", "f": "FIXED", "u": "UNIVERSAL", "u2": "UNIVERSAL"},
        **{"cv": "CONSTANT_VELOCITY", "il": "INLINE", "pa": "PERPENDICULAR"},
    }
    markers = found["markers"]
    assert markers["c.joint_i"]["axes"] == ((-1, 0, 0), (0, 0, 1), (0, 1, 0))
    assert markers["u.joint_i"]["axes"][0] == (0, 1, 0)  # shaft
    assert markers["u.joint_j"]["axes"][2] == (1, 0, 0)  # cross pin
    assert markers["u2.joint_i"]["axes"][2] == (1, 0, 0)  # square to both shafts
    assert markers["cv.joint_j"]["axes"][2] == (0, 0, 1)
    assert markers["il.joint_j"]["origin"] == (0, 10, 0)
    assert markers["pa.joint_j"]["axes"][2] == (0, 1, 0)
    assert found["motions"]["mot"]["value"] == "0.25*TIME+c.joint_i"


def test_coil_springs() -> None:
    found = read_clean(
        *PAIR,
        '*CoilSpringPair( cs, "Spring", b_arm, b_rod, p_hub, p_end )',
        "*SetCoilSpring( cs, LEFT, LIN, 120, LIN, 0.5, 7000, mag(p_hub.l.data-p_end.l.data) )",
    )["springs"]["cs.r"]
    assert (found["k"], found["c"], found["force"], found["length"]) == (120, 0.5, 7000, 50)
    assert found["points"] == ((100, 50, 10), (130, 90, 10))


def test_a_beam_has_a_body_at_each_point() -> None:
    found = read_clean(
        *(f'*Point( p{k}, "p" )' for k in range(3)),
        *(f"*SetPoint( p{k}, {10 * k}, 0, 0 )" for k in range(3)),
        '*PolyBeam( pb, "Beam", p0, p1, p2 )',
        "*SetPolyBeamProps( pb, CIRCULAR, 8e-6, 2e5, 7.5e4, 4, 0, 0, CRATIO, 0.01 )",
        '*BallJoint( j, "J", pb.body@p1, B_Ground, p1 )',
    )
    whole = 8e-6 * math.pi * 4 * 10
    assert found["bodies"]["pb.body1"]["mass"] == pytest.approx(whole)
    assert found["bodies"]["pb.body1"]["inertia"][1] == pytest.approx(whole * (3 * 4 + 100) / 12)
    assert found["joints"]["j"]["bodies"] == ("pb.body1", "B_Ground")


# ---------------------------------------------------------------- data, conditions, systems


def test_options_tables_and_conditions() -> None:
    found = read_clean(
        "*DefineRecord( rec )",
        '*Real( load, "Load", EDIT )',
        "*EndDefine()",
        "*DefineDataSet( def_ds )",
        '*Option( op, "Side", 3, "X", "Y", "Z", 1, 2, 4, "x", "y", "z", EDIT )',
        '*Option( short, "Short", 2, "No", "Yes" )',
        '*Integer( n, "N", EDIT )',
        '*String( s, "S", EDIT )',
        '*Table( tbl, "Table", rec, 2 )',
        "*EndDefine()",
        '*DataSet( ds, "Data", def_ds )',
        '*SetOption( ds.op, "Z" )',
        "*SetInteger( ds.n, (ds.op.ival + ds.op.current_index) * 10 )",
        '*SetString( ds.s, ds.label + "-" + ds.op.value )',
        "*SetReal( ds.tbl.load[1], ds.n.value/2 )",
        '*Point( p, "p" )',
        '*if( ds.op.value == "X" )',
        "*SetPoint( p, 1, 0, 0 )",
        '*elseif( ds.op.value == "Z" && ds.short.value == "No" )',
        "*SetPoint( p, 2, 0, 0 )",
        '*Point( extra, "e" )',
        "*SetPoint( extra, p.x, 0, 0 )",
        "*else()",
        "*SetPoint( p, 3, 0, 0 )",
        '*Point( extra, "other" )',
        "*endif()",
        '*if( sys_none.label != "" )',
        '*Point( never, "n" )',
        "*endif()",
    )
    data = found["datasets"]["ds"]
    assert data == {"op": "Z", "short": "No", "n": 60, "s": "Data-Z", "tbl": {"load": (0, 30)}}
    assert found["points"] == {"p": (2, 0, 0), "extra": (2, 0, 0)}


SYSTEM = (
    "*DefineSystem( def_leg, b_top, p_top )",
    '*Attachment( b_top, "Body", BodyPair, "note", B_Ground,  )',
    '*Attachment( p_top, "Point", Point, "note", ,  )',
    '*Point( p_foot, "Foot" )',
    '*Body( b_foot, "Foot", p_foot, , , ,  )',
    "*SetBodyInertia( b_foot, 1, 1, 1, 1 )",
    '*DataSet( ds_leg, "Leg", def_ds_leg )',
    "*SetReal( ds_leg.length, 10 )",
    "*SetPoint( p_foot, p_top.x, p_top.y, p_top.z-ds_leg.length.value )",
    '*FixedJoint( j, {THIS.label + " fixed"}, b_foot, b_top.l, p_foot )',
    '*if( strstr( PARENT.label, "m" ) != -1 )',
    '*System( sys_toe, "Toe", def_toe, THIS.p_foot )',
    "*endif()",
    "*EndDefine()",
    "*DefineSystem( def_toe, p )",
    '*Attachment( p, "Point", Point, "note", ,  )',
    '*Point( p_toe, "Toe" )',
    "*SetPoint( p_toe, p.x+ds_leg.length.value, MODEL.p_a.y, 0 )",
    "*EndDefine()",
    "*DefineDataSet( def_ds_leg )",
    '*Real( length, "Length", EDIT )',
    "*EndDefine()",
    '*Point( p_a, "A" )',
    '*Point( p_b, "B" )',
    "*SetPoint( p_a, 0, 1, 100 )",
    "*SetPoint( p_b, 50, 2, 100 )",
    '*System( sys_1, "One", def_leg, , p_a )',
    '*System( sys_2, "Two", def_leg, b_own, p_b )',
    '*Body( b_own, "Own", p_b, , , ,  )',
    "*SetBodyInertia( b_own, 1, 1, 1, 1 )",
)


def test_systems_attachments_and_contexts() -> None:
    found = read_clean(
        *SYSTEM,
        "*SetReal( sys_1.ds_leg.length, 15 )",
        "*BeginContext( sys_2 )",
        "*SetReal( ds_leg.length, 20 )",
        "*BeginContext( sys_toe )",
        "*SetPoint( p_toe, -1, -1, ds_leg.length.value )",
        "*EndContext()",
        "*EndContext()",
        '*Point( p_c, "C" )',
        "*SetPoint( p_c, sys_1.p_foot.z, model.sys_2.sys_toe.p_toe.x, sys_1.sys_toe.p_toe.x )",
    )
    assert found["points"]["sys_1.p_foot"] == (0, 1, 85)
    assert found["points"]["sys_2.p_foot"] == (50, 2, 80)
    assert found["points"]["sys_1.sys_toe.p_toe"] == (15, 1, 0)
    assert found["points"]["sys_2.sys_toe.p_toe"] == (-1, -1, 20)
    assert found["points"]["p_c"] == (85, -1, 15)
    assert found["joints"]["sys_1.j"]["bodies"] == ("sys_1.b_foot", "B_Ground")
    assert found["joints"]["sys_2.j"]["bodies"] == ("sys_2.b_foot", "b_own")
    assert found["joints"]["sys_2.j"]["label"] == "Two fixed"
    assert found["datasets"]["sys_2.ds_leg"] == {"length": 20}


def test_a_set_from_elsewhere_wins_and_moves_a_condition() -> None:
    """As vehicle files do: a later system switches an option of an earlier one."""
    found = read_clean(
        "*DefineSystem( def_a )",
        '*Option( op, "Op", 2, "On", "Off", 1, 2, "On", "Off", EDIT )',
        '*if( op.value == "On" )',
        '*Point( p, "on" )',
        "*SetPoint( p, 1, 0, 0 )",
        "*else()",
        '*Point( p, "off" )',
        "*SetPoint( p, 2, 0, 0 )",
        "*endif()",
        "*EndDefine()",
        "*DefineSystem( def_b )",
        '*SetOption( sys_a.op, "Off" )',
        "*EndDefine()",
        '*System( sys_b, "B", def_b )',
        '*System( sys_a, "A", def_a )',
    )
    assert found["points"] == {"sys_a.p": (2, 0, 0)}


def test_compound_graphics() -> None:
    found = read_clean(
        *PAIR,
        '*Graphic( g, "Compound", def_g, b_arm, p_hub, mrk.zaxis )',
        '*MarkerPair( mrk, "M", b_arm, p_hub )',
        "*DefineGraphic( def_g, body, point, axis )",
        '*Attachment( body, "b", BodyPair, "note", ,  )',
        '*Attachment( point, "p", PointPair, "note", ,  )',
        '*Attachment( axis, "v", VectorPair, "note", ,  )',
        '*GraphicPair( g_pin, "Pin", CYLINDER, body, point, VECTOR, axis, 3, g_pin.r1, 10, -5, CAPBOTH, 3 )',
        "*EndDefine()",
    )["graphics"]
    assert set(found) == {"g.g_pin.l", "g.g_pin.r"}
    assert found["g.g_pin.r"]["start"] == (100, 50, 5)
    assert found["g.g_pin.r"]["body"] == "b_arm.r"


def test_contacts() -> None:
    found = read_clean(
        '*Point( p, "p" )',
        "*SetPoint( p, 0, 0, 0 )",
        '*Body( b, "b", p )',
        "*SetBodyInertia( b, 1, 1, 1, 1 )",
        '*Graphic( g, "g", SPHERE, b, p, 2, 3 )',
        '*Graphic( h, "h", SPHERE, B_Ground, p, 2, 3 )',
        '*Contact( c, "c", POISSON, ON, BODY, b, 1, g, false, BODY, B_Ground, 1, h, true )',
        "*SetContact( c, 300, 0.5, 0.2, 0.1, 1, 1.5 )",
    )["contacts"]["c"]
    assert (found["bodies"], found["graphics"]) == (("b", "B_Ground"), (("g",), ("h",)))
    assert (found["penalty"], found["restitution"], found["mu_dynamic"]) == (300, 0.5, 0.1)


# ---------------------------------------------------------------- what the backend writes


@pytest.mark.parametrize("file", sorted(GOLDEN.glob("*.mdl")), ids=lambda f: f.name)
def test_golden_texts_read_clean(file: Path) -> None:
    report: Report = lint(file.read_text(), file.name)
    assert not report.findings, [str(f) for f in report.findings[:5]]


@pytest.mark.parametrize(
    "sample", sorted(p.relative_to(samples()) for p in samples().rglob("*.yaml")), ids=str
)
def test_sample_texts_read_clean(sample: Path) -> None:
    overrides = ["sheets.note.boxes=[2,3]"] if str(sample).startswith("transport") else []
    overrides.append("loads=[]")  # a text with loads is refused
    lowered = mdlgen.lower(mdlgen.load(samples() / sample, overrides=overrides))
    reading = read(mdlgen.emit(lowered, "motionview"), sample.name)
    found = reading.values
    assert not reading.report.errors
    arms = sum(roller.arm is not None for roller in lowered.rollers)  # whose springs are bushings, too
    assert len(found["bushings"]) == len(lowered.bushings) + arms
    assert json.loads(json.dumps(found, allow_nan=False))
    places = dict(zip((f"b_{n}" for n in lowered.bodies.name), lowered.bodies.position, strict=True))
    for name, body in found["bodies"].items():
        if name in places:
            assert body["cm"] == pytest.approx(places[name], rel=1e-12, abs=1e-12)


# ---------------------------------------------------------------- size and hostile texts


def chain(count: int, back: bool) -> str:
    """Points, each one from its neighbour."""
    points = (
        f'*Point( p{k}, "p" )\n*SetPoint( p{k}, '
        + (f"p{k + (1 if back else -1)}.x+1" if k != (count - 1 if back else 0) else "0")
        + ", 0, 0 )"
        for k in range(count)
    )
    return model(*points)


@pytest.mark.parametrize("back", [False, True])
def test_a_chain_may_be_as_long_as_the_file(back: bool) -> None:
    found = values(chain(5000, back))["points"]
    assert max(p[0] for p in found.values()) == 4999


def test_a_circle_is_told_once_however_long() -> None:
    ring = (f'*Point( p{k}, "p" )\n*SetPoint( p{k}, p{(k + 1) % 3000}.x, 0, 0 )' for k in range(3000))
    (error,) = lint(model(*ring)).errors
    assert error.code == "cycle"


HOSTILE = {
    "nothing": "",
    "no model": '*Point( p, "p" )',
    "zero bytes": "\0" * 100,
    "deep parentheses": model('*Point( p, "p" )', f"*SetPoint( p, {'(' * 9999}1{')' * 9999}, 0, 0 )"),
    "open parentheses": model(f"*SetPoint( p, {'(' * 9999}"),
    "dots": model('*Point( p, "p" )', f"*SetPoint( p, p{'.x' * 9999}, 0, 0 )"),
    "signs": model('*Point( p, "p" )', f"*SetPoint( p, {'-' * 9999}1, 0, 0 )"),
    "powers": model('*Point( p, "p" )', "*SetPoint( p, 9^9^9^9, 0, 0 )"),
    "open text": model('*Point( p, "p )', '*Point( q, "q" )'),
    "open definitions": model(*["*DefineSystem( d )"] * 999),
    "a system in itself": model(
        "*DefineSystem( d )", '*System( s, "s", d )', "*EndDefine()", '*System( t, "", d )'
    ),
    "attachments in a circle": model(
        "*DefineSystem( d, a )",
        '*Attachment( a, "a", Point, "", ,  )',
        '*Point( q, "q" )',
        "*SetPoint( q, a.x, 0, 0 )",
        "*EndDefine()",
        '*System( s1, "s", d, s2.a )',
        '*System( s2, "s", d, s1.a )',
    ),
    "empty arguments": model(
        "*Point( )", '*Body( b )', '*Graphic( g, "g", BOX )', '*Bush( b2, "b", , , )', '*Motion( m1, "x" )',
        '*RevJoint( j, "j", , , , POINT, )', '*Table( t, "" )', "*Set( )", '*PolyBeam( pb, "" )',
    ),
    "wrong kinds": model(
        '*Point( p, "p" )', '*Body( b, "b", b )', '*Marker( k, "k", p, b )',
        '*Graphic( g, "g", CYLINDER, p, b, VECTOR, k, "x", g.r2, {1,2}, 0, CAPBOTH, 3 )',
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_texts_give_lines_not_tracebacks(name: str) -> None:
    report = lint(HOSTILE[name], "h.mdl")
    assert report.errors
    for finding in report.findings:
        assert re.match(r"h\.mdl:\d+:\d+: (error|warning): .+ \[[a-z-]+\]\Z", str(finding))


def test_definitions_that_multiply_are_refused() -> None:
    lines = []
    for k in range(9):
        inner = [f'*System( s{j}, "s", d{k + 1} )' for j in range(10)]
        lines += [f"*DefineSystem( d{k} )", *inner, "*EndDefine()"]
    with pytest.raises(SpecError, match=r"h\.mdl:\d+:\d+: the definitions"):
        read(model(*lines, '*System( s, "s", d0 )'), "h.mdl")


def big(boxes: int) -> str:
    """Boxes in a row with a bushing between neighbours, ten lines each."""
    head = (
        "*DefineDataSet( def_d )",
        '*Real( d, "d", EDIT )',
        '*Real( k, "k", EDIT )',
        "*EndDefine()",
        '*DataSet( ds, "ds", def_d )',
        "*SetReal( ds.d, 0.5 )",
        "*SetReal( ds.k, 100 )",
    )
    law = ", ".join(["LIN, ds.k.value"] * 12)
    rows = (
        f'*Point( p_{k}, "Box {k}" )\n'
        f"*SetPoint( p_{k}, loc_rel_to( {{{k}*ds.d.value, 0, 0}}, Global_Frame )[0]\n"
        f"         , loc_rel_to( {{{k}*ds.d.value, 0, 0}}, Global_Frame )[1]\n"
        f"         , loc_rel_to( {{{k}*ds.d.value, 0, 0}}, Global_Frame )[2] )\n"
        f'*Body( b_{k}, "Box {k}", p_{k}, , , ,  )\n'
        f"*SetBodyInertia( b_{k}, ds.d.value^3, ds.d.value, ds.d.value, ds.d.value, 0, 0, 0 )\n"
        f'*Graphic( g_{k}, "Box {k}", BOX, b_{k}, CENTER, p_{k}, ZX, VECTOR, Global_Frame.zaxis\n'
        "        , VECTOR, Global_Frame.xaxis, ds.d.value, ds.d.value, ds.d.value, 3 )\n"
        f'*Bush( bsh_{k}, "Bush {k}", b_{k}, {f"b_{k - 1}" if k else "B_Ground"}, p_{k} )\n'
        f"*SetBush( bsh_{k}, {law}, 0, 0, 0, 0, 0, 0 )"
        for k in range(boxes)
    )
    return model(*head, *rows)


def time_to_read(boxes: int) -> float:
    text = big(boxes)
    begun = time.process_time()
    reading = read(text)
    found, report = reading.values, reading.report
    taken = time.process_time() - begun
    assert not report.findings
    assert len(found["bushings"]) == boxes
    assert found["points"][f"p_{boxes - 1}"] == ((boxes - 1) * 0.5, 0, 0)
    return taken


def test_large_texts_in_linear_time() -> None:
    time_to_read(200)
    small, large = time_to_read(1500), time_to_read(12_000)
    # 8 times the boxes in 8 times the time; what is not linear would take 64 times
    assert large / small < 16


# ---------------------------------------------------------------- a pair that MotionView made itself

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
