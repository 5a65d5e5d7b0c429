"""Measured curves in the MotionView text and in the deck: written, read back, and every slip found."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import mdlgen
from mdlgen.model import curves
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify.outcome import Verification
from mdlgen.verify.verification import verify

SNATCH = samples() / "snatch.yaml"
SMALL = ["sheets.note.boxes=[2,2]"]


def model_of(*overrides: str) -> Model:
    return lower(load(SNATCH, [*SMALL, *overrides]))


def values(text: str) -> dict:
    reading = emitter("motionview").read(text, "snatch.mdl")
    found = reading.values
    assert not reading.report.findings, [str(f) for f in reading.report.findings[:3]]
    return found


def verified(*overrides: str, **options) -> Verification:
    scene = load(SNATCH, [*SMALL, *overrides])
    return verify(scene, lower(scene), **options)


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center"])
@pytest.mark.parametrize("edge", ["x_min", "y_max"])
def test_text_and_deck_are_the_same_as_the_model(layout: str, edge: str) -> None:
    found = verified(
        f"sheets.note.layout={layout}",
        f"sheets.note.clamp={{edge: {edge}, length: 0 mm}}",
        "sheets.note.turn=20 deg",
    )
    assert [str(d) for d in found.all_differences()] == [] and not found.notes
    for kinds in found.kinds.values():
        assert kinds["curves"].entities > 2000 and kinds["curve laws"].entities > 0
        assert all(c.largest <= 1e-12 for c in kinds.values())
    assert found.perturbed is not None and found.perturbed.values >= 15 and found.perturbed.largest <= 1e-12


def test_the_sheets_alone_have_their_curves() -> None:
    found = verified(only="sheets")
    assert [str(d) for d in found.all_differences()] == []
    assert found.kinds["text"]["curves"].entities > 2000


@pytest.mark.parametrize("backend", ["motionview", "motionsolve"])
def test_a_joint_pulls_as_the_local_run_has_it(backend: str) -> None:
    """The force that text and deck give at an elongation of each bushing, by their own numbers."""
    model = model_of()
    text = mdlgen.emit(model, backend)
    found = values(text) if backend == "motionview" else emitter(backend).read(text, "snatch.xml").values
    table = model.curves
    for row in np.flatnonzero(table.of >= 0):
        law = found["bushings"][f"bsh_{model.bushings.name[row]}"]["curves"][f"k.{table.axis[row]}"]
        curve = found["curves"][law["curve"]]
        factor = 2.0 if law["variable"].startswith("2*") else 1.0
        end = curves.limit(table, int(table.of[row])) * table.length[row]
        elongation = np.linspace(-end, end, 999)
        force = np.interp(factor * elongation, curve["x"], curve["y"])
        exact = table.area[row] * curves.stress(table, int(table.of[row]), elongation / table.length[row])
        assert np.abs(force - exact).max() <= 1.1e-6 * exact.max()


def test_the_text_is_parametric() -> None:
    """Twice the thickness is twice the force, a longer sheet has longer elongations; E is only shown."""
    text = mdlgen.emit(model_of(), "motionview")
    assert re.search(r'\*Real\( real_E_md, "[^"]*first slope of its curve", NO_EDIT \)', text)
    first = values(text)["curves"]["crv_note_md"]
    thicker = values(text.replace("ds_note.real_s, 0.1 )", "ds_note.real_s, 0.2 )"))["curves"]["crv_note_md"]
    assert thicker["x"] == first["x"] and thicker["y"] == pytest.approx(2 * np.array(first["y"]), rel=1e-14)
    longer = values(text.replace("ds_note.real_L_x, 67.0 )", "ds_note.real_L_x, 134.0 )"))["curves"][
        "crv_note_md"
    ]
    assert longer["y"] == first["y"] and longer["x"] == pytest.approx(2 * np.array(first["x"]), rel=1e-14)


def test_the_head_says_what_becomes_of_the_curves() -> None:
    for backend in ("motionview", "motionsolve"):
        text = mdlgen.emit(model_of(), backend)
        head = text[: text.index("*BeginMDL" if backend == "motionview" else "<MultiBodySystem")]
        assert "crv_note_md" in head and "0.024" in head and "the local run ends" in head
        assert ("CRV in SetBush" if backend == "motionview" else "LINSPL") in head
        plain = mdlgen.emit(lower(load(samples() / "cantilever.yaml")), backend)
        assert "urve" not in plain.replace("CURVE", "")


def changed(pattern: str, new: str, where: int = 0) -> Callable[[str], str]:
    def change(text: str) -> str:
        found = list(re.finditer(pattern, text))
        assert found, pattern
        spot = found[where]
        return text[: spot.start()] + spot.expand(new) + text[spot.end() :]

    return change


SLIPS = {
    "a stress": changed(r"([1-9]\.\d+)\*ds_note\.real_A_x", r"1\1*ds_note.real_A_x"),
    "a strain": changed(r"(-0\.01)(\d+)\*ds_note\.real_d_x", r"\g<1>9\2*ds_note.real_d_x"),
    "the other section": changed(r"ds_note\.real_A_x\.value(?=, )", "ds_note.real_A_y.value", 5),
    "the other curve": changed(r"CRV, crv_note_md", "CRV, crv_note_cd"),
    "the method": changed(r"LINEAR, `", "AKIMA, `"),
    "no half cell": changed(r"`2\*DX", "`DX"),
    "half of it": changed(r"`2\*DX", "`2.5*DX"),
    "another direction": changed(r"`DX", "`DY"),
    "another bushing": changed(r"\{bsh_note_x_0_0_a\.i", "{bsh_note_x_0_1_a.i", -1),
    "the wrong way": changed(r"(`DX\(\{\w+)\.i(\.idstring\},\{\w+)\.j", r"\1.j\2.i"),
    "along global axes": changed(r"\{\w+\.j(\.idstring\}\)`)", r"{Global_Frame\1"),
    "in place of k_y": changed(r"(CRV, [^`]*`[^`]*`), LIN, [^,]*", r"LIN, 0, \1"),
    "a plain spring": changed(r"CRV, [^`]*`[^`]*`", "LIN, ds_note.real_k_x.value"),
    "no SetCurve": changed(r"(?s)  \*SetCurve\( crv_note_cd.*?\)\n", ""),
    "extrapolation": changed(r"(real_A_x\.value) \)", r"\1, LIN_EXTRAP )"),
    "the form": changed(r"CURVE_POINTS, OPEN", "CURVE_POINTS, CLOSED"),
}


@pytest.fixture(scope="module")
def honest(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Text and deck, which have no difference as they are."""
    texts = {kind: mdlgen.emit(model_of(), kind) for kind in ("motionview", "motionsolve")}
    for kind, option in (("motionview", "text"), ("motionsolve", "deck")):
        file = tmp_path_factory.mktemp("honest") / "snatch"
        file.write_text(texts[kind])
        assert not verified(perturb=False, **{option: file}).all_differences()
    return texts


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_in_the_text_is_found(tmp_path: Path, slip: str, honest: dict[str, str]) -> None:
    file = tmp_path / "snatch.mdl"
    file.write_text(SLIPS[slip](honest["motionview"]))
    assert verified(text=file, perturb=False).all_differences()


