"""Scripts that are hostile, wrong or of another program: one line each, and none is ever run."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from decks import FOUR, SHORT_SPRING, SMALL, model_of
from scripts import script_of, small_script

from mdlgen.backends import msolve
from mdlgen.backends.msolve.reader import standin
from mdlgen.backends.msolve.reader.standin import KNOWN
from mdlgen.errors import RefusedError, SpecError

TOUCH = "open({path!r}, 'w')"


@pytest.mark.parametrize(
    ("overrides", "match"),
    [
        ((SMALL, SHORT_SPRING), "spring of roller counter_"),
        ((SMALL, "contacts.0.rolling_resistance=0.01"), "rolling_resistance"),
        (("sheets.note.boxes=[3,4]", "parts={feed: {external: true, body: b_feed, graphics: [g]}}"), "feed"),
    ],
)
def test_what_a_script_cannot_say_is_refused_by_name(overrides: tuple[str, ...], match: str) -> None:
    with pytest.raises(RefusedError, match=match) as error:
        msolve.check(model_of(FOUR, *overrides))
    assert "MotionSolve script" in str(error.value)


def test_two_sheets_with_too_many_pairs_are_refused_by_name() -> None:
    grids = ("sheets.note_1.boxes=[30,60]", "sheets.note_2.boxes=[30,60]")
    with pytest.raises(RefusedError, match="MotionSolve script: note_1 and note_2"):
        msolve.emit(model_of("feeder.yaml", *grids))


@pytest.mark.parametrize(
    ("where", "what"),
    [
        ("NAME = ", "NAME = {touch} and "),
        ("import csv\n", "import csv\n{touch}\n"),
        ('if __name__ == "__main__":\n', '{touch}\nif __name__ == "__main__":\n'),
        ("def build():\n", "def build():\n    {touch}\n"),
        ('"mass": ', '"mass": {touch} or '),
        ("CONTACTS = [\n", "CONTACTS = [\n    {touch},\n"),
    ],
)
def test_nothing_of_a_file_is_run(where: str, what: str, tmp_path: Path) -> None:
    """Code in a value is no literal; code elsewhere makes another program, and mdlgen's own one is run."""
    trap = tmp_path / "trap"
    text = small_script().replace(where, what.format(touch=TOUCH.format(path=str(trap))), 1)
    assert text != small_script()
    try:
        reading = msolve.read(text, "bad.py")
        assert not reading.same_program
        assert reading.values["bodies"]
    except SpecError as error:
        assert re.match(r"bad\.py:\d+:\d+: (only plain |there is no NAME below its imports)", str(error))
    assert not trap.exists()


