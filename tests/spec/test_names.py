"""Nothing that a user types gets past as a name, except a name."""

from __future__ import annotations

import json
import re

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mdlgen.backends.motionview import emit
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.spec.fields import RESERVED
from mdlgen.spec.load import loads

IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")
NASTY = st.text(
    alphabet=st.one_of(st.sampled_from("aZ_0 ,\"'`{}()*<>%$\\\n\r\t\x00;:.#éſKıI-"), st.characters()),
    max_size=70,
)
NAMES = st.from_regex(IDENTIFIER, fullmatch=True).filter(lambda n: n.lower() not in RESERVED)


def scene(name: str = "s", sheet: str = "note", roller: str = "r", plane: str = "p", probe: str = "q") -> str:
    sheet_value = {
        "material": "m",
        "size": ["10 mm", "10 mm"],
        "thickness": "0.1 mm",
        "mass": "1 g",
        "boxes": [1, 1],
    }
    zero = ["0 mm", "0 mm", "0 mm"]
    return json.dumps(
        {
            "name": name,
            "materials": {
                "m": {"E_md": "1 GPa", "E_cd": "1 GPa", "k_tx": "1 N*mm/rad", "k_ty": "1 N*mm/rad"}
            },
            "sheets": {sheet: sheet_value},
            "rollers": {
                roller: {"center": zero, "axis": "y", "radius": "1 mm", "width": "1 mm", "mass": "1 g"}
            },
            "planes": {
                plane: {"center": zero, "normal": "z", "size": ["1 mm", "1 mm", "1 mm"], "mass": "1 g"}
            },
            "probes": {probe: {"sheet": sheet, "edge": "x_max"}},
        }
    )


@pytest.mark.parametrize("place", ["name", "sheet", "roller", "plane", "probe"])
@given(typed=NASTY)
def test_what_loads_is_an_identifier(place: str, typed: str) -> None:
    try:
        found = loads(scene(**{place: typed}))
    except SpecError as error:
        assert "\n" not in str(error)
        return
    assert IDENTIFIER.fullmatch(typed)
    parts = {"name": [found.name], "sheet": found.sheets, "roller": found.rollers, "plane": found.planes}
    assert list(parts.get(place, found.probes)) == [typed]


@given(name=NAMES)
def test_an_identifier_loads(name: str) -> None:
    assume(name.lower() not in ("r", "p", "q"))
    assert list(loads(scene(sheet=name)).sheets) == [name]


@pytest.mark.parametrize("name", sorted(RESERVED))
def test_reserved_names_are_refused_in_any_case(name: str) -> None:
    for typed in (name, name.upper(), name.capitalize()):
        with pytest.raises(SpecError, match="reserves"):
            loads(scene(sheet=typed))


@pytest.mark.parametrize("end", ["\n", " ", "\t", "\u2028", "\x00", "Ａ", "é"])
def test_a_name_is_matched_whole(end: str) -> None:
    with pytest.raises(SpecError):
        loads(scene(sheet="note" + end))


@given(names=st.lists(NAMES, min_size=5, max_size=5, unique_by=str.lower))
@settings(max_examples=20)
def test_names_do_not_change_the_statements(names: list[str]) -> None:
    """Whatever the names are, the text has the statements that it has with plain ones, or none at all."""
    keys = ("name", "sheet", "roller", "plane", "probe")
    try:
        text = emit(lower(loads(scene(**dict(zip(keys, names, strict=True))))))
    except SpecError:  # two names that are made from these meet
        return
    plain = emit(lower(loads(scene())))
    statement = re.compile(r"^ *\*(\w+)", re.M)
    assert sorted(statement.findall(text)) == sorted(statement.findall(plain))
