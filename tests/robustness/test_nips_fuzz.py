"""Any value in a nip: it is a scene, or lines that say what is wrong."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
from one_nip import ONE

from mdlgen.errors import SpecError
from mdlgen.spec.load import loads

WORDS = st.sampled_from(["3 N", "note", "x", "-z", "*", "1 mm"])


KEYS = "at force lower upper contact radius press name repeat mirror count step across names normal stiffness"


VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(-3, 3), WORDS),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from([*KEYS.split(), "sheet", "mass"]), inner, max_size=4)
    ),
    max_leaves=12,
)


PLACES = ("nips", "defaults.nips", "rollers", "planes", "nips.entry", "nips.entry.upper")


@settings(max_examples=300, deadline=None)
@given(VALUES, st.sampled_from(PLACES))
def test_any_value_is_a_scene_or_lines(value: Any, place: str) -> None:
    try:
        loads(ONE, "s", [f"{place}={json.dumps(value)}"])
    except SpecError as error:
        assert all("\n" not in str(e) for e in (error, *error.others))
