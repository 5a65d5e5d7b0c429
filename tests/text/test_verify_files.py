"""Scripts and decks that say something else than the Model: each change is seen."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from mutations import mutations
from places import RICH
from verified import check, files

from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify import verification
from mdlgen.verify.verification import verify


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"penalty": 30.0', '"penalty": 31.0'),
        ('"rest_coeff": 0.7', '"rest_coeff": 0.5'),
        ('"mu_dynamic": 0.3', '"mu_static": 0.3'),
        ('"con_two_0_1_low",', ""),
        ('"con_two_0_1_low",', '"con_two_0_1_slow",'),
        (", **numbers)", ")"),
        ("import mview", "import mview as os"),
    ],
)
def test_a_changed_script_is_caught(old: str, new: str, tmp_path: Path) -> None:
    text, script = files(tmp_path)
    assert check(RICH, text=text, perturb=False).ok
    assert old in script.read_text()
    script.write_text(script.read_text().replace(old, new, 1))
    try:
        assert not check(RICH, text=text, perturb=False).ok
    except SpecError as error:
        assert error.place is not None


def test_a_script_is_read_and_never_run(tmp_path: Path) -> None:
    text, script = files(tmp_path)
    target = tmp_path / "ran"
    script.write_text(script.read_text() + f"\nopen({str(target)!r}, 'w')\n")
    assert not check(RICH, text=text, perturb=False).ok
    script.write_text(f"CONTACTS = open({str(target)!r}, 'w')\n")
    with pytest.raises(SpecError, match="plain numbers"):
        check(RICH, text=text, perturb=False)
    assert not target.exists()


def test_a_change_of_any_number_of_a_deck_is_caught(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("_text", "_script", "_lint"):  # which are not changed
        monkeypatch.setattr(verification, name, lambda *_: None)
    scene = load(RICH)
    model = lower(scene)
    text = emitter("motionsolve").emit(model)
    file = tmp_path / "rich.xml"
    file.write_text(text)
    assert verify(scene, model, deck=file, perturb=False).ok
    tried = 0
    for change in mutations(text, 5, 450, "<Reference_Marker"):
        in_entity = any(f"{name}=" in change.where.replace(" ", "") for name in ENTITY_NUMBERS)
        in_entity |= "CONTACT(" in change.where
        if not change.old[0].isdigit() or not in_entity or not change.where.endswith('"'):
            continue
        at = next(k for k, (one, other) in enumerate(zip(text, change.text, strict=False)) if one != other)
        owner = text[:at].rpartition("<!-- MODEL.")[2].partition(" ")[0]
        if owner.startswith("gcyl_") and change.where.startswith(("a00", "a10", "a20")):
            continue  # a cylinder is the same round its axis
        file.write_text(change.text)
        try:
            ok = verify(scene, model, deck=file, perturb=False).ok
        except SpecError:
            ok = False
        assert not ok, f"{change.old} -> {change.new} in {change.where}"
        tried += 1
        if tried == 40:  # as many as of a text for each seed
            break
    assert tried == 40


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
    found = verify(scene, model, deck=file, perturb=False)
    assert any(message in str(d) for d in found.differences), [str(d) for d in found.differences[:5]]
