"""The suites of the bench: their cases, references, and what their rows say together."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from asked import as_asked

import mdlgen
from mdlgen.bench.campaign.drawn_run import DrawnRun
from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.fits import EQUAL_ERROR, fits, wall_at
from mdlgen.bench.row import Outcome, rows
from mdlgen.bench.run import Bench, bench
from mdlgen.bench.suites import SUITES, cases, stability
from mdlgen.bench.suites.elastica import drop
from mdlgen.bench.suites.ladder import piles
from mdlgen.bench.suites.piles import NAMES
from mdlgen.bench.table import markdown
from mdlgen.errors import SpecError

STRIP = Run("cantilever", ("sheets.note.boxes=[1,10]",))


@pytest.mark.parametrize("suite", SUITES)
def test_every_case_is_a_scene_with_a_command_that_repeats_it(suite):
    for solver in ("exudyn", "another"):
        made = cases(suite, solver, ("another", "exudyn"), quick=False)
        assert len({(case.name, case.run.step) for case in made}) == len(made)
        for case in made[:: max(1, len(made) // 12)]:
            case.run.model()
            command = case.run.command(solver)
            begins = f"mdlgen run samples/{case.run.sample}.yaml --solver {solver}"
            if isinstance(case.run, DrawnRun):
                begins = f"mdlgen bench campaign --seed 1 --only {case.run.number} --solver {solver}"
            assert command.startswith(begins)


def test_the_reference_of_the_transport_is_ten_times_finer_than_what_is_measured():
    made = cases("transport", "lattice", ("exudyn", "lattice"), quick=False)
    steps = [case.run.step for case in made if case.run.step is not None]
    assert steps == [0.25, 0.125, 0.0625, 0.025]
    for case in made:
        assert case.reference is not None and case.reference.solver == "lattice"
        # the finer grid runs at the step chosen, some 0.08 ms
        finest = min(steps) if "10 x 20" in case.name else 0.08
        assert (case.reference.run.step or 1.0) <= finest / 10
    assert [case.name for case in made if case.run.step is None] == [
        "10 x 20 boxes, step chosen",
        "20 x 30 boxes, step chosen",
    ]


def test_work_and_the_time_of_the_estimate_are_in_a_row():
    case = BenchCase("transport", "x", STRIP, drop)
    done = Outcome("ok", [Finding("position", 1e-3)], 0.1, 10, iterations=25, wall=1.0, estimating=0.5)
    made = rows(case, "lattice", done)
    assert [made[0].json()[key] for key in ("iterations", "rounds", "estimate_s")] == [25, 25, 0.5]
    text = markdown(Bench({"cpu": "x", "cores": 1, "python": "3"}, {}, {}, made))
    assert "| 1 s | 500 ms | 100 ms | 2.5 |" in text


def test_growth_is_of_the_whole_wall_time():
    made = []
    for boxes in (50, 200, 800):
        case = BenchCase("scaling", f"{boxes} boxes", STRIP, drop)
        done = Outcome("ok", [Finding("q", 0.0)], 0.05, boxes, wall=1e-3 * boxes**1.5, boxes=boxes)
        made += rows(case, "lattice", done)
    assert fits(made)["growth"] == {"lattice": pytest.approx(1.5)}


def test_growth_of_piles_is_that_of_a_step():
    made = []
    for count, wall, steps in ((5, 1.0, 100), (20, 10.0, 200)):
        case = BenchCase("piles", f"{count} notes at rest", STRIP, drop)
        done = Outcome("ok", [Finding("q", 0.0)], 0.1, steps, wall=wall, boxes=count)
        made += rows(case, "lattice", done)
    growth = fits(made)["piles"]
    assert growth == {"lattice: at rest, 5 to 20 notes": {"notes": 4.0, "times": pytest.approx(5.0)}}
    text = markdown(Bench({"cpu": "x", "cores": 1, "python": "3"}, {}, {}, made))
    assert "lattice: at rest, 5 to 20 notes: a step takes 5 times as long" in text


def test_growth_of_piles_is_found_without_their_landing_too():
    made = []
    for kind, steps, walls in (("lands", 100, (2.0, 20.0)), ("awake", 500, (6.0, 38.0))):
        for count, wall in zip((5, 20), walls, strict=True):
            case = BenchCase("piles", f"{count} notes {NAMES[kind]}", STRIP, drop)
            done = Outcome("ok", [Finding("q", 0.0)], 0.1, steps, wall=wall, boxes=count)
            made += rows(case, "lattice", done)
    growth = {label: found["times"] for label, found in fits(made)["piles"].items()}
    assert growth == {
        "lattice: at rest, none asleep, first 20 ms, 5 to 20 notes": pytest.approx(10.0),
        "lattice: at rest, none asleep, 5 to 20 notes": pytest.approx(38.0 / 6.0),
        "lattice: at rest, none asleep, without the first 20 ms, 5 to 20 notes": pytest.approx(18.0 / 4.0),
    }


def test_another_state_runs_each_case_too(tmp_path):
    """Here this one itself, one that refuses all, and none."""
    root = Path(mdlgen.__file__).resolve().parents[1]
    (tmp_path / "old" / "mdlgen").mkdir(parents=True)
    (tmp_path / "old" / "mdlgen" / "__init__.py").write_text("raise SystemExit('an old state')\n")
    run = {"solvers": ["lattice"], "quick": True, "repeats": 1}
    with pytest.raises(SpecError, match=r"does not run a case of this one with lattice: .*an old state"):
        bench(["flight"], tmp_path / "out", beside=tmp_path / "old", **run)
    with pytest.raises(SpecError, match="is not a folder with another state"):
        bench(["flight"], tmp_path / "out", beside=tmp_path, **run)
    found = bench(["flight"], tmp_path / "out", beside=root, **run)
    own = [row for row in found.rows if row.solver == "lattice"]
    beside = [row for row in found.rows if row.solver == "lattice, beside"]
    assert [(row.case, row.quantity, row.error) for row in own] == [
        (row.case, row.quantity, row.error) for row in beside
    ]
    found.rows[:] = [replace(row, status=status) for row in beside for status in ("wrong", "failed")]
    assert found.wrong == found.failed == [], "another state fails nothing"


def test_the_quick_ladder_has_a_rung_of_each_name():
    made = cases("stability", "exudyn", ("exudyn",), quick=True)
    assert {case.name for case in made} == set(stability.QUICK)


@pytest.mark.parametrize(
    "name",
    [
        "pile of masses 1 : 100, light on heavy: laid down",
        "pile of masses 1 : 100, in turns: laid down",
        "step 0.001 s: soft pile laid down",
        "sheets struck one by another, masses 100 : 1",
        "step 1e-05 s: pile in free fall, struck",
        "thrown along a pile: middle one of 5",
    ],
)
def test_a_rung_of_a_pile_is_right_and_is_wrong_where_its_motion_is(name):
    """Each measure has an independent truth: velocities that are off by 2 % are seen."""
    rung = next(rung for rung in piles.rungs() if rung.name == name)
    result = mdlgen.solve(rung.run.model(), "lattice")
    assert as_asked(result), result.status

    def wrong(tested):
        return [f.quantity for f in rung.measure(tested, None) if f.error > (f.tolerance or 0.0)]

    assert not wrong(result)
    stretched = result.position[0] + 1.02 * (result.position - result.position[0])
    assert wrong(replace(result, position=stretched, velocity=1.02 * result.velocity))


def test_a_reference_is_kept_and_used_again(tmp_path):
    heard: list[str] = []
    found = bench(["skip"], tmp_path, ["lattice"], quick=True, repeats=1, say=heard.append)
    assert sum("reference" in line for line in heard) == 1, "six cases, one reference"
    assert len(list(tmp_path.glob("reference_*.npz"))) == 1
    assert [row.status for row in found.rows] == ["ok"] * 6, [row.reason for row in found.rows]
    pruned, everything = (row.details["pairs"] for row in found.rows[:2])
    assert pruned < 0.3 * everything
    saves = fits(found.rows)["saves"]
    names = (
        *("pruned contacts", "idle parts left out", "folded bushings", "kept factors"),
        "a half of what is symmetric",
    )
    assert set(saves) == {f"lattice: {name}" for name in names}
    # how much they save a run of a millisecond does not tell
    assert "kept factors: saves" in (tmp_path / "bench.md").read_text()


def test_what_a_rule_saves_is_of_the_time_without_it():
    made = []
    for solver, unit in (("lattice", 1.0), ("exudyn", 40.0)):
        for case, wall in zip(cases("skip", "exudyn", ("exudyn",), True), (3.0, 4.0, 6.0), strict=True):
            made += rows(case, solver, Outcome("ok", [Finding("q", 0.0)], wall=unit * wall))
    part = {"pruned contacts": 0.25, "idle parts left out": 0.5}
    names = [f"{solver}: {rule}" for solver in ("lattice", "exudyn") for rule in part]
    assert fits(made)["saves"] == dict(zip(names, [*part.values()] * 2, strict=True))


def test_a_rule_is_taken_away_only_from_a_solver_that_has_it():
    known = ("exudyn", "lattice")
    own = {name: [c.run.without for c in cases("skip", name, known, False)] for name in known}
    assert not any(own["exudyn"])
    assert [rules for rules in own["lattice"] if rules] == [("folding",), ("factors",), ("symmetry",)]
    last = cases("skip", "lattice", known, False)[-1]
    assert last.run.command("lattice") == "mdlgen bench skip --solver lattice"


def test_order_and_equal_error():
    case = BenchCase("transport", "10 x 20 boxes, step given", Run("transport_4x4"), drop)
    made = []
    for step in (0.1, 0.05, 0.0125):
        done = Outcome("ok", [Finding("position", step**2)], step, 10, 1 / step, boxes=200)
        made += rows(case, "exudyn", done)
    record = fits(made)
    assert record["order"] == {"transport, exudyn: position": pytest.approx(2.0)}
    equal = record["wall_at_equal_error"]["exudyn, 200 boxes"]
    assert equal["wall_s"] == pytest.approx(1 / math.sqrt(EQUAL_ERROR))
    for step in (0.1, 0.05, 0.0125):
        done = Outcome("ok", [Finding("position", step**2)], step, 10, 0.1 / step, boxes=200)
        made += rows(case, "lattice", done)
    equal = fits(made)["wall_at_equal_error"]["exudyn, 200 boxes"]
    assert equal["fastest"] == "lattice, 200 boxes" and equal["times_fastest"] == pytest.approx(10.0)
    assert wall_at(1e-3, [1e-3], [1.0]) is None


def test_no_wall_time_is_reported_at_an_error_that_was_not_reached():
    case = BenchCase("transport", "10 x 20 boxes, by hand", Run("transport_4x4"), drop)
    made = []
    for step, error in ((0.1, 2.38e-3), (0.05, 2.35e-3)):
        done = Outcome("ok", [Finding("position", error)], step, 10, 1 / step, boxes=200)
        made += rows(case, "script", done)
    record = fits(made)
    assert record["wall_at_equal_error"] == {}
    assert record["least_error"] == {"script, 200 boxes": {"error": 2.35e-3, "wall_s": 20.0}}


@pytest.mark.parametrize(("estimate", "honest"), [(4e-4, False), (6e-4, True), (9e-3, True), (2e-2, False)])
def test_an_estimate_that_is_far_from_the_error_is_named(estimate, honest):
    done = Outcome("ok", [Finding("position", 1e-3)], 0.1, 10, 1.0, estimate=estimate)
    made = rows(BenchCase("transport", "x", STRIP, drop), "exudyn", done)
    assert (fits(made)["estimates_off"] == []) == honest


def test_a_reference_of_other_code_is_another_file(tmp_path):
    from mdlgen.bench.case import Reference
    from mdlgen.bench.reference import file_of

    run = Run("transport_4x4", ("run.duration=1 ms",), 0.1)
    one = file_of(Reference(run, "exudyn"), "mdlgen.backends.exudyn_local", tmp_path)
    assert one == file_of(Reference(run, "exudyn"), "mdlgen.backends.exudyn_local", tmp_path)
    assert one != file_of(Reference(run, "exudyn"), "mdlgen.bench", tmp_path)
    assert one != file_of(
        Reference(replace(run, step=0.2), "exudyn"), "mdlgen.backends.exudyn_local", tmp_path
    )
    assert isinstance(one, Path)


def test_the_page_of_the_ladder_has_both_solvers_beside_each_other():
    """A rung with two numbers counts once, as its worst, and one that failed stands in each of its lines."""
    from mdlgen.bench.page import page

    case = BenchCase("stability", "wrapped", STRIP, drop)
    two = [Finding("shape", 1e-3, 2e-2), Finding("position", 5e-2, 1e-3)]
    made = [
        *rows(case, "lattice", Outcome("ok", two, 0.1, 10, 1.0)),
        *rows(case, "exudyn", Outcome("a | bar", [], 0.1, 10, 2.0)),
        *rows(replace(case, name="rest"), "exudyn", Outcome("ok", two[:1], 0.1, 10, 2.0)),
    ]
    text = page("stability", Bench({}, {}, {}, made))
    assert "- lattice: 1 rung: 0 right, 0 failed with a reason, 1 wrong." in text
    assert "- exudyn: 2 rungs: 1 right, 1 failed with a reason, 0 wrong." in text
    assert (
        "| rung | of what | allowed | lattice, error | lattice, wall | exudyn, error | exudyn, wall |" in text
    )
    assert "| wrapped | shape | 0.02 | 0.001 | 1 s | **failed** | 2 s |" in text
    assert "| wrapped | position | 0.001 | **wrong** 0.05 | 1 s | **failed** | 2 s |" in text
    assert "| rest | shape | 0.02 |  |  | 0.001 | 2 s |" in text
    assert "- wrapped, exudyn: failed: a / bar" in text


@pytest.mark.parametrize("suites", [[], ["stability", "impact"], ["impact"]])
def test_a_page_is_of_a_suite_that_has_one(suites):
    from mdlgen.bench.page import check_page
    from mdlgen.errors import SpecError

    with pytest.raises(SpecError, match="page"):
        check_page(suites)
