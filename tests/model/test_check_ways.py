"""Lints of rollers that turn the wrong way or touch nothing, of soft contacts, and what a run costs."""

from __future__ import annotations

import json
import time
from dataclasses import replace
from typing import Any

import pytest
import ran
from typer.testing import CliRunner

import mdlgen
from mdlgen.checks import Lint, lints
from mdlgen.cli import app
from mdlgen.explain import explain
from mdlgen.lints.cost import cost, duration
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.spec.load import load

NEW = ("W123", "W124", "W129", "W133", "W134")


def found(sample: str, *sets: str) -> list[Lint]:
    made = lints(lower(load(samples() / f"{sample}.yaml", sets)))
    return [lint for lint in made if lint.code in NEW]


@pytest.mark.parametrize(
    ("sample", "sets", "code", "where", "said"),
    [
        (
            "transport_4x4",
            ["rollers.motor_1_left.drive.speed=-186.7 rad/s"],
            "W123",
            "motor_1_left",
            "along -x",
        ),
        # a note that has a place to come to, off a pile too
        (
            "feeder",
            ["rollers.prefeed.drive.speed=-15 rad/s"],
            "W123",
            "prefeed",
            "that of pull_motor along +x",
        ),
        ("retard_pad", ["rollers.pick.drive.speed=50 rad/s"], "W123", "feed", "that of pick along -x"),
        ("channel", ["rollers.motor.drive.speed=-133.333 rad/s"], "W124", "motor", "away from guide_inner"),
        ("channel", ["sheets.note.velocity=[-1 m/s, 0 m/s, 0 m/s]"], "W124", "motor", "that comes along -x"),
    ],
)
def test_a_roller_that_turns_the_wrong_way(
    sample: str, sets: list[str], code: str, where: str, said: str
) -> None:
    hit = next(lint for lint in found(sample, *sets) if lint.code == code)
    assert hit.where == f"rollers.{where}.drive" and said in hit.message
    assert str(hit).isascii() and explain(code)


def test_a_slow_roller_and_one_without_friction_may_turn_back() -> None:
    back = "rollers.motor_1_left.drive.speed=-100 rad/s"
    assert found("transport_4x4", back) == []
    smooth = ["rollers.motor_1_left.drive.speed=-186.7 rad/s", "contacts.4.friction=0"]
    assert found("transport_4x4", *smooth) == []


def test_a_sheet_that_leaves_what_it_lies_on_is_no_finding() -> None:
    """A nip that puts a sheet out of the channel that it is in: nothing is ahead, nothing wholly behind."""
    sets = ["rollers.motor.drive.speed=-133.333 rad/s", "sheets.note.center=[25 mm, 0 mm, 0 mm]"]
    assert "W124" not in {lint.code for lint in found("channel", *sets)}


def test_a_roller_that_touches_nothing() -> None:
    # its pressed counterpart follows it
    hits = found("transport_4x4", "rollers.motor_2_left.center.2=-370 mm")
    assert {(hit.code, hit.where) for hit in hits} == {
        ("W129", f"rollers.{name}_2_left.center") for name in ("motor", "counter")
    }
    assert "counter_2_left, note" in next(hit for hit in hits if "motor" in hit.where).message


def test_a_plane_that_a_sheet_falls_through() -> None:
    (hit,) = found("stack", "contacts.4.stiffness=1e-4 N/mm^1.5")
    assert (hit.code, hit.where) == ("W133", "contacts.4.stiffness")
    # the advice ends the finding, and the depth is a tenth of the thickness
    advised = hit.remedy.removeprefix("give ").split(" or more")[0]
    assert found("stack", f"contacts.4.stiffness={advised}") == []
    assert found("stack", "contacts.4.stiffness=1e-4 N/mm^1.5", "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]") == []


@pytest.mark.parametrize(
    ("sample", "value", "where"),
    [
        ("transport_4x4", "0.01 us", "run.step"),
        ("transport_4x4", "500 s", "run.duration"),
        ("verify/drop", "0.06 us", "run.print_step"),
        ("transport_4x4", "1e-9", "run.tolerance"),
        ("transport_4x4", "[200,200]", "sheets.note.boxes"),
    ],
)
def test_the_value_that_makes_a_run_long(sample: str, value: str, where: str) -> None:
    (hit,) = found(sample, f"{where}={value}")
    assert (hit.code, hit.where) == ("W134", where)


# transient samples that end within a few seconds
SHORT = (
    *("channel", "feeder_window", "guide_joint", "peel", "pick", "spring_plate", "stack"),
    *("transport_4x2", "transport_4x4", "transport_nips"),
    *("verify/drop", "verify/flip", "verify/incline", "verify/slide"),
)
# the search for a step halves it once more, or twice, where the estimate is just above the tolerance
HALVED_MORE = ("transport_4x2", "transport_nips", "verify/drop")


