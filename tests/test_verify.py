"""What a text, a script and a deck say is what is run; and a change of any of it is seen."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from mutations import mutations

from mdlgen.errors import MdlgenError, RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter, reader
from mdlgen.spec.load import load
from mdlgen.verify.expected import expected, stations
from mdlgen.verify.outcome import Verification
from mdlgen.verify.report import report
from mdlgen.verify.verification import verify

RICH = Path(__file__).with_name("rich.yaml")
SAMPLES = sorted(samples().rglob("*.yaml"))
SMALL = ["sheets.note.boxes=[4,6]"]


def check(spec: Path, overrides: list[str] | None = None, **options) -> Verification:
    scene = load(spec, overrides or [])
    return verify(scene, lower(scene), **options)


def emitted(spec: Path, overrides: list[str] | None = None, **options) -> str:
    return emitter("motionview").emit(lower(load(spec, overrides or [])), **options)


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda p: p.stem)
def test_every_sample_is_the_same_in_text_script_deck_and_model(sample: Path) -> None:
    found = check(sample)
    assert [str(d) for d in found.all_differences()] == []
    assert set(found.kinds) == {"text", "deck"} and not found.notes
    for kinds in found.kinds.values():
        assert all(c.largest <= 1e-12 for c in kinds.values())
    assert found.turned is not None and found.turned.values >= 15 and found.turned.largest <= 1e-12


def test_the_rich_scene_has_every_kind_and_every_value_turned() -> None:
    found = check(RICH)
    assert [str(d) for d in found.all_differences()] == []
    assert all(c.entities for c in found.kinds["text"].values()), "a kind that is not tested"
    assert found.turned is not None and found.turned.values == 96
    # what is only shown is set by the script, or off
    assert all(n.startswith("ds_contact_") or n == "ds_side.real_ramp" for n in found.turned.shown_only)


@pytest.mark.parametrize("seed", range(8))
def test_a_change_of_any_number_name_or_sign_is_caught(seed: int, tmp_path: Path) -> None:
    """40 random changes for each seed, 320 in all: each that alters a value, or makes the text wrong."""
    scene = load(RICH)
    model = lower(scene)
    text = emitter("motionview").emit(model, set_contact=seed % 2 == 1)
    before = reader("motionview").read(text)
    assert not before.report.findings
    file = tmp_path / "rich.mdl"
    altered = 0
    for change in mutations(text, seed, 40):
        try:
            after = reader("motionview").read(change.text)
            same = after.values == before.values and not after.report.findings
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
    reading = reader("motionview").read(text)
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
        whole = reader("motionview").read(f"{text[:start]}*SetReal( {path}, {number} ){text[end:]}").values
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
    for change in mutations(text, 5, 400, "<Reference_Marker"):
        in_entity = any(f"{name}=" in change.where.replace(" ", "") for name in ENTITY_NUMBERS)
        if not change.old[0].isdigit() or not in_entity or not change.where.endswith('"'):
            continue
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
    with pytest.raises(SpecError, match="no instance of def_sys_rich"):
        check(RICH, text=file, only="sheets")
    with pytest.raises(SpecError, match="cannot be verified alone"):
        check(RICH, only="rollers")


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
    told = report(found)
    assert not told["ok"] and any("b_note_3_5: is missing" in d for d in told["differences"])
    json.dumps(told, allow_nan=False)


def test_expected_values_need_no_text(monkeypatch: pytest.MonkeyPatch) -> None:
    """The tables to compare with come from the Model alone: without any backend at hand."""
    monkeypatch.setattr("mdlgen.registry.EMITTERS", {})
    monkeypatch.setattr("mdlgen.registry.READERS", {})
    model = lower(load(RICH))
    assert expected(model, stations(model))["bodies"].names
