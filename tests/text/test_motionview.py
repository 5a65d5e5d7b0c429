"""The MotionView text, read back and compared with the Model that a solver runs."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from motionview_cases import (
    CASES,
    LONG_SPRINGS,
    bodies_are_those_of_the_model,
    boxes_are_those_of_the_model,
    bushings_are_those_of_the_model,
    case_of,
    close,
    probes_are_those_of_the_model,
    velocities_are_those_of_the_model,
)
from written import Text, model_of

import mdlgen.backends.motionview as motionview
from mdlgen.model.tables import JOINT_X, JOINT_Y, SUPPORT, Model


@pytest.fixture(scope="module", params=sorted(CASES))
def case(request) -> tuple[Model, Text]:
    return case_of(request.param)


def test_a_few_values_by_hand():
    """With no help of the Model: 67 mm x 127 mm in 10 x 20 boxes, turned by 90 deg."""
    found = Text(
        motionview.emit(model_of("transport_4x4.yaml", 'sheets.note.turn="90 deg"', *LONG_SPRINGS))
    ).values
    box, bush = found["bodies"]["b_note_0_0"], found["bushings"]["bsh_note_x_0_0_b"]
    # the box at (-30.15, -60.325) turns to (60.325, -30.15); the corner at (-26.8, -57.15) to (57.15, -26.8)
    assert box["cm"] == pytest.approx((60.325, -30.15, 0.0), abs=1e-9)
    assert bush["origin"] == pytest.approx((57.15, -26.8, 0.0), abs=1e-9)
    assert box["axes"][0] == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)
    assert bush["axes"][1] == pytest.approx((-1.0, 0.0, 0.0), abs=1e-12)
    assert box["mass"] == pytest.approx(0.72e-3 / 200)
    assert box["inertia"][0] == pytest.approx(3.6e-6 * (6.35**2 + 0.1**2) / 12)
    # paper Table 2: k_x = E d_y s / d_x of a pair, half of it in each corner
    assert bush["k"] == pytest.approx((167.3, 58.7, 1673), rel=1e-3)
    assert bush["kt"] == pytest.approx((0.15, 0.185, 5.0))
    assert bush["c"][0] == pytest.approx(0.12 * (2 * 167.28e3 * 3.6e-6) ** 0.5 / 1e3, rel=1e-3)
    assert found["motions"]["mot_motor_1_left"]["value"] == "186.7*(1-MAX(0,1-TIME/0.005))"


def test_bodies_have_the_place_axes_mass_and_inertia_of_the_model(case):
    bodies_are_those_of_the_model(*case)


def test_bushings_have_the_place_axes_and_values_of_the_model(case):
    bushings_are_those_of_the_model(*case)


def test_initial_velocities(case):
    velocities_are_those_of_the_model(*case)


def test_graphics_of_boxes(case):
    boxes_are_those_of_the_model(*case)


def test_probes(case):
    probes_are_those_of_the_model(*case)


def test_bushings_are_linear(case):
    _, text = case
    for args in text.settings("SetBush").values():
        assert args[0:24:2] == ["LIN"] * 12


def test_corners_that_bushings_share_are_one_point(case):
    model, text = case
    points = {args[3] for args in text.of_kind("Bush").values()}
    for k, sheet in enumerate(model.sheets):
        joints = (model.bushings.sheet == k) & (model.bushings.kind != SUPPORT)
        corners = {tuple(node) for node in model.bushings.node[joints].tolist()}
        assert sum(p.startswith(f"p_{sheet.name}_node_") for p in points) == len(corners)


def test_held_bodies_have_a_fixed_joint(case):
    model, text = case
    joints = [j for j in text.values["joints"].values() if j["type"] == "FIXED"]
    held = {f"b_{n}" for k, n in enumerate(model.bodies.name) if model.bodies.fixed[k]}
    assert sorted(j["bodies"] for j in joints) == sorted((body, "B_Ground") for body in held)


def test_no_point_of_a_sheet_is_a_bare_coordinate(case):
    model, text = case
    points = text.settings("SetPoint")
    for name, coordinates in points.items():
        numbers = [e for e in coordinates if not re.search(r"\bds_\w+\.real_\w+\.value", e)]
        assert not numbers, f"{name} has the bare coordinates {numbers}"
    for sheet in model.sheets:
        for box in model.bodies.name[sheet.first : sheet.first + sheet.count]:
            assert all(f", m_{sheet.name} )" in e for e in points[f"p_{box}"])


def test_parameters_stand_in_their_data_sets(case):
    model, text = case
    factor = {"g": 1e3, "ms": 1e3, "mm/ms": 1e-3, "mm/ms^2": 1e-6, "rad/ms": 1e-3, "rad": math.pi / 180}
    given = text.settings("SetReal")
    for p in model.parameters:
        # as a plain number, so that a user can edit it
        close(float(given[f"ds_{p.data_set}.real_{p.member}"][0]) * factor.get(p.unit, 1.0), p.value)
        assert p.member and f"real_{p.member}" in text.members[f"def_ds_{p.data_set}"]


def test_derived_members_are_the_tables_of_the_sheet(case):
    model, text = case
    for k, sheet in enumerate(model.sheets):
        found = text.values["datasets"][f"ds_{sheet.name}"]
        for name, expected in sheet.derived.items():
            if name.endswith("_edge"):
                # no member of its own: the bushings at free edges have a factor before the member for twist,
                # k_tx_twist in the joints along x and k_ty_twist in those along y
                along, axis = (JOINT_X, 0) if name[3] == "x" else (JOINT_Y, 1)
                rows = np.flatnonzero((model.bushings.sheet == k) & (model.bushings.kind == along))
                written = [text.values["bushings"][f"bsh_{model.bushings.name[row]}"] for row in rows]
                most = max(bush["kt" if name[0] == "k" else "ct"][axis] for bush in written)
                close(most * (1000.0 if name[0] == "c" else 1.0), expected)
                continue
            if f"real_{name}" not in found:
                assert name[0] in "kc" and not np.any(model.bushings.sheet == 0)
                continue
            close(found[f"real_{name}"] * (1000.0 if name[0] in "mIc" else 1.0), expected)


def _turning(expression: str, time: float) -> float:
    """Value of a solver expression at a time [s]."""
    return eval(expression, {"__builtins__": {}}, {"MAX": max, "TIME": time})


def test_machine(case):
    model, text = case
    joints, bodies = text.values["joints"], text.values["bodies"]
    for roller in model.rollers:
        name, press = roller.name, roller.press
        on = f"b_{name}_carrier" if press else "B_Ground"
        axle = joints[f"j_{name}"]
        assert (axle["type"], axle["bodies"]) == ("REVOLUTE", (f"b_{name}", on))
        close(axle["axis"], roller.axis, scale=1.0)
        graphic = text.values["graphics"][f"gcyl_{name}"]
        assert (graphic["type"], graphic["body"]) == ("CYLINDER", f"b_{name}")
        close((*graphic["radii"], graphic["length"]), (roller.radius, roller.radius, roller.width))
        close(graphic["axis"], roller.axis, scale=1.0)
        center = roller.center + (press.start * press.direction if press else 0.0)
        close(axle["origin"], center, scale=10.0)
        close(graphic["start"], center - roller.axis * roller.width / 2, scale=100.0)
        if press:
            slide, spring = joints[f"j_{name}_slide"], text.values["springs"][f"cs_{name}"]
            assert (slide["type"], slide["bodies"]) == ("TRANSLATIONAL", (on, "B_Ground"))
            close(slide["axis"], press.direction, scale=1.0)
            close(bodies[on]["mass"] * 1000, press.carrier_mass)
            assert spring["bodies"] == (on, "B_Ground")
            ends = np.subtract(*spring["points"])
            close(ends, (press.start - press.touch + press.free_length) * press.direction, scale=10.0)
            found = [spring["k"], spring["c"] * 1000, spring["force"], spring["length"]]
            close(found, [press.stiffness, press.damping, press.preload, press.free_length])
        if roller.speed is None:
            assert f"mot_{name}" not in text.values["motions"]
        else:
            motion = text.values["motions"][f"mot_{name}"]
            kind = motion["joint"], motion["freedom"], motion["quantity"], motion["type"]
            assert kind == (f"j_{name}", "ROT", "VEL", "EXPR")
            for t in (0.0, 0.3, 1.0, 5.0):
                share = min(1.0, t) if roller.ramp > 0 else 1.0
                found = _turning(motion["value"], t * roller.ramp / 1000)
                close(found, roller.speed * 1000 * share, scale=1.0)


def test_contacts_are_the_pairs_of_the_model(case):
    model, text = case
    found = []
    for contact in text.values["contacts"].values():
        assert (contact["type"], contact["friction"]) == ("POISSON", "ON")
        assert contact["flips"] == ("false", "false")
        for body, graphics in zip(contact["bodies"], contact["graphics"], strict=True):
            assert [text.values["graphics"][g]["body"] for g in graphics] == [body]
        found.append(contact["bodies"])
    names = [f"b_{n}" for n in model.bodies.name]
    pairs = [(names[a], names[b]) for a, b in zip(model.pairs.a, model.pairs.b, strict=True)]
    assert sorted(found) == sorted(pairs)
