"""Sheets that friction holds and that creep by Eq. 12: what is reported of them, and where nothing is."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import ran
from solids import ascii_stl, prism

from mdlgen.checks import lints
from mdlgen.mechanics.laws import friction_over_speed
from mdlgen.model.creep import load_part, slip_part
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.report.html.happened import happened
from mdlgen.report.text import summary_text
from mdlgen.results.held import WAIT
from mdlgen.results.result import Result
from mdlgen.results.verdict import verdict
from mdlgen.spec.load import load, loads

Event = dict[str, Any]

# A card of 30 g hangs by its upper edge in a nip that presses with 1.2 N; friction can hold 2 x 0.5 x 1.2 N.
HANGING = """
name: hanging_card
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {card: {E_md: 3200 MPa, E_cd: 3200 MPa, D_md: 4 N*mm, D_cd: 4 N*mm}}
sheets:
  card: {material: card, size: [50 mm, 36 mm], thickness: 0.4 mm, mass: 30 g, boxes: [5, 3],
    rotation: [0 deg, 90 deg, 0 deg], center: [0 mm, 0 mm, -16 mm]}
rollers:
  back: {center: [-7.2 mm, 0 mm, 0 mm], axis: y, radius: 7 mm, width: 28 mm, mass: 15 g,
    drive: {speed: 0 rad/s}}
  front: {center: [7.19 mm, 0 mm, 0 mm], axis: y, radius: 7 mm, width: 28 mm, mass: 15 g,
    drive: {speed: 0 rad/s}, press: {direction: -x, stiffness: 0.4 N/mm, preload: 1.2 N}}
contacts:
  - {between: [card, [back, front]], stiffness: 250 N/mm^1.5, friction: 0.5, restitution: 0.3,
    smoothing: 4 mm/s}
run: {duration: 400 ms, margin: 15 mm}
"""
WEIGHT = 0.03 * 9.81  # [N]

# Both rollers turn so that the card goes down at 84 mm/s, and stop at 60 ms for the rest.
STOPS = (
    "rollers.back.drive={profile: [[0 ms, 12 rad/s], [50 ms, 12 rad/s], [60 ms, 0 rad/s]]}",
    "rollers.front.drive={profile: [[0 ms, -12 rad/s], [50 ms, -12 rad/s], [60 ms, 0 rad/s]]}",
)

# A block on a plane that is level while gravity leans by 16 degrees.
LEANS = math.radians(16.0)
SLOPE = f"""
name: block_on_a_slope
gravity: [{9.81 * math.sin(LEANS)} m/s^2, 0 m/s^2, {-9.81 * math.cos(LEANS)} m/s^2]
materials: {{m: {{E_md: 900 MPa, E_cd: 900 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}}}
sheets:
  block: {{material: m, size: [30 mm, 24 mm], thickness: 6 mm, mass: 8 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 2.998 mm]}}
planes: {{table: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [900 mm, 200 mm, 10 mm], mass: 100 g}}}}
contacts:
  - {{between: ["b*", table], stiffness: 900 N/mm^1.5, restitution: 0.4, friction: 0.45, smoothing: 3 mm/s}}
