"""The form of a MotionView text: arguments, names, numbers, characters."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from motionview_cases import (
    CASES,
    SMALL,
    TURN,
    case_of,
)
from written import Text, model_of

import mdlgen.backends.motionview as motionview
from mdlgen.model.tables import Model


@pytest.fixture(scope="module", params=sorted(CASES))
def case(request) -> tuple[Model, Text]:
    return case_of(request.param)


ARITY = {  # measured over real files or documented: see the MDL reference
    "BeginMDL": 2, "EndMDL": 0, "StandardInclude": 1, "SetCurrentSolverMode": 1, "SetBoolean": 2,
    "SetOption": 2, "BeginContext": 1, "EndContext": 0,
    "DefineDataSet": 1, "Real": 3, "EndDefine": 0, "DataSet": 3, "SetReal": 2,
    "Point": 2, "Vector": 2, "SetVector": 4, "SetPoint": 4, "Marker": 4,
    "Body": 7, "SetBodyInertia": 8, "SetBodyIC": 7, "SetBodyICFlag": 7,
    "Bush": 5, "SetBush": 31, "CoilSpring": 6, "SetCoilSpring": 7, "Contact": 14,
    "RevJoint": 7, "TransJoint": 7, "FixedJoint": 5, "Motion": 5, "SetMotion": 4,
    "Output": 9, "Template": 5, "DefineTemplate": 2, "System": 3, "DefineSystem": 1,
}  # fmt: skip


def test_argument_counts(case):
    _, text = case
    for name, args in text.statements:
        if name == "SetOrientation":
            assert len(args) in (7, 11)
        elif name == "Graphic":
            assert len(args) == {"BOX": 15, "CYLINDER": 13}[args[2]]
        elif name == "DeformableSurface":
            assert len(args) == 5 + int(args[3]) * int(args[4])
        else:
            assert len(args) == ARITY[name], name
    assert text.members.keys() <= text.entity.keys()


GLOBALS = {"B_Ground", "V_Global_X", "V_Global_Y", "V_Global_Z", "Global_Frame", "DS_MotionSolve_Simopts"}
STANDARD = {"ds_gravity": ("igrav", "jgrav", "kgrav"), "ds_units": ()}  # of the standard include
REACHED = {"Point", "Marker", "Vector", "DefineDataSet", "DefineTemplate"}  # of no use unless referred to
WORDS = re.compile(r"(?<![\w.])(?:def_)?(?:p|b|m|v|j|bsh|gbox|gcyl|con|mot|cs|ds|tmplt|o|defsur)_\w+")


def test_every_name_used_is_defined_and_every_name_defined_is_used(case):
    _, text = case
    used: Counter[str] = Counter()
    for _, args in text.statements:
        for arg in args[1:] if args and args[0] in text.entity else args:
            if not arg.startswith('"'):
                used.update(re.findall(WORDS, arg))
                used.update(w for w in re.findall(r"\b[A-Z]\w*_\w+", arg) if w in GLOBALS)
    undefined = set(used) - set(text.entity) - GLOBALS - set(STANDARD)
    assert not undefined
    idle = [n for n, (kind, _) in text.entity.items() if kind in REACHED and not used[n]]
    assert not idle
    lowered = Counter(n.lower() for n in text.entity)
    assert max(lowered.values()) == 1
    targets = set(text.settings("SetReal"))
    standard = {f"{holder}.{member}" for holder, members in STANDARD.items() for member in members}
    assert standard <= targets
    for target in targets - standard:
        data_set, member = target.split(".")
        assert member in text.members[text.entity[data_set][1][1]]
    sets = {n: args[1] for n, args in text.of_kind("DataSet").items()}
    assert {f"{n}.{m}" for n, d in sets.items() for m in text.members[d]} == targets - standard


def test_surface_lists_its_markers_row_by_row():
    model = model_of(*CASES["surface"])
    surface = Text(motionview.emit(model)).values["surfaces"]["defsur_note"]
    assert surface["type"] == "NATURAL"
    assert surface["markers"] == tuple(tuple(f"m_note_{i}_{j}" for i in range(3)) for j in range(4))


def test_banner_says_that_contacts_belong_to_the_start():
    head, _, _ = motionview.emit(model_of("transport_4x4.yaml", SMALL)).partition("*BeginMDL")
    assert "where they start" in head
    every = motionview.emit(model_of("transport_4x4.yaml", SMALL, "run.prune=false"))
    assert "where they start" not in every.partition("*BeginMDL")[0]


@pytest.mark.parametrize("set_contact", [False, True])
@pytest.mark.parametrize("name", sorted(CASES))
def test_a_value_can_be_edited_exactly_where_the_text_uses_it(name, set_contact):
    sample, *overrides = CASES[name]
    text = Text(motionview.emit(model_of(sample, *overrides), set_contact=set_contact))
    used = set(re.findall(r"\b(ds_\w+\.real_\w+)\.value", text.text))
    for data_set, (_, block) in text.of_kind("DataSet").items():
        for member, (_, edit) in text.members[block].items():
            assert f"{data_set}.{member}" in used or edit == "NO_EDIT", f"{data_set}.{member}"


def test_numbers_read_as_the_user_wrote_them():
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL, TURN))
    for line in (
        "ds_note.real_M, 0.00072 )",
        "ds_note.real_turn, 10.0 )",
        "ds_motor_1_left.real_omega, 186.7 )",
        "ds_motor_1_left.real_ramp, 0.005 )",
        "ds_counter_1_left.real_M, 0.00039 )",
        "ds_run.real_end, 0.05 )",
    ):
        assert line in text


def test_text_is_ascii_with_lf_and_ends_in_one_newline(case):
    written = case[1].text
    assert written.isascii() and "\r" not in written and "\t" not in written
    assert written.endswith("*EndMDL()\n")
    assert not re.search(r"[ ]+$|\n\n\n", written, re.M)
    assert not re.findall(r"\b(?:nan|inf|None|Undefined)\b|\$", written)
    assert str(Path.cwd()) not in written
