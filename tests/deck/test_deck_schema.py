"""The schema of decks against those that MotionView exported, and faults with their line."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from decks import deck_of, flat
from lxml import etree
from places import REAL

from mdlgen.backends import motionsolve
from mdlgen.backends.motionsolve.reader.schema import schema
from mdlgen.paths import templates
from mdlgen.registry import emitter


def shared(path: Path) -> etree._Element:
    """A real deck without the elements that ours never has."""
    known = set(re.findall(r'<element name="(\w+)"', (templates() / "motionsolve" / "deck.rng").read_text()))
    root = etree.fromstring(path.read_bytes())
    for section in root.iterchildren("Model", "Command"):
        for element in list(section):
            ours = isinstance(element.tag, str) and element.tag in known
            # a command that changes an element gives only what is new
            if not ours or (section.tag == "Command" and element.tag == "Motion_Joint"):
                section.remove(element)
    return root


real = pytest.mark.skipif(not REAL.is_dir(), reason="the real deck is not here")


@real
def test_the_schema_accepts_what_motionview_exported() -> None:
    root = shared(REAL / "tire_test_rig.xml")
    kinds = {element.tag for element in root.find("Model")}
    assert {"Reference_Marker", "Body_Rigid", "Constraint_Joint", "Motion_Joint", "Post_Graphic"} <= kinds
    checker = schema()
    assert checker.validate(root), checker.error_log


@real
def test_every_attribute_of_ours_is_one_that_motionview_exported() -> None:
    """For the elements that the real deck has; what it has not is named in the head of a deck."""
    wanted: dict[tuple[str, str], set[str]] = {}
    for element in etree.fromstring((REAL / "tire_test_rig.xml").read_bytes()).iter(etree.Element):
        wanted.setdefault((element.tag, element.get("type", "")), set()).update(element.attrib)
    ours = etree.fromstring(deck_of("transport_4x4").encode())
    for element in ours.iter(etree.Element):
        known = wanted.get((element.tag, element.get("type", "")))
        if known is not None:
            assert set(element.attrib) <= known, element.tag


@real
def test_the_reader_reads_the_deck_that_motionview_exported() -> None:
    """And finds there what the reader of MDL finds in the text that it was exported from (8 digits)."""
    file = REAL / "tire_test_rig.xml"
    found = motionsolve.read(file.read_text("utf-8"), file.name).values
    text = emitter("motionview").read((REAL / "tire_test_rig.mdl").read_text("utf-8", "replace")).values
    checked = 0
    for kind in ("bodies", "markers", "graphics", "joints"):
        for name in set(found[kind]) & set(text[kind]):
            own, due = found[kind][name], text[kind][name]
            for field in set(own) & set(due) - {"label", "value"}:
                mine, theirs = flat(own[field]), flat(due[field])
                if any(isinstance(v, (str, type(None))) for v in theirs):
                    assert mine == theirs, (kind, name, field)
                else:
                    np.testing.assert_allclose(mine, theirs, rtol=5e-7, atol=5e-7, err_msg=f"{name} {field}")
                checked += 1
    assert checked > 150


# What is put in the place of a pattern's first match, and a word of the problem that must be reported.
BROKEN = {
    "a marker less": (r'(i_marker_id +)= "\d+"', r'\1= "999999"', "999999"),
    "a graphic less": (r'(i_graphics_id +)= "\d+"', r'\1= "999999"', "Post_Graphic 999999"),
    "an expression of nothing": (r"DX\(\d+,", "DX(999999,", "Reference_Marker 999999"),
    "a contact less": (r"CONTACT\(\d+,", "CONTACT(999999,", "Force_Contact 999999"),
    "the frame of a contact less": (r"(CONTACT\(\d+,\d,\d),1\)", r"\1,999999)", "Reference_Marker 999999"),
    "an id twice": (r'( id +)= "2"', r'\1= "1"', "twice"),
    "another body's centre": (r'(cg_id +)= "\d+"', r'\1= "1"', "another body"),
    "a count that is wrong": (r'(num_i_graphics +)= "1"', r'\1= "2"', "num_i_graphics"),
    "a surface too small": (r'(num_marker_row +)= "\d+"', r'\1= "9"', "not 9 x"),
    "no number": (r'(mass +)= "[^"]+"', r'\1= "nan"', "Body_Rigid"),
    "a negative mass": (r'(mass +)= "', r'\1= "-', "Body_Rigid"),
    "an attribute less": (r" +penalty +=.*\n", "", "Force_Contact"),
    "an attribute more": (r"(\n +penalty )", r'\n exponent="2"\1', "Force_Contact"),
    "friction without being on": ("COULOMB_ON", "COULOMB_OFF", "Force_Contact"),
    "an element more": ("<Model>", "<Model><Force_Magic/>", "Force_Magic"),
    "other units": ("MILLIMETER", "METER", "Param_Unit"),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_a_fault_is_found_with_its_line(fault: str) -> None:
    pattern, new, word = BROKEN[fault]
    text = deck_of("surface")
    broken = re.sub(pattern, new, text, count=1)
    assert broken != text
    problems = motionsolve.validate(broken, "bad.xml")
    assert problems and any(word in problem for problem in problems), problems
    for problem in problems:
        assert re.match(r"bad\.xml:\d+: ", problem)
        assert "\n" not in problem


def test_the_line_is_that_of_the_element_far_down() -> None:
    text = deck_of("transport_4x4")
    at = text.rindex("<Post_Graphic")
    broken = text[:at] + "<Post_Graphik" + text[at + len("<Post_Graphic") :]
    (line, *_) = (int(p.split(":")[1]) for p in motionsolve.validate(broken) if "Graphik" in p)
    assert 0 <= line - text.count("\n", 0, at) <= 20
