"""The search for the best values: methods, conditions, failures, going on, and the command."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest
from ruamel.yaml import YAML
from typer.testing import CliRunner

import mdlgen
from mdlgen.cli import app
from mdlgen.errors import RefusedError, SpecError
from mdlgen.paths import samples
from mdlgen.study.design.case import Case
from mdlgen.study.design.task import Task, task
from mdlgen.study.execution.row import FAILED, OK, CaseRow
from mdlgen.study.optimise import optimisation
from mdlgen.study.optimise.goal import goal
from mdlgen.study.optimise.optimisation import Optimisation
from mdlgen.study.output.fragment import fragment

INCLINE = samples() / "verify" / "incline.yaml"
FRICTION, MASS = "contacts.0.friction", "sheets.block.mass"
# Names that a run of the scene has; what they come to is made up by the tests.
X, Y = "sheets.block.travel_mm.x", "sheets.block.travel_mm.y"

Numbers = Callable[[dict[str, str]], dict[str, float] | None]


class Made:
    """In the place of runs: measures from a function of the values, None for a failed run."""

    def __init__(self, numbers: Numbers, stop: int | None = None):
        self.numbers, self.stop, self.cases = numbers, stop, list[Case]()

    def rows(self, task: Task, cases: Sequence[Case]) -> Iterator[CaseRow]:
        for case in cases:
            if len(self.cases) == self.stop:
                raise KeyboardInterrupt
            self.cases.append(case)
            found = self.numbers(dict(case.values))
            if found is None:
                yield CaseRow(case.index, case.values, FAILED, "it did not converge")
                continue
            measures = {n: e.value(found.get) for n, e in task.expressions()}
            yield CaseRow(case.index, case.values, OK, "ok", measures)

    def close(self) -> None:
        """Nothing is open."""


def asked(
    minimise: str, *vary: str, under: Sequence[str] = (), lets: tuple[str, ...] = (), **more
) -> Optimisation:
    return optimisation.optimisation(task(INCLINE, lets=lets), vary, goal(minimise, under), **more)


def searched(
    folder: Path, wanted: Optimisation, numbers: Numbers, resume: bool = False, stop: int | None = None
) -> tuple[list[CaseRow], CaseRow | None, Made]:
    made = Made(numbers, stop)
    with optimisation.opened(folder, wanted, resume)[1] as journal:
        rows, best = optimisation.run(wanted, journal, made)
    return rows, best, made


def friction(values: dict[str, str]) -> float:
    return float(values[FRICTION])


def valley(values: dict[str, str]) -> dict[str, float]:
    return {X: 3.0 * (friction(values) - 0.3217)}


class TestMethods:
    @pytest.mark.parametrize("minimise", [f"{X}**2", f"abs({X})"])
    def test_one_value_is_found_by_brent(self, tmp_path: Path, minimise: str) -> None:
        wanted = asked(minimise, f"{FRICTION}=0.1:0.6")
        rows, best, _ = searched(tmp_path, wanted, valley)
        assert wanted.method == "brent" and best is not None
        # to a thousandth of the range, in which it stops
        assert float(best.values[0][1]) == pytest.approx(0.3217, abs=1e-3 * 0.5)
        assert len(rows) <= (8 if "**" in minimise else 20)

    @pytest.mark.parametrize("unit", [1.0, 0.1, 10.0, 7.0])
    def test_several_values_under_a_condition_by_cobyqa(self, tmp_path: Path, unit: float) -> None:
        """The nearest point to (0.4, 12), in parts of 0.4 and 10, with mu <= 0.3 and 30 mu + m <= 18, in any
        unit; the first condition passes through the middle of the ranges."""

        def numbers(values: dict[str, str]) -> dict[str, float]:
            return {X: friction(values), Y: float(values[MASS].split()[0])}

        wanted = asked(
            f"(({X} - 0.4)/0.4)**2 + (({Y} - 12)/10)**2",
            f"{FRICTION}=0.1:0.5",
            f"{MASS}=5 g:15 g",
            under=[f"{X} <= 0.3", f"{18 * unit:g} >= {30 * unit:g}*{X} + {unit:g}*{Y}"],
            most=60,
        )
        rows, best, _ = searched(tmp_path, wanted, numbers)
        assert wanted.method == "cobyqa" and best is not None
        # by Lagrange's multipliers, on the line 30 mu + m = 18, within mu <= 0.3
        mu = min(0.3, (0.4 / 0.16 + 30 * 6 / 100) / (1 / 0.16 + 900 / 100))
        assert friction(dict(best.values)) == pytest.approx(mu, abs=2e-3)
        assert best.measures["objective"] == pytest.approx(
            ((mu - 0.4) / 0.4) ** 2 + ((18 - 30 * mu - 12) / 10) ** 2, abs=2e-3
        )
        slack = 1e-6 * max(abs(row.measures["condition_2"] or 0.0) for row in rows)
        assert (best.measures["condition_2"] or 0.0) <= slack and best.measures["condition_1"] <= 0.0  # type: ignore[operator]

    def test_lists_are_searched_by_optuna_until_all_are_known(self, tmp_path: Path) -> None:
        def numbers(values: dict[str, str]) -> dict[str, float]:
            return {X: friction(values) * float(values[MASS].split()[0])}

        wanted = asked(f"{X}", f"{FRICTION}=[0.3, 0.1, 0.2]", f"{MASS}=[8 g, 5 g]", most=25)
        rows, best, made = searched(tmp_path, wanted, numbers)
        assert wanted.method == "optuna" and best is not None
        assert dict(best.values) == {FRICTION: "0.1", MASS: "5 g"}
        assert len(rows) == len(made.cases) == len({row.values for row in rows}) == 6

    def test_optuna_is_the_same_for_a_seed_and_minds_conditions(self, tmp_path: Path) -> None:
        def numbers(values: dict[str, str]) -> dict[str, float]:
            return {X: friction(values)}

        def found(name: str, **more) -> tuple[list[tuple], CaseRow | None]:
            wanted = asked(
                f"-{X}", f"{FRICTION}=0.1:0.5", under=[f"{X} <= 0.3"], method="optuna", most=20, **more
            )
            rows, best, _ = searched(tmp_path / name, wanted, numbers)
            return [row.values for row in rows], best

        one, best = found("one")
        assert best is not None and 0.25 < friction(dict(best.values)) <= 0.3
        assert found("two")[0] == one != found("three", seed=2)[0]
        # two at a time
        assert len(found("four", together=2)[0]) == 20

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"vary": [f"{FRICTION}=0.1:0.5"], "method": "brant"}, "did you mean 'brent'"),
            ({"vary": [f"{FRICTION}=[0.1, 0.5]"], "method": "brent"}, "--method optuna takes lists"),
            ({"vary": [f"{FRICTION}=0.1:0.5", f"{MASS}=5 g:9 g"], "method": "brent"}, "is for one variable"),
            ({"vary": [f"{FRICTION}=normal(0.3, 0.1)"]}, "a scatter is for mdlgen sweep"),
            ({"vary": [f"{FRICTION}=0.1:0.5", f"{FRICTION}=0.1:0.5"]}, "given twice"),
            ({"vary": []}, "name what may differ"),
            ({"vary": [f"{FRICTION}=0.1:0.5"], "most": 0}, "allowed are 1 to"),
            ({"vary": ["sheets.block.mas=1 g:2 g"]}, "did you mean 'mass'"),
        ],
    )
    def test_what_cannot_be_meant_is_reported(self, options: dict, message: str) -> None:
        with pytest.raises(SpecError) as error:
            asked(X, *options.pop("vary"), **options)
        assert message in str(error.value)

    def test_goals_are_read_before_anything_is_run(self) -> None:
        for minimise, under, message in (
            ("sheets.block.travel_m.x", [], "did you mean 'sheets.block.travel_mm.x'"),
            ("sheets.block.travel_mm", [], "is a vector"),
            (X, [X], "is not A <= B"),
            (X, [f"{X} == 1"], "is not A <= B"),
            (X, [f"0 < {X} < 1"], "is not A <= B"),
        ):
            with pytest.raises(SpecError) as error:
                asked(minimise, f"{FRICTION}=0.1:0.5", under=under)
            assert message in str(error.value)


class TestRuns:
    def test_a_failed_run_is_a_row_and_no_end(self, tmp_path: Path) -> None:
        def numbers(values: dict[str, str]) -> dict[str, float] | None:
            return None if friction(values) > 0.4 else valley(values)

        rows, best, _ = searched(tmp_path, asked(f"{X}**2", f"{FRICTION}=0.1:0.6"), numbers)
        assert any(row.kind == FAILED for row in rows) and best is not None
        assert float(best.values[0][1]) == pytest.approx(0.3217, abs=1e-3)

    def test_where_nothing_meets_the_conditions_there_is_no_best(self, tmp_path: Path) -> None:
        wanted = asked(f"{X}**2", f"{FRICTION}=0.1:0.6", under=[f"{X} >= 5"], most=12)
        rows, best, _ = searched(tmp_path, wanted, valley)
        assert best is None and 0 < len(rows) <= 12

    def test_no_more_runs_than_were_allowed(self, tmp_path: Path) -> None:
        rows, best, made = searched(tmp_path, asked(f"abs({X})", f"{FRICTION}=0.1:0.6", most=4), valley)
        assert len(rows) == len(made.cases) == 4
        assert best == min(rows, key=lambda row: row.measures["objective"] or 0.0)

    def test_one_that_was_cut_off_goes_on_to_the_same_rows(self, tmp_path: Path) -> None:
        wanted = asked(f"abs({X})", f"{FRICTION}=0.1:0.6")
        whole, _, _ = searched(tmp_path / "whole", wanted, valley)
        with pytest.raises(KeyboardInterrupt):
            searched(tmp_path / "cut", wanted, valley, stop=5)
        rows, _, made = searched(tmp_path / "cut", wanted, valley, resume=True)
        assert [row.json() for row in rows] == [row.json() for row in whole]
        assert len(made.cases) == len(whole) - 5
        with pytest.raises(RefusedError, match="its vary differs"):
            searched(tmp_path / "cut", asked(f"abs({X})", f"{FRICTION}=0.1:0.5"), valley, resume=True)
        with pytest.raises(RefusedError, match="holds a search"):
            searched(tmp_path / "cut", wanted, valley)

    def test_the_piece_of_a_scene_file_says_the_design(self, tmp_path: Path) -> None:
        wanted = asked(f"{X}**2", "delta=0 g:2 g", lets=(f"{MASS}=10 g - delta",), most=3)
        rows, best, _ = searched(
            tmp_path, wanted, lambda values: {X: float(values["delta"].split()[0]) - 1.3}
        )
        assert best is not None
        piece = fragment(wanted, rows, best)
        mass = YAML(typ="safe").load(piece)["sheets"]["block"]["mass"]
        assert mdlgen.load(INCLINE, [f"{MASS}={mass}"]).sheets["block"].mass == pytest.approx(
            10.0 - float(best.values[0][1].split()[0]), abs=1e-9
        )
        assert f"# delta = {best.values[0][1]}" in piece


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The friction with which a block has 20 mm/s after 20 ms on a slope of 20 deg, by the command."""
    folder = tmp_path_factory.mktemp("optimum")
    words = ["optimize", str(INCLINE), "--set", "run.duration=20 ms", "--vary", f"{FRICTION}=0.1:0.5"]
    words += ["--minimise", "(sheets.block.speed_mm_per_s.x - 20)**2", "--folder", str(folder / "table")]
    words += ["--measure", "sheets.block.speed_mm_per_s.x", "-o", str(folder / "best.mdl")]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    return folder, done.stdout


