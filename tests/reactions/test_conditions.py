"""Conditions of rules: what they say, what they compare, and what is wrong with others."""

from __future__ import annotations

import math
import re

import pytest

from mdlgen.conditions import LENGTH, SPEED, TIME, Amount, check, condition
from mdlgen.formulas import NONE

WORDS = {
    "eye.covered": None,
    "eye.clear": None,
    "eye.count": NONE,
    "eye.gap": LENGTH,
    "time": TIME,
    "note.x": LENGTH,
    "note.entered": None,
    "note.left": None,
    "infeed.left": NONE,
}
VALUES = {
    "eye.covered": 1.0,
    "eye.clear": 0.0,
    "eye.count": Amount(3.0, NONE),
    "eye.gap": Amount(math.nan, LENGTH),
    "time": Amount(30.0, TIME),
    "note.x": Amount(12.0, LENGTH),
    "v": Amount(0.5, SPEED),
    "note.entered": 1.0,
    "note.left": 0.0,
    "infeed.left": Amount(2.0, NONE),
}


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("eye covered", True),
        ("covered(eye) and not eye clear", True),
        ("eye clear or count(eye) == 3", True),
        ("count( eye ) != 3", False),
        ("time > 0.02 s", True),
        ("time > 31 ms or note.x < 1 cm", False),
        ("note.x - 2 mm == v*20 ms", True),
        ("gap(eye) < 20 mm", False),  # not known yet
        ("gap(eye) >= 20 mm", False),
        ("count(eye) % 2 == 1 and 31 ms % 30 ms < time", True),
        ("note entered and not note left", True),
        ("left(infeed) == 2 and not left(infeed) > 2", True),
        ("10 mm/(note.x - 12 mm) > 1", False),  # a division by zero
    ],
)
def test_a_condition_says_what_it_says(text: str, holds: bool) -> None:
    found = condition(text)
    check(found, WORDS, {"v": Amount(0.5, SPEED)})
    assert found.holds(VALUES.__getitem__) == holds


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("eie covered", "there is no 'eie'; did you mean 'eye'?"),
        ("eye.counts > 2", "eye has no 'counts'; did you mean 'count'?"),
        ("gap(eye) < 20 ms", "compares mm with s"),
        ("count(eye) % 2 mm == 0", "a remainder needs one unit, not no unit and mm"),
        ("left(infeed)", "is a number, not true or false"),
        ("note lefd", "'note lefd' is not understood; did you mean 'left'? behind a name stands covered"),
        ("eye covered note left", "between two conditions and or or"),
        ("eye", "'eye': eye alone says nothing; write eye covered, or eye clear, or count(eye) > 0"),
        ("time > 3 ms and not infeed", "infeed alone says nothing; write left(infeed) > 0"),
        ("note > 3 mm", "note alone says nothing; write note.x > 5 mm, or note entered, or note left"),
        ("count(eye) > 2 mm", "compares no unit with mm"),
        ("time > 0", "compares s with no unit; write a unit with the number, as 0 s"),
        ("20 < gap(eye)", "as 20 "),
        ("count(eye)", "is a number, not true or false"),
        ("time > 3 ms and gap(eye)", "is a number, not true or false"),
        ("eye covered + 1 > 0", "what is covered is yes or no"),
        ("eye covered and", "is not an expression"),
        ("__import__('os')", "is not"),
        ("speeds > 3", "there is no 'speeds'"),
        ("(" * 60 + "time" + ")" * 60 + " > 1 ms and " * 400, "longer than"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(text: str, says: str) -> None:
    with pytest.raises(ValueError, match=re.escape(says)) as raised:
        check(condition(text), WORDS, {"v": Amount(0.5, SPEED)})
    assert "\n" not in str(raised.value)
