"""The script for MotionSolve: run against a stand-in for msolve, equal to the deck of the same Model."""

from __future__ import annotations

import ast
import csv
import math
import re
import runpy
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from decks import SMALL, flat, model_of
from places import ROOT
from scripts import CASES, CLUTCHES, script_of, small_script

import mdlgen
from mdlgen.backends import motionsolve, msolve
from mdlgen.backends.msolve.reader import standin
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import loads

# Script and deck come from the same tables by a few operations in another order: some ulp remain.
RELATIVE = 1e-12
SIZE = 300.0  # coordinates are sums that may cancel: they count against the size of the scene [mm]
PLACES = {"origin", "center", "cm", "start", "points"}
KINDS = (
    "bodies",
    "bushings",
    "springs",
    "graphics",
    "joints",
    "motions",
    "contacts",
    "outputs",
    "forces",
    "curves",
)
# What a deck says elsewhere, or a script has no keyword for.
ONLY_DECK = {"label", "distance", "markers", "normal_trans_vel"}
ONLY_SCRIPT = {"label"}


@pytest.fixture(scope="module", params=sorted(CASES))
def case(request: pytest.FixtureRequest) -> str:
    return request.param


def stand_in(simulate: Any = None) -> tuple[ModuleType, list[standin.Thing]]:
    """A module `msolve` of the stand-in, and what is made with it."""
    names, made = standin.names(1_000_000)
    if simulate is not None:
        names["Model"].simulate = simulate
        names["Model"].generateOutput = lambda self: None
    module = ModuleType("msolve")
    module.__dict__.update(names)
    return module, made


def test_the_script_runs_to_its_simulation(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file itself is run as Python runs it, with the stand-in as `msolve`."""
    module, made = stand_in()
    monkeypatch.setitem(sys.modules, "msolve", module)
    file = tmp_path / "script.py"
    file.write_text(script_of(case))
    with pytest.raises(standin.Simulated) as ended:
        runpy.run_path(str(file), run_name="__main__")
    run = model_of(*CASES[case]).run
    if run.analysis == "static":
        assert ended.value.arguments == {"type": "STATICS", "returnResults": True}
    else:
        assert ended.value.arguments["end"] == pytest.approx(run.duration / 1000, rel=1e-15)
        assert ended.value.arguments["dtout"] == pytest.approx(run.print_step / 1000, rel=1e-15)
    assert len({thing.id for thing in made}) == len(made)
    # the reader makes the same objects without running the file
    read = msolve.read(script_of(case)).made.things
    assert [type(t).__name__ for t in read] == [type(t).__name__ for t in made]


def test_the_same_model_gives_the_same_ascii_text(case: str) -> None:
    model, text = model_of(*CASES[case]), script_of(case)
    assert msolve.emit(model) == text == mdlgen.emit(model, "msolve")
    assert text.isascii() and "\r" not in text and "\t" not in text and text.endswith("\n")
    assert not re.search(r"[ ]+$|\n\n\n\n", text, re.M)
    assert not re.findall(r"\b(?:nan|inf|Undefined)\b", text)
    assert max(map(len, text.splitlines())) <= 120
    ast.parse(text, feature_version=(3, 10))
    assert msolve.read(text).same_program


def test_it_says_what_the_deck_says(case: str) -> None:
    deck = motionsolve.read(motionsolve.emit(model_of(*CASES[case]))).values
    found = msolve.read(script_of(case)).values
    for kind in KINDS:
        # a script lists torques over a spin apart, see verify
        assert set(found[kind]) == set(deck[kind]) - set(found["clutches"]), kind
        for name, own in found[kind].items():
            due = deck[kind][name]
            assert set(due) - ONLY_DECK == set(own) - ONLY_SCRIPT, (kind, name)
            for field in set(own) & set(due) - {"label"}:
                scale = SIZE if field in PLACES else 1.0 if field in ("axes", "axis", "torque") else 0.0
                one, other = _plain(own[field]), _plain(due[field])
                if isinstance(one, list) and not any(isinstance(v, (str, type(None))) for v in other):
                    np.testing.assert_allclose(
                        one, other, rtol=RELATIVE, atol=RELATIVE * scale, err_msg=f"{kind} {name} {field}"
                    )
                else:
                    assert one == other, (kind, name, field)
    recorded = "contact outputs"
    assert [*found[recorded]] == [*deck[recorded]]
    for name, components in found[recorded].items():
        assert [sorted(terms) for terms in components] == [sorted(terms) for terms in deck[recorded][name]]
    assert set(found["velocities"]) == set(deck["velocities"])
    for name, own in found["velocities"].items():
        np.testing.assert_allclose(own, deck["velocities"][name], rtol=RELATIVE, atol=1e-9)
    assert found["gravity"] == deck["gravity"] and found["standard"] == deck["standard"]
    static = found["run"]["analysis"] == "Static"
    assert found["run"] == {k: v for k, v in deck["run"].items() if not static or k in found["run"]}


def _plain(value: Any) -> Any:
    """Numbers as a list; of curves, which the script has as `1*` where a deck has no factor, without it."""
    if isinstance(value, dict):
        return {key: _plain(v) for key, v in value.items()}
    if isinstance(value, str):
        return value.removeprefix("1*")
    return flat(value)


@pytest.mark.parametrize("speed", [0.0, 10.0, -30.0])
def test_clutches_have_their_torque(speed: float) -> None:
    """2 T s^2 / (1 + s) of the relative speed s against the free sense, over the creep."""
    model = model_of(*CLUTCHES)
    found = msolve.read(msolve.emit(model)).values["clutches"]
    assert set(found) == {"frc_counter_1_left_clutch", "frc_motor_1_left_clutch"}
    for roller in (r for r in model.rollers if r.one_way is not None):
        way = roller.one_way
        record = found[f"frc_{roller.name}_clutch"]
        on = f"b_{roller.name}_carrier" if roller.press is not None else "B_Ground"
        assert record["ends"] == (f"b_{roller.name}", f"j_{roller.name}.i", f"j_{roller.name}.j")
        assert (*record["force"], *record["torque"][:2]) == ("0",) * 5
        text = record["torque"][2]
        relative = f"WZ(j_{roller.name}.i,j_{roller.name}.j,j_{roller.name}.j)"
        assert relative in text and on in ("B_Ground", f"b_{roller.name}_carrier")
        for time in (0.0, 0.002, 1.0):
            value = eval(
                text.replace(relative, "W"), {"__builtins__": {}}, {"MAX": max, "TIME": time, "W": speed}
            )
            shaft = (
                float(roller.prescribed(np.array(time * 1000))) * 1000 if roller.speed is not None else 0.0
            )
            s = max(0.0, way.direction * (shaft - speed) / (way.creep * 1000))
            due = 2 * way.direction * way.torque * s * s / (1 + s)
            assert math.isclose(value, due, rel_tol=1e-12, abs_tol=1e-15)


def test_what_is_recorded_is_written_as_csv(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Time, then the six components of each request: those that the solver keeps as f2 to f4 and f6 to f8."""

    class Results:
        def getObject(self, request: standin.Thing) -> Any:
            number = request.id
            return SimpleNamespace(times=(0.0, 0.5), getComponent=lambda k: (number + k / 10, -1.0))

    module, made = stand_in(lambda self, **given: Results())
    monkeypatch.setitem(sys.modules, "msolve", module)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "script.py").write_text(small_script())
    runpy.run_path("script.py", run_name="__main__")
    with open("deck_small_requests.csv", newline="") as file:
        head, *rows = csv.reader(file)
    requests = [thing for thing in made if type(thing).__name__ == "Request"]
    names = ["o_low", "o_up", "o_middle", "o_note_on_low", "o_note_on_up"]
    assert [thing.label for thing in requests] == names
    assert head == ["time", *(f"{name}.f{k}" for name in names for k in (2, 3, 4, 6, 7, 8))]
    assert [row[0] for row in rows] == ["0.0", "0.5"]
    numbers = [float(v) for v in rows[0][1:]]
    assert numbers == [thing.id + k / 10 for thing in requests for k in (1, 2, 3, 5, 6, 7)]


