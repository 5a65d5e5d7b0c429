"""Pairs, joints, bushings and springs as the reader of MDL works them out."""

from __future__ import annotations

import math

import pytest
from readings import PAIR, read_clean


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