@pytest.mark.parametrize("sample", SHORT)
def test_steps_are_as_predicted_mostly_within_a_factor_of_two(sample: str) -> None:
    model = lower(load(samples() / f"{sample}.yaml"))
    answer, result = cost(model), ran.solved(model, "lattice")
    assert answer is not None
    within = 4.0 if sample in HALVED_MORE else 2.0
    assert answer.steps / 2 < result.steps < within * answer.steps


def test_time_grows_with_the_boxes_as_predicted_within_a_factor_of_two() -> None:
    """Processor time of this machine, whatever its speed, at one step: of the second half of a run, so that
    what each run takes as it begins does not count."""
    grown, said = [], []
    for boxes in ("[10,20]", "[20,40]"):
        times, costs = [], []
        for end in (10, 20):
            sets = [f"sheets.note.boxes={boxes}", "run.step=0.02 ms", f"run.duration={end} ms"]
            model = lower(load(samples() / "transport_4x4.yaml", sets))
            times.append(min(_took(model) for _ in range(5)))
            costs.append(cost(model))
        grown.append(times[1] - times[0])
        said.append(costs[1].seconds - costs[0].seconds)
    assert said[1] / said[0] / 2 < grown[1] / grown[0] < 2 * said[1] / said[0]


def _took(model: Model) -> float:
    began = time.process_time()
    assert mdlgen.solve(model, "lattice").usable
    return time.process_time() - began


def test_a_cost_grows_with_boxes_pairs_and_duration() -> None:
    model = lower(load(samples() / "transport_4x4.yaml"))
    base = cost(model)
    longer = cost(replace(model, run=replace(model.run, duration=10 * model.run.duration)))
    finer = cost(lower(load(samples() / "transport_4x4.yaml", ["sheets.note.boxes=[20,40]"])))
    assert base and longer and finer
    assert 5 * base.seconds < longer.seconds < 11 * base.seconds and abs(longer.steps - 10 * base.steps) <= 10
    assert finer.seconds > 3.5 * base.seconds and finer.steps == base.steps


def test_a_cost_has_what_is_outside_the_kernels() -> None:
    # of sorter that is nearly all: a few boxes, and rules that are asked at each step
    model = lower(load(samples() / "sorter.yaml"))
    blind, whole = cost(replace(model, reactions=type(model.reactions)())), cost(model)
    assert blind and whole and whole.seconds > 1.0 and whole.seconds > 2.0 * blind.seconds


@pytest.mark.parametrize(
    ("seconds", "said"),
    [
        (0.2, "less than 1 s"),
        (2.4, "about 2 s"),
        (43.0, "about 43 s"),
        (150.0, "about 2 min"),
        (7000.0, "about 2 h"),
        (1e6, "about 12 days"),
    ],
)
def test_a_time_in_words(seconds: float, said: str) -> None:
    assert duration(seconds) == said


def test_check_says_what_a_run_takes() -> None:
    file = str(samples() / "feeder.yaml")
    assert (
        "a run takes about 14 s, some 10000 steps, mostly within a factor of 2"
        in CliRunner().invoke(app, ["check", file]).stdout
    )
    answer: Any = json.loads(CliRunner().invoke(app, ["check", file, "--json"]).stdout)
    assert answer["cost"]["steps"] == 12000 and 10.0 < answer["cost"]["seconds"] < 30.0


def test_air_counts() -> None:
    film = "contacts.6.air={viscosity: 18.2 uPa*s}"
    grids = [f"sheets.note_{k}.boxes=[40,40]" for k in (1, 2)]
    plain, with_air = (cost(lower(load(samples() / "feeder.yaml", sets))) for sets in (grids, [*grids, film]))
    assert plain and with_air and plain.steps == with_air.steps
    assert with_air.seconds > 1.3 * plain.seconds


def test_sheets_that_a_rule_lets_in_count() -> None:
    # with so many boxes that rules and storage take little of the time
    sets = ["sensors={}", "require=[]", "rules=[{when: time >= 0 ms, do: {enter: infeed}}]"]
    sets += ["sheets.note.boxes=[20,20]"]
    one, three = (
        cost(lower(load(samples() / "sorter.yaml", [*sets, f"streams.infeed.count={k}"]))) for k in (1, 3)
    )
    # each of them is there for a third of the run
    assert one and three and three.seconds > 1.5 * one.seconds


def test_air_is_named_where_it_makes_a_run_long() -> None:
    assert ("W134", "contacts.landing.air") in [
        (hit.code, hit.where) for hit in found("landing", "run.duration=5 s", "run.step=30 us")
    ]
