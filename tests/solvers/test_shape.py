"""Sheets that are not flat when nothing acts on them: curl, folds, dog-ears, in solvers and text."""

from __future__ import annotations

import copy
import json

import numpy as np
import pytest
from asked import as_asked
from ruamel.yaml import YAML

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.results.summary import summary
from mdlgen.spec.load import load, loads
from mdlgen.verify.verification import verify

CANTILEVER, TRANSPORT = "samples/cantilever.yaml", "samples/transport_4x4.yaml"
NO_GRAVITY = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
with open(CANTILEVER) as file:
    HELD = YAML(typ="safe").load(file)
FREE = copy.deepcopy(HELD)
del FREE["sheets"]["note"]["clamp"]

SHAPES = {
    "curl along x": "{curl: {radius: 80 mm, along: x}}",
    "curl along y, fold": "{curl: {radius: -80 mm, along: y},"
    " folds: [{along: y, at: 12.7 mm, angle: 40 deg, stiffness: 0.3}]}",
    "two folds": "{folds: [{along: x, at: 6.7 mm, angle: 90 deg}, {along: x, at: -13.4 mm, angle: -60 deg}]}",
    "dog-ears": "{dog_ears: [{corner: [x_max, y_min], size: [20 mm, 25 mm], angle: 60 deg, stiffness: 0.5},"
    " {corner: [x_min, y_max], size: [20 mm, 15 mm], angle: -100 deg}]}",
}


def scene(data: dict, *overrides: str):
    return loads(json.dumps(data), overrides=overrides)


def shaped(data: dict, shape: str, *overrides: str):
    return lower(scene(data, NO_GRAVITY, f"sheets.note.shape={shape}", *overrides))


def test_the_boxes_of_a_curled_sheet_touch_its_circle():
    m = shaped(FREE, "{curl: {radius: 80 mm, along: x}}")
    # middles of chords of one circle, whose centre is on the normal of the sheet's middle
    ring = m.bodies.position[:10]
    step = 6.7 / 80  # angle from box to box
    radius = 6.7 / 2 / np.tan(step / 2)
    middle = np.array([0.0, radius * 1 / np.cos(step / 2)])
    assert np.hypot(ring[:, 0] - middle[0], ring[:, 2] - middle[1]) == pytest.approx(
        np.full(10, radius), rel=1e-12
    )
    assert ring[0, 2] > 0.5  # the edges rise
    angles = np.arctan2(m.bodies.rotation[:10, 2, 0], m.bodies.rotation[:10, 0, 0])
    assert np.diff(angles) == pytest.approx(np.full(9, step), rel=1e-12)


def test_a_fold_turns_one_side_by_its_angle():
    m = shaped(FREE, "{folds: [{along: y, at: 12.7 mm, angle: 40 deg}]}")
    rotation = m.bodies.rotation[:200]
    bent = m.bodies.position[:200] @ np.eye(3)
    normals = rotation[:, :, 2]
    assert np.unique(normals.round(12), axis=0).shape[0] == 2
    assert np.degrees(np.arccos(normals[0] @ normals[-1])) == pytest.approx(40.0, rel=1e-12)
    assert np.all(bent[-10:, 2] > 0) and np.allclose(bent[:10, 2], 0)


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
@pytest.mark.parametrize("name", SHAPES)
def test_a_bent_sheet_alone_keeps_its_shape(solver, name):
    m = shaped(FREE, SHAPES[name], "run.analysis=transient", "run.duration=5 ms")
    result = mdlgen.solve(m, solver)
    assert as_asked(result)
    assert np.abs(result.position - result.position[0]).max() < 1e-9 * 127


@pytest.mark.parametrize(
    "shape",
    [
        "curl: {radius: 80 mm, along: y}",
        "curl: {radius: 300 mm, along: y}, folds: [{along: y, at: 12.7 mm, angle: 40 deg, stiffness: 0.3}]",
    ],
)
def test_a_sheet_that_begins_flat_comes_to_rest_bent(shape):
    flat = mdlgen.solve(shaped(HELD, f"{{start: flat, {shape}}}"), "lattice")
    bent = shaped(HELD, f"{{{shape}}}")
    assert as_asked(flat)
    assert np.abs(flat.position[-1] - bent.bodies.position).max() < 1e-9 * 127


