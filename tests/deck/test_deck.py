"""The MotionSolve deck: valid, equal to the MotionView text of the same Model, and read back from itself."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree
from places import GOLDEN, REAL

import mdlgen
from mdlgen.backends import motionsolve
from mdlgen.backends.motionsolve.reader.schema import schema
from mdlgen.backends.motionsolve.writer.axes import along
from mdlgen.backends.motionsolve.writer.environment import comment
from mdlgen.cli import app
from mdlgen.errors import MdlgenError, RefusedError, SpecError
from mdlgen.model.tables import Model
from mdlgen.paths import samples, templates
from mdlgen.registry import emitter

# Text and deck come from the same tables by a few operations in another order: some ulp remain.
RELATIVE = 1e-12
# Coordinates are sums that may cancel: their difference counts against the size of the scene [mm].
SIZE = 100.0

SMALL = "sheets.note.boxes=[3,4]"
C2C = "sheets.note.layout=center_to_center"
GENERAL = 'sheets.note.rotation=["20 deg","-35 deg","110 deg"]'
MOVING = (
    'sheets.note.velocity=["1.5 m/s","0 m/s","-0.2 m/s"]',
    'sheets.note.spin=["3 rad/s","-7 rad/s","11 rad/s"]',
)
LONG_SPRINGS = tuple(
    f'rollers.counter_{row}_{side}.press.free_length="30 mm"' for row in (1, 2) for side in ("left", "right")
)
FOUR = "transport_4x4.yaml"
SHORT_SPRING = 'rollers.counter_1_left.press.free_length="0.003 mm"'
CASES: dict[str, tuple[str, ...]] = {
    **{
        path.relative_to(samples()).with_suffix("").as_posix(): (
            path.relative_to(samples()).as_posix(),
            "loads=[]",
        )
        for path in sorted(samples().rglob("*.yaml"))  # a text with loads is refused
    },
    "surface": (FOUR, SMALL, "sheets.note.surface=true"),
    "turned": (FOUR, SMALL, 'sheets.note.turn="10 deg"', 'sheets.note.center=["1 mm","-2 mm","0 mm"]'),
    "general": (FOUR, SMALL, GENERAL, *LONG_SPRINGS),
    "center_to_center": (FOUR, SMALL, C2C),
    "plate": (FOUR, SMALL, "sheets.note.layout=plate"),
    "paper_damping": (FOUR, SMALL, "materials.eur10.damping.rotation=paper"),
    "moving": (FOUR, SMALL, GENERAL, *LONG_SPRINGS, *MOVING),
    "clamp": ("cantilever.yaml", 'sheets.note.clamp.length="12.7 mm"', 'sheets.note.turn="30 deg"'),
    "clamp_moving": ("cantilever.yaml", SMALL, 'sheets.note.clamp.length="31.75 mm"', *MOVING),
    "supports": (
        "cantilever.yaml",
        'supports=[{"sheet":"note","at":["0 mm","0 mm"],"fix":["z"]},'
        '{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
    ),
    "gravity_turned": (FOUR, SMALL, 'gravity=["1 m/s^2","-2 m/s^2","-9.3 m/s^2"]'),
    "weightless": (FOUR, SMALL, 'gravity=["0 m/s^2","0 m/s^2","0 m/s^2"]'),
    "no_friction": (FOUR, SMALL, *(f"contacts.{k}.friction=0" for k in range(3))),
    "static_with_contacts": ("verify/slide.yaml", "run.analysis=static"),
    "profile": (
        FOUR,
        SMALL,
        "rollers.motor_1_left.drive={profile: [[1 ms, -5 rad/s], [3 ms, 90 rad/s], [4 ms, 0 rad/s]]}",
    ),
    "at_once": (FOUR, SMALL, 'rollers.motor_1_left.drive.ramp="0 ms"'),
    "skew_machine": (
        FOUR,
        SMALL,
        "rollers.motor_1_left.axis=[0.95,0.2,0.1]",
        "rollers.counter_1_left.axis=[0.95,0.2,0.1]",
        "rollers.motor_1_right.axis=[0.6,0.8,0]",
        "rollers.counter_1_right.axis=[-0.6,-0.8,0]",
        "rollers.motor_2_left.axis=-x",
        "rollers.counter_2_left.axis=x",
        "rollers.counter_2_right.press.direction=[0.1,0.2,-1]",
        "planes.support.normal=[0.3,-0.2,1]",
    ),
}
LOADS = (
    "cantilever.yaml",
    SMALL,
    'sheets.note.turn="90 deg"',
    'loads=[{"sheet":"note","edge":"y_max","force":["0 N","1 N","2 N"]},'
    '{"sheet":"note","edge":"x_max","moment":["0 N*mm","3 N*mm","0 N*mm"]}]',
)


# Two boxes between a driven roller and a pressed one, and one of all else that there is.
SCENE = {
    "name": "deck_small",
    "materials": {"m": {"E_md": "3 GPa", "E_cd": "1 GPa", "k_tx": "0.1 N*mm/rad", "k_ty": "0.2 N*mm/rad"}},
    "sheets": {
        "note": {
            "material": "m",
            "size": ["20 mm", "20 mm"],
            "thickness": "0.1 mm",
            "mass": "0.1 g",
            "boxes": [2, 2],
            "turn": "30 deg",
            "velocity": ["1 m/s", "0 m/s", "0 m/s"],
            "surface": True,
        }
    },
    "rollers": {
        "low": {
            "center": ["0 mm", "0 mm", "-5.05 mm"], "axis": "y", "radius": "5 mm", "width": "4 mm",
            "mass": "1 g", "drive": {"speed": "100 rad/s", "ramp": "5 ms"},
        },
        "up": {
            "center": ["0 mm", "0 mm", "5.05 mm"], "axis": "y", "radius": "5 mm", "width": "4 mm",
            "mass": "1 g",
            "press": {"direction": "-z", "stiffness": "0.3 N/mm", "preload": "3 N", "free_length": "6 mm"},
        },
    },
    "planes": {
        "table": {"center": ["0 mm", "0 mm", "-10 mm"], "normal": "z", "size": ["50 mm", "50 mm", "2 mm"],
                  "mass": "9 g"},
    },
    "contacts": [
        {"between": ["note", "low"], "stiffness": "300 N/mm^1.5", "friction": 0.5, "smoothing": "1 mm/s"},
        {"between": ["note", "up"], "stiffness": "300 N/mm^1.5", "friction": 0, "smoothing": "1 mm/s"},
    ],
    "loads": [{"sheet": "note", "at": ["9 mm", "0 mm"], "force": ["0 N", "0.5 N", "0 N"]}],
    "supports": [{"sheet": "note", "at": ["-9 mm", "0 mm"], "fix": ["z"]}],
    "probes": {"middle": {"sheet": "note", "at": ["0 mm", "0 mm"]}},
    "run": {"duration": "10 ms"},
}  # fmt: skip


@cache
def model_of(sample: str, *overrides: str) -> Model:
    return mdlgen.lower(mdlgen.load(samples() / sample, list(overrides)))


@cache
def deck_of(name: str) -> str:
    return motionsolve.emit(model_of(*(CASES.get(name) or LOADS)))


@cache
def small_deck() -> str:
    return motionsolve.emit(mdlgen.lower(mdlgen.loads(json.dumps(SCENE))))


@pytest.fixture(scope="module", params=sorted(CASES))
def case(request: pytest.FixtureRequest) -> tuple[Model, str]:
    return model_of(*CASES[request.param]), deck_of(request.param)


# ---------------------------------------------------------------- valid, and the same every time


def test_the_deck_is_valid_and_refers_to_nothing_that_is_missing(case: tuple[Model, str]) -> None:
    assert motionsolve.validate(case[1]) == []


def test_the_same_model_gives_the_same_ascii_text(case: tuple[Model, str]) -> None:
    model, text = case
    assert motionsolve.emit(model) == text == mdlgen.emit(model, "motionsolve")
    assert text.isascii() and "\r" not in text and "\t" not in text
    assert text.endswith("</MultiBodySystem>\n") and text.startswith("<?xml")
    assert not re.search(r"[ ]+$|\n\n\n", text, re.M)
    assert not re.findall(r"\b(?:nan|inf|None|Undefined)\b", text)
    assert str(Path.cwd()) not in text


def test_a_loaded_deck_is_valid() -> None:
    assert motionsolve.validate(deck_of("loads")) == []


def test_the_text_does_not_depend_on_the_hash_seed() -> None:
    code = (
        "import hashlib, mdlgen\nfrom mdlgen.paths import samples\n"
        f"m = mdlgen.lower(mdlgen.load(samples() / {FOUR!r}, [{SMALL!r}]))\n"
        "print(hashlib.sha256(mdlgen.emit(m, 'motionsolve').encode()).hexdigest())"
    )

    def run(seed: str) -> str:
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run(
            [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
        )
        return done.stdout

    assert run("1") == run("2")


# ---------------------------------------------------------------- equal to the text

# Only a MotionView text has these: the word of the statement, what a deck says elsewhere or has no word for.
ONLY_TEXT = {
    "statement",
    "refinement",
    "flips",
    "velocity_frames",
    "velocity_flags",
    "file",
    "scale",
    "moved",
}
# Numbers of contacts that MDL has no certain statement for, and what a file holds that a text names.
ONLY_DECK = {
    *("penalty", "restitution", "normal_trans_vel"),
    *("mu_static", "mu_dynamic", "stiction_velocity", "friction_velocity"),
    *("corners", "triangles"),
}
PLACES = {"origin", "center", "cm", "start", "points", "distance"}
KINDS = (
    *("bodies", "markers", "bushings", "springs", "graphics", "joints", "motions", "contacts"),
    *("surfaces", "outputs"),
)


def flat(value: Any) -> list[Any]:
    """Numbers and words of nested sequences, in order."""
    return [v for item in value for v in flat(item)] if isinstance(value, (list, tuple)) else [value]


def at_times(law: str) -> list[float]:
    """The value of a drive's expression at some times."""
    return [eval(law, {"__builtins__": {}}, {"MAX": max, "TIME": t}) for t in (0.0, 0.001, 0.0047, 1.0)]


