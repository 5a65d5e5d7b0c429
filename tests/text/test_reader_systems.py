"""Data, conditions, systems and contacts as the reader of MDL works them out."""

from __future__ import annotations

from readings import PAIR, read_clean


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