class TestCommand:
    def test_it_ends_with_the_friction_of_the_closed_form(self, found: tuple[Path, str]) -> None:
        folder, message = found
        with (folder / "table" / "table.csv").open() as stream:
            rows = list(csv.DictReader(stream))
        best = min(rows, key=lambda row: float(row["objective"]))
        angle = math.radians(20.0)
        # v = g (sin a - mu cos a) t; friction is less than mu for the 0.3 ms below 1 mm/s, its smoothing
        mu = math.tan(angle) - 0.020 / (9.81 * math.cos(angle) * 0.020)
        assert float(best[FRICTION]) == pytest.approx(mu, rel=0.02)
        assert len(rows) <= 12 and f"# {FRICTION}: {best[FRICTION]}" in message

    def test_it_writes_the_text_the_piece_and_the_page(self, found: tuple[Path, str]) -> None:
        folder, message = found
        assert message.endswith((folder / "table" / "best.yaml").read_text())
        assert "*EndMDL()" in (folder / "best.mdl").read_text()
        page = (folder / "table" / "study.html").read_text()
        data = json.loads(page.split('id="data">')[1].split("</script>")[0])
        assert data["objective"] == "objective" and data["best"] is not None

    def test_what_is_wrong_ends_in_one_line(self, tmp_path: Path) -> None:
        for words, message in (
            (["--vary", f"{FRICTION}=0.1:0.5", "--minimise", "sheets.block.yaw_de"], "did you mean"),
            (["--vary", f"{FRICTION}=2", "--minimise", X], "is no range"),
            (["--vary", "d=0.1:0.5", "--let", f"{FRICTION}=e", "--minimise", X], "no variable 'e'"),
        ):
            done = CliRunner().invoke(app, ["optimize", str(INCLINE), *words, "--folder", str(tmp_path)])
            assert done.exit_code == 2 and message in done.stderr and len(done.stderr.splitlines()) == 1
