"""report.html and what it is made from: the saved result, shapes, colours, curves, hostile text."""

from __future__ import annotations

import hashlib
import io
import re
from base64 import b64decode
from pathlib import Path

import h5py
import numpy as np
import pytest
from embedded import embedded
from places import RICH
from ran import ran
from scipy.spatial.transform import Rotation
from synthetic import moving, small_model

import mdlgen
from mdlgen.errors import OutputError
from mdlgen.model.tables import BOX_CYLINDER
from mdlgen.paths import samples, templates
from mdlgen.report import boxes
from mdlgen.report.animation import FRAMES, MOST, frames
from mdlgen.report.html.page import page
from mdlgen.report.meshes import machine
from mdlgen.report.motion import names, poses
from mdlgen.results.io import store, tree
from mdlgen.results.result import Result
from mdlgen.results.strain import histories

THIRD = templates() / "report" / "third_party"


def numbers(packed: str, kind: str) -> np.ndarray:
    return np.frombuffer(b64decode(packed), kind)


def test_third_parties_are_as_their_packages_have_them() -> None:
    rows = re.findall(r"^\| (\S+) \| ([0-9a-f]{64}) \|$", (THIRD / "README.md").read_text("utf-8"), re.M)
    assert {name for name, _ in rows} == {p.name for p in THIRD.iterdir()} - {"README.md"}
    for name, message in rows:
        assert hashlib.sha256((THIRD / name).read_bytes()).hexdigest() == message, name


class TestSaved:
    def test_a_result_reads_back_whole(self, result: Result, text: str, tmp_path: Path) -> None:
        result.save(tmp_path)
        again = Result.load(tmp_path)
        assert again.summary() == result.summary()
        assert store.hdf5(again) == store.hdf5(result)
        assert page([again]) == text

    def test_every_kind_of_table_reads_back(self, tmp_path: Path) -> None:
        for sample in ("channel", "verify/tension"):
            result = ran(sample)
            result.save(tmp_path / sample)
            assert store.hdf5(Result.load(tmp_path / sample)) == store.hdf5(result)

    @pytest.mark.parametrize("path", [*sorted(samples().rglob("*.yaml")), RICH], ids=lambda p: p.stem)
    def test_the_model_of_every_sample_reads_back(self, path: Path) -> None:
        model = mdlgen.lower(mdlgen.load(path))
        streams = io.BytesIO(), io.BytesIO()
        with h5py.File(streams[0], "w") as file:
            tree.put(file, {"model": model})
        with h5py.File(streams[0], "r") as file:
            again = tree.take(file)["model"]
        with h5py.File(streams[1], "w") as file:
            tree.put(file, {"model": again})
        assert type(again) is type(model) and repr(again) == repr(model)
        assert streams[0].getvalue() == streams[1].getvalue()

    def test_what_is_no_result_ends_in_one_line(self, result: Result, tmp_path: Path) -> None:
        with pytest.raises(OutputError, match="no such file; mdlgen run SPEC -o"):
            Result.load(tmp_path)
        path = tmp_path / "result.h5"
        path.write_bytes(b"not HDF5")
        with pytest.raises(OutputError, match="cannot read"):
            Result.load(tmp_path)
        result.save(tmp_path)
        with h5py.File(path, "r+") as file:
            del file["model"]
        with pytest.raises(OutputError, match="older mdlgen, run again"):
            Result.load(tmp_path)

    def test_a_table_that_is_not_ours_is_refused(self, result: Result, tmp_path: Path) -> None:
        result.save(tmp_path)
        with h5py.File(tmp_path / "result.h5", "r+") as file:
            message = bytes(file["model/tables"][()]).replace(b'"SheetPart"', b'"Popen"')
            del file["model/tables"]
            file["model/tables"] = np.bytes_(message)
        with pytest.raises(OutputError, match="cannot read"):
            Result.load(tmp_path)


