"""What a scene requires: how it is written, what a run makes of it, and that it ends so."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import ran
from typer.testing import CliRunner

import mdlgen
from mdlgen.cli import app
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.results.begun import begun_of
from mdlgen.results.result import Result
from mdlgen.results.summary import summary
from mdlgen.results.verdict import in_words, judged, outcomes_of
from mdlgen.spec.load import loads
from mdlgen.spec.require import requirement

# a block that slides to rest on a plane: v^2/(2 mu g) = 25.484 mm from 0.5 m/s with mu 0.5, after 101.9 ms
SLIDE = """
name: slide
materials: {p: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  b: {material: p, size: [20 mm, 20 mm], thickness: 5 mm, mass: 10 g, boxes: [1, 1],
      center: [0 mm, 0 mm, 2.5 mm], velocity: [0.5 m/s, 0 m/s, 0 m/s]}
planes: {t: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [400 mm, 100 mm, 10 mm]}}
contacts: [{between: [b, t], stiffness: 1e4 N/mm^1.5, friction: 0.5, smoothing: 1 mm/s}]
run: {duration: 80 ms, print_step: 1 ms}
"""


def required(*texts: str) -> Result:
    return ran.solved(lower(loads(SLIDE, "slide", (f"require={json.dumps(texts)}",))), "lattice")


def rows(result: Result) -> list[tuple[bool, float | None, float | None]]:
    return [(o.passed, o.value, o.margin) for o in outcomes_of(summary(result))]


def test_limits_are_judged_with_their_margins_in_the_units_of_the_limit() -> None:
    # by hand: after t ms x = 0.5 t - mu g t^2/2, v = 0.5 - mu g t, in mm and ms
    slow = 0.5 * 9.81e-3
    x, v = 0.5 * 80 - 0.5 * slow * 80**2, 0.5 - slow * 80
    found = rows(
        result := required(
            "travel.x above 2 cm",
            "travel below 2 cm",
            "sheets.b.speed from 50 mm/s to 0.2 m/s",
            "speed within 10 mm/s of 110 mm/s",
            "yaw within 1 deg",
        )
    )
    assert [passed for passed, _, _ in found] == [True, False, True, True, True]
    assert [(o.passed, o.value, o.margin) for o in result.verdict] == found
    assert str(result.verdict[1]).startswith("FAIL  travel below 2 cm: 2.4")
    values = [x / 10, x / 10, v * 1e3, v * 1e3]
    assert [value for _, value, _ in found[:4]] == pytest.approx(values, rel=2e-3)
    margins = [x / 10 - 2, 2 - x / 10, v * 1e3 - 50, 10 - abs(v * 1e3 - 110)]
    assert [margin for _, _, margin in found[:4]] == pytest.approx(margins, rel=0.05)


def test_a_measure_is_judged_at_a_time_or_throughout() -> None:
    slow = 0.5 * 9.81e-3
    at, always, force = rows(
        required(
            "speed above 0.3 m/s at 30 ms",
            "speed above 0.3 m/s throughout",
            "planes.t.nip_force from 0 N to 1 N throughout",
        )
    )
    assert at[0] and at[1] == pytest.approx(0.5 - slow * 30, rel=2e-3)
    assert not always[0] and always[1] == pytest.approx(0.5 - slow * 80, rel=5e-3), "the least there is"
    assert force[0]


def test_an_event_is_required_away_anywhere_or_at_a_part() -> None:
    result = required("no jam", "no stub at t")
    record = summary(result)
    assert record["verdict"]["passed"] is True and record["verdict"]["events"] == []
    event = {"kind": "jam", "sheet": "b", "roller": "r", "time_ms": 32.0, "duration_ms": 9.0}
    slip = {
        "kind": "slip",
        "sheet": "b",
        "roller": "r",
        "time_ms": 3.0,
        "part_of_surface_speed": -0.4,
    }
    jammed = {**record, "events": [event, slip, {**slip, "part_of_surface_speed": 0.01}]}
    from mdlgen.results.verdict import verdict

    found = verdict(result, jammed)
    assert [row["passed"] for row in found["requirements"]] == [False, True]
    assert found["events"] == [
        "jam of b at r from 32 ms",
        "slip of b at r, 40 % of the surface's speed, most at 3 ms",
    ]
    both = {"kind": "double_feed", "sheet": "a", "other": "b", "roller": "r", "time_ms": 1.5, "way_mm": 2.345}
    assert in_words(both) == "double feed of a and b at r from 1.5 ms, the slower one goes 2.35 mm"


def test_a_measure_that_is_not_known_is_missed() -> None:
    (found,) = rows(required("strain below 1 %"))  # a block has no joints
    assert found == (False, None, None)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("no jamm", "did you mean 'jam'"),
        ("yaw below", "the forms are"),
        ("yaw from 1 deg", "write 'from VALUE to VALUE'"),
        ("yaw from 2 deg to 1 deg", "ends below its begin"),
        ("yaw within -1 deg", "below zero"),
        ("yaw below 1 deg to 2 deg", "not a unit|unknown|unit"),
        ("yaw from 1 deg to 2 mm", "two kinds"),
        ("yaw below 1,5 deg", "comma"),
        ("yaw below 1 deg at 3 mm", "wrong unit"),
        ("no stub at guide_7", "there is no part 'guide_7'"),
        ("yaw below 3 mm", "is in deg, the limit is in mm"),
        ("yaw below 3", "is in deg, the limit has no unit"),
        ("yaww below 3 deg", "did you mean 'yaw'"),
        ("planes.u.nip_force below 3 N", "there is no 'u'"),
        ("planes.t.max_penetration below 1 mm throughout", "known at the end alone"),
        ("yaw below 3 deg at 90 ms", "not in the run of 80 ms"),
        ("scene below 3", "is a text"),
        ("a" * 5000, "has 5000 characters"),
        ("yaw below 9e999 deg", "finite"),
    ],
)
def test_what_cannot_be_judged_is_one_line_before_anything_runs(text: str, says: str) -> None:
    with pytest.raises(SpecError, match=says) as caught:
        mdlgen.solve(lower(loads(SLIDE, "slide", (f"require={json.dumps([text])}",))), "lattice")
    assert "\n" not in str(caught.value) and "require" in str(caught.value)


def test_what_has_come_in_or_left_is_required() -> None:
    texts = ("infeed left", "not infeed_1 left", "infeed_1 left", "not infeed_3 entered", "not eye covered")
    sensors = {"eye": {"beam": [["0 mm", "0 mm", "-5 mm"], ["0 mm", "0 mm", "5 mm"]]}}
    scene = mdlgen.load("samples/stream.yaml").with_({"require": texts, "sensors": sensors})
    run = begun_of(lower(scene))
    run.stays = np.array([[0.0, 107.0], [60.0, np.nan], [np.nan, np.nan]])
    record = summary(run, without=("estimates", "verdict"))
    found = [judged(run, record, k) for k in range(len(texts))]
    assert [outcome.passed for outcome in found] == [False, False, True, True, True]
    assert str(found[0]) == "FAIL  infeed left: infeed_2 and 1 more"
    assert str(found[1]) == "FAIL  not infeed_1 left" and str(found[2]) == "pass  infeed_1 left"


def test_check_names_each_that_there_is_not_with_its_place(tmp_path: Path) -> None:
    scene = tmp_path / "slide.yaml"
    wrong = "[sheets.c.yaw within 1 deg, no jam,\n  planes.tt.nip_force below 1 N, shets.b.yaw below 1 deg]\n"
    scene.write_text(f"{SLIDE}require: {wrong}")
    done = CliRunner().invoke(app, ["check", str(scene)])
    assert done.exit_code == 2
    assert "slide.yaml:10:11: require.0: 'sheets.c.yaw within 1 deg': there is no 'c'" in done.output
    assert "slide.yaml:11:3: require.2:" in done.output and "did you mean 't'?" in done.output
    assert "there is no 'shets'; did you mean 'sheets'?" in done.output
    with pytest.raises(SpecError, match="there is no 'c'"):
        loads(scene.read_text(), "slide").check()


def test_values_have_units_percentages_and_plain_numbers() -> None:
    assert requirement("x below 50 %").high == 0.5
    assert requirement("x above 0.2").low == 0.2 and requirement("x above 0.2").high == math.inf
    wanted = requirement("x  within 1 mm of 2 cm   throughout")
    assert (wanted.low, wanted.high, wanted.throughout) == (19.0, 21.0, True)
    assert requirement("x below 3 N at 0.02 s").at == 20.0


def test_a_missed_requirement_ends_with_6_and_writes_its_results(tmp_path: Path) -> None:
    scene = tmp_path / "slide.yaml"
    scene.write_text(SLIDE + "require: [travel.x above 1 m, no jam]\n")
    done = CliRunner().invoke(app, ["run", str(scene), "-o", str(tmp_path / "out"), "--page"])
    assert done.exit_code == 6
    assert "FAIL  travel.x above 1 m" in done.output and "pass  no jam" in done.output
    assert "1 of 2 requirements missed: travel.x above 1 m" in done.output
    record = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert record["verdict"]["passed"] is False and record["status"] == "ok"
    assert "FAIL" in (tmp_path / "out" / "report.html").read_text()
    loaded = Result.load(tmp_path / "out")
    assert [o.passed for o in outcomes_of(loaded.summary())] == [False, True]


def test_a_sweep_counts_the_cases_that_pass(tmp_path: Path) -> None:
    scene = tmp_path / "slide.yaml"
    scene.write_text(SLIDE + "require: [travel.x above 2 cm]\n")
    over = ["--over", "contacts.0.friction=[0.3, 0.5, 0.9]", "--measure", "verdict.passed"]
    done = CliRunner().invoke(app, ["sweep", str(scene), "-o", str(tmp_path / "out"), *over])
    assert done.exit_code == 0, done.output
    table = (tmp_path / "out" / "table.csv").read_text().splitlines()
    column = table[0].split(",").index("verdict.passed")
    # mu g t^2/2 is 9.4, 15.7 and 14.2 mm (it stops after 56.6 ms) of 40 mm
    assert [float(row.split(",")[column]) for row in table[1:]] == [1.0, 1.0, 0.0]
