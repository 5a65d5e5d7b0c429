"""Loads in MotionView text: against the Model, and changed, on sheets of every kind."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from verified import check, emitted
from written import Text, model_of

import mdlgen.backends.motionview as motionview
from mdlgen.paths import samples

STRIP = "verify/rollup.yaml"
ALL = (
    {"sheet": "strip", "edge": "x_max", "force": ["1 N", "-2 N", "0.5 N"]},
    {"sheet": "strip", "edge": "y_min", "moment": ["1 N*mm", "0 N*mm", "-3 N*mm"]},
    {"sheet": "strip", "edge": "y_max", "stress": "2 MPa"},
    {"sheet": "strip", "edge": "x_min", "stress": "-1 MPa"},
    {"sheet": "strip", "at": ["3 mm", "2 mm"], "force": ["0 N", "0 N", "-1 N"]},
    {"sheet": "strip", "at": ["0 mm", "0 mm"], "force": ["0 N", "0.1 N", "-1 N"]},
)
SHEETS = {
    "as it is": (),
    "turned, in two rows": (
        "sheets.strip.boxes=[4,2]",
        'sheets.strip.rotation=["20 deg","-35 deg","110 deg"]',
    ),
    "with lengths of its own and a zone": (
        "sheets.strip.boxes=[4,2]",
        "sheets.strip.clamp=null",
        "sheets.strip.grading={x: {sizes: [1, 2, 2, 3]}, y: {sizes: [2, 3]}}",
        "sheets.strip.zones={tape: {x: [-100 mm, 0 mm], y: [-10 mm, 10 mm], thickness: 0.2 mm}}",
    ),
    "on the paper's grid, centre to centre": (
        "sheets.strip.boxes=[4,3]",
        *("sheets.strip.grid=paper", "sheets.strip.layout=center_to_center"),
    ),
    "curled": ("sheets.strip.boxes=[4,2]", "sheets.strip.shape={curl: {radius: 90 mm, along: x}}"),
}


@pytest.mark.parametrize("kind", SHEETS)
def test_loads_are_those_of_the_model_also_when_values_are_changed(kind: str) -> None:
    overrides = [f"loads={json.dumps(ALL)}", *SHEETS[kind]]
    found = check(samples() / STRIP, overrides)
    assert found.ok, found.all_differences()[:5]
    assert found.kinds["text"]["loads"].entities >= len(ALL)
    assert found.kinds["deck"]["loads"].entities == found.kinds["text"]["loads"].entities
    assert found.perturbed is not None and not {p for p in found.perturbed.shown_only if "load" in p}


def test_a_load_keeps_its_direction_while_its_box_turns() -> None:
    model = model_of("verify/tension.yaml", 'sheets.strip.turn="90 deg"')
    forces = Text(motionview.emit(model)).values["forces"]
    whole = [sum(record["force"][k] for record in forces.values()) for k in range(3)]
    sheet = model.sheets[0]
    pull = 30.0 * sheet.size[1] * sheet.thickness
    assert whole == pytest.approx([0.0, pull, 0.0], abs=1e-12 * pull)
    assert {record["reference"] for record in forces.values()} == {"m_strip"}  # on ground


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("real_m_y, -3.14", "real_m_y, 3.14", "data ds_load_0.real_m_y"),
        ("p_frc_0, m_strip )", "p_frc_0, Global_Frame )", "reference"),
        ("ROT, b_strip_19_0", "TRANS, b_strip_19_0", "loads frc_0"),
        ("ROT, b_strip_19_0", "ROT, b_strip_18_0", "b_strip_18_0, not b_strip_19_0"),
        ("LIN, ds_load_0.real_m_z", "LIN, -ds_load_0.real_m_y", "loads frc_0: moment.2"),
        (
            "*EndMDL()",
            '*ActionOnlyForce( frc_1, "f", TRANS, b_strip_1_0, p_frc_0, m_strip )\n*EndMDL()',
            "frc_1",
        ),
    ],
)
def test_a_changed_load_is_caught(old: str, new: str, message: str, tmp_path: Path) -> None:
    text = emitted(samples() / STRIP)
    assert old in text
    (tmp_path / "rollup.mdl").write_text(text.replace(old, new, 1))
    found = check(samples() / STRIP, text=tmp_path / "rollup.mdl", perturb=False)
    assert any(message in str(d) for d in found.differences), found.differences