def assert_same(mine: Any, theirs: Any, where: str, scale: float = 0.0) -> None:
    found, due = flat(mine), flat(theirs)
    assert len(found) == len(due), where
    if any(isinstance(v, (str, type(None))) for v in due):
        assert found == due, where
    else:
        np.testing.assert_allclose(found, due, rtol=RELATIVE, atol=RELATIVE * scale, err_msg=where)


def test_the_deck_has_the_values_of_the_text(case: tuple[Model, str]) -> None:
    model, deck = case
    text = emitter("motionview").read(mdlgen.emit(model)).values
    found = motionsolve.read(deck).values
    for kind in KINDS:
        assert set(found[kind]) == set(text[kind]), kind
        for name, due in text[kind].items():
            own = found[kind][name]
            assert set(due) - ONLY_TEXT - ONLY_DECK == set(own) - ONLY_DECK, (kind, name)
            for field in set(own) & set(due):
                if field == "value":  # MotionView pastes 186.0 as 186
                    assert_same(at_times(own[field]), at_times(due[field]), f"{name} law")
                    continue
                if field == "curves":
                    assert own[field] == due[field], name
                    continue
                if (kind, field) == (
                    "bushings",
                    "k",
                ):  # a curve of the text is a force of its own in the deck
                    due = {**due, "k": tuple(0.0 if isinstance(v, str) else v for v in due["k"])}
                scale = SIZE if field in PLACES else 1.0 if field in ("axes", "axis") else 0.0
                assert_same(own[field], due[field], f"{kind} {name} {field}", scale)
    assert set(found["curves"]) == set(text["curves"])
    for name, due in text["curves"].items():
        for axis in "xy":
            assert_same(found["curves"][name][axis], list(due[axis]), f"{name} {axis}", max(due[axis]))
    assert set(found["velocities"]) == set(text["velocities"])
    for name, due in text["velocities"].items():
        assert_same(found["velocities"][name], due, f"velocities {name}", SIZE)
    assert not found["forces"]