DECK_SLIPS = {
    "a point": changed(r"(?m)^     (0\.\d+) (\d)", r"     \1 1\2", 7),
    "a sign": changed(r'"-LINSPL', '"LINSPL'),
    "no half cell": changed(r"LINSPL\(2\*DX", "LINSPL(DX"),
    "another spline": changed(r",0,1\)", ",0,2)"),
    "no spline": changed(r",0,1\)", ",0,9)"),
    "another marker": changed(r"(DX\(\d+,)(\d+),\d+", r"\g<1>\2,1"),
    "a stiffness": changed(r'k(x +)= "0\.0"', r'k\1= "5.0"'),
    "no force": changed(r"(?s)<!-- MODEL.frc_note_x_0_0_a -->\s*<Force_Vector_TwoBody.*?/>\n", ""),
    "also along y": changed(r'fy_expression       = "0"', r'fy_expression       = "1"'),
    "a floating marker elsewhere": changed(r'j_floating_marker_id= "\d+"', 'j_floating_marker_id= "1"'),
    "its place": changed(r'(?s)(jfloat -->.{200,400}?pos_x +)= "[^"]*"', r'\1= "77.0"'),
    "extrapolation": changed(r'linear_extrap       = "FALSE"', 'linear_extrap       = "TRUE"'),
    "a count": changed(r'num_x               = "(\d+)"', r'num_x               = "1\1"'),
}


