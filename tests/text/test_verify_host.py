"""Sheets in a model of the user, verified there."""

from __future__ import annotations

from pathlib import Path

import pytest
from places import RICH
from verified import check, emitted

from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify.outcome import Verification

HOST = """*BeginMDL( host, "Host" )
  *StandardInclude(FILE)
  *Include("rich_sheets.mdl")
  *Point( p_own, "Own" )
  *SetPoint( p_own, 0, 0, 0 )
  *Body( b_own, "Own", p_own, , , ,  )
  *SetBodyInertia( b_own, 1, 1, 1, 1, 0, 0, 0 )
  *Graphic( g_own, "Own", SPHERE, b_own, p_own, 5, 3 )
  *System( sys_paper, "Paper", def_sys_rich, b_own, g_own, b_own, g_own, b_own, g_own )
*EndMDL()
"""


def host(folder: Path, sheets: str) -> Path:
    (folder / "rich_sheets.mdl").write_text(sheets)
    file = folder / "host.mdl"
    file.write_text(HOST)
    return file


def test_sheets_alone_are_the_same_and_parametric() -> None:
    found = check(RICH, only="sheets")
    assert [str(d) for d in found.all_differences()] == []
    assert found.perturbed is not None and found.perturbed.values > 50
    assert "motions" not in found.kinds["text"] and found.kinds["text"]["contacts"].entities == 12


def test_sheets_in_a_model_of_the_user(tmp_path: Path) -> None:
    sheets = emitted(RICH, only="sheets")
    found = check(RICH, text=host(tmp_path, sheets), only="sheets")
    assert [str(d) for d in found.all_differences()] == []
    changed = sheets.replace("LIN, ds_two.real_k_x.value", "LIN, 1.0*ds_two.real_k_y.value", 1)
    assert changed != sheets
    assert not check(RICH, text=host(tmp_path, changed), only="sheets", perturb=False).ok


def test_a_model_without_the_sheets_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "host.mdl"
    file.write_text('*BeginMDL( host, "Host" )\n*EndMDL()\n')
    with pytest.raises(SpecError, match=r"host\.mdl: this text has no instance of def_sys_rich"):
        check(RICH, text=file, only="sheets")
    with pytest.raises(SpecError, match="cannot be verified alone"):
        check(RICH, only="rollers")


FOUR = samples() / "transport_4x4.yaml"
TOUCHES = "BODY, b_note_0_0, 1, gbox_note_0_0, false, BODY, {}, 1, {}, false )"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            TOUCHES.format("b_counter_1_left_att", "gra_counter_1_left_att"),
            TOUCHES.format("b_motor_2_left_att", "gra_counter_1_left_att"),
            "'b_motor_2_left_att', not 'b_counter_1_left_att'",
        ),
        (
            TOUCHES.format("b_counter_1_left_att", "gra_counter_1_left_att"),
            TOUCHES.format("b_counter_1_left_att", "gra_motor_1_right_att"),
            "'gra_motor_1_right_att', not 'gra_counter_1_left_att'",
        ),
        ('attachment.", b_motor_1_left,', 'attachment.", b_motor_2_left,', "*Attachment( b_motor_1_left_att"),
        (", gra_support_att )", ", gra_support_att, b_more_att )", "*DefineSystem( def_sys_transport_4x4"),
    ],
)
def test_the_part_that_a_sheet_touches_counts(old: str, new: str, message: str, tmp_path: Path) -> None:
    overrides = ["sheets.note.boxes=[2,3]", "run.prune=false"]
    text = emitted(FOUR, overrides, only="sheets")
    file = tmp_path / "sheets.mdl"
    file.write_text(text)
    assert check(FOUR, overrides, text=file, only="sheets", perturb=False).ok
    assert old in text
    file.write_text(text.replace(old, new, 1))
    found = check(FOUR, overrides, text=file, only="sheets", perturb=False)
    assert any(message in str(d) for d in found.differences)


MACHINE = """*BeginMDL( host, "Host" )
  *StandardInclude(FILE)
  {0}
  {1}
*EndMDL()
"""
GIVEN = "b_high, g_high, b_low, g_low, b_floor, g_floor"


def machine(folder: Path, systems: list[str], *more: str) -> Path:
    """A model with bodies for the rich scene, and `systems` of its sheets."""
    (folder / "rich_sheets.mdl").write_text(emitted(RICH, only="sheets"))
    bodies = [
        f'*Body( b_{n}, "{n}", P_Global_Origin, , , ,  )\n*SetBodyInertia( b_{n}, 1, 1, 1, 1 )\n'
        f'*Graphic( g_{n}, "{n}", SPHERE, b_{n}, P_Global_Origin, 5, 3 )'
        for n in ("high", "low", "floor")
    ]
    file = folder / "host.mdl"
    lines = [*bodies, '*Include("rich_sheets.mdl")', *systems]
    file.write_text(MACHINE.format("\n".join(lines), "\n".join(more)))
    return file


def in_host(file: Path, **options) -> Verification:
    return check(RICH, text=file, only="sheets", perturb=False, **options)


def of(name: str, given: str = GIVEN) -> str:
    return f'*System( {name}, "Paper", def_sys_rich, {given} )'


