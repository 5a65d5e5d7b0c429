"""Events of a run: entering, leaving, slip, gap, jam, double feed, from what is stored."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
import ran
from asked import as_asked
from papers import HINGED_PAPER

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.events import events
from mdlgen.results.held import JAM_END, JAM_LONG, JAM_PART, WAIT
from mdlgen.results.result import Result
from mdlgen.results.stays import SHORT, intervals
from mdlgen.spec.load import load, loads

Event = dict[str, Any]

SHEET = "material: paper, size: [40 mm, 30 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [4, 3]"
# one nip; the motor's surface runs at 750 mm/s
NIP = f"""
name: nip
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials:
  paper: {HINGED_PAPER}
sheets:
  a: {{{SHEET}, center: [0 mm, 0 mm, 0 mm]}}
rollers:
  motor: {{center: [0 mm, 0 mm, -7.5 mm], axis: y, radius: 7.5 mm, width: 20 mm, mass: 10 g,
    drive: {{speed: 100 rad/s, ramp: 2 ms}}}}
  idler: {{center: [0 mm, 0 mm, 5 mm], axis: y, radius: 5 mm, width: 20 mm, mass: 5 g,
    press: {{direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}}}
contacts:
  - {{between: ["?", motor], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s}}
  - {{between: ["?", idler], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s}}
run: {{duration: 20 ms, print_step: 0.1 ms}}
"""
STOPPED = ("rollers.idler.drive={speed: 0 rad/s}", "contacts.0.friction=0.2")


def solved(text: str, solver: str, *overrides: str) -> Result:
    return ran.solved(lower(loads(text, "nip", overrides)), solver)


@lru_cache
def transport(name: str) -> Result:
    result = mdlgen.solve(lower(load(samples() / f"{name}.yaml")), "lattice")
    assert as_asked(result), result.status
    return result


def of(found: list[Event], kind: str, roller: str = "", sheet: str = "") -> list[Event]:
    return [e for e in found if e["kind"] == kind and e["roller"].startswith(roller) and sheet in e["sheet"]]


def times(found: list[Event], kind: str, roller: str = "") -> list[float]:
    return [e["time_ms"] for e in of(found, kind, roller)]


def test_an_interval_outlasts_short_breaks_and_grazes() -> None:
    time = np.arange(0.0, 10.0, 0.25)

    def held(*spans: tuple[float, float]) -> list[tuple[float, float]]:
        holds = np.zeros(len(time), bool)
        for low, high in spans:
            holds |= (time >= low) & (time <= high)
        return [(float(time[a]), float(time[b])) for a, b in intervals(time, holds, SHORT)]

    assert held() == [] and held((0.0, 9.75)) == [(0.0, 9.75)]
    assert held((2.0, 2.25)) == [] and held((2.0, 3.0)) == [(2.0, 3.0)]
    assert held((2.0, 3.0), (3.75, 5.0)) == [(2.0, 5.0)]  # off for less than 1 ms
    assert held((2.0, 3.0), (4.5, 6.0)) == [(2.0, 3.0), (4.5, 6.0)]
    assert held((0.0, 0.25), (9.5, 9.75)) == [(0.0, 0.25), (9.5, 9.75)]  # longer than is seen


def test_the_note_goes_from_row_1_to_row_2() -> None:
    """Row 2 is 38.5 mm ahead of the leading edge, row 1 47 mm from the trailing one: of boxes that touch a
    roller 0.85 mm beside its contact line."""
    result = transport("transport_4x4")
    found, place = events(result), result.sheet_motion(0)[0][:, 0]
    for name in ("motor", "counter"):
        assert times(found, "enter", f"{name}_1") == [0.0, 0.0]
        for kind, row, due in (("enter", 2, 38.5), ("leave", 1, 47.0)):
            at = times(found, kind, f"{name}_{row}")
            assert len(at) == 2 and at[0] == at[1]
            moved = float(np.interp(at[0], result.time, place)) - place[0]
            # half a box, half of the nip's length of 1.7 mm, and what it goes between two stored states
            assert abs(moved - due) < 0.85 + 0.87 + 0.35
        assert not of(found, "leave", f"{name}_2")
    assert 28.0 < times(found, "enter", "motor_2")[0] < 30.0  # the paper: about 30 ms
    assert 35.0 < times(found, "leave", "motor_1")[0] < 38.0
    assert of(found, "enter", "motor_2")[0]["speed_mm_per_s"] == pytest.approx(1400, rel=0.02)
    # row 1 pulls the note along, and row 2 has to catch it
    for event in of(found, "slip", "motor"):
        assert 0.0 < event["part_of_surface_speed"] < 0.02
        assert event["mean_mm_per_s"] < event["max_mm_per_s"] < 150.0  # as row 2 catches it
    assert of(found, "slip", "motor_1")[0]["contact_ms"] == times(found, "leave", "motor_1")[0] - 0.25
    assert not of(found, "jam") and not of(found, "double_feed") and not of(found, "gap")
    assert [e["time_ms"] for e in found] == sorted(e["time_ms"] for e in found)
    assert result.summary()["events"] == json.loads(json.dumps(found))


def test_without_counter_rollers_row_1_slips_and_jams_nothing() -> None:
    """Paper 4.2: the note creeps, and reaches row 2 after 90 to 130 ms."""
    found = events(transport("transport_4x2"))
    entered = times(found, "enter", "motor_2")
    assert len(entered) == 2 and 90.0 < entered[0] < 130.0
    # once row 2 pulls, the note is as fast as row 1, which it may still touch
    alone = [e for e in of(found, "slip", "motor_1") if e["time_ms"] < entered[0]]
    assert alone and all(e["part_of_surface_speed"] > 0.5 for e in alone)
    assert all(e["part_of_surface_speed"] < 0.05 for e in of(found, "slip", "motor_2"))
    assert not of(found, "jam")  # no roller presses the note onto row 1
    assert min(times(found, "leave", "motor_1")) < entered[0]


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_a_stopped_roller_makes_a_jam(solver: str) -> None:
    found = events(solved(NIP, solver, *STOPPED))
    (jam,) = of(found, "jam")
    assert (jam["sheet"], jam["roller"]) == ("a", "motor")
    assert jam["time_ms"] < 1.0 and jam["duration_ms"] > 18.0 and abs(jam["part_of_surface_speed"]) < 0.02
    assert jam["held_by"] == ["idler"]
    (slip,) = of(found, "slip", "motor")
    assert slip["max_mm_per_s"] == pytest.approx(750, rel=0.02)
    assert slip["part_of_surface_speed"] == pytest.approx(1.0, abs=0.02)
    (held,) = of(found, "slip", "idler")
    assert held["mean_mm_per_s"] < 10.0 and "part_of_surface_speed" not in held


def test_a_jam_lasts_longer_than_a_stated_time_and_is_of_a_roller_that_turns() -> None:
    free = events(solved(NIP, "lattice"))
    assert not of(free, "jam")
    short = events(solved(NIP, "lattice", *STOPPED, f"run.duration={JAM_END - 0.5} ms"))
    assert not of(short, "jam") and of(short, "wait")
    shorter = events(solved(NIP, "lattice", *STOPPED, f"run.duration={WAIT} ms"))
    assert not of(shorter, "jam") and not of(shorter, "wait")
    stands = (*STOPPED, "rollers.motor.drive={speed: 0 rad/s}")
    assert not of(events(solved(NIP, "lattice", *stands)), "jam")
    # stopped for the first 8 ms alone
    later = "rollers.idler.drive={profile: [[8 ms, 0 rad/s], [9 ms, -150 rad/s]]}"
    found = events(solved(NIP, "lattice", *STOPPED, later))
    (wait,) = of(found, "wait")
    # the idler takes the sheet along by its friction: 75 mm/s are reached after a tenth of a millisecond
    assert 7.0 < wait["time_ms"] + wait["duration_ms"] < 8.0 + 1.0 and JAM_PART == 0.1
    assert not of(found, "jam")  # it went on
    # and where that took longer than a sensor waits for a sheet
    ends, begins = JAM_LONG + 5.0, JAM_LONG + 6.0
    late = later.replace("8 ms,", f"{ends} ms,").replace("9 ms,", f"{begins} ms,")
    found = events(solved(NIP, "lattice", *STOPPED, late, f"run.duration={JAM_LONG + 20.0} ms"))
    assert of(found, "jam") and not of(found, "wait")


def test_the_gap_between_two_sheets_is_reported_where_the_second_enters() -> None:
    """Two of 40 mm, 45 mm apart; both in nips that run at 750 mm/s."""
    second = f"sheets.b={{{SHEET}, center: [-45 mm, 0 mm, 0 mm], velocity: [0.75 m/s, 0 m/s, 0 m/s]}}"
    first = "sheets.a.velocity=[0.75 m/s, 0 m/s, 0 m/s]"
    run = ("run.duration=50 ms", "run.step=0.02 ms", "rollers.motor.drive={speed: 100 rad/s}")
    # between the two the rollers lie on each other: the idler may not fall into the gap
    closed = "  - {between: [motor, idler], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s}\nrun:"
    result = solved(NIP.replace("run:", closed), "lattice", second, first, *run)
    found = events(result)
    gaps = of(found, "gap")
    assert {g["roller"] for g in gaps} == {"motor", "idler"} and len(gaps) == 2
    for gap in gaps:
        assert (gap["sheet"], gap["before"]) == ("b", "a")
        assert gap["time_ms"] == of(found, "enter", gap["roller"], "b")[0]["time_ms"]
        assert gap["gap_mm"] == pytest.approx(5.0, abs=0.1)
        left = of(found, "leave", gap["roller"], "a")[0]["time_ms"]
        assert gap["gap_ms"] == pytest.approx(gap["time_ms"] - left)
        assert 0.0 < gap["gap_ms"] < 5.0 / 0.75
    assert not of(found, "double_feed")


def test_two_sheets_in_one_nip_are_a_double_feed_and_two_beside_each_other_are_not() -> None:
    over = (f"sheets.b={{{SHEET}, center: [-10 mm, 0 mm, 0.1 mm]}}", "rollers.idler.center.2=5.2 mm")
    law = "stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s"
    text = NIP.replace("run:", f"  - {{between: [a, b], {law}}}\nrun:")
    found = events(solved(text, "lattice", *over, "run.duration=10 ms", "run.step=0.05 ms"))
    both = of(found, "double_feed")
    assert both and all({e["sheet"], e["other"]} == {"a", "b"} for e in both)
    assert min(e["time_ms"] for e in both) < 2.0 and max(e["duration_ms"] for e in both) > 5.0
    longest = max(both, key=lambda e: e["way_mm"])
    assert 0.0 < longest["way_mm"] <= 0.75 * (longest["duration_ms"] + 1.0)
    beside = f"sheets.b={{{SHEET}, center: [0 mm, 31 mm, 0 mm]}}"
    wide = ("rollers.motor.width=90 mm", "rollers.idler.width=90 mm")
    result = solved(NIP, "lattice", beside, *wide, "run.duration=10 ms")
    found = events(result)
    assert {e["sheet"] for e in of(found, "enter")} == {"a", "b"}
    assert not of(found, "double_feed")


def test_what_ends_at_its_start_has_no_events() -> None:
    result = solved(NIP, "lattice", "run.duration=1 ms")
    result.time = result.time[:1]
    assert events(result) == []


# Cards on a table, under a roller that drives the upper one against a gate: as ../shared/cases/jam_at_a_gate.
GATE = """
name: gate
materials: {pvc: {E_md: 2500 MPa, E_cd: 2500 MPa, D_md: 5.6 N*mm, D_cd: 5.6 N*mm}}
sheets:
  card: {material: pvc, size: [60 mm, 40 mm], thickness: 0.5 mm, density: 1.3 g/cm^3, boxes: [3, 2],
    layout: plate, center: [0 mm, 0 mm, 0.25 mm]}
piles: {deck: {of: card, count: 2, contact: {stiffness: 2000 N/mm^1.5, friction: 0.3}}}
rollers:
  pick: {center: [10 mm, 0 mm, 11 mm], axis: y, radius: 10 mm, width: 20 mm, mass: 20 g,
    drive: {surface_speed: 150 mm/s, direction: DIRECTION, ramp: 5 ms},
    press: {direction: -z, stiffness: 0.2 N/mm, preload: 1 N, damping_ratio: 0.3}}
planes:
  tray: {center: [60 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 80 mm, 10 mm]}
  gate: {center: [35.1 mm, 0 mm, 6 mm], normal: -x, size: [10 mm, 60 mm, 10 mm]}
contacts:
  - {between: ["deck_*", pick], stiffness: 300 N/mm^1.5, friction: 0.9, smoothing: 5 mm/s}
  - {between: ["deck_*", tray], stiffness: 300 N/mm^1.5, friction: 0.25}
  - {between: ["deck_*", gate], stiffness: 300 N/mm^1.5, friction: 0.2}
run: {duration: 60 ms, print_step: 0.5 ms, tolerance: 0.01}
require: [no jam]
"""


@lru_cache
def gate(direction: str, *overrides: str) -> Result:
    result = mdlgen.solve(lower(loads(GATE.replace("DIRECTION", direction), "gate", overrides)), "lattice")
    assert result.ok, result.status
    return result


def test_a_card_at_a_gate_is_jammed() -> None:
    """One roller alone holds it there, and slips."""
    result = gate("+x")
    (jam,) = of(events(result), "jam")
    assert (jam["sheet"], jam["roller"]) == ("deck_2", "pick")
    assert jam["duration_ms"] > 45.0 and sorted(jam["held_by"]) == ["deck_1", "gate"]
    found = result.summary()["verdict"]
    assert not found["passed"]
    (said,) = found["events"]  # and no slip of the same card there
    assert said.startswith("jam of deck_2 at pick from ") and "held by " in said and "gate" in said
    at_the_gate = gate("+x", "require=[no jam at gate, no jam at tray]").summary()["verdict"]["requirements"]
    assert [row["passed"] for row in at_the_gate] == [False, True]


def test_a_card_that_is_driven_away_from_the_gate_is_not_jammed() -> None:
    """It goes, and the card below it stays or goes with it: neither is held."""
    result = gate("-x")
    assert result.summary()["sheets"]["deck_2"]["travel_mm"][0] < -3.0
    assert not of(events(result), "jam") and not of(events(result), "wait")


def test_where_the_drive_stands_nothing_is_jammed() -> None:
    """It brings the card to the gate, stops, and presses on."""
    stops = "rollers.pick.drive={profile: [[0 ms, -15 rad/s], [8 ms, -15 rad/s], [9 ms, 0 rad/s]]}"
    found = events(gate("+x", stops))
    assert not of(found, "jam")


def test_a_sheet_that_only_creeps_up_to_speed_is_not_jammed() -> None:
    """A weak roller speeds it up by its friction, through a tenth of its own speed long after 50 ms."""
    weak = ("rollers.pick.press.preload=0.02 N", "run.duration=40 ms", "piles.deck.count=1")
    fast = "rollers.pick.drive={surface_speed: 3 m/s, direction: -x, ramp: 5 ms}"
    result = gate("-x", *weak, fast, "contacts.1.friction=0", "contacts.0.friction=0.03")
    speed = abs(result.summary()["sheets"]["deck_1"]["speed_mm_per_s"][0])
    assert 50.0 < speed < 300.0
    assert not of(events(result), "jam") and not of(events(result), "wait")


def test_a_roller_that_turns_against_a_sheet_that_goes_does_not_jam_it() -> None:
    """The idler is driven against the sheet's way, at a low friction: the motor takes the sheet through."""
    retard = ("rollers.idler.drive={speed: 50 rad/s}", "contacts.1.friction=0.1", "run.duration=30 ms")
    found = events(solved(NIP, "lattice", *retard))
    assert not of(found, "jam") and not of(found, "wait")
    (slip,) = of(found, "slip", "idler")
    assert slip["part_of_surface_speed"] > 1.0


def test_a_clamped_sheet_that_a_roller_rubs_is_not_jammed() -> None:
    clamped = "sheets.a.clamp={edge: x_min}"
    found = events(solved(NIP, "lattice", clamped, "contacts.0.friction=0.2"))
    assert of(found, "slip", "motor") and not of(found, "jam") and not of(found, "wait")
