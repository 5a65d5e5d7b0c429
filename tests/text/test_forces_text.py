"""Forces of contacts that a text records where it is asked to."""

from __future__ import annotations

from pathlib import Path

import pytest
from places import RICH
from verified import SMALL, check

from mdlgen.altair import recorded
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load

LONGEST = 528  # characters of a line that MotionView saved
TRANSPORT = samples() / "transport_4x4.yaml"


def written(spec: Path, *sets: str, **options: object) -> str:
    return emitter("motionview").emit(lower(load(spec, [*sets])), **{"forces": True, **options})


@pytest.mark.parametrize(
    ("spec", "sets"),
    [
        (RICH, ()),
        (TRANSPORT, ("sheets.note.boxes=[4,5]",)),
        (samples() / "retard_pad.yaml", ()),  # rims and planes: sides of statements change places
    ],
    ids=lambda v: getattr(v, "stem", ""),
)
def test_the_text_records_what_the_deck_does(spec: Path, sets: tuple[str, ...], tmp_path: Path) -> None:
    file = tmp_path / "note.mdl"
    file.write_text(written(spec, *sets))
    found = check(spec, [*sets], text=file, perturb=False)
    assert [str(d) for d in found.all_differences()] == []
    text, deck = (found.kinds[kind]["contact outputs"] for kind in ("text", "deck"))
    assert text.entities == deck.entities > 0


def test_without_the_option_none_is_recorded() -> None:
    assert "CONTACT(" not in written(TRANSPORT, *SMALL, forces=False)
    found = check(TRANSPORT, SMALL, perturb=False)
    assert "contact outputs" not in found.kinds["text"]


def test_long_sums_are_split_over_lines_that_were_seen() -> None:
    text = written(TRANSPORT)
    sums = [line for line in text.splitlines() if "CONTACT(" in line]
    assert "(7 of 7)" in text and max(map(len, sums)) <= LONGEST
    assert text.count("CONTACT({con_note_4_7_motor_1_left.idstring}") == 6


def test_the_head_names_what_is_not_known() -> None:
    head, _, _ = written(TRANSPORT, *SMALL).partition("*BeginMDL")
    assert "with --forces in outputs" in head and "sums of CONTACT" in head
    plain, _, _ = written(TRANSPORT, *SMALL, forces=False).partition("*BeginMDL")
    assert "sums of CONTACT" not in plain


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("motor_1_left.idstring},1,2,", "motor_1_left.idstring},0,2,"),
        ("motor_1_left.idstring},1,2,", "motor_1_left.idstring},1,3,"),
        ("_motor_1_left.idstring},1", "_motor_1_right.idstring},1"),
        ("1,2,{Global_Frame.idstring})", "1,2,{b_motor_1_left.cm.idstring})"),
        ("`CONTACT({con_note_", "`-CONTACT({con_note_"),
        ("o_note_on_motor_1_left, ", "o_note_on_motor_1_left_part2, "),
    ],
)
def test_a_slip_is_found(old: str, new: str, tmp_path: Path) -> None:
    text = written(TRANSPORT, *SMALL)
    assert old in text
    file = tmp_path / "note.mdl"
    file.write_text(text.replace(old, new, 1))
    assert check(TRANSPORT, SMALL, text=file, perturb=False).all_differences()


def test_a_request_that_is_left_out_is_found(tmp_path: Path) -> None:
    text = written(TRANSPORT, *SMALL)
    begin = text.index("  *Output( o_note_on_motor_2_left,")
    end = text.index(" )\n", begin)
    file = tmp_path / "note.mdl"
    file.write_text(text[:begin] + text[end + 3 :])
    found = check(TRANSPORT, SMALL, text=file, perturb=False)
    assert any("o_note_on_motor_2_left" in str(d) for d in found.all_differences())


def test_the_sheets_alone_have_no_such_requests() -> None:
    with pytest.raises(SpecError, match="whole text"):
        written(TRANSPORT, *SMALL, only="sheets")


def test_parts_are_of_the_whole() -> None:
    assert recorded.whole(recorded.part_of("Contact of a on b", 2, 3)) == ("Contact of a on b", 2, 3)
    assert recorded.part_of("Contact of a on b", 1, 1) == "Contact of a on b"
    assert recorded.whole("Contact of a on b") is None
