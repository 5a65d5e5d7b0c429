"""The sheets for a machine that stands in the user's own model: their system definition."""

from __future__ import annotations

from typing import Any

import pytest
from external_scene import FOUR, SMALL, SYSTEMS, counts, host_of, model_of, sheets_of
from golden import compare

import mdlgen
import mdlgen.backends.motionview as motionview
from mdlgen.backends.motionview.reader import lint, read
from mdlgen.errors import SpecError
from mdlgen.paths import samples


def test_statements_of_the_definition() -> None:
    text = sheets_of(model_of())
    found = counts(text)
    assert found["DefineSystem"] == 1 and found["Attachment"] == 2 + 2 + 3
    assert found["Body"] == found["Graphic"] == 12
    # two bushings for each of 2 x 4 joints along x and 3 x 3 along y
    assert found["Bush"] == found["SetBush"] == 2 * (2 * 4 + 3 * 3)
    assert found["Contact"] == 12 * 3 and found["Output"] == 1
    assert found["DataSet"] == found["DefineDataSet"] == 1 + 2 + 1
    assert not set(found) & {"BeginMDL", "System", "Template", "StandardInclude", "RevJoint", "Motion"}
    order = [s.name for s in read(text).program.statements]
    # the context of a data set's definition is the model, not a system
    assert order.index("EndDefine") < order.index("DefineDataSet")


def test_attachments_are_the_parts_that_sheets_meet() -> None:
    text = sheets_of(model_of())
    begin = text[text.index("\n*DefineSystem") :]
    assert begin.startswith(
        "\n*DefineSystem( def_sys_feed\n"
        "             , b_motor_att\n"
        "             , gra_motor_att\n"
        "             , b_feed_att\n"
        "             , gra_feed_att\n"
        "             , b_guide_att\n"
        "             , gra_guide_att_0\n"
        "             , gra_guide_att_1 )\n"
    )
    words = 'b_guide_att, "Body of guide", Body, "Select attachment.", MODEL.sys_guide.b_guide, '
    assert f"\n  *Attachment( {words} )\n" in begin
    assert "BODY, b_guide_att, 2, gra_guide_att_0, false, gra_guide_att_1, false )" in begin
    pasted = next(x for x in text.splitlines() if "*System(" in x)
    assert pasted == (
        '//   *System( sys_feed, "feed", def_sys_feed, b_motor, gcyl_motor, b_feed, gra_feed, '
        "MODEL.sys_guide.b_guide, sys_guide.gra_a, sys_guide.gra_b )"
    )


def test_contacts_of_the_machine_itself_are_left_out() -> None:
    model = mdlgen.lower(mdlgen.load(FOUR, [SMALL]))
    text = sheets_of(model)
    found = counts(text)
    assert found["Attachment"] == 2 * (8 + 1) and found["Body"] == 6
    assert found["Contact"] == len(model.pairs) - 4
    head = text[: text.index("\n*DefineSystem")]
    assert "//   motor_1_left / counter_1_left\n" in head
    assert all(line.startswith("//") for line in head.splitlines())
    assert text.isascii() and text.endswith("\n") and "\n\n\n" not in text


def test_a_sheet_that_meets_nothing_has_no_attachments() -> None:
    text = sheets_of(mdlgen.lower(mdlgen.load(samples() / "cantilever.yaml", [SMALL])))
    assert "*DefineSystem( def_sys_cantilever )\n" in text
    assert lint(text).findings == ()


def test_loads_stand_in_the_system() -> None:
    text = sheets_of(model_of("loads=[{sheet: note, edge: x_max, force: [1 N, 0 N, 0 N]}]"))
    forces = read(text).values["forces"]
    assert forces and sum(record["force"][0] for record in forces.values()) == pytest.approx(1.0, rel=1e-12)
    assert all(record["reference"].endswith(".m_note") for record in forces.values())


def test_taken_names_are_refused() -> None:
    with pytest.raises(SpecError, match="sys_misc"):
        sheets_of(model_of("name=misc"))
    with pytest.raises(SpecError, match="cannot be written alone"):
        motionview.emit(model_of(), only="rollers")


TURNED = ('sheets.note.turn="10 deg"', 'sheets.note.velocity=["1 m/s", "0.2 m/s", "0 m/s"]',
          'sheets.note.spin=["0 rad/s", "0 rad/s", "3 rad/s"]')  # fmt: skip
ROTATED = ('sheets.note.rotation=["5 deg", "-3 deg", "20 deg"]', "sheets.note.surface=true", *TURNED[1:])
HELD = ("sheets.note.clamp={edge: y_min}", "supports=[{sheet: note, at: [33.5 mm, 63.5 mm], fix: [z]}]")


def inside(values: dict[str, dict[str, Any]], system: str) -> dict[str, dict[str, Any]]:
    """What lies in a system, by kind, under the names that it has there."""

    def plain(value: Any) -> Any:
        if isinstance(value, str):
            return value.replace(f"{system}.", "") if system else value
        if isinstance(value, (tuple, list)):
            return [plain(v) for v in value]
        if isinstance(value, dict):  # what is an argument of a system is a name of its own only there
            return {k: plain(v) for k, v in value.items() if k != "attachments"}
        return value

    return {
        kind: {plain(n): plain(v) for n, v in found.items() if n.startswith(system)}
        for kind, found in values.items()
    }


@pytest.mark.parametrize("changes", [(), TURNED, ROTATED, HELD], ids=["plain", "turned", "rotated", "held"])
@pytest.mark.parametrize("set_contact", [False, True])
def test_the_definition_means_what_the_whole_text_means(changes: tuple[str, ...], set_contact: bool) -> None:
    model = mdlgen.lower(mdlgen.load(FOUR, [SMALL, *changes]))
    whole = inside(read(motionview.emit(model, set_contact=set_contact)).values, "")
    text = motionview.emit(model, set_contact=set_contact, only="sheets")
    host = host_of(model, text[text.index("*DefineSystem") :])
    assert lint(host).findings == ()
    for found in (read(text).values, read(host).values):
        system = inside(found, f"sys_{model.name}")
        for kind, records in system.items():
            for name, record in records.items():
                if kind == "members" and name.lstrip(".").startswith("ds_contact_") and not set_contact:
                    assert record["edit"] == "NO_EDIT"  # the script sets it, in a whole text a command
                    continue
                assert record == whole[kind][name.lstrip(".")], (kind, name)
        assert len(system["bushings"]) == len(model.bushings)
        assert len(system["bodies"]) == 6 and len(system["contacts"]) == len(model.pairs) - 4
        sheet_points = {n for n in whole["points"] if n.startswith(("p_note", "p_probe", "p_support_"))}
        assert set(system["points"]) == sheet_points


def test_two_notes_in_one_machine_do_not_meet() -> None:
    texts = [sheets_of(model_of(f"name={name}")) for name in ("one", "two")]
    bare = "\n".join(t[t.index("*DefineSystem") :] for t in texts)
    host = f'*BeginMDL( host, "Host" )\n*StandardInclude(FILE)\n{bare}*EndMDL()\n'
    assert {f.code for f in lint(host).findings} == {"external"}
    assert len(read(host).values["bushings"]) == 2 * 34


GOLDENS = {
    "feed_sheets.mdl": model_of,
    "transport_4x4_2x3_sheets.mdl": lambda: mdlgen.lower(mdlgen.load(FOUR, [SMALL])),
}


@pytest.mark.parametrize("name", sorted(GOLDENS))
def test_golden(name: str) -> None:
    compare(sheets_of(GOLDENS[name]()), SYSTEMS / name)