def test_the_numbers_that_the_text_leaves_to_its_script(case: tuple[Model, str]) -> None:
    model, deck = case
    found, table = motionsolve.read(deck).values, model.contacts
    assert_same(found["gravity"], (model.gravity * 1e6).tolist(), "gravity", 1e-3)
    rims = {r.body: r.rim for r in model.rollers if r.rim is not None}
    rows = {}
    for row, a, b in zip(
        *(c.tolist() for c in (model.pairs.contact, model.pairs.a, model.pairs.b)), strict=True
    ):
        name, rim = f"con_{model.bodies.name[a]}_{model.bodies.name[b]}", rims.get(a) or rims.get(b)
        if rim is None:
            rows[name] = (row, 1.0, 1.0, table.restitution[row])
        for k, sector in enumerate(rim.name if rim is not None else ()):
            assert rim is not None
            bounce = table.restitution[row] if np.isnan(rim.restitution[k]) else rim.restitution[k]
            rows[f"{name}_{sector}"] = (row, rim.friction[k], rim.stiffness[k], bounce)
    assert set(found["contacts"]) == set(rows)
    for name, contact in found["contacts"].items():
        row, rough, stiff, bounce = rows[name]
        due = [table.stiffness[row] * stiff, bounce, table.smoothing[row] * 1000]
        assert_same([contact[k] for k in ("penalty", "restitution", "normal_trans_vel")], due, name)
        friction = ("mu_static", "mu_dynamic", "stiction_velocity", "friction_velocity")
        assert (contact["friction"] == "ON") == all(k in contact for k in friction)
        assert (contact["friction"] == "ON") == bool(table.mu_static[row] > 0 or table.mu_dynamic[row] > 0)
        if contact["friction"] == "ON":
            due = [table.mu_static[row] * rough, table.mu_dynamic[row] * rough]
            due += [table.stiction_velocity[row] * 1000, table.friction_velocity[row] * 1000]
            assert_same([contact[k] for k in friction], due, name)


