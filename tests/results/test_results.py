"""The files of a run, and the distance between two runs."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from synthetic import SPEED, moving, small_model

import mdlgen
from mdlgen.errors import OutputError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.report.figures.figure import figure
from mdlgen.report.html.page import page
from mdlgen.report.overview import overview
from mdlgen.report.text import overview_text, summary_text
from mdlgen.results.compare import compare, scale
from mdlgen.results.io import store
from mdlgen.results.io.series import series
from mdlgen.results.result import Result
from mdlgen.results.summary import summary
from mdlgen.results.wording import number, numbers
from mdlgen.spec.load import loads

FILES = ["result.h5", "series.csv", "summary.json"]
PROMISED = {
    "scene", "solver", "status", "t_end_ms", "steps", "step_ms", "wall_s", "compile_s", "build_s", "pairs",
    "error_estimate", "tolerance", "energy", "events", "sheets", "rollers", "guides", "meshes", "probes",
    "mark", "duration_ms", "error_below", "search_ended", "chaotic", "estimates_below",
    "verdict", "versions", "error_estimate_of", "error_unknown", "estimates", "estimate_scales", "planes",
}  # fmt: skip
WORK = {"iterations", "rounds", "estimate_s", "halved"}  # what a run and the estimate of its error took
STRIP = """
name: pull
materials: {m: {E_md: 1 GPa, E_cd: 1 GPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  strip:
    {material: m, size: [40 mm, 10 mm], thickness: 0.1 mm, mass: 1 g, boxes: [4, 2], clamp: {edge: x_min}}
loads: [{sheet: strip, edge: x_max, stress: 1 MPa}]
run: {analysis: static}
"""


@pytest.fixture(scope="module")
def model() -> Model:
    return small_model()


@pytest.fixture(scope="module")
def result(model: Model) -> Result:
    return moving(model)


def test_round_off_is_shown_as_0(result: Result) -> None:
    assert numbers([382.3, -3e-8, None], 4, "-") == ["382.3", "0", "-"] and number(3e-19, 4) == "0"
    assert numbers([3e-8, -3e-8], 4, "-") == ["3e-08", "-3e-08"]  # of their own size
    turned = replace(result, position=result.position + 1e-14 * np.random.default_rng(1).random((3,)))
    assert "yaw 0 deg" in repr(turned.sheets["note"]) and ", 0, 0] mm" in repr(turned.sheets["note"])
    assert "e-1" not in turned._repr_html_()


def test_pairs_that_are_found_as_it_runs_are_said() -> None:
    """More may touch than are kept."""
    text = (samples() / "feeder.yaml").read_text("utf-8")
    boxes = ["sheets.note_1.boxes=[24,16]", "sheets.note_2.boxes=[24,16]", "run.duration=20 ms"]
    found = lower(loads(text, "s", boxes))
    assert len(found.pairs.searched) == 1
    ended = replace(moving(found), touched=10**6)
    assert summary(ended)["pairs"]["searched"] == 1
    said = f"{len(found.pairs)} kept and those of sheets in 1 contact, found as it runs, 1000000 touched"
    assert said in summary_text(summary(ended))
    assert "found as it runs (margin" in overview_text(overview(found))
    assert "found as it ran, 1000000 touched" in page([ended])
    plain = moving(small_model())
    assert "found as it r" not in summary_text(summary(plain)) + page([plain])


class TestSummary:
    def test_is_the_promised_object(self, result: Result) -> None:
        record = summary(result)
        assert set(record) == PROMISED | WORK
        assert set(record["pairs"]) == {
            "possible",
            "kept",
            "searched",
            "touched",
            "margin_mm",
            "margin_given_mm",
        }
        assert set(record["sheets"]["note"]) == {
            "travel_mm", "speed_mm_per_s", "yaw_deg", "way_mm", "mean_speed_mm_per_s", "skew_deg",
            "boxes", "bushings", "strain", "curvature", "twist", "tension", "residual", "energy",
        }  # fmt: skip
        assert set(record["probes"]["lead"]) == {"displacement_mm", "speed_mm_per_s"}

    def test_values_are_in_mm_and_s(self, result: Result) -> None:
        record = summary(result)
        end = result.model.run.duration
        note = record["sheets"]["note"]
        # a product and a mean over boxes: some ulp
        assert note["travel_mm"] == pytest.approx([SPEED * end, 0, 0], abs=1e-12)
        assert note["speed_mm_per_s"] == pytest.approx([SPEED * 1000, 0, 0], abs=1e-9)
        assert (note["boxes"], note["bushings"]) == (6, 14)
        assert record["probes"]["lead"]["displacement_mm"] == pytest.approx([SPEED * end, 0, 0], abs=1e-12)
        assert record["rollers"]["motor_1_left"]["omega_rad_per_s"] == pytest.approx(186.7, rel=1e-12)

    def test_a_roller_counts_sheets_only_in_its_penetration(self, result: Result) -> None:
        contacts = result.model.contacts
        roller = summary(result)["rollers"]["counter_2_left"]
        pairs = zip(contacts.part_a, contacts.part_b, strict=True)
        rows = {frozenset(pair): k for k, pair in enumerate(pairs)}
        sheet = rows[frozenset(("note", "counter_2_left"))]
        counterpart = rows[frozenset(("motor_2_left", "counter_2_left"))]
        assert roller["max_penetration_mm"] == sheet * 0.01
        assert roller["mean_penetration_mm"] == sheet * 0.005
        assert roller["nip_force_n"] == sheet + counterpart
        assert roller["contacts"]["motor_2_left"]["max_force_n"] == counterpart * 2
        assert roller["free_of_counterpart_at_ms"] == counterpart

    def test_a_counterpart_that_still_acts_is_null(self, result: Result) -> None:
        rollers = summary(result)["rollers"]
        first = result.model.contacts.part_a[0]
        assert rollers[first]["free_of_counterpart_at_ms"] is None

    def test_a_roller_without_counterpart_was_never_in_contact(self) -> None:
        contact = "{between: [note, motor_1_left], stiffness: 300 N/mm^1.5, friction: 0}"
        alone = moving(small_model(f"contacts=[{contact}]"))
        roller = summary(alone)["rollers"]["counter_1_left"]
        assert (roller["free_of_counterpart_at_ms"], roller["nip_force_n"], roller["contacts"]) == (
            0.0,
            0.0,
            {},
        )

    def test_what_is_not_finite_is_null(self, result: Result) -> None:
        broken = replace(result, wall_s=math.inf, error_estimate=math.nan)
        record = json.loads(json.dumps(summary(broken), allow_nan=False))
        assert record["wall_s"] is None and record["error_estimate"] is None

    def test_a_run_without_states_has_a_summary(self, result: Result) -> None:
        none = replace(
            result,
            status="it failed",
            time=result.time[:0],
            position=result.position[:0],
            rotation=result.rotation[:0],
            velocity=result.velocity[:0],
            spin=result.spin[:0],
            contact_force=result.contact_force[:0],
        )
        record = summary(none)
        assert record["status"] == "it failed" and record["sheets"]["note"]["travel_mm"] is None

    def test_static_results_are_relative_to_the_model(self, model: Model) -> None:
        one = moving(model, times=2, shift=-3.0)
        static = replace(
            one,
            time=one.time[:1],
            position=one.position[:1],
            rotation=one.rotation[:1],
            velocity=0 * one.velocity[:1],
            spin=0 * one.spin[:1],
            contact_force=one.contact_force[:1],
        )
        record = summary(static)
        assert record["sheets"]["note"]["travel_mm"] == pytest.approx([0, 0, -3], abs=1e-12)
        assert record["probes"]["lead"]["displacement_mm"] == pytest.approx([0, 0, -3], abs=1e-12)

    @pytest.mark.parametrize(("clamp", "pull", "row"), [("x_min", "x_max", -1), ("x_max", "x_min", 0)])
    def test_strain_is_elongation_over_the_flexible_length(self, clamp: str, pull: str, row: int) -> None:
        strip = lower(loads(STRIP, "s", [f"sheets.strip.clamp.edge={clamp}", f"loads.0.edge={pull}"]))
        assert strip.tension is not None and (strip.tension.axis, strip.tension.length) == (0, 35.0)
        result = moving(strip, times=2, speed=0.0)
        outward = 1.0 if pull == "x_max" else -1.0
        result.position[:, [3, 7] if row else [0, 4], 0] += outward * 0.7
        assert summary(result)["strain"] == pytest.approx(0.02, rel=1e-12)  # 0.7 / 35


class TestFiles:
    def test_written_and_read_back(self, result: Result, tmp_path: Path) -> None:
        result.save(tmp_path / "a" / "b")
        assert sorted(p.name for p in (tmp_path / "a" / "b").iterdir()) == FILES
        found = store.read(tmp_path / "a" / "b")
        assert found["bodies"] == list(result.model.bodies.name)
        assert found["contacts"][0] == "motor_1_left / counter_1_left"
        assert (found["scene"], found["status"], found["solver"]) == ("transport_4x4", "ok", "synthetic")
        for name in store.STATES:
            np.testing.assert_array_equal(found[name], getattr(result, name))
        np.testing.assert_array_equal(found["statistics/last_force_at"], result.statistics.last_force_at)

    def test_summary_is_strict_json(self, result: Result, tmp_path: Path) -> None:
        result.save(tmp_path)

        def refuse(word: str) -> None:
            raise AssertionError(word)

        text = (tmp_path / "summary.json").read_text("ascii")
        assert json.loads(text, parse_constant=refuse)["scene"] == "transport_4x4"

    def test_series_has_the_promised_columns(self, result: Result, tmp_path: Path) -> None:
        result.save(tmp_path)
        with open(tmp_path / "series.csv", newline="") as stream:
            rows = list(csv.DictReader(stream))
        motion = ["x_mm", "y_mm", "z_mm", "vx_mm_per_s", "vy_mm_per_s", "vz_mm_per_s"]
        columns = ["time_ms", *(f"note.{c}" for c in [*motion, "yaw_deg", "tension_max_n", "tension_min_n"])]
        columns += [f"{p}.{c}" for p in ("grip", "lead") for c in motion]
        columns += [
            f"{r.name}.{c}"
            for r in result.model.rollers
            for c in ("z_mm", *["slide_mm"] * (r.press is not None), "omega_rad_per_s", "force_n")
        ]
        columns += [f"{plane.name}.force_n" for plane in result.model.planes]
        assert list(rows[0]) == columns
        assert len(rows) == len(result.time)
        last = rows[-1]
        assert float(last["time_ms"]) == result.time[-1]
        assert float(last["note.x_mm"]) == pytest.approx(SPEED * result.time[-1], rel=1e-12)
        assert float(last["note.vx_mm_per_s"]) == pytest.approx(1400, rel=1e-12)

    def test_series_has_the_ways_that_parts_move_along(self) -> None:
        slid = small_model(
            "rollers.counter_1_left.press.direction=-x",
            "rollers.counter_2_left.press.direction=[0, -1, -1]",
            'contacts.0.between=[motor_1_left, motor_2_left]',
            'contacts.2.between=[motor_1_right, motor_2_right]',
        )  # fmt: skip
        names = list(series(moving(slid)))
        places = [
            name for name in names if name.startswith("counter_") and name.endswith(("x_mm", "y_mm", "z_mm"))
        ]
        assert places == [
            "counter_1_left.x_mm",  # z of one that slides along x is constant
            "counter_1_right.z_mm",
            *("counter_2_left.y_mm", "counter_2_left.z_mm"),
            "counter_2_right.z_mm",
        ]
        swung = moving(lower(loads((samples() / "feeder.yaml").read_text("utf-8"))))
        table = series(swung)
        assert "skimmer_left.x_mm" in table and "skimmer_left.y_mm" not in table  # about y
        body = swung.model.roller("skimmer_left").body
        np.testing.assert_array_equal(table["skimmer_left.x_mm"], swung.position[:, body, 0])

    def test_forces_on_fixed_parts(self, result: Result) -> None:
        """Planes that do not move have the sum of their contacts, at the end and over time."""
        text = (samples() / "verify" / "slide.yaml").read_text("utf-8")
        model = lower(loads(text))
        ended = moving(model, speed=0.0)
        force = ended.contact_force
        force[:] = np.linspace(1.0, 2.0, len(force))[:, None]
        (plane,) = model.planes
        record = summary(ended)["planes"][plane.name]
        assert record["nip_force_n"] == 2.0 * len(model.contacts)
        assert "center_mm" not in record and record["contacts"]["block"]["max_force_n"] == 0.0
        np.testing.assert_array_equal(series(ended)[f"{plane.name}.force_n"], force.sum(axis=1))

    @pytest.mark.parametrize("yaw", [0.0, 0.2, -2.5])
    @pytest.mark.parametrize("turn", [0.0, 1.0, math.pi / 2, 2.8])
    @pytest.mark.parametrize("about", [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.6, 0.8, 0.0]])
    def test_a_curve_that_a_sheet_goes_round_is_no_yaw(
        self, yaw: float, turn: float, about: list[float]
    ) -> None:
        """A sheet at 10 deg turns by `yaw` in its plane, and is led round an axis of that plane."""
        model = small_model("sheets.note.turn=10 deg")
        ended, own = moving(model, times=5), Rotation.from_euler("z", 10, degrees=True)
        parts = np.linspace(0.0, 1.0, 5)
        for k, part in enumerate(parts):
            round_it = Rotation.from_rotvec(part * turn * own.apply(about))
            turned = round_it * Rotation.from_rotvec([0.0, 0.0, part * yaw]) * own
            ended.rotation[k, : model.sheets[0].count] = turned.as_quat(scalar_first=True)
        np.testing.assert_allclose(ended.sheet_motion(0)[2], parts * yaw + np.radians(10), atol=1e-12)

    def test_the_same_result_gives_the_same_bytes(self, result: Result) -> None:
        assert store.hdf5(result) == store.hdf5(result)
        assert figure(result) == figure(result)

    def test_figures_of_a_static_and_of_a_moving_result(self, result: Result) -> None:
        static = moving(lower(loads(STRIP)), times=2)
        for one in (result, static):
            assert figure(one).startswith(b"\x89PNG\r\n\x1a\n")

    def test_a_failed_run_is_written_and_marked(self, result: Result, tmp_path: Path) -> None:
        result.save(tmp_path)
        part = slice(0, len(result.time) // 2)
        names = ("time", "position", "rotation", "velocity", "spin", "contact_force")
        early = replace(result, **{name: getattr(result, name)[part] for name in names}, status="it blew up")
        early.contact_torque = early.contact_friction = None
        early.save(tmp_path)
        assert sorted(p.name for p in tmp_path.iterdir()) == FILES
        record = json.loads((tmp_path / "summary.json").read_text("utf-8"))
        end, duration = early.time[-1], result.model.run.duration
        assert record["mark"] == f"ended early, at {end:.6g} of {duration:g} ms: it blew up"
        assert record["status"] == "it blew up" and record["t_end_ms"] == end < duration
        again = store.load(tmp_path)
        assert again.status == "it blew up" and not again.usable and len(again.time) == len(early.time)

    def test_a_failed_run_without_a_state_leaves_the_old_files(self, result: Result, tmp_path: Path) -> None:
        result.save(tmp_path)
        old = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
        with pytest.raises(OutputError, match="it blew up"):
            replace(result, time=np.zeros(0), status="it blew up").save(tmp_path)
        assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == old

    def test_old_files_stay_where_one_cannot_be_written(self, result: Result, tmp_path: Path) -> None:
        result.save(tmp_path)
        old = (tmp_path / "summary.json").read_bytes()
        (tmp_path / "result.h5").unlink()
        (tmp_path / "result.h5").mkdir()
        with pytest.raises(OutputError, match="folder"):
            replace(result, steps=7).save(tmp_path)
        assert (tmp_path / "summary.json").read_bytes() == old
        assert sorted(p.name for p in tmp_path.iterdir()) == FILES

    @pytest.mark.parametrize("where", ["file", "file/below", "link"])
    def test_a_place_that_is_no_folder_is_refused(self, result: Result, tmp_path: Path, where: str) -> None:
        (tmp_path / "file").write_text("mine")
        (tmp_path / "real").mkdir()
        (tmp_path / "link").symlink_to(tmp_path / "real")
        with pytest.raises(OutputError):
            result.save(tmp_path / where)
        assert (tmp_path / "file").read_text() == "mine"
        assert not list((tmp_path / "real").iterdir())

    def test_reading_nothing_is_an_error(self, tmp_path: Path) -> None:
        with pytest.raises(OutputError, match="cannot read"):
            store.read(tmp_path)
        (tmp_path / "result.h5").write_bytes(b"no")
        with pytest.raises(OutputError, match="cannot read"):
            store.read(tmp_path)


class TestCompare:
    def test_a_result_is_no_distance_from_itself(self, result: Result) -> None:
        found = mdlgen.compare(result, result)
        assert (found.position_rms_mm, found.position_max_mm, found.travel_difference_mm) == (0, 0, 0)
        assert set(found.nip_force.values()) == {0.0}

    def test_a_shift_is_its_own_size(self, model: Model, result: Result) -> None:
        found = compare(result, moving(model, shift=0.5))
        assert found.position_rms_mm == pytest.approx(0.5, rel=1e-12)
        assert found.position_axes_mm == pytest.approx((0.0, 0.0, 0.5), abs=1e-12)
        assert found.relative == pytest.approx(0.5 / (SPEED * model.run.duration), rel=1e-12)

    def test_short_travels_are_relative_to_the_sheet(self, model: Model) -> None:
        assert scale(moving(model, speed=0.0)) == 12.7  # a tenth of 127 mm

    def test_other_times_are_interpolated_by_the_cubic(self, model: Model) -> None:
        def thrown(times: int) -> Result:
            result = moving(model, times=times)
            t = result.time[:, None]
            result.position[:, :, 2] += 1e-3 * t**3
            result.velocity[:, :, 2] += 3e-3 * t**2
            return result

        # a cubic through positions and velocities is exact for a cubic motion; values reach 125
        assert compare(thrown(11), thrown(8)).position_max_mm < 1e-11

    def test_a_shorter_run_is_compared_as_far_as_it_goes(self, model: Model, result: Result) -> None:
        half = replace(
            result,
            **{name: getattr(result, name)[:5] for name in store.STATES},
        )
        assert compare(result, half).position_max_mm < 1e-12
        assert compare(half, result).position_max_mm < 1e-12

    def test_different_scenes_are_refused(self, result: Result) -> None:
        with pytest.raises(SpecError, match="different boxes"):
            compare(result, moving(small_model("sheets.note.boxes=[3,3]")))

    def test_forces_are_relative_to_the_larger(self, model: Model, result: Result) -> None:
        other = moving(model)
        other.contact_force[:, 4] *= 2
        assert list(compare(result, other).nip_force.values())[4] == pytest.approx(0.5)


def test_the_public_names() -> None:
    assert mdlgen.__version__.count(".") >= 2
    assert mdlgen.Scene.__name__ == "Scene" and mdlgen.Model is Model and mdlgen.Result is Result
    with pytest.raises(AttributeError):
        _ = mdlgen.nothing
    assert mdlgen.lower(mdlgen.loads(STRIP)).name == "pull"