def test_both_solvers_move_a_sheet_that_springs_into_its_curl_alike():
    shape = "{start: flat, curl: {radius: 200 mm, along: y}}"
    m = shaped(HELD, shape, "sheets.note.boxes=[2,6]", "run.analysis=transient", "run.duration=20 ms")
    one, two = mdlgen.solve(m, "lattice"), mdlgen.solve(m, "exudyn")
    moved = np.abs(one.position - one.position[0]).max()
    assert as_asked(one) and as_asked(two)
    assert moved > 2.0
    assert np.abs(one.position - two.position).max() < 0.01 * moved


def test_a_curled_and_tilted_note_runs_through_the_machine():
    overrides = (
        "sheets.note.boxes=[5,10]",
        "sheets.note.turn=5 deg",
        "sheets.note.shape={start: flat, curl: {radius: 200 mm, along: y}}",
        "run.step=0.1 ms",
    )
    result = mdlgen.solve(lower(load(TRANSPORT, overrides)), "lattice")
    assert as_asked(result)
    note = summary(result)["sheets"]["note"]
    assert note["travel_mm"][0] == pytest.approx(66.3, abs=0.5)


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("more", [(), ("sheets.note.rotation=[10 deg, 20 deg, 30 deg]",)], ids=["", "turned"])
def test_the_text_says_the_same(name, more):
    # fewer boxes; folds and ears are where lines are
    few = ("sheets.note.boxes=[10,10]", *more)
    message = scene(FREE, f"sheets.note.shape={SHAPES[name]}", *few)
    found = verify(message, lower(message), perturb=not more)
    assert found.ok, found.all_differences()[:3]


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("edge", ["x_min", "y_max"])
def test_the_text_of_a_sheet_that_begins_flat(axis, edge):
    few = ("sheets.note.boxes=[3,4]", f"sheets.note.clamp.edge={edge}")
    message = scene(HELD, f"sheets.note.shape={{start: flat, curl: {{radius: -90 mm, along: {axis}}}}}", *few)
    found = verify(message, lower(message))
    assert found.ok, found.all_differences()[:3]
    assert "ds_note_shape.real_radius" not in (found.perturbed.shown_only if found.perturbed else ())


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ("{}", "give a curl"),
        ("{curl: {radius: 0 mm, along: x}}", "radius is 0"),
        ("{curl: {radius: 9 mm, along: x}, folds: [{along: y, at: 0 mm, angle: 9 deg}]}", "one direction"),
        (
            "{folds: [{along: y, at: 1 mm, angle: 9 deg}]}",
            "not a line between boxes; the nearest are 0 mm and 6.35",
        ),
        ("{folds: [{along: y, at: 0 mm, angle: 180 deg}]}", "allowed -170 to 170"),
        (
            "{folds: [{along: y, at: 0 mm, angle: 9 deg}, {along: y, at: 0 mm, angle: 9 deg}]}",
            "a fold at 0 mm already",
        ),
        ("{folds: [{along: y, at: -57.15 mm, angle: 9 deg}]}", "is clamped"),
        ("{dog_ears: [{corner: [x_max, y_max], size: [1 mm, 1 mm], angle: 9 deg}]}", "the boxes are larger"),
        ("{dog_ears: [{corner: [x_max, y_max], size: [60 mm, 1 mm], angle: 9 deg}]}", "more than half"),
        ("{dog_ears: [{corner: [x_max, y_min], size: [20 mm, 20 mm], angle: 9 deg}]}", "y_min is clamped"),
        (
            "{start: flat, dog_ears: [{corner: [x_max, y_max], size: [20 mm, 20 mm], angle: 9 deg}]}",
            "begin folded",
        ),
    ],
)
def test_what_is_refused(shape, words):
    with pytest.raises(SpecError, match=words):
        scene(HELD, 'sheets.note.clamp.length="6.35 mm"', f"sheets.note.shape={shape}")


