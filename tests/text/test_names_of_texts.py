"""Nothing that is typed as a name becomes a statement."""

from __future__ import annotations

import copy
import json
from collections import Counter
from typing import Any

import pytest
from any_scene import Spec
from any_scene_counts import statement_counts
from hypothesis import given, settings
from hypothesis import strategies as st

from mdlgen.backends.motionview import emit
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

PLAIN: Spec = {
    "name": "plain",
    "materials": {"paper": {"E_md": "1 GPa", "E_cd": "1 GPa", "k_tx": "1 N*mm/rad", "k_ty": "1 N*mm/rad"}},
    "sheets": {
        "note": {
            "material": "paper",
            "size": ["9 mm", "9 mm"],
            "thickness": "0.1 mm",
            "mass": "1 g",
            "boxes": [2, 1],
        }
    },
    "rollers": {
        "roll": {
            "center": ["0 mm", "0 mm", "-3 mm"],
            "axis": "y",
            "radius": "3 mm",
            "width": "3 mm",
            "mass": "1 g",
        }
    },
    "planes": {
        "plate": {
            "center": ["0 mm", "0 mm", "-9 mm"],
            "normal": "z",
            "size": ["9 mm", "9 mm", "1 mm"],
            "mass": "1 g",
        }
    },
    "contacts": [{"between": ["note", "roll"], "stiffness": "1 N/mm^1.5", "friction": 0}],
    "probes": {"lead": {"sheet": "note", "edge": "x_max"}},
    "supports": [{"sheet": "note", "at": ["0 mm", "0 mm"], "fix": ["z"]}],
}
# Where a name stands: as a key of a mapping, or as a value.
KEYS = (
    ("materials", "paper"),
    ("sheets", "note"),
    ("rollers", "roll"),
    ("planes", "plate"),
    ("probes", "lead"),
)
VALUES = (
    ("name",),
    ("sheets", "note", "material"),
    ("contacts", 0, "between", 0),
    ("contacts", 0, "between", 1),
    ("probes", "lead", "sheet"),
    ("supports", 0, "sheet"),
)
HOSTILE = {
    "quote": 'x" )\n  *Include( "evil.mdl" )\n  *Point( p, "',
    "quotes": '"x"',
    "new line": "x\n*EndMDL()",
    "return": "x\r*EndMDL()",
    "statement": "*EndMDL()",
    "comma": "x, y",
    "parenthesis": "x)",
    "backquote": "`x`",
    "brace": "{ds_note.real_L_x.value}",
    "jinja": "<< scene >>",
    "jinja braces": "{{ scene }}",
    "dollar": "$L_x",
    "comment": "// x",
    "letters": "n\u00f6te",
    "wide": "\uff41\uff42",
    "dotless": "\u0131f",
    "direction mark": "x\u202ey",
    "line separator": "x\u2028*EndMDL()",
    "nul": "x\x00",
    "empty": "",
    "blank": " ",
    "digit first": "1x",
    "long": "x" * 10_000,
    "one too long": "x" * 64,
    "reserved": "b_ground",
    "reserved, other case": "Global_Frame",
    "word": "endif",
}


def counts_of(spec: Spec) -> Counter[str]:
    return statement_counts(emit(lower(loads(json.dumps(spec)))))


def with_name(spec: Spec, place: tuple[str | int, ...], name: str) -> Spec:
    """The spec with a name typed at one place: a key of KEYS (and all that refers to it), or a value."""
    if place in KEYS:
        kind, old = place
        spec = json.loads(json.dumps(spec).replace(json.dumps(old), json.dumps(name)))
        assert name in spec[kind]
        return spec
    made: Any = copy.deepcopy(spec)
    holder = made
    for step in place[:-1]:
        holder = holder[step]
    holder[place[-1]] = name
    return made


@pytest.mark.parametrize("place", [*KEYS, *VALUES], ids=lambda p: ".".join(map(str, p)))
def test_hostile_names_are_refused_wherever_a_name_may_stand(place: tuple[str | int, ...]) -> None:
    for kind, name in HOSTILE.items():
        with pytest.raises(SpecError) as caught:
            counts_of(with_name(PLAIN, place, name))
        assert "\n" not in str(caught.value), kind
        assert len(str(caught.value)) < 1000, kind


@pytest.mark.parametrize(("kind", "old"), KEYS[1:])
def test_names_that_differ_in_case_only_are_refused(kind: str, old: str) -> None:
    for _, name in KEYS[1:]:
        spec = copy.deepcopy(PLAIN)
        spec[kind][name.capitalize()] = spec[kind][old]
        with pytest.raises(SpecError, match="used twice"):
            counts_of(spec)


PIECES = st.sampled_from(
    ["x", "note", "_0", "0_0", "_ANCHOR", "contact_", '"', "`", "*", "(", " )", ", ", "\n", "é"]
)


@settings(max_examples=100)
@given(place=st.sampled_from(KEYS), name=st.lists(PIECES, min_size=1, max_size=4).map("".join))
def test_no_name_changes_the_statements(place: tuple[str, str], name: str) -> None:
    """With any name there are the statements that there are with a plain one, or none at all."""
    try:
        found = counts_of(with_name(PLAIN, place, name))
    except SpecError:
        return
    assert found == counts_of(PLAIN)