run: {{duration: 300 ms}}
"""
LEVEL = ("gravity=[0 m/s^2, 0 m/s^2, -9.81 m/s^2]",)


def model(text: str, *overrides: str):
    return lower(loads(text, "scene", overrides))


def solved(text: str, *overrides: str) -> Result:
    return ran.solved(model(text, *overrides), "lattice")


def creeps(result: Result) -> list[Event]:
    return [event for event in result.events if event["kind"] == "creep"]


def codes(text: str, *overrides: str) -> list[str]:
    return [lint.code for lint in lints(model(text, *overrides)) if lint.code in ("W138", "W139")]


def test_the_slip_is_the_inverse_of_the_law() -> None:
    x = np.linspace(0.0, 1.0, 41)
    np.testing.assert_allclose(slip_part(load_part(x)), x, atol=1e-7)  # its slope is infinite at 1
    for part in (0.2, 0.5, 0.9):
        mu = friction_over_speed(part * 3.0, 0.4, 0.4, 3.0, 3.0) * part * 3.0
        assert float(load_part(np.array(part))) == pytest.approx(mu / 0.4, rel=1e-12)
    assert float(slip_part(0.5)) == pytest.approx(0.347, abs=5e-4)  # as the manual has it


def test_a_card_in_a_stopped_nip_creeps_as_the_law_has_it() -> None:
    result = solved(HANGING)
    (event,) = creeps(result)
    held = 2.0 * 0.5 * result.statistics.mean_force[0]  # what both surfaces can hold [N]
    speed = 4.0 * float(slip_part(WEIGHT / held))  # [mm/s]
    assert event["sheet"] == "card" and event["held_by"] == ["back", "front"]
    assert event["duration_ms"] > 390.0
    assert event["creep_mm"] == pytest.approx(speed * event["duration_ms"] / 1e3, rel=0.01)
    assert event["smoothing_mm_per_s"] == event["stiction_velocity_mm_per_s"] == pytest.approx(4.0)
    # the card itself went so far, but for its sag into the soft nip
    gone = -result.summary()["sheets"]["card"]["travel_mm"][2]
    assert event["creep_mm"] == pytest.approx(gone, rel=0.02)
    record = result.summary()
    line = (
        f"card is held by friction at back, front for {event['duration_ms']:.3g} ms and creeps by "
        f"{event['creep_mm']:.2g} mm: smoothing 4 mm/s; sticking holds it"
    )
    assert record["verdict"]["events"] == [line] and line in summary_text(record).splitlines()
    (row,) = [row for row in happened(record["events"]) if row["kind"] == "creep"]
    assert row["places"] == ["back, front"] and row["text"] == line


def test_a_card_that_its_weight_pulls_along_the_axes_creeps_too() -> None:
    """Friction along a roller's surface as it turns is none there: the slip at the contact line counts."""
    result = solved(HANGING, "gravity=[0 m/s^2, -9.81 m/s^2, 0 m/s^2]", "run.duration=100 ms")
    (event,) = creeps(result)
    assert event["held_by"] == ["back", "front"] and event["duration_ms"] > 90.0
    # the card turns about the nip as well, so that its centre goes further down
    assert 0.05 < event["creep_mm"] < -result.summary()["sheets"]["card"]["travel_mm"][1]


def test_it_counts_from_where_the_nip_stops() -> None:
    result = solved(HANGING, *STOPS)
    (event,) = creeps(result)
    assert 50.0 < event["time_ms"] < 65.0
    assert event["time_ms"] + event["duration_ms"] == pytest.approx(400.0)
    at = np.searchsorted(result.time, 100.0)
    away = result.sheet_motion(0)[0][:, 2]
    rest = float(away[at] - away[-1]) / float(result.time[-1] - result.time[at])  # [mm/ms]
    assert event["creep_mm"] == pytest.approx(rest * event["duration_ms"], rel=0.02)


def test_a_nip_that_lets_a_card_down_slowly_holds_nothing() -> None:
    """Its surface is slower than the stiction velocity, and faster than the card creeps on it."""
    slow = tuple(
        f"rollers.{name}.drive.speed={rate} rad/s" for name, rate in (("back", 0.4), ("front", -0.4))
    )
    result = solved(HANGING, *slow)
    assert result.summary()["sheets"]["card"]["travel_mm"][2] < -1.0  # 2.8 mm/s by the rollers
    assert creeps(result) == []


@pytest.mark.parametrize(
    ("mu", "solver"), [(0.32, "lattice"), (0.45, "lattice"), (1.2, "lattice"), (0.45, "exudyn")]
)
def test_a_block_on_a_slope_creeps_as_the_lint_says(mu: float, solver: str) -> None:
    result = ran.solved(model(SLOPE, f"contacts.0.friction={mu}"), solver)
    (event,) = creeps(result)
    used = math.tan(LEANS) / mu
    speed = 3.0 * float(slip_part(used))
    assert event["held_by"] == ["table"] and event["duration_ms"] > 290.0
    assert event["creep_mm"] == pytest.approx(speed * event["duration_ms"] / 1e3, rel=0.01)
    (lint,) = [lint for lint in lints(result.model) if lint.code == "W138"]
    assert lint.where == "contacts.0.friction" and f"at {100.0 * used:.3g} % of its limit" in lint.message
    assert f"creeps at {speed:.3g} mm/s: by {0.3 * speed:.2g} mm in 300 ms (smoothing 3 mm/s)" in lint.message
    assert "sticking" in lint.remedy


