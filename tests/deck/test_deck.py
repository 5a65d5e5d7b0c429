"""The MotionSolve deck: valid, equal to the MotionView text of the same Model, and read back from itself."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from decks import CASES, FOUR, LOADS, SMALL, deck_of, flat, model_of
from lxml import etree

import mdlgen
from mdlgen.backends import motionsolve
from mdlgen.backends.motionsolve.writer.axes import along
from mdlgen.model.tables import Model
from mdlgen.registry import emitter
from mdlgen.verify.solver_expressions import law, torques

# Text and deck come from the same tables by a few operations in another order: some ulp remain.
RELATIVE = 1e-12
# Coordinates are sums that may cancel: their difference counts against the size of the scene [mm].
SIZE = 100.0


@pytest.fixture(scope="module", params=sorted(CASES))
def case(request: pytest.FixtureRequest) -> tuple[Model, str]:
    return model_of(*CASES[request.param]), deck_of(request.param)


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
    *("corners", "triangles", "master"),
}
PLACES = {"origin", "center", "cm", "start", "points", "distance"}
KINDS = (
    *("bodies", "markers", "bushings", "springs", "graphics", "joints", "motions", "contacts"),
    *("surfaces", "outputs"),
)


def at_times(expression: str) -> list[float]:
    """The value of a drive's expression at some times."""
    return [law(expression, t) for t in (0.0, 0.001, 0.0047, 0.085, 1.0)]


def at_spins(component: str | float) -> list[float]:
    """The value of a torque's expression at some spins [rad/s], as the run begins."""
    return torques(str(component), [(0.0, w) for w in (-90.0, -0.04, 0.0, 0.07, 30.0)])


def assert_same(mine: Any, theirs: Any, where: str, scale: float = 0.0) -> None:
    found, due = ([pasted(value) for value in flat(values)] for values in (mine, theirs))
    assert len(found) == len(due), where
    if any(isinstance(v, (str, type(None))) for v in due):
        assert found == due, where
    else:
        np.testing.assert_allclose(found, due, rtol=RELATIVE, atol=RELATIVE * scale, err_msg=where)


def pasted(value: Any) -> Any:
    """A value, with 186.0 as 186 where it is a law: so MotionView pastes it."""
    return re.sub(r"(?<=\d)\.0(?!\d)", "", value) if isinstance(value, str) else value


def test_the_deck_has_the_values_of_the_text(case: tuple[Model, str]) -> None:
    model, deck = case
    text = emitter("motionview").read(mdlgen.emit(model)).values
    found = motionsolve.read(deck).values
    unused = {f"{load}.{end}" for load in text["forces"] for end in ("j", "jfloat")}  # on ground, of loads
    for kind in KINDS:
        assert set(found[kind]) == set(text[kind]) - unused, kind
        for name, due in text[kind].items():
            if name in unused:
                continue
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
    assert set(found["forces"]) == set(text["forces"])
    for name, due in text["forces"].items():
        for field in ("origin", "force", "torque"):
            own, other = found["forces"][name][field], due[field]
            if field == "torque" and name.endswith(("_axle", "_clutch")):
                own, other = ([at_spins(v) for v in values] for values in (own, other))
            assert_same(own, other, f"forces {name} {field}", SIZE)


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
    step = (model.run.step or min(0.01, model.run.print_step)) / 1e3
    assert_same([run["h_max"], run["h_min"], run["tol"]], [step, min(1e-6, step / 100), 1e-3], "steps")
    if model.run.analysis == "static":
        assert (run["analysis"], run["end"], run["print"]) == ("Static", 0.0, 0.0)
        assert run["method"] == ("MKEAM" if len(model.pairs) else "FIM_D")
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


def test_a_mesh_is_as_in_an_exported_deck() -> None:
    """Attributes and notes of nine meshes in the deck of a car that MotionView 2022 exported."""
    model, deck = model_of("pick.yaml"), etree.fromstring(motionsolve.emit(model_of("pick.yaml")).encode())
    meshes = deck.findall(".//Post_Graphic[@type='TriaMesh']")
    assert len(meshes) == len(model.meshes) > 0
    named = {"id", "label", "full_label", "type", "ref_marker_id"}
    named |= {"num_point", "num_triangle", "refinement_level", "is_material_inside"}
    for mesh, part in zip(meshes, model.meshes, strict=True):
        assert set(mesh.attrib) == named
        corners, triangles = mesh
        assert (corners.text, triangles.text) == (" Node Position ", " Tria Connectivity ")
        assert len(corners.tail.split()) == 3 * int(mesh.get("num_point")) == part.corners.size
        numbers = [int(number) for number in triangles.tail.split()]
        assert numbers == part.triangles.ravel().tolist() and min(numbers) == 0
