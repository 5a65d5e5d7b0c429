"""What a text, a script and a deck say is what is run; and a change of any of it is seen."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from mutations import mutations, omissions
from places import RICH
from unsaid import UNSAID
from verified import SMALL, check, emitted

from mdlgen.errors import MdlgenError, RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify import verification
from mdlgen.verify.expected.motions import stations
from mdlgen.verify.expected.whole import expected
from mdlgen.verify.perturb import perturb
from mdlgen.verify.perturb.perturbations import Perturbation
from mdlgen.verify.report import report
from mdlgen.verify.verification import verify

SAMPLES = sorted(samples().rglob("*.yaml"))
# Grids in place of those of large samples: fewer boxes are written in the same way. transport_4x4 stays.
FEW = ("sheets.note.boxes=[4, 6]",)
COARSE = {
    **UNSAID,
    "feeder_one": ("sheets.note_1.boxes=[4, 6]",),
    "feeder": ("sheets.note_1.boxes=[4, 3]", "sheets.note_2.boxes=[3, 2]"),
    "register": (*UNSAID["register"], "sheets.note.boxes=[2, 2]"),
    "duplex": (*UNSAID["duplex"], "sheets.note.boxes=[2, 1]"),
    **dict.fromkeys(("tilt_correction", "transport_4x2", "transport_nips", "transport_tilted"), FEW),
}


# all values of a scene with every kind of part are turned below; all of each sample before a release
@pytest.mark.parametrize(
    "every", [6, pytest.param(1, marks=pytest.mark.release)], ids=["some values", "all values"]
)
@pytest.mark.parametrize("sample", SAMPLES, ids=lambda p: p.stem)
def test_every_sample_is_the_same_in_text_scripts_deck_and_model(
    sample: Path, every: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With one of so many values turned; which one of them differs from sample to sample."""
    turn, seen = perturb._Perturber.perturb, []

    def some(self: perturb._Perturber, perturbation: Perturbation) -> None:
        seen.append(perturbation.path)
        if (len(seen) + SAMPLES.index(sample)) % every == 0:
            turn(self, perturbation)

    monkeypatch.setattr(perturb._Perturber, "perturb", some)
    found = check(sample, [*COARSE.get(sample.stem, ())])
    assert [str(d) for d in found.all_differences()] == []
    assert set(found.kinds) == {"text", "deck", "msolve"} and not found.notes
    for kinds in found.kinds.values():
        assert all(c.largest <= 1e-12 for c in kinds.values())
    # 14 values at least: a sheet alone, its bending per width, no hinge in the plane
    assert len(seen) >= 14 and found.perturbed is not None
    assert found.perturbed.values >= len(seen) // every and found.perturbed.largest <= 1e-12


def test_the_rich_scene_has_every_kind_and_every_value_turned() -> None:
    found = check(RICH)
    assert [str(d) for d in found.all_differences()] == []
    untested = {kind for kind, c in found.kinds["text"].items() if not c.entities}
    # meshes are in the sample pick, the others in scenes of their own
    assert untested == {"meshes", "mesh files", "axles", "stops"}
    assert found.perturbed is not None and found.perturbed.values == 127
    # what is only shown is set by the script, or off
    assert all(n.startswith("ds_contact_") or n == "ds_side.real_ramp" for n in found.perturbed.shown_only)


def rest(reading) -> list[tuple[str, ...]]:
    """Statements that no value shows."""
    return [found.key for found in reading.remainder()]


@pytest.fixture
def text_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Deck and script, which are not changed, are not looked at: what is caught is caught in the text."""
    for name in ("_deck", "_script"):
        monkeypatch.setattr(verification, name, lambda *_: None)


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
                not verify(scene, model, text=file, perturb=False).ok
                or not verify(scene, model, text=file).ok
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
            caught = not check(RICH, text=file, perturb=False, only=only).ok
            caught = caught or not check(RICH, text=file, only=only).ok
        except MdlgenError:
            caught = True
        assert caught, change.old
        tried += 1
    assert tried >= (20 if only else 30)


@pytest.mark.usefixtures("text_alone")
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
        ('"{ds_run.real_h_max.value}"', '"1e-05"'),
        ('"{ds_run.real_tol.value}"', '"0.001"'),
        ("kgrav, MODEL.ds_run.real_g_z.value", "kgrav, -9000.0"),
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
    found = check(RICH, text=file, perturb=True)
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
                merged[kind][key] = (
                    {**merged[kind][key], **record} if kind in ("datasets", "standard") else record
                )
        for values in (merged, whole):  # the markers that MotionView makes are not found again
            values["markers"] = {n: r for n, r in values["markers"].items() if "." not in n}
        assert merged == whole, path
        tried += 1
    assert tried > 80
    assert reading.values == base


def test_a_scene_that_has_no_text_is_refused_by_name(tmp_path: Path) -> None:
    rolling = "contacts.0.rolling_resistance=0.01"
    with pytest.raises(RefusedError, match="rolling"):
        check(samples() / "transport_4x4.yaml", [*SMALL, rolling])


def test_a_missing_body_is_reported_by_name(tmp_path: Path) -> None:
    spec = samples() / "transport_4x4.yaml"
    text = emitted(spec, ["sheets.note.boxes=[4,5]"])
    file = tmp_path / "note.mdl"
    file.write_text(text)
    found = check(spec, SMALL, text=file, perturb=False)
    record = report(found)
    assert not record["ok"] and any("b_note_3_5: is missing" in d for d in record["differences"])
    json.dumps(record, allow_nan=False)


def test_expected_values_need_no_text(monkeypatch: pytest.MonkeyPatch) -> None:
    """The tables to compare with come from the Model alone: without any backend at hand."""
    monkeypatch.setattr("mdlgen.registry.EMITTERS", {})
    model = lower(load(RICH))
    assert expected(model, stations(model))["bodies"].names