def test_what_a_host_gives_the_sheets_is_noted(tmp_path: Path) -> None:
    found = in_host(machine(tmp_path, [of("sys_rich")]))
    assert found.ok and not [n for n in found.notes if "given" in n]
    exchanged = "b_low, g_low, b_high, g_high, b_floor, g_floor"
    found = in_host(machine(tmp_path, [of("sys_rich", exchanged)]))
    assert found.ok and "sys_rich.b_high_att is given b_low, which b_low_att is in the scene" in found.notes
    found = in_host(machine(tmp_path, [of("sys_rich", ", ".join(["b_low, g_low"] * 3))]))
    assert found.ok and any("is given b_low for 3 attachments" in n for n in found.notes)


def test_what_a_host_does_to_the_sheets_is_noted(tmp_path: Path) -> None:
    lock = '*FixedJoint( j_lock, "lock", sys_rich.b_one_0_0, B_Ground, P_Global_Origin )'
    probe = '*Marker( m_probe, "probe", sys_rich.b_one_0_0, P_Global_Origin )'
    found = in_host(machine(tmp_path, [of("sys_rich")], lock, probe, "*Deactivate( sys_rich.b_one_0_0 )"))
    acting = [n for n in found.notes if "acts on the sheets sys_rich" in n]
    assert found.ok and ["j_lock" in n for n in acting] == [True, False]
    assert any("*Deactivate is not a statement that is known" in n for n in found.notes)


def test_through_an_attachment_of_another_system_too(tmp_path: Path) -> None:
    other = (
        "*DefineSystem( def_m, b_att )\n"
        '*Attachment( b_att, "b", Body, "Select attachment.", B_Ground,  )\n'
        '*FixedJoint( j_lock, "lock", b_att, B_Ground, P_Global_Origin )\n'
        "*EndDefine()"
    )
    found = in_host(
        machine(tmp_path, [of("sys_rich"), '*System( sys_m, "M", def_m, sys_rich.b_one_0_0 )'], other)
    )
    assert found.ok and any("j_lock" in n for n in found.notes)


CONTEXT = "*BeginContext( sys_rich )\n{}\n*EndContext()"


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("*Set( sys_rich.b_one_0_0.mass, 5 )", "*Set( sys_rich.b_one_0_0.mass, 5 )"),
        ("*SetState( sys_rich.b_one_0_0, false )", "*SetState( sys_rich.b_one_0_0, false )"),
        (
            "*BeginContext( sys_rich )\n*SetState( b_one_0_0, false )\n*EndContext()",
            "*SetState( b_one_0_0, false )",
        ),
        ("*BeginContext( sys_rich )\n*SetReal( ds_one.real_M, 5 )\n*EndContext()", "ds_one.real_M"),
    ],
)
def test_what_a_host_sets_in_the_sheets_counts(more: str, message: str, tmp_path: Path) -> None:
    found = in_host(machine(tmp_path, [of("sys_rich")], more))
    assert any(message in str(d) for d in found.differences)


def test_what_stands_in_the_file_of_the_sheets_counts(tmp_path: Path) -> None:
    file = machine(tmp_path, [of("sys_rich")])
    sheets = tmp_path / "rich_sheets.mdl"
    text = sheets.read_text()
    for more in ('*Include("missing.mdl")', "*Gravity( 0, 0, 0 )"):
        sheets.write_text(f"{text}{more}\n")
        found = in_host(file)
        assert [more.rstrip(")").split("(")[0] in d.what for d in found.differences] == [True]
        sheets.write_text(text.replace("*DataSet( ds_one", f"{more}\n  *DataSet( ds_one", 1))
        assert not in_host(file).ok
    sheets.write_text(text)
    host = file.read_text()
    file.write_text(host.replace("*EndMDL()", "*Gravity( 0, 0, 0 )\n*EndMDL()"))
    found = in_host(file)
    assert found.ok and any("*Gravity" in n for n in found.notes)


def test_each_system_of_the_sheets_is_verified(tmp_path: Path) -> None:
    context = "*BeginContext( sys_two )\n*SetReal( ds_one.real_M, 5 )\n*EndContext()"
    file = machine(tmp_path, [of("sys_rich"), of("sys_two")])
    found = in_host(file)
    assert found.ok and any("must be run for each" in n for n in found.notes)
    found = in_host(machine(tmp_path, [of("sys_rich"), of("sys_two")], context))
    assert found.differences and all(d.name.startswith("sys_two.") for d in found.differences)


def test_the_script_is_for_the_system_of_the_host(tmp_path: Path) -> None:
    file = machine(tmp_path, [of("sys_paper")])
    found = in_host(file)
    assert found.ok and found.script is None
    assert any("rich_sheets_mview.py" in n and "host_mview.py" in n for n in found.notes)
    assert any("SYSTEM is 'sys_rich'" in n for n in found.notes)
    companion = emitter("motionview").companion(lower(load(RICH)), only="sheets")
    assert companion is not None
    script = tmp_path / "rich_sheets_mview.py"  # beside the file of the sheets
    script.write_text(companion)
    found = in_host(file)
    assert found.script == str(script)
    assert [d.kind for d in found.differences] == ["script"] and "sys_paper" in found.differences[0].what
    script.write_text(companion.replace('"sys_rich"', '"sys_paper"', 1))
    assert in_host(file).ok
    script.write_text(companion.replace("SYSTEM = ", "ELSEWHERE = ", 1))
    assert not in_host(file).ok
