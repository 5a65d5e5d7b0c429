"""A run leaves an answer: within the tolerance, or marked with what is known of its error."""

from __future__ import annotations

import re
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mdlgen
from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice import watches
from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.lattice.kernels import tuning
from mdlgen.backends.lattice.kernels.tuning import HELD_UP, REPORTED
from mdlgen.model.tables import Model
from mdlgen.results import chaos
from mdlgen.results.quantities import differences
from mdlgen.results.result import Result

CASES = Path(__file__).parents[1] / "cases"
LIMIT = 1.5  # [s]


def case(name: str, *sets: str) -> Model:
    return mdlgen.lower(mdlgen.load(CASES / f"{name}.yaml", sets))


def thrown(*sets: str) -> Model:
    """With fewer boxes: a search of it has six passes."""
    return case("thrown", "sheets.n.boxes=[7,3]", *sets)


def turned(result: Result) -> np.ndarray:
    """The x axis of the block at the end."""
    w, x, y, z = result.rotation[-1, 0]
    return np.array([w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)])


@pytest.mark.parametrize("step", [10.0, 15.0, 16.0, 20.0, 30.0, 60.0])
def test_a_step_that_the_solver_divides_is_compared_with_finer_ones(step: float) -> None:
    """Steps of 10 and 20 ms are both divided to the same 135. The two agree to 1e-9, and the turn is off
    by degrees."""
    result = mdlgen.solve(case("short_step", f"run.step={step} ms"), "lattice")
    exact = mdlgen.solve(case("short_step", "run.step=0.01 ms"), "lattice")
    off = float(np.linalg.norm(turned(result) - turned(exact)))
    assert off > 0.01  # rad: far above what the tolerance allows
    assert result.status == "inaccurate" and result.usable and not result.ok
    assert result.error_estimate is None or result.error_estimate > result.model.run.tolerance
    assert result.error_unknown.startswith("the error is not known: a run at finer steps differs")


def test_a_step_that_is_fine_is_within_the_tolerance() -> None:
    result = mdlgen.solve(case("short_step", "run.step=0.05 ms"), "lattice")
    exact = mdlgen.solve(case("short_step", "run.step=0.01 ms"), "lattice")
    assert result.ok and result.error_estimate is not None
    half = float(np.linalg.norm(result.model.bodies.half[0]))
    off = half * float(np.linalg.norm(turned(result) - turned(exact))) / 6.0  # of a tenth of the length
    assert off < 2.0 * result.error_estimate


def test_two_runs_that_agree_by_accident_do_not_hide_an_error() -> None:
    """Runs at 0.2 and 0.1 ms differ by 0.12 of the tolerance, and the finer one is off by 0.62 of it."""
    result = mdlgen.solve(case("arms"), "lattice")
    exact = lattice.solve(result.model, step=result.step / 8)
    found = differences(result, exact, judged=True)["sheets.n.position"]
    assert result.ok and result.error_estimate is not None
    assert 0.2 * result.model.run.tolerance < found.value < result.error_estimate


def test_one_rule_ends_the_search() -> None:
    """A sheet held at a corner gains 4e-5 of its energy, by a rule that is second to its tolerance."""
    result = mdlgen.solve(case("held_corner"), "lattice")
    assert result.ok, result.status
    assert result.error_estimate is not None and result.error_estimate <= result.model.run.tolerance


def test_a_sheet_that_is_thrown_keeps_its_best_run_and_says_that_it_is_chaotic() -> None:
    """No step down to a 32nd of the first one brings it within the tolerance."""
    result = mdlgen.solve(thrown(), "lattice")
    assert result.status == "inaccurate" and result.time[-1] == pytest.approx(result.model.run.duration)
    assert result.error_estimate is None or result.error_estimate > result.model.run.tolerance
    assert "was tried" in result.search_ended
    record = result.summary()
    assert record["mark"].startswith("inaccurate: the error ") and "sheets.n.position" in record["mark"]
    assert result.chaotic is not None and record["chaotic"]["quantity"] == "sheets.n.position"
    assert result.chaotic.apart > 10.0 * result.chaotic.start_mm
    assert 'mdlgen sweep SPEC --over "sheets.n.center.0=' in record["chaotic"]["in_words"]