def test_a_value_that_is_changed_is_changed_in_all_that_follows() -> None:
    """The script is made of its values: a pitch moves all boxes, a stiffness all bushings of its kind."""
    model = model_of("transport_4x4.yaml", SMALL)
    text = msolve.emit(model)
    before = msolve.read(text).values
    pitch = f'"pitch": [{model.sheets[0].d_x!r}, {model.sheets[0].d_y!r}]'
    assert text.count(pitch) == 1
    wide = f'"pitch": [{2 * model.sheets[0].d_x!r}, {model.sheets[0].d_y!r}]'
    after = msolve.read(text.replace(pitch, wide)).values
    for name, record in after["bodies"].items():
        if name.startswith("b_note_"):
            x, y, z = before["bodies"][name]["cm"]
            np.testing.assert_allclose(record["cm"], (2 * x, y, z), rtol=1e-15)


def test_the_forms_are_those_of_the_reference() -> None:
    """Every class and keyword that is in use has a row in the manual, with its confidence."""
    page = (ROOT / "docs" / "motionview" / "script.md").read_text().partition("## Classes")[2]
    from mdlgen.backends.msolve.reader.standin import KNOWN

    rows = dict(re.findall(r"^\| `(\w+)` \| (.*) \|$", page, re.M))
    assert set(rows) == set(KNOWN)
    for name, form in KNOWN.items():
        seen, documented, source = rows[name].split(" | ")
        for column, confidence in ((seen, "SEEN"), (documented, "DOC")):
            own = {k for k, v in form.keywords.items() if v.confidence == confidence}
            assert set(re.findall(r"`(\w+)`", column)) == own, name
        assert form.page in source, name
    gates = loads((ROOT / "tests" / "cases" / "stops.yaml").read_text(), "stops", folder=samples())
    texts = [*map(script_of, CASES), msolve.emit(model_of(*CLUTCHES)), msolve.emit(lower(gates))]
    used = {
        (type(thing).__name__, k)
        for text in texts
        for thing in msolve.read(text).made.things
        for k in thing.given
    }
    known = {(name, keyword) for name, form in KNOWN.items() for keyword in form.keywords}
    assert used == known, "a form or a keyword that no script uses"


def test_names_that_would_meet_are_refused() -> None:
    fine = "{center: [500 mm, 0 mm, 0 mm], axis: y, radius: 1 mm, width: 1 mm, mass: 1 g}"
    contact = "contacts=[{between: [motor_1_left, counter_1_left], stiffness: 1 N/mm^1.5, friction: 0}]"
    with pytest.raises(SpecError, match="would be called"):
        emitter("msolve").emit(
            model_of("transport_4x4.yaml", SMALL, contact, f"rollers.counter_1_left_carrier={fine}")
        )
