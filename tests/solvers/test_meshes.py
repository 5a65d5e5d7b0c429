"""Meshes in runs, text and deck."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import ran
from asked import as_asked
from mesh_scenes import WEDGE, scene_of, solids_in
from ruamel.yaml import YAML
from solids import ascii_stl, binary, brick, cylinder, flats, obj

import mdlgen
from mdlgen.checks import lints
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load, loads
from mdlgen.verify.verification import verify

PICK = samples() / "pick.yaml"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return solids_in(tmp_path_factory.mktemp("solids"))


def transport(folder, count, meshes=True, boxes=(10, 20)):
    """transport_4x4, its motor rollers as cylinders or as meshes of `count` sides, 4 count triangles."""
    record = YAML(typ="safe").load((samples() / "transport_4x4.yaml").read_text())
    record["sheets"]["note"]["boxes"] = list(boxes)
    if meshes:
        (folder / "roller.stl").write_bytes(binary(*cylinder(7.5, 5.0, count)))
        motors = [name for name in record["rollers"] if name.startswith("motor")]
        record["meshes"] = {
            f"rim_{n}": {
                "file": "roller.stl",
                "center": record["rollers"][n]["center"],
                "on": n,
                "mass": "1e-6 g",
            }
            for n in motors
        }
        (contact,) = [c for c in record["contacts"] if c["between"] == ["note", "motor_*"]]
        contact["between"] = ["note", "rim_*"]
    return lower(loads(json.dumps(record), folder=folder))


def test_a_roller_of_20000_triangles_transports_as_the_cylinder(tmp_path):
    meshed = transport(tmp_path, 5000, boxes=(5, 10))
    assert [len(m.triangles) for m in meshed.meshes] == [20000] * 4
    plain = transport(tmp_path, 0, meshes=False, boxes=(5, 10))
    assert len(meshed.pairs) == len(plain.pairs)
    # meshes are not halved, so the cylinders are not for the comparison; both at one step
    whole = replace(plain, run=replace(plain.run, symmetry=False, step=0.05))
    meshed = replace(meshed, run=replace(meshed.run, step=0.05))
    # by turns, since other work on the machine comes and goes
    runs = [[mdlgen.solve(model, "lattice") for model in (whole, meshed)] for _ in range(2)]
    one, two = (min(both, key=lambda r: r.wall_s) for both in zip(*runs, strict=True))
    assert as_asked(one) and as_asked(two), (one.status, two.status)
    first, second = (r.summary()["sheets"]["note"] for r in (one, two))
    assert second["travel_mm"][0] == pytest.approx(first["travel_mm"][0], rel=0.01)
    assert second["speed_mm_per_s"][0] == pytest.approx(first["speed_mm_per_s"][0], rel=0.01)
    assert two.wall_s < 15 * one.wall_s  # the sweep over a mesh is not bounded yet
    # nips in full grip push alike
    rows = [
        row
        for row, b in enumerate(plain.contacts.part_b)
        if "motor" in b and plain.contacts.part_a[row] == "note"
    ]
    np.testing.assert_allclose(two.statistics.mean_force[rows], one.statistics.mean_force[rows], rtol=0.03)
    # and the meshes have turned with their rollers
    mesh = meshed.meshes[0]
    roller = meshed.rollers[mesh.on]
    turned = 2 * np.arccos(np.clip(abs(two.rotation[:, mesh.body] @ two.rotation[0, mesh.body]), 0, 1))
    angle = roller.turned(two.time)
    wrapped = np.abs((angle + np.pi) % (2 * np.pi) - np.pi)
    np.testing.assert_allclose(turned, wrapped, atol=1e-6)


def test_both_solvers_run_meshes_alike():
    """The sample: a lobe that turns, a ramp that stands; 1 % in where the note is and what pushes it."""
    model = lower(load(PICK))
    one, two = ran.solved(model, "lattice"), ran.solved(lower(load(PICK, ["run.step=0.04 ms"])), "exudyn")
    first, second = one.summary(), two.summary()
    assert second["sheets"]["note"]["travel_mm"][0] == pytest.approx(
        first["sheets"]["note"]["travel_mm"][0], rel=0.01
    )
    assert (
        first["sheets"]["note"]["travel_mm"][0] > 5.0
        and first["meshes"]["ramp"]["contacts"]["note"]["max_force_n"] > 0
    )
    lobe = [r.statistics.mean_force[list(model.contacts.part_b).index("lobe")] for r in (one, two)]
    assert lobe[1] == pytest.approx(lobe[0], rel=0.05)
    body = next(m.body for m in model.meshes if m.name == "lobe")
    np.testing.assert_allclose(
        np.abs((one.rotation[-1, body] * two.rotation[-1, body]).sum()), 1.0, atol=1e-6
    )


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_a_run_ends_where_a_mesh_does_not_hold_a_box(tmp_path, solver):
    (tmp_path / "plate.stl").write_bytes(binary(*brick(60.0, 60.0, 0.8)))
    text = (
        "name: n\nmaterials: {m: {E_md: 1 GPa, E_cd: 1 GPa}}\n"
        "sheets: {s: {material: m, size: [20 mm, 20 mm], thickness: 0.2 mm, mass: 1 g, boxes: [2, 2],\n"
        "             center: [0 mm, 0 mm, 1 mm]}}\n"
        "meshes: {p: {file: plate.stl}}\n"
        "contacts: [{between: [s, p], stiffness: 1e-4 N/mm^1.5, friction: 0}]\n"
        "run: {duration: 30 ms, step: 0.1 ms}\n"
    )
    result = mdlgen.solve(lower(loads(text, folder=tmp_path)), solver)
    assert not as_asked(result) and "into mesh p" in result.status


def test_a_note_rests_on_a_mesh_as_on_a_plane(tmp_path):
    (tmp_path / "plate.stl").write_bytes(binary(*brick(60.0, 60.0, 2.0)))
    text = (
        "name: n\nmaterials: {{m: {{E_md: 1 GPa, E_cd: 1 GPa}}}}\n"
        "sheets: {{s: {{material: m, size: [20 mm, 20 mm], thickness: 0.2 mm, mass: 1 g, boxes: [2, 2],\n"
        "             center: [0 mm, 0 mm, 0.1 mm], velocity: [0.5 m/s, 0 m/s, 0 m/s]}}}}\n{part}\n"
        "contacts: [{{between: [s, p], stiffness: 10 N/mm^1.5, friction: 0.3, smoothing: 5 mm/s}}]\n"
        "run: {{duration: 30 ms, step: 0.05 ms}}\n"
    )
    mesh = "meshes: {p: {file: plate.stl, center: [0 mm, 0 mm, -1 mm]}}"
    plane = "planes: {p: {center: [0 mm, 0 mm, -1 mm], normal: z, size: [60 mm, 60 mm, 2 mm], mass: 1 g}}"
    one, two = (
        mdlgen.solve(lower(loads(text.format(part=p), folder=tmp_path)), "lattice") for p in (mesh, plane)
    )
    assert as_asked(one) and as_asked(two), (one.status, two.status)
    way = two.sheet_motion(0)[0][-1, 0]
    assert way > 10.0 and one.sheet_motion(0)[0][-1, 0] == pytest.approx(way, rel=1e-3)


def test_the_samples_files_are_what_the_tests_make():
    assert (samples() / "meshes/lobe.obj").read_text().split("\n", 1)[1] == obj(*flats(7.5, 12, 96, 6.5))
    assert (samples() / "meshes/ramp.stl").read_text() == ascii_stl(*WEDGE, "ramp")


def test_meshes_are_the_same_in_text_script_deck_and_model(folder):
    scene = scene_of(folder)
    model = lower(scene)
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []
    turned = {p.data_set for p in model.parameters if p.data_set in scene.meshes}
    assert turned == set(scene.meshes) and found.perturbed is not None and found.perturbed.largest <= 1e-12
    assert [str(d) for d in verify(scene, model, only="sheets").all_differences()] == []
    assert not emitter("motionview").read(emitter("motionview").emit(model), "own").notes.findings()
    assert not emitter("motionsolve").validate(emitter("motionsolve").emit(model), "deck")


def test_a_changed_mesh_is_seen_in_text_and_deck(folder, tmp_path):
    scene = scene_of(folder)
    model = lower(scene)
    text, deck = (emitter(name).emit(model) for name in ("motionview", "motionsolve"))
    for old, new in (
        ('"wedge.stl"', '"round.stl"'),
        ("MARKER, m_three", "MARKER, m_one"),
        ("          , 0, 0, 0, 0, 0, 0, ds_three", "          , 0, 0, 1, 0, 0, 0, ds_three"),
        ("ds_two.real_scale, 10.0", "ds_two.real_scale, 1.0"),
        ("gcad_one, false", "gcad_three, false"),
        ("b_one, b_r, p_one_cm", "b_one, B_Ground, p_one_cm"),
    ):
        assert old in text, old
        changed = tmp_path / "changed.mdl"
        changed.write_text(text.replace(old, new, 1))
        assert verify(scene, model, text=changed).all_differences(), new
    corner = next(line for line in deck[deck.index("TriaMesh") :].splitlines()[6:] if line.count(".") == 3)
    changed = tmp_path / "changed.xml"
    changed.write_text(deck.replace(corner, corner.replace(corner.split()[0], "6.0", 1), 1))
    assert verify(scene, model, deck=changed).all_differences()


def test_a_mesh_without_a_contact_is_reported(folder):
    model = lower(scene_of(folder, ('"t*"', "two")))
    assert ("W111", "meshes.three") in {(lint.code, lint.where) for lint in lints(model)}
    # a roller is there for what it turns
    assert [lint.code for lint in lints(lower(load(PICK)))] == []


def test_a_sample_is_copied_with_its_files(tmp_path):
    command = [sys.executable, "-m", "mdlgen", "new", "scene", "--from", "pick"]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=False).returncode == 0
    copied = load(tmp_path / "scene" / "pick.yaml")
    assert copied.meshes["lobe"].solid == load(PICK).meshes["lobe"].solid