def test_the_stiction_velocity_is_named_where_it_is_not_the_smoothing() -> None:
    friction = "contacts.0.friction={static: 0.45, dynamic: 0.45, stiction_velocity: 2 mm/s}"
    (event,) = creeps(solved(SLOPE, friction))
    assert event["smoothing_mm_per_s"] == pytest.approx(3.0)
    assert event["stiction_velocity_mm_per_s"] == pytest.approx(2.0)
    (lint,) = [lint for lint in lints(model(SLOPE, friction)) if lint.code == "W138"]
    assert "(stiction velocity 2 mm/s)" in lint.message


STILL_AND_SLIDING = [
    ("on a level plane at rest", LEVEL),
    ("that slides", ("contacts.0.friction=0.15",)),
    ("that just slides", (f"contacts.0.friction={0.98 * math.tan(LEANS)}",)),
    ("that slides with the dynamic coefficient", (
        "contacts.0.friction={static: 0.5, dynamic: 0.2}", "sheets.block.velocity=[0.2 m/s, 0 m/s, 0 m/s]",
    )),
    ("that friction stops on a level plane", (*LEVEL, "sheets.block.velocity=[0.3 m/s, 0 m/s, 0 m/s]")),
    ("that friction stops from a fast slip", (
        *LEVEL, "sheets.block.velocity=[0.3 m/s, 0 m/s, 0 m/s]", "contacts.0.smoothing=40 mm/s",
    )),
    ("on a slope where nothing holds", ("contacts.0.friction=0",)),
]  # fmt: skip


@pytest.mark.parametrize(
    "overrides", [o for _, o in STILL_AND_SLIDING], ids=[n for n, _ in STILL_AND_SLIDING]
)
def test_nothing_is_reported_of_a_block(overrides: tuple[str, ...]) -> None:
    result = solved(SLOPE, *overrides)
    assert creeps(result) == [] and not any("friction at" in line for line in _lines(result))


def _lines(result: Result) -> list[str]:
    return summary_text(result.summary()).splitlines()


@pytest.mark.parametrize(
    "overrides",
    [LEVEL, ("contacts.0.friction=0.2",), ("sheets.block.velocity=[0.3 m/s, 0 m/s, 0 m/s]",),
     ("run.duration=1 ms",), ("contacts.0.smoothing=1 um/s",), ("sheets.block.center=[0 mm, 0 mm, 300 mm]",)],
)  # fmt: skip
def test_no_lint_where_nothing_creeps_far(overrides: tuple[str, ...]) -> None:
    assert codes(SLOPE) == ["W138"] and codes(SLOPE, *overrides) == []


def test_a_sheet_on_another_one_creeps_on_it_unless_they_stick() -> None:
    """Both have the same part of their limits; the upper one moves against the lower one as that against the
    plane."""
    second = (
        "sheets.bridge={material: m, size: [26 mm, 20 mm], thickness: 6 mm, mass: 5 g, boxes: [1, 1], "
        "center: [0 mm, 0 mm, 8.997 mm]}"
    )
    law = "stiffness: 900 N/mm^1.5, restitution: 0.4, smoothing: 3 mm/s"
    table = f"{{between: [block, table], {law}, friction: 0.45}}"
    between = f"{{between: [block, bridge], {law}, friction: 0.45}}"
    found = creeps(solved(SLOPE, second, f"contacts=[{table}, {between}]"))
    found.sort(key=lambda event: event["sheet"])
    assert [(event["sheet"], event["held_by"]) for event in found] == [
        ("block", ["table"]), ("bridge", ["block"]),
    ]  # fmt: skip
    speed = 3.0 * float(slip_part(math.tan(LEANS) / 0.45))
    for event in found:
        assert event["creep_mm"] == pytest.approx(speed * event["duration_ms"] / 1e3, rel=0.02)
    sticks = between.replace("friction: 0.45", "friction: {static: 0.45, dynamic: 0.45, sticking: 60 N/mm}")
    (event,) = creeps(solved(SLOPE, second, f"contacts=[{table}, {sticks}]"))
    assert (event["sheet"], event["held_by"]) == ("block", ["table"])