def test_the_run(case: tuple[Model, str]) -> None:
    model, deck = case
    run = motionsolve.read(deck).values["run"]
    if model.run.analysis == "static":
        assert run == {"analysis": "Static", "end": 0.0, "print": 0.0}
    else:
        assert run["analysis"] == "Transient"
        assert_same([run["end"], run["print"]], [model.run.duration / 1e3, model.run.print_step / 1e3], "run")
    assert ("<Param_Static" in deck) == (model.run.analysis == "static")


def test_the_static_method_can_have_the_contacts() -> None:
    assert 'method              = "MKEAM"' in deck_of("static_with_contacts")
    assert 'method              = "FIM_D"' in deck_of("cantilever")


def test_a_given_step_is_the_largest() -> None:
    deck = motionsolve.emit(model_of(FOUR, SMALL, 'run.step="0.002 ms"'))
    assert 'h_max               = "2e-06"' in deck
    assert 'h_min               = "2e-08"' in deck
    assert motionsolve.validate(deck) == []


def test_loads_stand_on_a_marker_with_global_components() -> None:
    model = model_of(*LOADS)
    forces = motionsolve.read(deck_of("loads")).values["forces"]
    assert len(forces) == len(model.loads.body) == 3 + 4
    for row, load in enumerate(forces.values()):
        body = int(model.loads.body[row])
        assert load["reference"] == "Global_Frame"
        assert load["body"] == f"b_{model.bodies.name[body]}"
        at = model.bodies.position[body] + model.bodies.rotation[body] @ model.loads.local[row]
        assert_same(load["origin"], at.tolist(), "origin", SIZE)
        assert_same(load["force"], model.loads.force[row].tolist(), "force")
        assert_same(load["torque"], model.loads.moment[row].tolist(), "torque")
    # the sheet is turned by 90 deg, so its y is the global -x
    total = np.sum([load["force"] for load in forces.values()], axis=0)
    np.testing.assert_allclose(total, [-1.0, 0.0, 2.0], atol=1e-12)


