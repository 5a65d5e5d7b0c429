"""Texts of many scenes, and how close numbers of a text are to those of the Model."""

from __future__ import annotations

import re

import numpy as np
from written import Text, model_of

import mdlgen.backends.motionview as motionview
from mdlgen.model.tables import GROUND, Model

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


def case_of(name: str) -> tuple[Model, Text]:
    sample, *overrides = CASES[name]
    model = model_of(sample, *overrides)
    return model, Text(motionview.emit(model))


def close(found, expected, scale: float = 0.0) -> None:
    """Within RELATIVE of the value, or of `scale` where differences of such values are meant."""
    np.testing.assert_allclose(found, expected, rtol=RELATIVE, atol=RELATIVE * scale)


def bodies_are_those_of_the_model(model: Model, text: Text) -> None:
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


def bushings_are_those_of_the_model(model: Model, text: Text) -> None:
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


def velocities_are_those_of_the_model(model: Model, text: Text) -> None:
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


def boxes_are_those_of_the_model(model: Model, text: Text) -> None:
    for k, name in enumerate(model.bodies.name):
        if model.bodies.half[k].any():
            graphic = text.values["graphics"][f"gbox_{name}"]
            assert (graphic["type"], graphic["body"]) == ("BOX", f"b_{name}")
            close(graphic["center"], model.bodies.position[k], scale=100.0)
            close(np.transpose(graphic["axes"]), model.bodies.rotation[k], scale=1.0)
            close(graphic["lengths"], 2 * model.bodies.half[k])


def probes_are_those_of_the_model(model: Model, text: Text) -> None:
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
