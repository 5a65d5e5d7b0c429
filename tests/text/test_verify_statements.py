"""Statements of a text that no value shows: each is accounted for."""

from __future__ import annotations

from pathlib import Path

import pytest
from places import RICH
from verified import SMALL, check, emitted, files

from mdlgen.errors import SpecError
from mdlgen.paths import samples
from mdlgen.verify.report import report


@pytest.mark.parametrize(
    "more",
    [
        "*Set( b_one_0_0.mass, 5 )",
        "*Set( bsh_one_x_0_0_a.kx, 5 )",
        "*Set( con_two_0_0_low.penalty, 5 )",
        "*Set( m_one.origin, p_two )",
        "*Set( b_one_0_0.usecm, false )",
        "*SetState( b_one_0_0, false )",
        "*SetPoint( b_one_0_0, 1, 2, 3 )",
        '*Include("missing.mdl")',
        "*Gravity( 0, 0, 0 )",
        "*Deactivate( b_one_0_0 )",
        "*SetReal( sys_misc.gravity, 0 )",
        '*Coupler( cpl, "c", 2JOINT, j_low, j_high )',
        '*ActionReactionForce( frc, "f", TRANS, b_one_0_0, b_one_0_1, p_one_0_0, Global_Frame )',
        '*PointToDeformableSurfaceContact( con_more, "c", b_low, p_low, POISSON, defsur_two, false )',
        "*SetSystem( ds_one )",
        "*if( 0 )\n*endif()",
    ],
)
def test_a_statement_that_is_not_accounted_for_fails(more: str, tmp_path: Path) -> None:
    text, _ = files(tmp_path)
    text.write_text(text.read_text().replace("*EndMDL()", f"{more}\n*EndMDL()"))
    found = check(RICH, text=text, perturb=False)
    named = more.partition("(")[0]
    assert any(named in str(d) and "rich.mdl:" in str(d) for d in found.differences), found.differences


def test_what_is_for_people_passes(tmp_path: Path) -> None:
    text, _ = files(tmp_path)
    more = '*SetNote( b_one_0_0, "mine" )\n*Set( b_one_0_0.usecm, true )\n*SetEntityId( b_one_0_0, 7 )\n'
    text.write_bytes(text.read_text().replace("*EndMDL()", f"{more}*EndMDL()").replace("\n", "\r\n").encode())
    found = check(RICH, text=text, perturb=False)
    assert found.ok and any("CR LF" in n for n in found.notes)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("  *StandardInclude(FILE)\n", "", "standard_include"),
        ("  *SetCurrentSolverMode(MotionSolve)\n", "", "solver"),
        ('"Run settings", def_sys_run )', '"Run settings", def_sys_other )', "def_sys_other"),
        ("  *Vector( v_one_x,", "  *Vector( v_other_x,", "v_one_x"),
        ('op_length, "MILLIMETER"', 'op_length, "METER"', "METER, not MILLIMETER"),
        ('op_gravity, "On"', 'op_gravity, "Off"', "gravity"),
        ("  *BeginContext( model.sys_misc )\n", "", "*EndContext closes no"),
        ("  {format, %.15g}\n", "  {format, %.3f}\n", "h_max is 0, not 1e-05"),
        ('max_order           = "5"', 'max_order           = "6"', "max_order is 6, not 5"),
        (
            "<Stop/>",
            "",
            "15 elements, not 16; the first other one, 16, is nothing, not Stop",
        ),
        ("Simopts.use_run_panel_values, false", "Simopts.use_run_panel_values, true", "use_run_panel_values"),
    ],
)
def test_a_statement_that_is_missing_or_changed_fails(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    text, _ = files(tmp_path)
    assert old in text.read_text()
    text.write_text(text.read_text().replace(old, new, 1))
    found = check(RICH, text=text, perturb=False)
    assert any(message in str(d) for d in found.differences), found.differences


def test_gravity_is_known_by_the_standard_include(tmp_path: Path) -> None:
    file = tmp_path / "drop.mdl"
    spec = samples() / "transport_4x4.yaml"
    text = emitted(spec, SMALL)
    file.write_text(text.replace("  *StandardInclude(FILE)\n", ""))
    found = check(spec, SMALL, text=file, perturb=False)
    assert any(d.kind == "gravity" for d in found.differences)


def test_a_script_that_is_not_there_is_reported(tmp_path: Path) -> None:
    text, script = files(tmp_path)
    found = check(RICH, text=text, perturb=False)
    assert found.script == str(script) and not found.notes
    script.unlink()
    found = check(RICH, text=text, perturb=False)
    assert found.ok and not found.notes and found.script is None  # the solver commands need none
    text.write_text(emitted(RICH, set_contact=True))
    found = check(RICH, text=text, perturb=False)
    assert found.ok and found.notes == [
        f"there is no {script}: the script that mdlgen writes is taken in its place"
    ]
    assert report(found)["script"] is None and report(found)["notes"] == found.notes


@pytest.mark.parametrize("raw", [b"", "*BeginMDL( m )".encode("utf-16"), bytes(range(256)) * 9])
def test_a_file_that_is_no_text_is_one_line(raw: bytes, tmp_path: Path) -> None:
    file = tmp_path / "none.mdl"
    file.write_bytes(raw)
    for only in (None, "sheets"):
        with pytest.raises(SpecError, match=r"none\.mdl.*there is no \*BeginMDL"):
            check(RICH, text=file, only=only)