def test_ids_are_small_and_each_is_one_of_its_kind() -> None:
    root = etree.fromstring(deck_of("surface").encode())
    seen: dict[str, list[int]] = {}
    for element in root.find("Model").iterchildren(etree.Element):
        if element.get("id"):
            seen.setdefault(element.tag, []).append(int(element.get("id")))
    for kind, ids in seen.items():
        assert len(set(ids)) == len(ids), kind
        assert min(ids) == 1 and max(ids) == len(ids), kind


def test_names_stand_before_their_elements() -> None:
    deck = deck_of("transport_4x4")
    for name, tag in (
        ("Global_Frame", "Reference_Marker"),
        ("b_note_0_0", "Body_Rigid"),
        ("b_note_0_0.cm", "Reference_Marker"),
        ("bsh_note_x_0_0_a.i", "Reference_Marker"),
        ("j_motor_1_left.joint_i", "Reference_Marker"),
    ):
        assert re.search(rf"<!-- MODEL\.{re.escape(name)} -->\n  <{tag}\n", deck), name


def test_a_carrier_is_named_in_requests_by_ids_of_markers_that_are_there() -> None:
    outputs = motionsolve.read(deck_of("transport_4x4")).values["outputs"]
    assert outputs["o_counter_1_left"]["expressions"][3] == (
        "WX(b_counter_1_left.cm,Global_Frame,Global_Frame)"
    )


def test_axes_of_joints_follow_the_rule_of_decks() -> None:
    np.testing.assert_array_equal(along(np.array([0.0, 0.0, 1.0])), np.eye(3))
    for z in ((0.0, 0.0, -1.0), (0.0, -1.0, 0.0), (0.6, 0.0, -0.8)):
        axes = along(np.array(z))
        np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-15)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert axes[2, 0] == 0.0


# ---------------------------------------------------------------- what is refused


def test_a_spring_shorter_than_its_compression_is_refused_by_name() -> None:
    model = model_of(FOUR, SMALL, SHORT_SPRING)
    with pytest.raises(RefusedError, match="spring of roller counter_") as error:
        motionsolve.check(model)
    assert error.value.path[0] == "rollers" and error.value.path[2:] == ("press", "free_length")


def test_names_that_would_meet_are_refused() -> None:
    contact = 'contacts=[{"between":["motor_1_left","counter_1_left"],"stiffness":"1 N/mm^1.5","friction":0}]'
    fine = json.loads(
        '{"center":["500 mm","0 mm","0 mm"],"axis":"y","radius":"1 mm","width":"1 mm","mass":"1 g"}'
    )
    twin = f"rollers.counter_1_left_carrier={json.dumps(fine)}"
    with pytest.raises(SpecError, match="would be called"):
        motionsolve.emit(model_of(FOUR, SMALL, contact, twin))


def test_what_is_pasted_is_escaped_and_cannot_end_a_comment() -> None:
    assert "--" not in comment("a --> b")
    from mdlgen.backends.motionsolve.writer.environment import environment

    assert environment().from_string("{{ x }}").render(x='"<&>') == "&#34;&lt;&amp;&gt;"


# ---------------------------------------------------------------- the schema knows reality


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


# ---------------------------------------------------------------- hostile and malformed decks

