"""Starts and factors over time: what is refused, said and written of them."""

from __future__ import annotations

import json

import numpy as np
import pytest

import mdlgen
from mdlgen.errors import RefusedError, SpecError

SCENE = """
name: starts
materials: {paper: {E_md: 1 GPa, E_cd: 1 GPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets: {note: {material: paper, size: [40 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [4, 2]}}
rollers:
  free: {center: [0 mm, 0 mm, 20 mm], axis: y, radius: 5 mm, width: 5 mm, mass: 4 g}
  held:
    center: [10 mm, 0 mm, 30 mm]
    axis: y
    radius: 5 mm
    width: 5 mm
    mass: 4 g
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 1 N}
  hung:
    center: [60 mm, 0 mm, -20 mm]
    axis: y
    radius: 5 mm
    width: 5 mm
    mass: 4 g
    arm: {pivot: [60 mm, 0 mm, 0 mm], mass: 3 g}
planes:
  plate:
    center: [0 mm, 0 mm, -30 mm]
    normal: z
    size: [50 mm, 50 mm, 2 mm]
    mass: 20 g
    press: {direction: z, stiffness: 0.3 N/mm, preload: 0.2 N}
contacts: {on: {between: [note, held], stiffness: 300 N/mm^1.5, friction: 0.5, smoothing: 1 mm/s}}
loads: [{sheet: note, edge: x_max, force: [1 N, 0 N, 0 N]}]
run: {duration: 10 ms}
"""


def lowered(*sets: str) -> mdlgen.Model:
    return mdlgen.lower(mdlgen.loads(SCENE, list(sets)))


@pytest.mark.parametrize(
    ("sets", "said"),
    [
        (
            ["rollers.free.drive={speed: 20 rad/s}", "rollers.free.spin=10 rad/s"],
            "rollers.free.spin: a roller with a drive begins with the speed of its drive",
        ),
        (["rollers.free.spin=10"], "rollers.free.spin: 10 has no unit"),
        (["rollers.free.spin=10 rad/s", "run.analysis=static"], "free.spin: a static analysis has no speeds"),
        (
            ["planes.plate.press.start=-6 mm"],
            "planes.plate.press.start: -6 mm is beyond the way of the plate",
        ),
        (["loads.0.profile=[[1 ms, 1]]"], "loads.0.profile: 1 corners; allowed 2 to 64"),
        (["loads.0.profile=[[1 ms, 1], [1 ms, 2]]"], "loads.0.profile.1: the time 1 ms is not above"),
        (["gravity_profile=[[0 ms, 1], [1 ms, 2000]]"], "gravity_profile.1.1: 2000 is outside"),
        (["gravity_profile=[[0 ms], [1 ms, 2]]"], "gravity_profile.0: expected [time, factor]"),
    ],
)
def test_what_is_wrong_is_named(sets, said):
    with pytest.raises(SpecError) as error:
        lowered(*sets)
    assert said in str(error.value)


def test_a_nip_is_in_balance_with_gravity_in_full():
    scene = mdlgen.load("samples/transport_nips.yaml", ["gravity_profile=[[0 ms, 1], [1 ms, 0]]"])
    assert mdlgen.lower(scene).changes
    with pytest.raises(SpecError, match=r"gravity_profile.*begin with a factor of 1"):
        mdlgen.load("samples/transport_nips.yaml", ["gravity_profile=[[0 ms, 0.5], [1 ms, 0]]"])


def test_a_press_begins_where_it_is_told_to():
    """From where its spring has its preload, along its direction; its force is that of the spring there."""
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.mechanics.arm import FORCE_0

    for start in (-2.0, 0.0, 0.5):
        model = lowered(f"rollers.held.press.start={start} mm", f"planes.plate.press.start={start} mm")
        roller, plate = model.roller("held"), model.planes[0]
        bodies = build(model).bodies
        assert model.bodies.position[roller.body] == pytest.approx([10.0, 0.0, 30.0 - start])
        assert model.bodies.position[plate.body] == pytest.approx([0.0, 0.0, -30.0 + start])
        assert bodies["press"][roller.body, FORCE_0] == pytest.approx(1.0 - 0.3 * start)
        assert bodies["press"][plate.body, FORCE_0] == pytest.approx(0.2 - 0.3 * start)


def test_an_arm_begins_turned_about_its_pivot():
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.mechanics.arm import FORCE_0

    model = lowered("rollers.hung.arm.start=90 deg", "rollers.hung.arm.stiffness=3 N*mm/rad")
    body = model.roller("hung").body
    # about y a quarter of a turn brings -z to -x
    assert model.bodies.position[body] == pytest.approx([40.0, 0.0, 0.0], abs=1e-12)
    row = build(model).bodies[body]
    assert row["hang"] == pytest.approx([-3.0 * 10.0, 0.0, 0.0], abs=1e-12)
    assert row["press"][FORCE_0] == pytest.approx(-3.0 * np.pi / 2)


def test_a_scene_without_starts_has_the_same_tables():
    """Starts that are those of a scene without change no number."""
    plain, said = lowered(), lowered("rollers.free.spin=0 rad/s", "rollers.hung.arm.start=0 deg")
    assert (plain.bodies.position == said.bodies.position).all()
    assert not plain.changes