@pytest.mark.parametrize(
    "what", ["probes.mid={sheet: note, at: [%s]}", "supports=[{sheet: note, at: [%s], fix: [x, z]}]"]
)
@pytest.mark.parametrize(
    ("shape", "at"),
    [
        ("{curl: {radius: 90 mm, along: y}}", "0 mm, 0 mm"),
        ("{dog_ears: [{corner: [x_max, y_max], size: [30 mm, 40 mm], angle: 60 deg}]}", "16.75 mm, 50 mm"),
    ],
)
def test_the_text_has_a_point_between_frames_on_each_of_its_boxes(what, shape, at):
    few = ("sheets.note.boxes=[4,4]", f"sheets.note.shape={shape}", what % at)
    message = scene(FREE, *few)
    found = verify(message, lower(message))
    assert found.ok, found.all_differences()[:3]


@pytest.mark.parametrize(
    "shape",
    [
        "{curl: {radius: 18 mm, along: y}}",
        "{folds: [{along: y, at: -31.75 mm, angle: 100 deg}, {along: y, at: 0 mm, angle: 100 deg}]}",
    ],
)
def test_a_sheet_may_turn_by_more_than_half_a_turn_in_all(shape):
    message = scene(FREE, "sheets.note.boxes=[2,20]", f"sheets.note.shape={shape}")
    assert verify(message, lower(message), perturb=False).ok


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("sheets.note.shape={curl: {radius: 1 mm, along: y}}", "joints at y = .* turn by .* take more boxes"),
        ("sheets.note.shape={curl: {radius: 1e-15 mm, along: x}}", "turn by"),
        ("sheets.note.zones={a: {x: [0 mm, 1 mm], y: [0 mm, 1 mm], density: 1e-17}}", "0.001"),
        ("sheets.note.grading.x={near: [0 mm], width: 1e-19 mm, ratio: 3}", "at least"),
    ],
)
def test_what_has_no_meaning_is_refused_in_its_place(override, words):
    with pytest.raises(SpecError, match=words) as caught:
        scene(FREE, override)
    assert caught.value.path[:3] == tuple(override.partition("=")[0].split("."))[:3]


def test_one_box_cannot_be_bent():
    with pytest.raises(SpecError, match="one box along x"):
        scene(FREE, "sheets.note.boxes=[1,4]", "sheets.note.shape={curl: {radius: 90 mm, along: x}}")


@pytest.mark.parametrize(
    ("name", "sets"),
    [
        ("note_cells", "zones={a: {x: [0 mm, 1 mm], y: [0 mm, 1 mm]}}"),
        ("note_zone_a", "zones={a: {x: [0 mm, 1 mm], y: [0 mm, 1 mm]}}"),
        ("note_shape", "shape={curl: {radius: 90 mm, along: y}}"),
        ("note_f1", "shape={curl: {radius: 90 mm, along: y}}"),
        ("note_grid_x", "grading.x=[1,1,1,1,1,1,1,1,1,2]"),
    ],
)
def test_names_that_are_made_do_not_meet_others(name, sets):
    with pytest.raises(SpecError, match="rename one"):
        scene(FREE, f"probes.{name}={{sheet: note, edge: y_max}}", f"sheets.note.{sets}")


def test_strain_is_of_material_and_from_the_shape_without_stress():
    still = "gravity=[0 m/s^2, 0 m/s^2, -1e-3 m/s^2]"
    found = []
    for start in ("bent", "flat"):
        m = lower(
            scene(
                HELD,
                still,
                "sheets.note.boxes=[2,10]",
                f"sheets.note.shape={{start: {start}, curl: {{radius: 150 mm, along: y}}}}",
            )
        )
        found.append(mdlgen.solve(m, "lattice"))
    bent, flat = (summary(result)["sheets"]["note"]["curvature"] for result in found)
    assert bent["max_cd_per_mm"] == pytest.approx(flat["max_cd_per_mm"], rel=0.05)
    joints = found[0].strains.joints
    assert joints.length[joints.axis == 1] == pytest.approx(
        [6.35] * 2 + [12.7] * 18 if joints.a[joints.axis == 1][0] < 0 else [12.7] * 18 + [6.35] * 2, rel=1e-12
    )
    assert np.abs(joints.at).max() < 63.5 + 1e-9