LAUGHS = (
    '<?xml version="1.0"?>\n<!DOCTYPE x [<!ENTITY a "ha">'
    + "".join(f'<!ENTITY {b} "{f"&{a};" * 20}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True))
    + "]>\n<MultiBodySystem>&i;</MultiBodySystem>"
)
OUTSIDE = '<!DOCTYPE x [<!ENTITY f SYSTEM "file:///etc/passwd">]>\n<MultiBodySystem><Model>&f;</Model></MultiBodySystem>'
HOSTILE = {
    "nothing": "",
    "words": "hello",
    "half": '<?xml version="1.0"?>\n<MultiBodySystem>\n<Model>',
    "another root": "<html/>",
    "no model": "<MultiBodySystem><Command/></MultiBodySystem>",
    "no command": "<MultiBodySystem><Model/></MultiBodySystem>",
    "no run": "<MultiBodySystem><Model/><Command/></MultiBodySystem>",
    "laughs": LAUGHS,
    "outside": OUTSIDE,
    "outside by a parameter": '<!DOCTYPE x SYSTEM "http://127.0.0.1:9/x.dtd">\n<MultiBodySystem/>',
    "entity that is not there": "<MultiBodySystem><Model>&what;</Model></MultiBodySystem>",
    "another encoding": '<?xml version="1.0" encoding="UTF-16"?><MultiBodySystem/>',
    "null": "<MultiBodySystem>\x00</MultiBodySystem>",
    "surrogate": "<MultiBodySystem>\ud800</MultiBodySystem>",
    "deep": "<MultiBodySystem>" + "<Model>" * 100_000,
    "an attribute twice": '<MultiBodySystem a="1" a="2"/>',
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_deck_ends_in_one_line(name: str) -> None:
    with pytest.raises(SpecError) as error:
        _ = motionsolve.read(HOSTILE[name], "bad.xml").values
    assert re.match(r"bad\.xml:\d+: ", str(error.value)), str(error.value)
    assert "\n" not in str(error.value) and "root:" not in str(error.value)
    problems = motionsolve.validate(HOSTILE[name], "bad.xml")
    assert problems and all(re.match(r"bad\.xml:\d+: ", problem) for problem in problems)


ATTRIBUTES = (
    "id mass cg_id pos_x a00 expr kx preload length i_graphics_id penalty cff_type joint_id expr2 comment "
    "ends_type end_time num_marker_row grav_x val_type"
)


@pytest.mark.parametrize("attribute", ATTRIBUTES.split())
@pytest.mark.parametrize(
    "value", ["", "x", "1e999", "nan", "-1", "99999999999999999999", "1_0", "&#10;", "0x10"]
)
def test_a_wrong_attribute_never_ends_in_a_traceback(attribute: str, value: str) -> None:
    text = re.sub(rf'(\n +{attribute} +)= "[^"]*"', rf'\1= "{value}"', small_deck())
    assert text != small_deck()
    try:
        _ = motionsolve.read(text, "bad.xml").values
    except MdlgenError as error:
        assert re.match(r"bad\.xml:\d+: ", str(error))
    for problem in motionsolve.validate(text, "bad.xml"):
        assert re.match(r"bad\.xml:\d+: ", problem)


@pytest.mark.parametrize(
    "attribute", ["cg_id", "body_id", "kx", "type", "joint_id", "penalty", "expr3", "end_time"]
)
def test_a_missing_attribute_never_ends_in_a_traceback(attribute: str) -> None:
    text = re.sub(rf'\n +{attribute} += "[^"]*"', "", small_deck())
    assert text != small_deck()
    assert motionsolve.validate(text)
    if attribute != "end_time":
        with pytest.raises(SpecError, match=rf"<deck>:\d+: .*{attribute} is missing"):
            _ = motionsolve.read(text).values


def test_two_of_a_name_are_refused() -> None:
    text = deck_of("surface").replace("<!-- MODEL.b_note_1_0 -->", "<!-- MODEL.b_note_0_0 -->")
    with pytest.raises(SpecError, match="name is taken"):
        _ = motionsolve.read(text).values


# ---------------------------------------------------------------- the command


def run(*args: object) -> int:
    with pytest.raises(SystemExit) as ended:
        app([str(a) for a in args], prog_name="mdlgen")
    assert isinstance(ended.value.code, int)
    return ended.value.code


def test_the_command(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = samples() / FOUR
    expected = motionsolve.emit(model_of(FOUR, SMALL))
    assert run("deck", spec, "--set", SMALL) == 0
    assert capsys.readouterr() == ("", "wrote transport_4x4.xml\n")
    assert Path("transport_4x4.xml").read_text() == expected
    assert run("deck", spec, "--set", SMALL, "-q", "-o", "a.xml") == 0
    assert capsys.readouterr() == ("", "")
    assert run("deck", spec, "--set", SMALL, "-o", "-") == 0
    assert capsys.readouterr() == (expected, "")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.xml", "transport_4x4.xml"]


def test_the_command_fails_in_one_line(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = samples() / FOUR
    (tmp_path / "folder").mkdir()
    for code, args in (
        (2, (spec, "--set", "sheets.note.mass=1")),
        (2, (spec, "--set", SMALL, "--set", SHORT_SPRING)),
        (3, ("nothing.yaml",)),
        (3, (spec, "--set", SMALL, "-o", "folder")),
        (3, (spec, "--set", SMALL, "-o", "no/such/folder/a.xml")),
    ):
        assert run("deck", *args) == code, args
        out, err = capsys.readouterr()
        assert out == "" and len(err.splitlines()) == 1 and "Traceback" not in err
    assert [p.name for p in tmp_path.rglob("*")] == ["folder"]


def test_the_command_imports_no_solver() -> None:
    script = (
        "import contextlib, io, sys\nfrom mdlgen.cli import main\n"
        f"sys.argv = ['mdlgen', 'deck', {str(samples() / FOUR)!r}, '-o', '-', '-q']\n"
        "with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):\n    main()\n"
        "print('\\n'.join({m.split('.')[0] for m in sys.modules}), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    found = set(done.stderr.split())
    assert "jinja2" in found
    assert not found & {"exudyn", "numba", "scipy", "matplotlib", "h5py", "rich", "lxml"}


# ---------------------------------------------------------------- size


def test_the_time_grows_no_faster_than_the_deck() -> None:
    """Nine times the boxes must not cost 25 times: linear is 9, quadratic 81."""
    from time import process_time

    def seconds(boxes: str) -> float:
        model = model_of("cantilever.yaml", f"sheets.note.boxes={boxes}")
        best = math.inf
        for _ in range(2):
            start = process_time()
            motionsolve.emit(model)
            best = min(best, process_time() - start)
        return best

    assert seconds("[60,60]") < 25 * seconds("[20,20]")


# ---------------------------------------------------------------- a whole deck to look at


def test_golden() -> None:
    text, path = small_deck(), GOLDEN / "deck_small.xml"
    assert motionsolve.validate(text) == []
    if os.environ.get("MDLGEN_ACCEPT"):
        path.write_bytes(text.encode("ascii"))
    expected = path.read_bytes().decode("ascii") if path.exists() else ""
    if text != expected:
        pairs = zip(text.splitlines(), expected.splitlines(), strict=False)
        line, (new, old) = next(((k, p) for k, p in enumerate(pairs, 1) if p[0] != p[1]), (0, ("", "")))
        pytest.fail(
            f"{path.name} differs from the deck, first in line {line}:\n"
            f"  golden: {old[:200]}\n  deck:   {new[:200]}\n"
            "If the new deck is right, accept it with\n"
            "  MDLGEN_ACCEPT=1 python -m pytest tests/deck/test_deck.py -k golden",
            pytrace=False,
        )