@pytest.mark.parametrize(
    ("sets", "code", "where"),
    [
        (["loads.0.profile=[[0 ms, 0], [10 ms, 0]]"], "W183", "loads.0.profile"),
        (["gravity_profile=[[10 ms, 0], [12 ms, 1]]"], "W183", "gravity_profile"),
        (["gravity_profile=[[0 ms, 1], [12 ms, 0]]"], "W184", "gravity_profile"),
        (["rollers.held.press.start=-6 mm"], "W185", "rollers.held.press.start"),
        (["rollers.held.press.start=3 mm"], "W185", "rollers.held.press.start"),
    ],
)
def test_lints(sets, code, where):
    scene = mdlgen.loads(SCENE, sets)
    assert (code, where) in {(lint.code, lint.where) for lint in scene.check()}


@pytest.mark.parametrize(
    "sets",
    [
        [],
        ["loads.0.profile=[[0 ms, 0], [10 ms, 1]]", "gravity_profile=[[0 ms, 1], [10 ms, 0]]"],
        ["rollers.held.press.start=-5.9 mm"],
    ],
)
def test_no_lint_where_nothing_is_odd(sets):
    codes = {lint.code for lint in mdlgen.loads(SCENE, sets).check()}
    assert codes.isdisjoint({"W183", "W184", "W185"})


@pytest.mark.parametrize("backend", ["motionview", "motionsolve", "msolve"])
@pytest.mark.parametrize(
    ("sets", "path"),
    [
        ("gravity_profile=[[0 ms, 1], [1 ms, 0]]", ("gravity_profile",)),
        ("rollers.held.press.start_speed=10 mm/s", ("rollers", "held", "press", "start_speed")),
        ("rollers.hung.arm.start=5 deg", ("rollers", "hung", "arm", "start")),
        ("rollers.hung.arm.start_speed=5 rad/s", ("rollers", "hung", "arm", "start_speed")),
        ("planes.plate.press.start_speed=10 mm/s", ("planes", "plate", "press", "start_speed")),
    ],
)
def test_texts_refuse_by_name(backend, sets, path):
    with pytest.raises(RefusedError) as error:
        mdlgen.emit(lowered(sets), backend)
    assert error.value.path == path


WRITTEN = {
    "press": ["rollers.held.press.start=-2 mm", "planes.plate.press.start=1 mm"],
    "spin": ["rollers.free.spin=10 rad/s", "rollers.held.spin=-3 rad/s"],
    "force": ["loads.0.profile=[[1 ms, 0], [2 ms, 1], [3 ms, -2]]", "sheets.note.turn=20 deg"],
    "moment": [
        "loads=[{sheet: note, edge: x_max, moment: [1 N*mm, 2 N*mm, 0 N*mm], profile: [[0 ms, 1], [3 ms,0]]}]"
    ],
    "stress": ["loads=[{sheet: note, edge: x_max, stress: 1 MPa, profile: [[0 ms, 1], [3 ms, 0]]}]"],
}


@pytest.mark.parametrize("what", WRITTEN)
def test_texts_are_read_back(tmp_path, what):
    """Text, deck and script are compared with the Model, and each value changed."""
    from typer.testing import CliRunner

    from mdlgen.cli import app

    spec = tmp_path / "starts.yaml"
    spec.write_text(SCENE, "utf-8")
    sets = [word for change in WRITTEN[what] for word in ("--set", change)]
    found = CliRunner().invoke(app, ["verify", str(spec), *sets])
    assert found.exit_code == 0, found.output


def test_a_text_says_what_a_user_looks_for():
    text = mdlgen.emit(lowered(*(change for changes in list(WRITTEN.values())[:3] for change in changes)))
    assert "Start along the slide where the scene has it, as written" in text
    assert "*SetBodyIC( b_free, 0, 0, 0, V_Global_Y.x*ds_free.real_spin.value" in text
    assert (
        "EXPR, `({ds_load_0.real_f_x.value})/({ds_note.real_n_y.value})*({ds_load_0.real_c_0.value}+" in text
    )


def test_facts_and_arrows_say_what_changed():
    from mdlgen.model.parts.kinds import kind_of
    from mdlgen.report.arrows import arrows

    model = lowered(
        *("rollers.free.spin=10 rad/s", "rollers.held.press.start=-2 mm", "rollers.hung.arm.start=5 deg"),
        "loads.0.profile=[[0 ms, 0], [10 ms, 1]]",
    )
    facts = [fact for part in model.machine for fact in kind_of(part).facts(model, part)]
    assert "turns freely, at 10 rad/s as the run begins" in facts
    assert "begins -2 mm from where its spring has that force" in facts
    assert "its arm begins turned by 5 deg" in facts
    assert any("times a factor of 0 at 0 ms, 1 at 10 ms" in str(arrow) for arrow in arrows(model))


def test_a_scene_is_written_and_read_again():
    sets = ["gravity_profile=[[0 ms, 1], [2 ms, 50%]]", "loads.0.profile=[[0 ms, 0], [1 ms, 1]]"]
    scene = mdlgen.loads(SCENE, [*sets, "rollers.held.press.start=-2 mm"])
    again = mdlgen.loads(scene.to_yaml())
    assert json.dumps(again.model_dump(mode="json")) == json.dumps(scene.model_dump(mode="json"))
    assert mdlgen.lower(again).gravity_profile.tolist() == [[0.0, 1.0], [2.0, 0.5]]
