"""What a text, a script and a deck say is what is run; and a change of any of it is seen."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from mutations import mutations, omissions
from places import RICH

from mdlgen.errors import MdlgenError, RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify import verification
from mdlgen.verify.expected.motions import stations
from mdlgen.verify.expected.whole import expected
from mdlgen.verify.outcome import Verification
from mdlgen.verify.report import report
from mdlgen.verify.verification import verify

SAMPLES = sorted(samples().rglob("*.yaml"))
SMALL = ["sheets.note.boxes=[4,6]"]


def check(spec: Path, overrides: list[str] | None = None, **options) -> Verification:
    scene = load(spec, overrides or [])
    return verify(scene, lower(scene), **options)


def emitted(spec: Path, overrides: list[str] | None = None, **options) -> str:
    return emitter("motionview").emit(lower(load(spec, overrides or [])), **options)


# Grids in place of those of large samples: fewer boxes are written in the same way. transport_4x4 stays.
FEW = ("sheets.note.boxes=[4, 6]",)
COARSE = {
    "feeder_one": ("sheets.note_1.boxes=[4, 6]",),
    "feeder": ("sheets.note_1.boxes=[4, 3]", "sheets.note_2.boxes=[3, 2]"),
    **dict.fromkeys(("tilt_correction", "transport_4x2", "transport_nips", "transport_tilted"), FEW),
}


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda p: p.stem)
def test_every_sample_is_the_same_in_text_script_deck_and_model(sample: Path) -> None:
    found = check(sample, ["loads=[]", *COARSE.get(sample.stem, ())])  # a text with loads is refused
    assert [str(d) for d in found.all_differences()] == []
    assert set(found.kinds) == {"text", "deck"} and not found.notes
    for kinds in found.kinds.values():
        assert all(c.largest <= 1e-12 for c in kinds.values())
    # 14 values at least: a sheet alone, its bending per width, no hinge in the plane
    least = 14
    assert found.turned is not None and found.turned.values >= least and found.turned.largest <= 1e-12


def test_the_rich_scene_has_every_kind_and_every_value_turned() -> None:
    found = check(RICH)
    assert [str(d) for d in found.all_differences()] == []
    untested = {kind for kind, c in found.kinds["text"].items() if not c.entities}
    assert untested == {"meshes", "mesh files"}, "those are in the sample pick"
    assert found.turned is not None and found.turned.values == 95
    # what is only shown is set by the script, or off
    assert all(n.startswith("ds_contact_") or n == "ds_side.real_ramp" for n in found.turned.shown_only)


def rest(reading) -> list[tuple[str, ...]]:
    """Statements that no value shows."""
    return [found.key for found in reading.remainder()]


@pytest.fixture
def text_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """The deck, which is not changed, is not looked at: what is caught is caught in the text."""
    monkeypatch.setattr(verification, "_deck", lambda *_: None)


@pytest.mark.usefixtures("text_alone")
@pytest.mark.parametrize("seed", range(8))
def test_a_change_of_any_number_name_or_sign_is_caught(seed: int, tmp_path: Path) -> None:
    """40 random changes for each seed, 320 in all: each that alters a value, or makes the text wrong."""
    scene = load(RICH)
    model = lower(scene)
    text = emitter("motionview").emit(model, set_contact=seed % 2 == 1)
    before = emitter("motionview").read(text)
    assert not before.report.findings
    file = tmp_path / "rich.mdl"
    altered = 0
    for change in mutations(text, seed, 40):
        try:
            after = emitter("motionview").read(change.text)
            same = after.values == before.values and not after.report.findings and rest(after) == rest(before)
        except SpecError:
            same = False
        if same:
            continue
        altered += 1
        file.write_text(change.text)
        try:
            caught = (
                not verify(scene, model, text=file, turn=False).ok or not verify(scene, model, text=file).ok
            )
        except MdlgenError:
            caught = True
        assert caught, f"{change.old} -> {change.new} in {change.where}"
    assert altered >= 30


@pytest.mark.usefixtures("text_alone")
@pytest.mark.parametrize("only", [None, "sheets"])
def test_a_statement_that_is_left_out_is_caught(only: str | None, tmp_path: Path) -> None:
    text = emitted(RICH, only=only)
    file = tmp_path / "rich.mdl"
    tried = 0
    for change in omissions(text, 3, "*DefineSystem" if only else "*BeginMDL"):
        file.write_text(change.text)
        try:
            caught = not check(RICH, text=file, turn=False, only=only).ok
            caught = caught or not check(RICH, text=file, only=only).ok
        except MdlgenError:
            caught = True
        assert caught, change.old
        tried += 1
    assert tried >= (20 if only else 30)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        # right once, and not parametric: only turning the value tells
        ("ds_one.real_L_x.value/ds_one.real_n_x.value", "10.0"),
        ("real_d_x, ds_two.real_L_x.value/", "real_d_x, 30.0/"),
        ("2*ds_one.real_zeta_ty.value*sqrt", "0.08*sqrt"),
        ("ds_high.real_R.value^2", "16^2"),
        ("{ds_low.real_omega.value}*(1", "100*(1"),
        ("1-TIME/{ds_low.real_ramp.value}", "1-TIME/0.005"),
        ('"{ds_run.real_end.value}"', '"0.003"'),
        ("*SetPoint( p_low, ds_low.real_x.value", "*SetPoint( p_low, 3"),
        ("ds_floor.real_L_z.value^2)/12, ds_floor", "16)/12, ds_floor"),
        ("10*(ds_one.real_k_x.value < ds_one.real_k_y.value", "10*(1 < 0"),
    ],
)
def test_a_formula_that_became_a_number_is_caught(old: str, new: str, tmp_path: Path) -> None:
    text = emitted(RICH)
    assert old in text
    file = tmp_path / "rich.mdl"
    file.write_text(text.replace(old, new, 1))
    found = check(RICH, text=file, turn=True)
    assert not found.ok
    if found.differences:  # a wrong value at once is caught without turning; only these two are
        assert old in ("ds_high.real_R.value^2", "ds_floor.real_L_z.value^2)/12, ds_floor")


def test_values_found_again_are_those_of_a_whole_reading() -> None:
    """What `changed` leaves as it is does not depend on the value that was changed."""
    text = emitted(RICH, set_contact=True)
    reading = emitter("motionview").read(text)
    base = reading.values
    tried = 0
    for path, member in base["members"].items():
        if member["edit"] == "NO_EDIT":
            continue
        holder, _, name = path.rpartition(".")
        number = repr(base["datasets"][holder][name] * 1.25 or 0.5)
        changed = reading.changed(path, number)
        start = text.index(f"*SetReal( {path}, ")
        end = text.index("\n", start)
        whole = emitter("motionview").read(f"{text[:start]}*SetReal( {path}, {number} ){text[end:]}").values
        merged = {kind: dict(records) for kind, records in base.items()}
        for kind, records in changed.items():
            for key, record in records.items():
                merged[kind][key] = {**merged[kind][key], **record} if kind == "datasets" else record
        for values in (merged, whole):  # the markers that MotionView makes are not found again
            values["markers"] = {n: r for n, r in values["markers"].items() if "." not in n}
        assert merged == whole, path
        tried += 1
    assert tried > 80
    assert reading.values == base


# -- the script


def files(folder: Path) -> tuple[Path, Path]:
    model = lower(load(RICH))
    text, script = folder / "rich.mdl", folder / "rich_mview.py"
    text.write_text(emitter("motionview").emit(model))
    companion = emitter("motionview").companion(model)
    assert companion is not None
    script.write_text(companion)
    return text, script


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"penalty": 30.0', '"penalty": 31.0'),
        ('"rest_coeff": 0.7', '"rest_coeff": 0.5'),
        ('"mu_dynamic": 0.3', '"mu_static": 0.3'),
        ('"con_two_0_1_low",', ""),
        ('"con_two_0_1_low",', '"con_two_0_1_slow",'),
        ("GRAVITY = (0.0, 1000.0, -", "GRAVITY = (0.0, 1000.0, "),
        ("GRAVITY = (", "GRAVITIES = ("),
        ("model.gravity.x, model.gravity.y", "model.gravity.y, model.gravity.x"),
        (".setValues(**numbers)", ".setValues()"),
        ("import mview", "import mview as os"),
    ],
)
def test_a_changed_script_is_caught(old: str, new: str, tmp_path: Path) -> None:
    text, script = files(tmp_path)
    assert check(RICH, text=text, turn=False).ok
    assert old in script.read_text()
    script.write_text(script.read_text().replace(old, new, 1))
    try:
        assert not check(RICH, text=text, turn=False).ok
    except SpecError as error:
        assert error.place is not None


def test_a_script_is_read_and_never_run(tmp_path: Path) -> None:
    text, script = files(tmp_path)
    target = tmp_path / "ran"
    script.write_text(script.read_text() + f"\nopen({str(target)!r}, 'w')\n")
    assert not check(RICH, text=text, turn=False).ok
    script.write_text(f"CONTACTS = open({str(target)!r}, 'w')\n")
    with pytest.raises(SpecError, match="plain numbers"):
        check(RICH, text=text, turn=False)
    assert not target.exists()


# -- the deck


def test_a_change_of_any_number_of_a_deck_is_caught(tmp_path: Path) -> None:
    scene = load(RICH)
    model = lower(scene)
    text = emitter("motionsolve").emit(model)
    file = tmp_path / "rich.xml"
    file.write_text(text)
    assert verify(scene, model, deck=file, turn=False).ok
    tried = 0
    for change in mutations(text, 5, 450, "<Reference_Marker"):
        in_entity = any(f"{name}=" in change.where.replace(" ", "") for name in ENTITY_NUMBERS)
        if not change.old[0].isdigit() or not in_entity or not change.where.endswith('"'):
            continue
        at = next(k for k, (one, other) in enumerate(zip(text, change.text, strict=False)) if one != other)
        owner = text[:at].rpartition("<!-- MODEL.")[2].partition(" ")[0]
        if owner.startswith("gcyl_") and change.where.startswith(("a00", "a10", "a20")):
            continue  # a cylinder is the same round its axis
        file.write_text(change.text)
        try:
            ok = verify(scene, model, deck=file, turn=False).ok
        except SpecError:
            ok = False
        assert not ok, f"{change.old} -> {change.new} in {change.where}"
        tried += 1
    assert tried >= 40


ENTITY_NUMBERS = (
    *(
        "pos_x",
        "pos_y",
        "pos_z",
        "a00",
        "a10",
        "a20",
        "a02",
        "a12",
        "a22",
        "mass",
        "inertia_xx",
        "inertia_yy",
    ),
    *(
        "inertia_zz",
        "inertia_xy",
        "inertia_yz",
        "inertia_xz",
        "kx",
        "ky",
        "kz",
        "cx",
        "cy",
        "cz",
        "ktx",
        "kty",
    ),
    *(
        "ktz",
        "ctx",
        "cty",
        "ctz",
        "stiffness",
        "damping",
        "preload",
        "penalty",
        "restitution_coef",
        "body_id",
    ),
    *(
        "mu_static",
        "mu_dynamic",
        "stiction_trans_vel",
        "friction_trans_vel",
        "normal_trans_vel",
        "i_marker_id",
    ),
    *("j_marker_id", "length_x", "length_y", "length_z", "top_radius", "bottom_radius", "end_time", "grav_x"),
)


# -- the sheets alone


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
    assert found.turned is not None and found.turned.values > 50
    assert "motions" not in found.kinds["text"] and found.kinds["text"]["contacts"].entities == 12


def test_sheets_in_a_model_of_the_user(tmp_path: Path) -> None:
    sheets = emitted(RICH, only="sheets")
    found = check(RICH, text=host(tmp_path, sheets), only="sheets")
    assert [str(d) for d in found.all_differences()] == []
    changed = sheets.replace("LIN, ds_two.real_k_x.value", "LIN, 1.0*ds_two.real_k_y.value", 1)
    assert changed != sheets
    assert not check(RICH, text=host(tmp_path, changed), only="sheets", turn=False).ok


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
    assert check(FOUR, overrides, text=file, only="sheets", turn=False).ok
    assert old in text
    file.write_text(text.replace(old, new, 1))
    found = check(FOUR, overrides, text=file, only="sheets", turn=False)
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
    return check(RICH, text=file, only="sheets", turn=False, **options)


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


# -- statements that no value shows


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
        '*ActionOnlyForce( frc, "f", TRANS, b_one_0_0, p_one_0_0, Global_Frame )',
        '*PointToDeformableSurfaceContact( con_more, "c", b_low, p_low, POISSON, defsur_two, false )',
        "*SetSystem( ds_one )",
        "*if( 0 )\n*endif()",
    ],
)
def test_a_statement_that_is_not_accounted_for_fails(more: str, tmp_path: Path) -> None:
    text, _ = files(tmp_path)
    text.write_text(text.read_text().replace("*EndMDL()", f"{more}\n*EndMDL()"))
    found = check(RICH, text=text, turn=False)
    named = more.partition("(")[0]
    assert any(named in str(d) and "rich.mdl:" in str(d) for d in found.differences), found.differences


def test_what_is_for_people_passes(tmp_path: Path) -> None:
    text, _ = files(tmp_path)
    more = '*SetNote( b_one_0_0, "mine" )\n*Set( b_one_0_0.usecm, true )\n*SetEntityId( b_one_0_0, 7 )\n'
    text.write_bytes(text.read_text().replace("*EndMDL()", f"{more}*EndMDL()").replace("\n", "\r\n").encode())
    found = check(RICH, text=text, turn=False)
    assert found.ok and any("CR LF" in n for n in found.notes)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("  *StandardInclude(FILE)\n", "", "standard_include"),
        ("  *SetCurrentSolverMode(MotionSolve)\n", "", "solver"),
        ("real_turn.value != 0 )", "real_turn.value > 0 )", "*if( ds_two.real_turn.value != 0 ) is missing"),
        ("real_turn.value != 0 )", "real_turn.value != 10 )", "*if( ds_two.real_turn.value != 10 )"),
        ("Simopts.use_run_panel_values, false", "Simopts.use_run_panel_values, true", "use_run_panel_values"),
    ],
)
def test_a_statement_that_is_missing_or_changed_fails(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    text, _ = files(tmp_path)
    assert old in text.read_text()
    text.write_text(text.read_text().replace(old, new, 1))
    found = check(RICH, text=text, turn=False)
    assert any(message in str(d) for d in found.differences), found.differences


def test_gravity_is_known_by_the_standard_include(tmp_path: Path) -> None:
    file = tmp_path / "drop.mdl"
    spec = samples() / "transport_4x4.yaml"
    text = emitted(spec, SMALL)
    file.write_text(text.replace("  *StandardInclude(FILE)\n", ""))
    found = check(spec, SMALL, text=file, turn=False)
    assert any(d.kind == "gravity" for d in found.differences)


def test_a_script_that_is_not_there_is_told(tmp_path: Path) -> None:
    text, script = files(tmp_path)
    found = check(RICH, text=text, turn=False)
    assert found.script == str(script) and not found.notes
    script.unlink()
    found = check(RICH, text=text, turn=False)
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


# -- the deck, beside its numbers


@pytest.mark.parametrize(
    ("pattern", "new", "message"),
    [
        (r'(<!-- MODEL.b_one_0_0 -->.*?lprf_id\s*= )"\d+"', r'\1"{b_one_0_0.cm}"', "lprf_id is b_one_0_0.cm"),
        (r'(vm_id\s*= )"1"', r'\1"{b_one_0_0.cm}"', "vm_id is b_one_0_0.cm, not Global_Frame"),
        (r'(wm_id\s*= )"1"', r'\1"99999"', "wm_id names Reference_Marker 99999"),
        (r'(cg_id\s*= )"\d+"', r'\1"99999"', "cg_id names Reference_Marker 99999"),
        (r'(v_ic_x_flag\s*= )"TRUE"', r'\1"FALSE"', "v_ic_x_flag is FALSE"),
        (r'(w_ic_z_flag\s*= )"TRUE"', r'\1"FALSE"', "w_ic_z_flag is FALSE"),
        (r'(h_max\s*= )"[^"]*"', r'\1"1.0"', "Param_Transient: h_max is 1.0"),
        (r'(is_material_inside\s*= )"TRUE"', r'\1"FALSE"', "is_material_inside is FALSE"),
        (r'(refinement_level\s*= )"\d+"', r'\1"9"', "refinement_level is 9"),
        (r'(u_span\s*= )"[^"]*"', r'\1"0.125"', "u_span is 0.125"),
        (r'(dae_index\s*= )"3"', r'\1"1"', "dae_index is 1"),
        (r'(integrator_type\s*= )"DSTIFF"', r'\1"DSTIFF1"', "integrator_type"),
        (r'(collision_engine\s*= )"PCM"', r'\1"PCM1"', "collision_engine"),
        (r'(linsolver\s*= )"HARWELL"', r'\1"HARWELL1"', "linsolver"),
        (r'(expr1\s*= )"[^"]*"', r'\1"7"', "expr1 is 7"),
        (r'(label\s*= )"Ground Body"', r'\1"Sky Body"', "label is Sky Body"),
        (r"(<Simulate.*?/>)", r"\1\n\1", "Simulate 2 of Command is not in the deck"),
        (r"(<Simulate.*?/>)(\s*)(<Stop/>)", r"\3\2\1", "order is"),
        (r"<H3DOutput.*?/>", "", "H3DOutput"),
    ],
)
def test_what_a_deck_says_beside_numbers_counts(pattern: str, new: str, message: str, tmp_path: Path) -> None:
    scene = load(RICH)
    model = lower(scene)
    text = emitter("motionsolve").emit(model)
    for name in re.findall(r"\{(.*?)\}", new):
        marker = re.search(rf'<!-- MODEL.{re.escape(name)} -->\s*<Reference_Marker\s*id\s*= "(\d+)"', text)
        assert marker is not None
        new = new.replace(f"{{{name}}}", marker[1])
    changed, count = re.subn(pattern, new, text, count=1, flags=re.S)
    assert count == 1
    file = tmp_path / "rich.xml"
    file.write_text(changed)
    found = verify(scene, model, deck=file, turn=False)
    assert any(message in str(d) for d in found.differences), [str(d) for d in found.differences[:5]]


# -- what is refused, and the report


def test_a_scene_that_has_no_text_is_refused_by_name(tmp_path: Path) -> None:
    scene = "sheets.note.boxes=[2,2]"
    with pytest.raises(RefusedError, match="loads"):
        check(
            samples() / "cantilever.yaml",
            [scene, "loads=[{sheet: note, edge: y_max, force: [0 N, 0 N, 1 N]}]"],
        )


def test_a_missing_body_is_told_by_name(tmp_path: Path) -> None:
    spec = samples() / "transport_4x4.yaml"
    text = emitted(spec, ["sheets.note.boxes=[4,5]"])
    file = tmp_path / "note.mdl"
    file.write_text(text)
    found = check(spec, SMALL, text=file, turn=False)
    record = report(found)
    assert not record["ok"] and any("b_note_3_5: is missing" in d for d in record["differences"])
    json.dumps(record, allow_nan=False)


def test_expected_values_need_no_text(monkeypatch: pytest.MonkeyPatch) -> None:
    """The tables to compare with come from the Model alone: without any backend at hand."""
    monkeypatch.setattr("mdlgen.registry.EMITTERS", {})
    model = lower(load(RICH))
    assert expected(model, stations(model))["bodies"].names
