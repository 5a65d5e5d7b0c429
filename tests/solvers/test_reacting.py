"""Machines that react, in both solvers: times of edges by closed forms, orders that are carried out when they
are due, runs that a rule ends, and that go on from a checkpoint as they would have."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from reacting import falling, wheel

import mdlgen
from mdlgen.backends.exudyn_local.solve import solve as exudyn
from mdlgen.backends.lattice.run import solve as lattice
from mdlgen.runs.checkpoint import Checkpointer

SOLVERS = pytest.mark.parametrize("solver", [lattice, exudyn], ids=["lattice", "exudyn"])
STOP = {"when": "eye covered", "after": "3 ms", "do": {"speed": {"w": {"speed": "0 rad/s", "ramp": "4 ms"}}}}


def at(result, kind: str = "covered") -> list[float]:
    return [row["time_ms"] for row in result.reactions if row["kind"] == kind]


@SOLVERS
def test_edges_are_where_a_falling_note_is(solver) -> None:
    # x = a t^2 / 2; the trailing edge is 60 mm behind, and clears 0.01 mm later (hysteresis)
    h, model = 0.5, falling([], run={"duration": "320 ms"})
    result = solver(model, step=h)
    exact = [math.sqrt(2.0 * way / 0.002) for way in (10.0, 40.0)]
    # between the ends of a step a line stands for the parabola: off by a h^2 / 8, over the speed
    for times, ways in ((at(result), (10.0, 40.0)), (at(result, "cleared"), (70.01, 100.01))):
        for time, way in zip(times, ways, strict=True):
            speed = math.sqrt(2.0 * 0.002 * way)
            assert abs(time - speed / 0.002) <= 0.002 * h * h / 8.0 / speed + 1e-6
    row = next(row for row in result.reactions if row["sensor"] == "far")
    assert row["speed_mm_per_s"] == pytest.approx(2.0 * exact[1], rel=0.01)


@SOLVERS
def test_a_sensor_changes_nothing(solver) -> None:
    model = falling([])
    blind = replace(model, reactions=type(model.reactions)())
    seen, unseen = solver(model, step=1.0), solver(blind, step=1.0)
    assert np.array_equal(seen.position, unseen.position)
    assert not unseen.reactions


@SOLVERS
def test_a_drive_is_told_when_it_is_due(solver) -> None:
    result = solver(wheel([STOP]), step=0.5)
    edge = math.sqrt(2.0 * 10.0 / 0.002)
    ordered = at(result, "rule")[0]
    assert ordered == pytest.approx(edge + 3.0, abs=1e-3)
    omega = result.spin[:, 1] @ result.model.rollers[0].axis
    expected = np.interp(result.time, [ordered, ordered + 4.0], [0.1, 0.0])
    assert omega == pytest.approx(expected, abs=1e-9)
    assert abs(result.energy.balance_error) < 1e-9


@SOLVERS
def test_events_do_not_hang_on_the_times_that_are_stored(solver) -> None:
    few, many = (
        solver(replace(m, run=replace(m.run, print_step=p)), step=0.5)
        for m, p in ((wheel([STOP]), 125.0), (wheel([STOP]), 2.5))
    )
    assert at(few) == pytest.approx(at(many), rel=1e-12)
    assert at(few, "rule") == pytest.approx(at(many, "rule"), rel=1e-12)


@SOLVERS
def test_a_rule_ends_a_run_well(solver) -> None:
    result = solver(falling([{"when": "far covered", "after": "1 ms", "do": {"end": True}}]))
    assert result.ok
    assert result.time[-1] == pytest.approx(math.ceil((200.0 + 1.0) / 1.25) * 1.25)
    assert result.model.run.duration == pytest.approx(result.time[-1])
    assert result.error_estimate is not None


def test_both_solvers_see_the_same_within_the_estimate() -> None:
    model = mdlgen.lower(
        mdlgen.load(
            "samples/register.yaml", ["sheets.note.boxes=[5,2]", "run.duration=36 ms", "run.tolerance=0.01"]
        )
    )
    one, two = lattice(model), exudyn(model)
    kinds = [row["kind"] for row in one.reactions]
    assert [row["kind"] for row in two.reactions] == kinds == ["covered", "rule"]
    apart = [abs(a["time_ms"] - b["time_ms"]) for a, b in zip(one.reactions, two.reactions, strict=True)]
    # the note goes at 1.4 mm/ms; what it is relative to is its travel
    allowed = (one.error_estimate + two.error_estimate) * 40.0 / 1.4
    assert max(apart) < allowed


def test_a_run_that_is_gone_on_with_reacts_as_it_would_have(tmp_path) -> None:
    model = wheel([STOP, {"when": "far covered", "do": {"speed": {"w": "7 rad/s"}}}])
    whole = lattice(model, step=0.5)

    class Enough(Exception):
        pass

    def stopped(t: float, *_: object) -> None:
        if t > 103.5:  # the drive slows down
            raise Enough

    (tmp_path / "kept").mkdir()
    keep = Checkpointer(tmp_path / "kept", every=0.0)
    with pytest.raises(Enough):
        lattice(model, step=0.5, progress=stopped, keep=keep)
    on = lattice(model, step=0.5, keep=Checkpointer(tmp_path / "kept", every=0.0))
    assert on.reactions == whole.reactions
    assert np.array_equal(on.position, whole.position)
    assert np.array_equal(on.spin, whole.spin)


@SOLVERS
def test_a_gate_goes_where_a_rule_sends_it(solver) -> None:
    # it is sent on while it is under way, with the speed that it has
    rules = [
        {"when": "eye covered", "after": "2 ms", "do": {"move": {"gate": {"to": "open", "in": "20 ms"}}}},
        {"when": "eye covered", "after": "12 ms", "do": {"move": {"gate": {"to": "1 mm", "in": "10 ms"}}}},
    ]
    positions = {"open": "4 mm", "closed": "0 mm"}
    gate = {"center": ["0 mm", "0 mm", "-30 mm"], "normal": "z", "size": ["9 mm", "9 mm", "2 mm"]}
    gate["slide"] = {"direction": "z", "positions": positions}
    result = solver(falling(rules, planes={"gate": gate}, run={"duration": "150 ms"}), step=0.5)
    first, second = at(result, "rule")
    assert (first, second) == pytest.approx((102.0, 112.0), abs=1e-3)
    place = result.position[:, 1, 2] + 30.0
    s = np.clip((result.time - first) / 20.0, 0.0, 1.0)
    ease = 4.0 * s * s * (3.0 - 2.0 * s)
    before = result.time < second
    assert place[before] == pytest.approx(ease[before], abs=1e-6)
    # from the middle of its way with the speed that it has there, 4 mm * 1.5 / 20 ms
    r = np.clip((result.time - second) / 10.0, 0.0, 1.0)
    on = 2.0 - r * r * (3.0 - 2.0 * r) + 10.0 * 0.3 * r * (1.0 - r) ** 2
    assert place[~before] == pytest.approx(on[~before], abs=1e-4)


@SOLVERS
def test_the_next_note_comes_when_the_one_before_has_gone_by(solver) -> None:
    rules = [
        {"when": "count(eye) == 0", "after": "5 ms", "do": {"enter": "infeed"}},
        {"when": "eye clear and count(eye) > 0", "after": "3 ms", "do": {"enter": "infeed"}},
    ]
    stream = {"infeed": {"of": "note", "by_rule": True, "count": 3, "out": "beyond x = 45 mm"}}
    result = solver(falling(rules, streams=stream, run={"duration": "560 ms"}), step=1.0)
    # each begins at rest; its trailing edge is 70 mm behind the eye, and 0.01 mm of hysteresis
    gone = math.sqrt(2.0 * 70.01 / 0.002)
    assert result.stays is not None
    assert result.stays[:, 0] == pytest.approx([5.0, 8.0 + gone, 11.0 + 2.0 * gone], abs=3e-3)
    cleared = [r for r in result.reactions if r["kind"] == "cleared" and r["sensor"] == "eye"]
    assert [r["time_ms"] for r in cleared] == pytest.approx([5.0 + gone, 8.0 + 2.0 * gone], abs=2e-3)
    assert [r["sheet"] for r in cleared] == ["infeed_1", "infeed_2"]


def test_a_note_that_leaves_while_it_is_seen_covers_nothing_any_more() -> None:
    stream = {"infeed": {"of": "note", "every": "1 s", "count": 1, "out": "beyond x = 30 mm"}}
    result = lattice(falling([], streams=stream, run={"duration": "300 ms"}), step=1.0)
    assert result.stays is not None
    assert at(result, "cleared")[0] == pytest.approx(result.stays[0, 1], abs=1.0)


IDLER = {"center": ["0 mm", "0 mm", "-60 mm"], "axis": "y", "radius": "5 mm", "width": "5 mm", "mass": "1 g"}
PRESSED = IDLER | {"press": {"direction": "z", "stiffness": "1 N/mm", "preload": "1 N"}}
HARDER = {"when": "eye covered", "do": {"press": {"idler": "3 N"}}}


@SOLVERS
def test_a_spring_is_pressed_harder_and_energy_is_kept(solver) -> None:
    # from its balance at 1 mm it swings about 3 mm: x = 3 mm - 2 mm cos(omega t), little damped
    model = falling([HARDER], rollers={"idler": PRESSED}, run={"duration": "110 ms"})
    result = solver(model, step=0.05)
    way = result.position[:, 1, 2] + 60.0
    still = result.time < 100.0
    assert np.ptp(way[still]) < 1e-9
    assert np.ptp(way[~still]) > 3.0
    assert abs(result.energy.balance_error) < 1e-3


def test_a_pass_begins_with_what_the_scene_has_and_not_with_what_the_one_before_was_ordered() -> None:
    model = falling([HARDER], rollers={"idler": PRESSED}, run={"duration": "110 ms"})
    result = lattice(model, threads=1)  # passes one after the other, in the same arrays
    assert np.ptp(result.position[result.time < 99.0, 1, 2]) < 1e-9
    once = lattice(model, step=result.step, threads=1)
    assert np.array_equal(once.position, result.position)


def test_a_motor_that_a_rule_stops_does_not_stall() -> None:
    motor = {"torque": "20 N*mm", "speed": "50 rad/s"}
    own = IDLER | {"drive": {"motor": motor}}
    stop = {"when": "eye covered", "do": {"speed": {"m": "0 rad/s"}}}
    result = lattice(falling([stop], rollers={"m": own}, run={"duration": "200 ms"}), step=0.5)
    assert [event["kind"] for event in result.events if event["kind"] == "stall"] == []
    summary = result.summary()["rollers"]["m"]
    # it has come to rest, and has no torque any more
    assert abs(summary["omega_rad_per_s"]) < 1e-3
    assert abs(summary["torque_n_mm"]) < 1.0


def test_a_sheet_that_was_let_in_comes_after_a_run_is_gone_on_with(tmp_path) -> None:
    rules = [{"when": "time >= 20 ms", "after": "0.4 ms", "do": {"enter": "infeed"}}]
    stream = {"infeed": {"of": "note", "by_rule": True, "count": 1}}
    model = falling(rules, streams=stream, run={"duration": "40 ms", "print_step": "4 ms"})
    whole = lattice(model, step=0.5)

    class EnoughError(Exception):
        pass

    def stopped(t: float, *_: object) -> None:
        if t > 19.0:  # the rule is due, and the sheet has not come
            raise EnoughError

    (tmp_path / "kept").mkdir()
    with pytest.raises(EnoughError):
        lattice(model, step=0.5, progress=stopped, keep=Checkpointer(tmp_path / "kept", every=0.0))
    on = lattice(model, step=0.5, keep=Checkpointer(tmp_path / "kept", every=0.0))
    assert on.stays is not None and whole.stays is not None
    assert on.stays[0, 0] == whole.stays[0, 0] == pytest.approx(20.4, abs=1e-3)


@SOLVERS
def test_a_graded_note_askew_is_seen_where_its_edge_is(solver) -> None:
    turn, h = math.radians(7.0), 0.5
    note = {"boxes": [6, 3], "turn": "7 deg", "grading": {"x": [1, 1, 2, 4, 2, 2]}}
    result = solver(falling([], note=note, run={"duration": "150 ms"}), step=h)
    row = next(row for row in result.reactions if row["sensor"] == "eye")
    way = 40.0 - (30.0 - math.sin(turn)) / math.cos(turn)  # of the edge at y = 1 mm, to the beam
    speed = math.sqrt(2.0 * 0.002 * way)
    assert abs(row["time_ms"] - speed / 0.002) <= 0.002 * h * h / 8.0 / speed + 1e-6
    assert row["skew_deg"] == pytest.approx(7.0, abs=1e-3)
