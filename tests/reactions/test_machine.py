"""A machine along a motion that is known: when it looks, what it sees, which rules act and when."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from reacting import wheel

from mdlgen.model.tables import Model
from mdlgen.reactions.machine import Machine, RunawayError
from mdlgen.reactions.sensing import Poses

SPEED = 0.4  # [mm/ms]; the eye is 10 mm ahead of the leading edge


def poses(model: Model, t: float, acceleration: float = 0.0) -> Poses:
    bodies, n = model.bodies, len(model.bodies.name)
    u = np.zeros((n, 3))
    x = bodies.position.copy()
    x[0, 0] += SPEED * t + 0.5 * acceleration * t * t
    u[0, 0] = SPEED + acceleration * t
    return Poses(x, bodies.rotation.reshape(n, 9), u, np.zeros((n, 3)))


def followed(
    model: Model, step: float, end: float, acceleration: float = 0.0, machine: Machine | None = None
):
    """The machine, with what it ordered and the times at which it looked."""
    machine = machine or Machine(model, SPEED)
    t, orders, looked = 0.0, [], []
    ordered = machine.look(t, step, poses(model, t, acceleration))
    orders += [(t, order) for order in ordered]
    while t < end:
        t = min(machine.ahead(t, step, poses(model, t, acceleration)), end)
        ordered = machine.look(t, step, poses(model, t, acceleration))
        looked.append(t)
        orders += [(t, order) for order in ordered]
    return machine, orders, looked


def stop(**more):
    return {"when": "eye covered", "do": {"speed": {"w": "0 rad/s"}}, **more}


def test_a_delay_counts_from_the_edge() -> None:
    _, orders, looked = followed(wheel([stop(after="3 ms")]), 0.5, 60.0)
    assert [t for t, _ in orders] == pytest.approx([28.0], abs=1e-3 * 0.5)
    # away from the sensor it is not asked at each step
    assert len(looked) < 40


def test_a_wide_sheet_in_a_bend_is_not_looked_at_more_often() -> None:
    """A box that turns about its length across goes no faster than its short sides."""
    model = wheel([stop()], note={"size": ["10 mm", "400 mm"]})
    machine, still = Machine(model, SPEED), poses(model, 0.0)
    turning = still._replace(w=np.array([[0.0, 0.2, 0.0]] * len(model.bodies.name)))
    fastest = machine._fastest(machine._eyes[0], turning)
    assert fastest == pytest.approx(SPEED + 0.2 * math.hypot(5.0, 0.05), rel=1e-9)


def test_the_time_of_an_edge_is_second_order_in_the_step() -> None:
    a, model = 0.01, wheel([stop()])
    exact = (math.sqrt(SPEED**2 + 2.0 * a * 10.0) - SPEED) / a
    errors = []
    for step in (1.6, 0.8, 0.4):
        machine, orders, _ = followed(model, step, 60.0, a)
        assert orders[0][0] == pytest.approx(machine.log[0]["time_ms"], abs=2e-3 * step)
        errors.append(abs(machine.log[0]["time_ms"] - exact))
    # off by a h^2 / 2 over the speed at most
    for step, error in zip((1.6, 0.8, 0.4), errors, strict=True):
        assert error < 0.5 * a * step**2 / SPEED


def test_without_rules_an_edge_is_found_in_the_step_that_passed_it() -> None:
    a, model = 0.01, wheel([])
    exact = (math.sqrt(SPEED**2 + 2.0 * a * 10.0) - SPEED) / a
    for step in (1.6, 0.4):
        machine, _, _ = followed(model, step, 60.0, a)
        assert abs(machine.log[0]["time_ms"] - exact) < 0.5 * a * step**2 / SPEED


@pytest.mark.parametrize(
    ("rules", "times"),
    [
        ([{"when": "time > 7.3 ms", "do": {"speed": {"w": "1 rad/s"}}}], [7.3]),
        ([{"when": "note.x > 5 mm", "after": "0.2 ms", "do": {"speed": {"w": "1 rad/s"}}}], [12.7]),
        ([{"when": "since(eye) > 4 ms", "do": {"speed": {"w": "1 rad/s"}}}], [29.0]),
        ([{"when": "not eye covered", "do": {"speed": {"w": "1 rad/s"}}}], [0.0]),
        ([{"when": "count(eye) == 1 and note.x >= 16 mm", "do": {"speed": {"w": "1 rad/s"}}}], [40.0]),
        ([{"when": "w.omega > 1 rad/s", "do": {"speed": {"w": "1 rad/s"}}}], []),
    ],
)
def test_rules_act_when_their_condition_comes_true(rules, times) -> None:
    _, orders, _ = followed(wheel(rules), 0.5, 60.0)
    assert [t for t, _ in orders] == pytest.approx(times, abs=1e-3)


def test_once_is_once() -> None:
    blink = {"when": "note.x > 2 mm and note.x < 3 mm or note.x > 6 mm", "do": {"speed": {"w": "1 rad/s"}}}
    assert len(followed(wheel([blink]), 0.5, 30.0)[1]) == 2
    assert len(followed(wheel([blink | {"once": True}]), 0.5, 30.0)[1]) == 1


def test_states_say_which_rules_hold() -> None:
    rules = [
        {"when": "time > 1 ms", "in": "waits", "do": {"go": "runs"}},
        {"when": "eye covered", "in": "waits", "do": {"speed": {"w": "1 rad/s"}}},
        {
            "when": "eye covered",
            "in": ["runs", "ends"],
            "after": "2 ms",
            "do": {"speed": {"w": "2 rad/s"}, "go": "ends"},
        },
        {"when": "time > 0 ms", "in": "ends", "do": {"speed": {"w": "3 rad/s"}}},
    ]
    machine, orders, _ = followed(wheel(rules), 0.5, 60.0)
    assert [(round(t, 2), round(1e3 * order.value)) for t, order in orders] == [(27.0, 2), (27.0, 3)]
    assert [row["rule"] for row in machine.log if row["kind"] == "rule"] == [0, 2, 3]


def test_rules_that_chase_each_other_are_an_end() -> None:
    rules = [
        {"when": "time > 1 ms", "in": "a", "do": {"go": "b"}},
        {"when": "time > 1 ms", "in": "b", "do": {"go": "a"}},
    ]
    with pytest.raises(RunawayError, match=r"rules\.0 and rules\.1 set off each other at 1(\.\d+)? ms"):
        followed(wheel(rules), 0.5, 5.0)


def test_a_sensor_that_flickers_within_its_hysteresis_sees_one_sheet() -> None:
    model = wheel([stop()])
    machine = Machine(model, SPEED)
    t, step = 0.0, 0.1
    for k in range(200):
        # the edge trembles by 4 um about the beam
        at = poses(model, 0.0)
        at.x[0, 0] += 10.0 + 0.004 * math.sin(k)
        machine.ahead(t, step, at)
        machine.look(t, step, at)
        t += step
    assert [row["kind"] for row in machine.log] == ["covered", "rule"]


def test_what_is_kept_goes_on_as_before() -> None:
    model = wheel([stop(after="3 ms"), {"when": "far covered", "do": {"speed": {"w": "5 rad/s"}}}])
    whole, orders, _ = followed(model, 0.5, 120.0)
    first, before, _ = followed(model, 0.5, 26.0)
    second = Machine(model, SPEED)
    second.restore(json.loads(json.dumps(first.kept())))
    t = 26.0
    while t < 120.0:
        t = min(second.ahead(t, 0.5, poses(model, t)), 120.0)
        before += [(t, order) for order in second.look(t, 0.5, poses(model, t))]
    assert [order for _, order in before] == [order for _, order in orders]
    assert [t for t, _ in before] == pytest.approx([t for t, _ in orders], abs=1e-3)
    assert [row["kind"] for row in second.log] == [row["kind"] for row in whole.log]


@pytest.mark.parametrize(
    ("rules", "acted"),
    [
        # the first rule with a state has an in: the machine begins there
        ([{"in": "a", "do": {"go": "b"}}, {"in": "b", "do": {"go": "c"}}], [0, 1]),
        # it only goes to one: the machine is in none until then, so the rule of b acts after it
        ([{"do": {"go": "b"}}, {"in": "b", "do": {"go": "c"}}], [0, 1]),
        # without in a rule holds in each state, and where there is no rule of a state
        ([{"in": "a", "do": {"go": "done"}}, {"do": {"end": True}}], [0, 1]),
    ],
)
def test_the_first_rule_with_a_state_says_where_the_machine_begins(rules, acted) -> None:
    model = wheel([{"when": f"time > {k + 1} ms", **rule} for k, rule in enumerate(rules)])
    assert [row["rule"] for row in followed(model, 0.5, 5.0)[0].log if row["kind"] == "rule"] == acted


def test_rules_act_as_sheets_come_in_and_leave() -> None:
    stream = {"of": "note", "times": ["0 ms", "10 ms"], "out": "beyond x = 400 mm"}
    go = {"speed": {"w": "1 rad/s"}}
    rules = [
        {"when": "infeed_2 entered", "do": go},
        {"when": "left(infeed) == 1 and entered(infeed) == 2", "do": go},
        {"when": "infeed_2 left", "do": {"end": True}},
    ]
    model = wheel(rules, streams={"infeed": stream})
    machine = Machine(model, SPEED)

    def turned(t: float, there: list[bool]) -> list[int]:
        machine.there = np.array(there)
        ahead = machine.ahead(t, 0.5, poses(model, t))
        assert ahead == pytest.approx(t + 5e-4), "it looks at once"
        return [row["rule"] for row in machine.log]

    machine.there = np.array([True, False])
    machine.look(0.0, 0.5, poses(model, 0.0))
    for t, there in ((10.0, [True, True]), (20.0, [False, True]), (30.0, [False, False])):
        turned(t, there)
        machine.look(t + 5e-4, 0.5, poses(model, t))
        machine.restore(json.loads(json.dumps(machine.kept())))
        assert machine.ahead(t + 5e-4, 0.5, poses(model, t)) > t + 0.4
    assert [row["rule"] for row in machine.log if row["kind"] == "rule"] == [0, 1, 2] and machine.ended


def test_times_ahead_are_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    rules = [{"when": "time > 50 ms or note.vx < 0 m/s and eye covered", "do": {"end": True}}]
    rules += [{"when": "time > 52 ms", "do": {"speed": {"w": "1 rad/s"}}}]
    asked: list[int] = []
    own = Machine._changed

    def counted(machine: Machine, which, t, at) -> bool:
        asked.append(len(which))
        return own(machine, which, t, at)

    monkeypatch.setattr(Machine, "_changed", counted)
    _, orders, looked = followed(wheel(rules), 0.5, 60.0)
    assert [t for t, order in orders if order.kind == "speed"] == pytest.approx([52.0], abs=1e-3)
    # the first rule is asked at each step; the second one 64 steps ahead at once, and once more after an edge
    assert len(asked) < 3 * len(looked) + 400