HOSTILE = {
    "nothing": "",
    "words": "hello world",
    "another program": "print('hello')\n",
    "null": "NAME = 'a\x00'",
    "surrogate": "NAME = '\ud800'\n",
    "no Python": "NAME = [",
    "deep": "NAME = " + "[" * 100_000,
    "sum": "NAME = " + "+".join(["1"] * 100_000),
    "twice": small_script().replace("GRAVITY = ", "GRAVITY = [0.0]\nGRAVITY = ", 1),
    "no run": re.sub(r"^RUN = .*\n", "", small_script(), flags=re.M),
    "run is a list": re.sub(r"^RUN = .*\n", "RUN = []\n", small_script(), flags=re.M),
    "sheets are a number": re.sub(r"^SHEETS = \{", "SHEETS = 7\nOTHER = {", small_script(), flags=re.M),
    "boxes without end": small_script().replace('"boxes": [2, 2]', '"boxes": [10**9, 2]'),
    "very many boxes": small_script().replace('"boxes": [2, 2]', '"boxes": [9000000000, 2]'),
    "a part that is not there": small_script().replace('("note_0_0", "low")', '("note_9_9", "low")', 1),
    "other bytes": "# coding: utf-7\n" + small_script(),
    "other bytes below a line": "\n#!vim: set fileencoding=rot13\n" + small_script(),
    "values below the program": re.sub(r"^(NAME = .*\n)((.|\n)*)", r"\2\1", small_script(), flags=re.M),
    "values above the imports": small_script().replace("import csv\n", "NAME = 'x'\nimport csv\n"),
    "endless": small_script().replace('"mass": ', '"mass": 1e999, "m": ', 1),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_script_ends_in_one_line(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mdlgen.backends.msolve.reader.Reading.most", 20_000)
    with pytest.raises(SpecError) as error:
        _ = msolve.read(HOSTILE[name], "bad.py").values
    message = str(error.value)
    assert re.match(r"bad\.py:\d+:\d+: ", message) and "\n" not in message and len(message) < 400


VALUES = [
    "''",
    "'x'",
    "None",
    "True",
    "[]",
    "[1.0]",
    "[1.0, 2.0, 3.0, 4.0]",
    "{}",
    "()",
    "-1",
    "10**400",
    "1j",
    "b'x'",
]
KEYS = "center axes boxes pitch mass inertia lengths held columns rows at k kt law pairs penalty drive speed"


@pytest.mark.parametrize("key", KEYS.split())
@pytest.mark.parametrize("value", VALUES)
def test_a_wrong_value_never_ends_in_a_traceback(
    key: str, value: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mdlgen.backends.msolve.reader.Reading.most", 20_000)
    text = re.sub(rf'"{key}": ', f'"{key}": {value}, "old": ', small_script(), count=1)
    assert text != small_script()
    try:
        _ = msolve.read(text, "bad.py").values
    except SpecError as error:
        assert "\n" not in str(error) and str(error).startswith("bad.py:")


def made() -> dict[str, object]:
    names, _ = standin.names(100)
    return names


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("Contact(normal_trans_vel=1.0)", "Contact has no keyword normal_trans_vel"),
        ("Contact(type='POISSON')", "Contact has no coulomb_friction, igeom, jgeom"),
        ("Units(force='NEWTON')", "Units has no length, mass, time"),
        ("Bushing(k=[1.0, 2.0])", r"Bushing.k is \[1.0, 2.0\], not three"),
        ("Bushing(k=[1.0, 2.0, True])", "Bushing.k is .*, not three"),
        ("Part(ip=[1.0, 1.0, 1.0])", "Part.ip is .*, not six"),
        ("Part(mass='1')", "Part.mass is '1', not number"),
        ("Part(mass=float('nan'))", "Part.mass is nan, not number"),
        ("Part(ground=1)", "Part.ground is 1, not yes"),
        ("Marker(part=Part(), qp=(0.0, 0.0, 0.0))", "Marker.qp is .*, not point"),
        ("Marker(qp=Point(0.0, 0.0, 0.0))", "Marker has no part"),
        ("Joint(type='SPHERICAL')", "Joint.type is 'SPHERICAL', not FIXED|REVOLUTE|TRANSLATIONAL"),
        ("Joint(i=Part())", "Joint.i is Part, not Marker"),
        ("Spline(x=[1.0], y=[1.0, 2.0])", "Spline.x is .*, not numbers"),
        ("Box(cm=Marker(part=Part()), x=1.0, y=1.0, z=1.0, refinement_level=3.0)", "refinement_level is 3.0"),
        ("setattr(Part(), 'color', 'red')", "Part has no keyword color"),
        ("Model().simulate(type='MODAL')", "simulate has no type 'MODAL'"),
        ("Model().simulate(type='STATICS', returnResults=True, end=1.0)", "simulate.STATICS. takes"),
        ("Model().simulate(type='TRANSIENT', returnResults=True, end=1.0, dtout='x')", "dtout is 'x'"),
        ("[Part() for _ in range(101)]", "more than 100 objects"),
    ],
)
def test_the_stand_in_allows_only_what_is_in_the_table(call: str, message: str) -> None:
    with pytest.raises(standin.FormError, match=message):
        eval(call, made())


def test_there_is_no_other_class() -> None:
    assert set(made()) == {"Point", *KNOWN}
    with pytest.raises(AttributeError, match="Part has no mass"):
        eval("Part().mass", made())


def test_a_sum_is_left_out_where_its_pairs_are_too_many() -> None:
    """The head says so; the other contacts are recorded."""
    text = script_of("transport_tilted")
    assert "of more than 200 pairs" not in text
    many = msolve.emit(model_of(FOUR, "run.prune=false", "sheets.note.boxes=[15,20]"))
    assert many.count("Not recorded: the force of note on ") == 9
    assert len(msolve.read(many).values["contact outputs"]) == 4