def test_a_mesh_holds_as_a_plane_does(tmp_path) -> None:
    plate = prism([(-60, -10), (60, -10), (60, 0), (-60, 0)], 80)
    (tmp_path / "plate.stl").write_text(ascii_stl(*plate))
    (plane,) = [line for line in SLOPE.splitlines() if line.startswith("planes")]
    mesh = "meshes: {table: {file: plate.stl, center: [0 mm, 0 mm, 0 mm]}}"
    scene = loads(SLOPE.replace(plane, mesh), "plate", folder=tmp_path)
    (event,) = creeps(ran.solved(lower(scene), "lattice"))
    speed = 3.0 * float(slip_part(math.tan(LEANS) / 0.45))
    assert event["held_by"] == ["table"]
    assert event["creep_mm"] == pytest.approx(speed * event["duration_ms"] / 1e3, rel=0.02)


def test_a_note_that_a_machine_transports_is_not_held() -> None:
    result = ran.solved(lower(load(samples() / "transport_4x4.yaml")), "lattice")
    assert creeps(result) == []


def test_it_can_be_required_away() -> None:
    result = solved(HANGING, "require=[no creep, no creep at back, no creep at card]")
    assert [outcome.passed for outcome in result.verdict] == [False, False, False]
    assert solved(SLOPE, *LEVEL, "require=[no creep]").verdict[0].passed


def test_what_a_machine_does_wrong_stands_before_creep() -> None:
    result = solved(HANGING)
    jam = {
        "kind": "jam",
        "sheet": "card",
        "roller": "back",
        "time_ms": 200.0,
        "held_by": [],
        "duration_ms": 60.0,
    }
    lines = verdict(result, {"events": [*creeps(result), jam]})["events"]
    assert lines[0] == "jam of card at back from 200 ms" and "creeps by" in lines[1]


def test_the_lint_of_a_stopped_nip_has_how_long_it_stands() -> None:
    (lint,) = [lint for lint in lints(model(HANGING)) if lint.code == "W139"]
    far = 4.0 * 0.4 * float(slip_part(0.5))
    assert lint.where == "contacts.0.friction" and "stands still for 400 ms" in lint.message
    assert f"creeps by {far:.2g} mm: card (smoothing 4 mm/s)" in lint.message
    assert lint.message.startswith("back, front: ") and "sticking: 50 N/mm" in lint.remedy
    (lint,) = [lint for lint in lints(model(HANGING, *STOPS)) if lint.code == "W139"]
    assert "stands still for 340 ms" in lint.message


@pytest.mark.parametrize(
    "overrides",
    [
        ("rollers.back.drive.speed=5 rad/s", "rollers.front.drive.speed=-5 rad/s"),
        ("rollers.back.drive=null", "rollers.front.drive=null"),
        ("contacts.0.friction=0",),
        ("contacts.0.smoothing=1 um/s",),
        ("sheets.card.clamp={edge: x_max}",),
        ("sheets.card.center=[0 mm, 400 mm, -16 mm]",),
        tuple(text.replace("60 ms", "390 ms").replace("50 ms", "380 ms") for text in STOPS),
    ],
)
def test_no_lint_where_nothing_stands_or_holds(overrides: tuple[str, ...]) -> None:
    assert codes(HANGING, *overrides) == []


def test_what_lasts_for_less_than_a_wait_is_left_out() -> None:
    result = solved(SLOPE, f"run.duration={0.8 * WAIT} ms", "run.tolerance=1e-6")
    assert creeps(result) == []
