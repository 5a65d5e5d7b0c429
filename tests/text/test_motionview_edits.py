"""What a user does in MotionView: a value of a text is edited, and the whole follows."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from motionview_cases import (
    C2C,
    MOVING,
    SMALL,
    TURN,
    bodies_are_those_of_the_model,
    boxes_are_those_of_the_model,
    bushings_are_those_of_the_model,
    probes_are_those_of_the_model,
    velocities_are_those_of_the_model,
)
from written import Text, model_of

import mdlgen.backends.motionview as motionview
from mdlgen.model.tables import Model


def test_changing_one_value_moves_the_whole_note():
    """What a user does in MotionView: edit a value of ds_note; the same text must follow."""
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL, TURN))
    for old, new, override in (
        ("real_turn, 10.0 )", "real_turn, -25.0 )", 'sheets.note.turn="-25 deg"'),
        ("real_L_x, 67.0 )", "real_L_x, 80.0 )", 'sheets.note.size=["80 mm","127 mm"]'),
        ("real_k_tx, 0.15 )", "real_k_tx, 0.3 )", 'materials.eur10.k_tx="0.3 N*mm/rad"'),
        ("real_M, 0.00072 )", "real_M, 0.001 )", 'sheets.note.mass="1 g"'),
    ):
        assert text.count(f"ds_note.{old}") == 1
        changed = Text(text.replace(f"ds_note.{old}", f"ds_note.{new}"))
        model = model_of("transport_4x4.yaml", SMALL, *([TURN] if "turn" not in override else []), override)
        bodies_are_those_of_the_model(model, changed)
        bushings_are_those_of_the_model(model, changed)


SUPPORTED = (
    'supports=[{"sheet":"note","at":["0 mm","0 mm"],"fix":["z"]},'
    '{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
    'probes.inside={"sheet":"note","at":["3 mm","-7 mm"]}',
)
TURNED_SCENES = {
    "transport": ("transport_4x4.yaml",),
    "c2c": ("transport_4x4.yaml", SMALL, C2C),
    "moving": ("transport_4x4.yaml", SMALL, *MOVING),
    "surface": ("transport_4x4.yaml", SMALL, "sheets.note.surface=true"),
    "supports": ("cantilever.yaml", *SUPPORTED),
    "clamp": ("cantilever.yaml", SMALL, 'sheets.note.clamp.length="31.75 mm"', *MOVING),
    "block": ("verify/slide.yaml", "sheets.block.boxes=[2,3]"),
}


def follows(text: str, model: Model) -> None:
    """Everything of the text that has a place or axes is where `model` has it."""
    found = Text(text)
    bodies_are_those_of_the_model(model, found)
    bushings_are_those_of_the_model(model, found)
    velocities_are_those_of_the_model(model, found)
    boxes_are_those_of_the_model(model, found)
    probes_are_those_of_the_model(model, found)


def edited(text: str, value: str, new: float) -> str:
    """`text` with only the number of one value of a data set changed."""
    pattern = rf"(\*SetReal\( {re.escape(value)}, )[-+.e\d]+( \))"
    text, count = re.subn(pattern, lambda m: f"{m[1]}{new!r}{m[2]}", text)
    assert count == 1
    return text


@pytest.mark.parametrize("name", sorted(TURNED_SCENES))
def test_editing_the_turn_turns_the_whole_sheet_and_back(name):
    sample, *overrides = TURNED_SCENES[name]
    sheet = "block" if name == "block" else "note"
    aligned = model_of(sample, *overrides)
    turned = model_of(sample, *overrides, f'sheets.{sheet}.turn="10 deg"')
    assert not np.allclose(aligned.bushings.axes, turned.bushings.axes)
    text, value = motionview.emit(aligned), f"ds_{sheet}.real_turn"
    follows(edited(text, value, 10.0), turned)
    follows(edited(text, value, 0.0), aligned)
    follows(edited(motionview.emit(turned), value, 0.0), aligned)


@pytest.mark.parametrize("edge", ["x_min", "x_max", "y_min", "y_max"])
def test_editing_the_size_moves_what_stands_on_an_edge(edge):
    on_edge = (
        f'supports=[{{"sheet":"note","edge":"{edge}","fix":["z"]}}]',
        f'probes={{"side":{{"sheet":"note","edge":"{edge}"}}}}',
    )
    scene = ("cantilever.yaml", SMALL, TURN, *on_edge)
    resized = model_of(*scene, 'sheets.note.size=["80 mm","95 mm"]')
    text = edited(motionview.emit(model_of(*scene)), "ds_note.real_L_x", 80.0)
    follows(edited(text, "ds_note.real_L_y", 95.0), resized)


@pytest.mark.parametrize("axis", "xyz")
def test_editing_one_of_three_angles_turns_the_whole_sheet_and_back(axis):
    angles = ["20 deg" if a == axis else "0 deg" for a in "xyz"]
    # without springs: a note that stands across the machine lifts the rollers
    scene = ("cantilever.yaml", SMALL, *MOVING, *SUPPORTED)
    aligned = model_of(*scene, 'sheets.note.rotation=["0 deg","0 deg","0 deg"]')
    turned = model_of(*scene, f"sheets.note.rotation={json.dumps(angles)}")
    text, value = motionview.emit(aligned), f"ds_note.real_r_{axis}"
    follows(text, aligned)
    follows(edited(text, value, 20.0), turned)
    follows(edited(motionview.emit(turned), value, 0.0), aligned)