def test_a_search_ends_where_the_motion_is_chaotic(monkeypatch: pytest.MonkeyPatch) -> None:
    """After three halvings runs from slightly different starts part by as much as half the step changes, and
    two finer steps are left out. The starts differ by 0.01 mm here: how far runs of a chaotic scene part from
    a smaller difference depends on the last bit of a processor's arithmetic."""
    monkeypatch.setattr(chaos, "START", 1e-2)
    monkeypatch.setattr(chaos, "falls", lambda *_: False)
    result = mdlgen.solve(case("retard"), "lattice")
    found = result.chaotic
    assert result.status == "inaccurate" and found is not None
    assert found.apart > 0.5 * found.step_apart > 0.0
    assert result.step > 2.0 * lattice.first_step(result.model) / 2**lattice.MOST_REFINED
    assert "was tried" in result.search_ended


def passes(
    monkeypatch: pytest.MonkeyPatch,
    walls: list[float],
    fails: tuple[int, ...] = (),
    reason: str = "it ended early",
) -> list[float]:
    """Steps of the passes of a search from now on, which seem to take such wall times [s] in turn; those in
    `fails` seem to end early for that reason, each later than the one before."""
    steps: list[float] = []
    of_one = lattice.one_pass

    def seen(*args: Any, **named: Any) -> Any:
        result = of_one(*args, **named)
        k = len(steps)
        steps.append(result.step)
        result = replace(result, wall_s=walls[k])
        if k in fails:
            kept = {name: getattr(result, name)[: 10 * (k + 1)] for name in ("time", "position", "rotation")}
            result = replace(result, **kept).failed(reason)
        return result

    monkeypatch.setattr(lattice, "one_pass", seen)
    return steps


@pytest.mark.parametrize(
    ("walls", "fails", "times", "says"),
    [
        # a single pass is compared with one at twice its step
        ([25.0, 12.0, 6.0], (), (1, 2), "left no time for a finer step"),
        ([5.0, 11.0, 30.0], (), (1, 0.5, 0.25), "left no time for a finer step"),
        # the second takes five times as long: the third would take 60 s
        ([2.4, 12.0, 1.0], (), (1, 0.5), "left no time for a finer step"),
        # how long one took that ended early says nothing about the next one
        ([0.1, 4.0, 8.0, 40.0], (0,), (1, 0.5, 0.25, 0.125), "left no time for a finer step"),
    ],
)
def test_a_search_has_a_time_of_its_own(
    monkeypatch: pytest.MonkeyPatch,
    walls: list[float],
    fails: tuple[int, ...],
    times: tuple[float, ...],
    says: str,
) -> None:
    """Without run.limit a search begins no finer pass with which all would take more than a minute."""
    monkeypatch.setattr(chaos, "falls", lambda *_: True)  # no further pass from another start
    steps = passes(monkeypatch, [*walls, *[0.0] * 9], fails)
    model = thrown()
    result = mdlgen.solve(model, "lattice")
    first = lattice.first_step(model)
    assert (
        result.status == "inaccurate" and says in result.search_ended and "run.limit" in result.search_ended
    )
    assert [step / first for step in steps[: len(times)]] == pytest.approx(times, rel=0.02)
    assert result.step == pytest.approx(min(steps), rel=1e-9)
    assert result.error_estimate is not None or "at twice the step" in result.error_unknown or len(times) > 1


