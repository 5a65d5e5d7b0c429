"""The MotionView text, read back and compared with the Model that a solver runs."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from written import Text, model_of

import mdlgen.backends.motionview as motionview
from mdlgen.model.tables import GROUND, JOINT_X, JOINT_Y, SUPPORT, Model

# Both sides do the same few operations in another order and in units 1000 apart: some ulp remain.
RELATIVE = 1e-12
C2C = "sheets.note.layout=center_to_center"
PLATE = "sheets.note.layout=plate"
SMALL = "sheets.note.boxes=[3,4]"
PLATES = ('materials.eur10.D_cd="0.242 N*mm"', 'materials.eur10.D_md="0.4 N*mm"')
TURN = 'sheets.note.turn="10 deg"'
GENERAL = 'sheets.note.rotation=["20 deg","-35 deg","110 deg"]'
MOVING = (
    'sheets.note.velocity=["1.5 m/s","0 m/s","-0.2 m/s"]',
    'sheets.note.spin=["3 rad/s","-7 rad/s","11 rad/s"]',
)
# a note that stands across the machine lifts the rollers far at the start
LONG_SPRINGS = tuple(
    f'rollers.counter_{row}_{side}.press.free_length="30 mm"' for row in (1, 2) for side in ("left", "right")
)
CASES = {
    "transport": ("transport_4x4.yaml",),
    "transport_c2c": ("transport_4x4.yaml", C2C),
    "tilted": ("transport_tilted.yaml",),
    "4x2": ("transport_4x2.yaml",),
    "paper_grid": ("transport_4x4.yaml", SMALL, "sheets.note.grid=paper"),
    "paper_damping": ("transport_4x4.yaml", SMALL, "materials.eur10.damping.rotation=paper"),
    "paper_damping_c2c": ("transport_4x4.yaml", SMALL, C2C, "materials.eur10.damping.rotation=paper"),
    "plates": ("transport_4x4.yaml", SMALL, *PLATES),
    "twist": ("transport_4x4.yaml", SMALL, C2C, *PLATES, 'materials.eur10.D_twist="0.1 N*mm"'),
    "twist_paper": (
        "transport_4x4.yaml",
        SMALL,
        C2C,
        'materials.eur10.D_twist="0.1 N*mm"',
        "materials.eur10.damping.rotation=paper",
    ),
    "twist_clamp_x": (
        "cantilever.yaml",
        SMALL,
        C2C,
        'materials.eur10.D_twist="0.1 N*mm"',
        "sheets.note.clamp.edge=x_max",
    ),
    "plate": ("transport_4x4.yaml", SMALL, PLATE),
    "plate_given": (
        "cantilever.yaml",
        SMALL,
        PLATE,
        'materials.eur10.D_twist="0.2 N*mm"',
        'materials.eur10.G="700 MPa"',
        "materials.eur10.damping.rotation=paper",
        "sheets.note.clamp.edge=x_max",
        TURN,
    ),
    "soft_cd": ("transport_4x4.yaml", SMALL, 'materials.eur10.E_cd="90000 MPa"'),
    "turned": ("transport_4x4.yaml", SMALL, TURN),
    "general": (
        "transport_4x4.yaml",
        SMALL,
        C2C,
        GENERAL,
        *LONG_SPRINGS,
        'sheets.note.center=["1 mm","-2 mm","3 mm"]',
    ),
    "moving": ("transport_4x4.yaml", SMALL, GENERAL, *LONG_SPRINGS, *MOVING),
    "surface": ("transport_4x4.yaml", SMALL, "sheets.note.surface=true"),
    "cantilever": ("cantilever.yaml",),
    "clamp_length": ("cantilever.yaml", 'sheets.note.clamp.length="12.7 mm"'),
    "clamp_moving": ("cantilever.yaml", SMALL, 'sheets.note.clamp.length="31.75 mm"', *MOVING),
    "supports": (
        "cantilever.yaml",
        TURN,
        'supports=[{"sheet":"note","at":["0 mm","0 mm"],"fix":["z"]},'
        '{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
    ),
    "block": ("verify/slide.yaml",),
    "k_tz_left_out": ("verify/slide.yaml", "sheets.block.boxes=[2,3]", 'materials.solid.k_tx="2 N*mm/rad"'),
    "incline": ("verify/incline.yaml",),
    "skew_machine": (
        "transport_4x4.yaml",
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


@pytest.fixture(scope="module", params=sorted(CASES))
def case(request) -> tuple[Model, Text]:
    sample, *overrides = CASES[request.param]
    model = model_of(sample, *overrides)
    return model, Text(motionview.emit(model))


def close(found, expected, scale: float = 0.0) -> None:
    """Within RELATIVE of the value, or of `scale` where differences of such values are meant."""
    np.testing.assert_allclose(found, expected, rtol=RELATIVE, atol=RELATIVE * scale)


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
    model, text = case
    bodies, table = text.values["bodies"], model.bodies
    carriers = {f"b_{r.name}_carrier" for r in model.rollers if r.press is not None}
    assert set(bodies) == {f"b_{name}" for name in table.name} | carriers
    for k, name in enumerate(table.name):
        body = bodies[f"b_{name}"]
        assert body["label"] == table.label[k]
        close(body["cm"], table.position[k], scale=100.0)
        close(np.transpose(body["axes"]), table.rotation[k], scale=1.0)
        close(body["mass"] * 1000, table.mass[k])
        close(np.array(body["inertia"][:3]) * 1000, table.inertia[k])
        assert body["inertia"][3:] == (0.0, 0.0, 0.0)


def test_bushings_have_the_place_axes_and_values_of_the_model(case):
    model, text = case
    bushes, table = text.values["bushings"], model.bushings
    assert set(bushes) == {f"bsh_{name}" for name in table.name}
    for row, name in enumerate(table.name):
        bush, a = bushes[f"bsh_{name}"], int(table.a[row])
        body_1 = "B_Ground" if a == GROUND else f"b_{model.bodies.name[a]}"
        assert bush["bodies"] == (body_1, f"b_{model.bodies.name[int(table.b[row])]}")
        close(bush["origin"], table.origin[row], scale=100.0)
        close(np.transpose(bush["axes"]), table.axes[row], scale=1.0)
        close((*bush["k"], *bush["kt"]), table.k[row])
        close(np.array([*bush["c"], *bush["ct"]]) * 1000, table.c[row])
        assert bush["force"] == bush["torque"] == (0.0, 0.0, 0.0)


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


def test_initial_velocities(case):
    model, text = case
    table, found = model.bodies, text.values["velocities"]
    moving = {f"b_{n}" for k, n in enumerate(table.name) if table.velocity[k].any() or table.spin[k].any()}
    assert set(found) == moving
    for k, name in enumerate(table.name):
        if f"b_{name}" in moving:
            close(found[f"b_{name}"][:3], table.velocity[k] * 1000, scale=1500.0)
            close(found[f"b_{name}"][3:], table.spin[k] * 1000)
            body = text.values["bodies"][f"b_{name}"]
            assert body["velocity_frames"] == ("Global_Frame", "Global_Frame")
            assert body["velocity_flags"] == ("true",) * 6


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
    factor = {"g": 1e3, "ms": 1e3, "mm/ms": 1e-3, "rad/ms": 1e-3, "rad": math.pi / 180}
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


def test_graphics_of_boxes(case):
    model, text = case
    for k, name in enumerate(model.bodies.name):
        if model.bodies.half[k].any():
            graphic = text.values["graphics"][f"gbox_{name}"]
            assert (graphic["type"], graphic["body"]) == ("BOX", f"b_{name}")
            close(graphic["center"], model.bodies.position[k], scale=100.0)
            close(np.transpose(graphic["axes"]), model.bodies.rotation[k], scale=1.0)
            close(graphic["lengths"], 2 * model.bodies.half[k])


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


def test_probes(case):
    model, text = case
    for probe in model.probes:
        expressions = text.values["outputs"][f"o_{probe.name}"]["expressions"]
        markers = re.findall(r"DX\((\w+),Global_Frame,Global_Frame\)", expressions[0])
        assert len(markers) == len(probe.body)
        for quantity, expression in zip(("DX", "DY", "DZ", "VX", "VY", "VZ"), expressions, strict=True):
            terms = "+".join(f"{quantity}({m},Global_Frame,Global_Frame)" for m in markers)
            assert expression == (f"({terms})/{len(markers)}" if len(markers) > 1 else terms)
        for name, body, local in zip(markers, probe.body, probe.local, strict=True):
            marker = text.values["markers"][name]
            assert marker["body"] == f"b_{model.bodies.name[body]}"
            expected = model.bodies.position[body] + model.bodies.rotation[body] @ local
            close(marker["origin"], expected, scale=100.0)


ARITY = {  # measured over real files or documented: see the MDL reference
    "BeginMDL": 2, "EndMDL": 0, "StandardInclude": 1, "SetCurrentSolverMode": 1, "SetBoolean": 2,
    "DefineDataSet": 1, "Real": 3, "EndDefine": 0, "DataSet": 3, "SetReal": 2,
    "Point": 2, "Vector": 2, "SetVector": 4, "SetPoint": 4, "Marker": 4,
    "Body": 7, "SetBodyInertia": 8, "SetBodyIC": 7, "SetBodyICFlag": 7,
    "Bush": 5, "SetBush": 31, "CoilSpring": 6, "SetCoilSpring": 7, "Contact": 14,
    "RevJoint": 7, "TransJoint": 7, "FixedJoint": 5, "Motion": 5, "SetMotion": 4,
    "Output": 9, "Template": 5, "DefineTemplate": 2, "if": 1, "endif": 0,
}  # fmt: skip


def test_argument_counts(case):
    _, text = case
    for name, args in text.statements:
        if name == "SetOrientation":
            assert len(args) in (7, 11)
        elif name == "Graphic":
            assert len(args) == {"BOX": 15, "CYLINDER": 13}[args[2]]
        elif name == "DeformableSurface":
            assert len(args) == 5 + int(args[3]) * int(args[4])
        else:
            assert len(args) == ARITY[name], name
    assert text.members.keys() <= text.entity.keys()


GLOBALS = {"B_Ground", "V_Global_X", "V_Global_Y", "V_Global_Z", "Global_Frame", "DS_MotionSolve_Simopts"}
REACHED = {"Point", "Marker", "Vector", "DefineDataSet", "DefineTemplate"}  # of no use unless referred to
WORDS = re.compile(r"(?<![\w.])(?:def_)?(?:p|b|m|v|j|bsh|gbox|gcyl|con|mot|cs|ds|tmplt|o|defsur)_\w+")


def test_every_name_used_is_defined_and_every_name_defined_is_used(case):
    _, text = case
    used: Counter[str] = Counter()
    for _, args in text.statements:
        for arg in args[1:] if args and args[0] in text.entity else args:
            if not arg.startswith('"'):
                used.update(re.findall(WORDS, arg))
                used.update(w for w in re.findall(r"\b[A-Z]\w*_\w+", arg) if w in GLOBALS)
    undefined = set(used) - set(text.entity) - GLOBALS
    assert not undefined
    idle = [n for n, (kind, _) in text.entity.items() if kind in REACHED and not used[n]]
    assert not idle
    lowered = Counter(n.lower() for n in text.entity)
    assert max(lowered.values()) == 1
    for target in text.settings("SetReal"):
        data_set, member = target.split(".")
        assert member in text.members[text.entity[data_set][1][1]]
    sets = {n: args[1] for n, args in text.of_kind("DataSet").items()}
    assert {f"{n}.{m}" for n, d in sets.items() for m in text.members[d]} == set(text.settings("SetReal"))


def test_surface_lists_its_markers_row_by_row():
    model = model_of(*CASES["surface"])
    surface = Text(motionview.emit(model)).values["surfaces"]["defsur_note"]
    assert surface["type"] == "NATURAL"
    assert surface["markers"] == tuple(tuple(f"m_note_{i}_{j}" for i in range(3)) for j in range(4))


def test_changing_one_value_moves_the_whole_note():
    """What a user does in MotionView: edit a value of ds_note; the same text must follow."""
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL, TURN))
    for old, new, override in (
        ("real_turn, 10.0 )", "real_turn, -25.0 )", 'sheets.note.turn="-25 deg"'),
        ("real_L_x, 67.0 )", "real_L_x, 80.0 )", 'sheets.note.size=["80 mm","127 mm"]'),
        ("real_k_tx, 0.15 )", "real_k_tx, 0.3 )", 'materials.eur10.k_tx="0.3 N*mm/rad"'),
        ("real_M, 0.00072 )", "real_M, 0.001 )", 'sheets.note.mass="1 g"'),
    ):
        assert text.count(f"ds_note.{old}") == 1
        changed = Text(text.replace(f"ds_note.{old}", f"ds_note.{new}"))
        model = model_of("transport_4x4.yaml", SMALL, *([TURN] if "turn" not in override else []), override)
        test_bodies_have_the_place_axes_mass_and_inertia_of_the_model((model, changed))
        test_bushings_have_the_place_axes_and_values_of_the_model((model, changed))


SUPPORTED = (
    'supports=[{"sheet":"note","at":["0 mm","0 mm"],"fix":["z"]},'
    '{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
    'probes.inside={"sheet":"note","at":["3 mm","-7 mm"]}',
)
TURNED_SCENES = {
    "transport": ("transport_4x4.yaml",),
    "c2c": ("transport_4x4.yaml", SMALL, C2C),
    "moving": ("transport_4x4.yaml", SMALL, *MOVING),
    "surface": ("transport_4x4.yaml", SMALL, "sheets.note.surface=true"),
    "supports": ("cantilever.yaml", *SUPPORTED),
    "clamp": ("cantilever.yaml", SMALL, 'sheets.note.clamp.length="31.75 mm"', *MOVING),
    "block": ("verify/slide.yaml", "sheets.block.boxes=[2,3]"),
}


def follows(text: str, model: Model) -> None:
    """Everything of the text that has a place or axes is where `model` has it."""
    case = model, Text(text)
    test_bodies_have_the_place_axes_mass_and_inertia_of_the_model(case)
    test_bushings_have_the_place_axes_and_values_of_the_model(case)
    test_initial_velocities(case)
    test_graphics_of_boxes(case)
    test_probes(case)


def edited(text: str, value: str, new: float) -> str:
    """`text` with only the number of one value of a data set changed."""
    pattern = rf"(\*SetReal\( {re.escape(value)}, )[-+.e\d]+( \))"
    text, count = re.subn(pattern, lambda m: f"{m[1]}{new!r}{m[2]}", text)
    assert count == 1
    return text


@pytest.mark.parametrize("name", sorted(TURNED_SCENES))
def test_editing_the_turn_turns_the_whole_sheet_and_back(name):
    sample, *overrides = TURNED_SCENES[name]
    sheet = "block" if name == "block" else "note"
    aligned = model_of(sample, *overrides)
    turned = model_of(sample, *overrides, f'sheets.{sheet}.turn="10 deg"')
    assert not np.allclose(aligned.bushings.axes, turned.bushings.axes)
    text, value = motionview.emit(aligned), f"ds_{sheet}.real_turn"
    follows(edited(text, value, 10.0), turned)
    follows(edited(text, value, 0.0), aligned)
    follows(edited(motionview.emit(turned), value, 0.0), aligned)


@pytest.mark.parametrize("edge", ["x_min", "x_max", "y_min", "y_max"])
def test_editing_the_size_moves_what_stands_on_an_edge(edge):
    on_edge = (
        f'supports=[{{"sheet":"note","edge":"{edge}","fix":["z"]}}]',
        f'probes={{"side":{{"sheet":"note","edge":"{edge}"}}}}',
    )
    scene = ("cantilever.yaml", SMALL, TURN, *on_edge)
    resized = model_of(*scene, 'sheets.note.size=["80 mm","95 mm"]')
    text = edited(motionview.emit(model_of(*scene)), "ds_note.real_L_x", 80.0)
    follows(edited(text, "ds_note.real_L_y", 95.0), resized)


@pytest.mark.parametrize("axis", "xyz")
def test_editing_one_of_three_angles_turns_the_whole_sheet_and_back(axis):
    angles = ["20 deg" if a == axis else "0 deg" for a in "xyz"]
    # without springs: a note that stands across the machine lifts the rollers
    scene = ("cantilever.yaml", SMALL, *MOVING, *SUPPORTED)
    aligned = model_of(*scene, 'sheets.note.rotation=["0 deg","0 deg","0 deg"]')
    turned = model_of(*scene, f"sheets.note.rotation={json.dumps(angles)}")
    text, value = motionview.emit(aligned), f"ds_note.real_r_{axis}"
    follows(text, aligned)
    follows(edited(text, value, 20.0), turned)
    follows(edited(motionview.emit(turned), value, 0.0), aligned)


def test_an_aligned_sheet_is_oriented_only_once_it_is_turned():
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL))
    outside = re.sub(r"^  \*if\(.*?^  \*endif\(\)$", "", text, flags=re.M | re.S)
    assert not re.search(r"\*SetOrientation\( (bsh_|b_note)", outside)
    assert text.count("*if( ds_note.real_turn.value != 0 )") == text.count("*if(") == 1
    turned = motionview.emit(model_of("transport_4x4.yaml", SMALL, TURN))
    assert "*if(" not in turned
    assert "inside an if" in text and "inside an if" not in turned


def test_banner_says_that_contacts_belong_to_the_start():
    head, _, _ = motionview.emit(model_of("transport_4x4.yaml", SMALL)).partition("*BeginMDL")
    assert "where they start" in head
    every = motionview.emit(model_of("transport_4x4.yaml", SMALL, "run.prune=false"))
    assert "where they start" not in every.partition("*BeginMDL")[0]


@pytest.mark.parametrize("set_contact", [False, True])
@pytest.mark.parametrize("name", sorted(CASES))
def test_a_value_can_be_edited_exactly_where_the_text_uses_it(name, set_contact):
    sample, *overrides = CASES[name]
    text = Text(motionview.emit(model_of(sample, *overrides), set_contact=set_contact))
    used = set(re.findall(r"\b(ds_\w+\.real_\w+)\.value", text.text))
    for data_set, (_, block) in text.of_kind("DataSet").items():
        for member, (_, edit) in text.members[block].items():
            assert f"{data_set}.{member}" in used or edit == "NO_EDIT", f"{data_set}.{member}"


def test_numbers_read_as_the_user_wrote_them():
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL, TURN))
    for line in (
        "ds_note.real_M, 0.00072 )",
        "ds_note.real_turn, 10.0 )",
        "ds_motor_1_left.real_omega, 186.7 )",
        "ds_motor_1_left.real_ramp, 0.005 )",
        "ds_counter_1_left.real_M, 0.00039 )",
        "ds_run.real_end, 0.05 )",
    ):
        assert line in text


def test_text_is_ascii_with_lf_and_ends_in_one_newline(case):
    written = case[1].text
    assert written.isascii() and "\r" not in written and "\t" not in written
    assert written.endswith("*EndMDL()\n")
    assert not re.search(r"[ ]+$|\n\n\n", written, re.M)
    assert not re.findall(r"\b(?:nan|inf|None|Undefined)\b|\$", written)
    assert str(Path.cwd()) not in written