@pytest.mark.parametrize("slip", DECK_SLIPS)
def test_a_slip_in_the_deck_is_found(tmp_path: Path, slip: str, honest: dict[str, str]) -> None:
    file = tmp_path / "snatch.xml"
    file.write_text(DECK_SLIPS[slip](honest["motionsolve"]))
    assert verified(deck=file, perturb=False).all_differences()


BUSH = "LIN, 1, " * 11 + "0, 0, 0, 0, 0, 0"
LITTLE = """*BeginMDL( m, "m" )
  *StandardInclude(FILE)
  *SetCurrentSolverMode(MotionSolve)
  *Point( p, "p" )
  *Body( b, "b", p, , , ,  )
  *SetPoint( p, 0, 0, 0 )
  *SetBodyInertia( b, 1, 1, 1, 1 )
  *Bush( bsh, "bsh", b, B_Ground, p )
  *Curve( crv, "crv", 2D, CARTESIAN, WRITE, CURVE_POINTS, OPEN )
  *SetCurve( {curve} )
  *SetBush( bsh, CRV, {law}, {rest} )
*EndMDL()
"""


@pytest.mark.parametrize(
    ("curve", "law", "words"),
    [
        ("crv, VALUE, 2, 0, 1, VALUE, 2, 0, 5", "crv, LINEAR, `DX({bsh.i.idstring})`", ""),
        (
            "crv, VALUE, 2, 0, 1, VALUE, 3, 0, 5, 6",
            "crv, LINEAR, `DX({bsh.i.idstring})`",
            "2 values of x and 3",
        ),
        ("crv, VALUE, 9, 0, 1, VALUE, 2, 0, 5", "crv, LINEAR, `DX({bsh.i.idstring})`", "number of values"),
        (
            "crv, MATH, {0,1}, VALUE, 2, 0, 5",
            "crv, LINEAR, `DX({bsh.i.idstring})`",
            "the only form that is read",
        ),
        ("crv, VALUE, 2, 0, 1, VALUE, 2, 0, 5", "crw, LINEAR, `DX({bsh.i.idstring})`", "crw"),
        ("crv, VALUE, 2, 0, 1, VALUE, 2, 0, 5", "p, LINEAR, `DX({bsh.i.idstring})`", "a Curve is due"),
        ("crv, VALUE, 2, 0, 1, VALUE, 2, 0, 5", "crv, LINEAR, `DX({bush.i.idstring})`", "bush"),
    ],
)
def test_what_the_reader_says_of_a_curve(curve: str, law: str, words: str) -> None:
    text = LITTLE.format(curve=curve, law=law, rest=BUSH)
    reading = emitter("motionview").read(text, "little.mdl")
    found = reading.values
    message = " ".join(str(f) for f in reading.report.findings)
    assert words in message and bool(words) == bool(reading.report.findings)
    if not words:
        assert found["curves"]["crv"]["x"] == (0.0, 1.0) and found["curves"]["crv"]["y"] == (0.0, 5.0)
        law_read = found["bushings"]["bsh"]["curves"]["k.0"]
        assert law_read == {"curve": "crv", "method": "LINEAR", "variable": "DX(bsh.i)"}


def test_a_curve_is_emitted_by_the_same_numbers_twice() -> None:
    assert emitter("motionview").emit(model_of()) == emitter("motionview").emit(model_of())