def test_a_finer_pass_that_ended_early_leaves_the_error_unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the time is over as well. With run.limit the time that it gives counts alone."""
    monkeypatch.setattr(chaos, "falls", lambda *_: True)
    steps = passes(monkeypatch, [2.0, 8.0, 50.0, *[0.0] * 9], (2,))
    result = mdlgen.solve(thrown(), "lattice")
    assert len(steps) == 3 and result.status == "inaccurate"
    assert "a run at half the step ended early: it ended early" in result.error_unknown
    monkeypatch.undo()
    monkeypatch.setattr(lattice, "PATIENCE", 1e-3)
    monkeypatch.setattr(lattice, "MOST_REFINED", 2)
    longer = mdlgen.solve(thrown("run.limit=600 s"), "lattice")
    assert longer.step < 0.3 * lattice.first_step(longer.model)


def test_a_pass_that_run_limit_cut_says_nothing_about_the_one_before(monkeypatch: pytest.MonkeyPatch) -> None:
    """The estimate of the finest complete run is kept."""
    monkeypatch.setattr(chaos, "falls", lambda *_: True)
    model = case("retard", "run.limit=600 s", "run.duration=10 ms", "run.tolerance=1e-6")
    limit = "run.limit of 600 s"
    steps = passes(monkeypatch, [1.0] * 9, (3,), f"{limit} of wall time was over at 5 ms")
    monkeypatch.setattr(lattice.Search, "_stops", lambda self: len(steps) == 4)
    result = mdlgen.solve(model, "lattice")
    assert len(steps) == 4 and steps[3] == min(steps)  # the one that is cut
    assert result.status == "inaccurate" and result.step == pytest.approx(min(steps[:3]))
    assert result.search_ended == f"{limit} left no time for a finer step"
    assert "ended early" not in result.error_unknown
    assert result.error_estimate is not None or "does not come closer" in result.error_unknown


def test_runs_at_twice_and_four_times_a_step_keep_their_states_apart() -> None:
    """A checkpoint of one is none of the other."""
    numbers = (watches.DOUBLED, watches.QUADRUPLED, watches.CHECK, watches.FINER, watches.MOVED)
    every = (*numbers, watches.MOVED_EARLY, *range(tuning.MOST_REFINED_RIGID + 1))
    assert len(set(every)) == len(every)
    search = lattice.Search(case("thrown"), None, lattice.Watches(None, None, True))
    asked: list[tuple[float, int]] = []
    search._once = lambda h, halved, seen, *_: asked.append((h, seen.number))
    search._coarser(2, 0.1, 0)
    search._coarser(4, 0.1, 0)
    assert asked == [(0.2, watches.DOUBLED), (0.4, watches.QUADRUPLED)]


def test_a_pass_that_crawls_ends_early_and_says_which_body_holds_it_up() -> None:
    """It takes more steps than the finest pass of a search would; only the search ends it."""
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.backends.lattice.integrate.passes import one_pass

    model = case(
        "retard", "run.duration=6 ms"
    )  # before its motion parts from that of a start moved by 1e-9 mm
    whole = one_pass(model, build(model), 0.05)
    assert whole.ok and whole.steps == 120
    part = one_pass(model, build(model), 0.05, times=0.5)
    assert not part.usable and 0.0 < part.time[-1] < 6.0 and 60 < part.steps < 80
    assert re.match(r"\d+ steps were needed up to [\d.]+ ms, .* velocity of box pile_\d_\d_0", part.status)


def test_a_moved_start_strains_no_joint() -> None:
    model = thrown()
    moved = chaos.moved(model).bodies.position - model.bodies.position
    assert np.abs(moved[:-1] - moved[0]).max() < 1e-13  # the plane is last, and stays
    assert np.linalg.norm(moved[0]) == pytest.approx(chaos.START, rel=1e-4) and not moved[-1].any()


def test_the_command_of_a_sweep_over_starts_runs(tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from mdlgen.cli import app

    spec = CASES / "thrown.yaml"
    found = chaos.Chaos("sheets.n.position", 1e-9, 1e-3, 1e-3, "mm", "n")
    line = chaos.command(found, (0.0, 0.0, 30.0), str(spec)).replace(':11"', ':2"')
    words = line.replace('"', "").partition(" --over ")
    extra = ["--set", "run.duration=1 ms", "-o", str(tmp_path / "s"), "-q"]
    ended = CliRunner().invoke(app, ["sweep", str(spec), "--over", words[2], *extra])
    assert ended.exit_code == 0, ended.output
    rows = (tmp_path / "s" / "table.csv").read_text("utf-8").splitlines()
    assert len(rows) == 3 and "sheets.n.center.0" in rows[0]


@pytest.mark.parametrize("sets", [(), ("run.step=1 us",)])
def test_a_limit_ends_a_run_in_time(sets: tuple[str, ...]) -> None:
    """With what there is: the best complete run, or the part so far."""
    began = time.perf_counter()
    result = mdlgen.solve(case("thrown", *sets, f"run.limit={LIMIT} s", "run.duration=1000 ms"), "lattice")
    # building, and a call that is under way; other work on the machine slows both
    assert time.perf_counter() - began < LIMIT + 10.0
    assert not result.ok and "run.limit of 1.5 s" in str(result.summary()["mark"])
    assert result.usable or 0.0 < result.time[-1] < 1000.0
    assert np.isfinite(result.position).all() and result.model.pairs.low.max() < np.inf


def test_a_limit_that_is_not_met_changes_nothing() -> None:
    plain = mdlgen.solve(case("short_step", "run.step=0.1 ms"), "lattice")
    other = mdlgen.solve(case("short_step", "run.step=0.1 ms", "run.limit=60 s"), "lattice")
    assert np.array_equal(plain.position, other.position) and plain.status == other.status == "ok"


def test_a_slow_pass_names_its_step_and_the_body_that_holds_it_up(caplog: pytest.LogCaptureFixture) -> None:
    """Only where the step is halved many times; how far it is, in any case."""
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.backends.lattice.integrate.slow import Slow
    from mdlgen.backends.lattice.integrate.work import arrays, control
    from mdlgen.backends.lattice.kernels.state import LEVEL, WORST

    model = thrown()
    steering = control(arrays(model, build(model)))
    seen: list[float] = []
    slow = Slow(model, steering, lambda at, *_: seen.append(at))
    caplog.set_level("INFO", "mdlgen.slow")
    slow.tell(1.0, 0.1, 0.5 * REPORTED)
    assert not seen
    slow.tell(2.0, 0.1, REPORTED)
    assert seen == [2.0] and not caplog.messages
    steering.pace[LEVEL], steering.counters[WORST] = HELD_UP, 3
    slow.tell(3.0, 0.16, REPORTED)
    assert seen == [2.0, 3.0]
    body = model.bodies.name[3]
    assert caplog.messages == [f"steps of 0.01 ms at 3 ms: the velocity of {body} converges slowly"]


def test_a_run_that_keeps_its_energy_at_no_step_is_shown_and_marked() -> None:
    """Up to a quarter of what passes through it: beyond, it is no result."""
    done = mdlgen.solve(case("short_step", "run.step=0.05 ms"), "lattice")

    def best(*off: float) -> Result:
        search = lattice.Search(done.model, build(done.model), watches.Watches(None, None, True))
        search._runs = [
            replace(done, energy=replace(done.energy, balance_error=part)).failed("it came from nowhere")
            for part in off
        ]
        return search._best()

    found = best(0.03, 0.3)
    assert found.status == "inaccurate"
    assert found.error_unknown.startswith("the error is not known: at the finest step ")
    assert "of energy came from nowhere, 3 % of" in found.error_unknown
    assert best(-0.03, -0.03).error_unknown.endswith("N mm; allowed are 1 %")
    assert not best(0.3, 0.03).usable


def test_a_pass_that_is_slower_than_was_foreseen_ends_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """There is a complete run by then, which is the result."""
    monkeypatch.setattr(lattice, "PATIENCE", 0.0)
    monkeypatch.setattr(lattice.Search, "_stops", lambda self: False)
    result = lattice.solve(thrown())
    assert result.usable and result.time[-1] == result.model.run.duration
    assert "of wall time" in result.search_ended and "left no time" in result.search_ended