class TestPicture:
    def test_positions_are_within_a_quantum(self, result: Result, text: str) -> None:
        record = embedded(text)[0]["animation"]
        at = frames(result)
        shape = (len(at), record["bodies"], 3)
        place = np.array(record["low"]) + record["step"] * numbers(record["place"], "<u2").reshape(shape)
        rows = [result.model.bodies.name.index(name) for name in record["names"]]
        true = result.position[at][:, rows]
        # half a step each way, and round-off
        assert np.abs(place - true).max() <= 0.501 * max(record["step"])
        assert max(record["step"]) < 0.005  # mm, on a picture of 200 mm
        turn = numbers(record["turn"], "<i2").reshape(*shape[:2], 4) / 32767
        assert np.abs(turn[:, : record["boxes"]] - result.rotation[at, : record["boxes"]]).max() < 2e-5

    def test_rollers_turn_as_fast_as_they_are_driven(self, result: Result) -> None:
        at = np.arange(len(result.time))
        _, turn = poses(result, at)
        roller = result.model.roller("motor_1_left")
        expected = roller.turned(result.time)
        w = np.clip(np.abs(np.einsum("tk,k->t", turn[:, roller.body], turn[0, roller.body])), 0.0, 1.0)
        found = 2 * np.arccos(w)
        away = np.abs((expected + np.pi) % (2 * np.pi) - np.pi)
        # the ramp's corner lies between two stored states at worst; arccos near 1 has half the digits
        assert np.abs(found - away).max() < 1e-3

    def test_meshes_are_closed_and_look_outward(self) -> None:
        for sample in ("transport_4x4", "channel", "peel", "pick"):
            model = mdlgen.lower(mdlgen.load(samples() / f"{sample}.yaml"))
            for mesh in machine(model):
                edges = mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
                assert sorted(map(tuple, edges)) == sorted(map(tuple, edges[:, ::-1])), mesh.name
                a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
                volume = np.einsum("ni,ni->n", a, np.cross(b, c)).sum() / 6
                assert volume > 0, mesh.name
                sectors = {
                    f"{r.name} {s}": (r, k) for r in model.rollers if r.rim for k, s in enumerate(r.rim.name)
                }
                if mesh.name in sectors:
                    roller, k = sectors[mesh.name]
                    assert roller.rim is not None
                    assert mesh.kind == ("sector" if roller.rim.name[k].startswith("s") else "roller")
                    angle, radius = roller.rim.end[k] - roller.rim.begin[k], roller.rim.radius[k]
                    # sides of a prism, 48 in a round
                    sides = np.ceil(48 * angle / (2 * np.pi) - 1e-9)
                    part = sides / angle * np.sin(angle / sides)
                    assert volume == pytest.approx(angle / 2 * radius**2 * roller.width * part, rel=1e-9)
                elif mesh.kind == "roller":
                    roller = model.roller(mesh.name)
                    part = 48 / (2 * np.pi) * np.sin(2 * np.pi / 48)
                    assert volume == pytest.approx(np.pi * roller.radius**2 * roller.width * part, rel=1e-9)

    def test_a_tooth_stands_out_of_its_rim_as_far_as_it_is_given(self) -> None:
        tooth = "rollers.feed.rim={sectors: [{from: 30 deg, to: 60 deg, radius: 15.5 mm}]}"
        model = mdlgen.lower(mdlgen.load(samples() / "peel.yaml", [tooth]))
        reach = {
            m.name: np.hypot(*m.points[:, :2].T).max() for m in machine(model) if m.name.startswith("feed ")
        }
        assert reach == pytest.approx({"feed s0": 15.5, "feed g0": 15.0}, rel=1e-12)
        angle = next(np.arctan2(*m.points[1:3, 1::-1].T) for m in machine(model) if m.name == "feed s0")
        assert angle[0] == pytest.approx(np.radians(30), abs=1e-12)

    def test_a_roller_whose_mesh_is_touched_is_drawn_as_the_mesh(self) -> None:
        model = mdlgen.lower(mdlgen.load(samples() / "pick.yaml"))
        assert [(m.name, m.kind) for m in machine(model)] == [
            ("plate", "plane"),
            ("lobe", "mesh"),
            ("ramp", "guide"),
        ]
        both = mdlgen.lower(mdlgen.load(samples() / "pick.yaml", ["contacts.0.between=[note, pick]"]))
        assert ("pick", "roller") in [(m.name, m.kind) for m in machine(both)]

    def test_an_arm_goes_from_its_pivot_to_the_axis_of_its_roller(self) -> None:
        result = ran("peel")
        at = np.arange(len(result.time))
        place, turn = poses(result, at)
        roller = result.model.roller("reject")
        assert roller.arm is not None and names(result.model)[-1] == "reject_arm"
        axes = Rotation.from_quat(np.roll(turn[:, -1], -1, axis=1)).as_matrix()
        assert np.abs(place[:, -1] - roller.arm.pivot).max() < 1e-12
        mesh = next(m for m in machine(result.model) if m.kind == "arm")
        assert mesh.body == len(result.model.bodies.name)
        # the solver keeps the length of the arm to 1e-9 of it; its round end goes 0.2 radii beyond the axis
        tip = place[:, -1] + (mesh.points[:, 0].max() - 0.2 * roller.radius) * axes[:, :, 0]
        assert np.abs(tip - result.position[:, roller.body]).max() < 1e-6
        swung = np.ptp(result.position[:, roller.body, 2])
        assert swung > 1e-3  # it does swing

    def test_a_pairs_force_is_shared_whole_among_its_boxes(self, result: Result) -> None:
        at = np.arange(len(result.time))
        force, deep = boxes.contact(result, at)
        contacts = result.model.contacts
        rows = [k for k, name in enumerate(contacts.part_a) if name == "note"]
        total = result.contact_force[:, rows].sum(axis=1)
        # what grazes at the end of a time of force may be off by now
        assert np.abs(force.sum(axis=1) - total).max() < 0.01 * total.max()
        for row in np.flatnonzero(contacts.kind == BOX_CYLINDER):
            # stored states see no more than every step does, but for where in a step the solver looks
            most = result.statistics.max_depth[row]
            assert 0.9 * most < deep[:, row].max() <= 1.01 * most

    def test_colours_reach_the_peaks_of_the_summary(self, result: Result) -> None:
        at = np.arange(len(result.time))
        strain, curvature = boxes.greatest(histories(result, at), (len(at), boxes.count(result.model)))
        record = result.summary()["sheets"]["note"]
        assert strain.max() == pytest.approx(max(record["strain"][f"max_{w}"] for w in ("md", "cd")))
        assert curvature.max() == pytest.approx(
            max(record["curvature"][f"max_{w}_per_mm"] for w in ("md", "cd"))
        )

    def test_curves_end_where_the_summary_does(self, result: Result, text: str) -> None:
        record, summary = embedded(text)[0], result.summary()
        last = {
            (panel["key"], line["name"]): float(numbers(line["y"], "<f4")[-1])
            for panel in record["panels"]
            for line in panel["lines"]
        }
        note = summary["sheets"]["note"]
        for k, axis in enumerate("xyz"):
            # four-byte numbers
            assert last["displacement", f"note {axis}"] == pytest.approx(
                note["travel_mm"][k], rel=1e-6, abs=1e-9
            )
            assert last["speed", f"note {axis}"] == pytest.approx(
                note["speed_mm_per_s"][k], rel=1e-6, abs=1e-6
            )
        assert last["yaw", "note"] == pytest.approx(note["yaw_deg"], rel=1e-6, abs=1e-9)
        for name, roller in summary["rollers"].items():
            assert last["omega", name] == pytest.approx(roller["omega_rad_per_s"], rel=1e-6)
            assert last["force", name] == pytest.approx(roller["nip_force_n"], rel=1e-6)
        keys = [panel["key"] for panel in record["panels"]]
        assert keys == [
            "displacement", "speed", "drift", "yaw", "tilt", "force", "penetration", "slide", "omega",
            "torque", "power", "traction", "drag",
            "driven_energy", "friction_loss", "tension", "tension along", "strain", "curvature",
        ]  # fmt: skip

    def test_a_static_run_is_shown_before_and_after(self) -> None:
        result = ran("cantilever", "sheets.note.boxes=[2,8]")
        record = embedded(page([result]))[0]
        assert record["animation"]["static"] and len(record["animation"]["time"]) == 2
        panel, pulled = record["panels"]
        assert pulled["key"] == "tension along"
        assert {line["name"] for line in panel["lines"]} == {"before", "after"}
        drop = result.summary()["probes"]["tip"]["displacement_mm"][2]
        lowest = min(float(numbers(line["y"], "<f4").min()) for line in panel["lines"])
        # the outermost box's centre, not the edge
        assert drop < lowest < 0.8 * drop


class TestSize:
    def test_a_page_of_200_boxes_can_be_mailed(self) -> None:
        model = small_model("sheets.note.boxes=[10,20]")
        assert len(page([moving(model, 201)])) < 10e6

    def test_a_page_of_600_boxes_and_500_states(self) -> None:
        model = small_model("sheets.note.boxes=[20,30]")
        result = moving(model, 500)
        assert len(frames(result)) == 500
        assert len(page([result])) < 30e6

    def test_of_very_many_states_some_are_left_out(self) -> None:
        model = small_model()
        result = moving(model, 5001)
        at = frames(result)
        assert at[0] == 0 and at[-1] == 5000 and len(at) <= min(FRAMES, MOST) + 1
        assert len(set(np.diff(at[:-1]))) == 1
