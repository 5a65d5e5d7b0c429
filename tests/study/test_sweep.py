"""Many runs of one scene: what is asked for, what is measured, what survives, and what the table says."""

from __future__ import annotations

import csv
import io
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import mdlgen
from mdlgen.cli import app
from mdlgen.errors import OutputError, RefusedError, SpecError
from mdlgen.paths import samples
from mdlgen.results.summary import summary
from mdlgen.study import sweep
from mdlgen.study.analysis import table
from mdlgen.study.design import expression, measure
from mdlgen.study.design.case import Case
from mdlgen.study.design.task import Task, task
from mdlgen.study.design.variable import grid, quantity, value_text, variable
from mdlgen.study.execution import journal, perform, workers
from mdlgen.study.execution.row import FAILED, INACCURATE, LOST, OK, REFUSED, CaseRow, Times
from mdlgen.study.output.files import write

INCLINE = samples() / "verify" / "incline.yaml"
FOUR = samples() / "transport_4x4.yaml"
SHORT = ["run.duration=2 ms"]
FRICTION = "contacts.0.friction"


class Here:
    """Runs cases in this process, and counts them; `stop` ends as Ctrl-C does, after so many."""

    def __init__(self, stop: int | None = None):
        self.stop, self.ran = stop, 0

    def rows(self, task: Task, cases: Sequence[Case]) -> Iterator[CaseRow]:
        for case in cases:
            if self.ran == self.stop:
                raise KeyboardInterrupt
            self.ran += 1
            yield perform.perform(task, case)

    def close(self) -> None:
        """Nothing is open."""


def wanted(
    *over: str, measures: Sequence[str] = (), sets: Sequence[str] = SHORT, **asked: Any
) -> sweep.Sweep:
    cases, how = sweep.over(over, None, 1)
    return sweep.sweep(task(INCLINE, list(sets), **asked), cases, how, measures)


def swept(
    folder: Path, asked: sweep.Sweep, resume: bool = False, stop: int | None = None
) -> tuple[list[CaseRow], int]:
    """The rows of a sweep in `folder`, whose table is written, and how many cases were run for it."""
    here = Here(stop)
    found, kept = sweep.opened(folder, asked, resume)
    with kept:
        rows = sweep.run(found, kept, here)
    write(folder, found.task, rows, parquet=False)
    return rows, here.ran


def cli(*args: object) -> tuple[int, str, str]:
    done = CliRunner().invoke(app, [str(arg) for arg in args])
    return done.exit_code, done.stdout, done.stderr


def read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


class TestVariables:
    @pytest.mark.parametrize(
        ("text", "texts"),
        [
            ("a.b=0.1:0.5:9", ["0.1", "0.15", "0.2", "0.25", "0.3", "0.35", "0.4", "0.45", "0.5"]),
            ("a=180 rad/s:200 rad/s:3", ["180.0 rad/s", "190.0 rad/s", "200.0 rad/s"]),
            ("a=1 mm:0.2 cm:3", ["1.0 mm", "1.5 mm", "2.0 mm"]),
            ("a=5:20:4", ["5", "10", "15", "20"]),
            ("a=5:6:3", ["5.0", "5.5", "6.0"]),
            ("a=-1e-3:1e-3:2", ["-0.001", "0.001"]),
            ("a=[0.1 mm, null, [1, 2], {b: x}, true, '5', 5]",
             ["0.1 mm", "null", "[1, 2]", '{"b": "x"}', "true", '"5"', "5"]),
        ],
    )  # fmt: skip
    def test_ranges_and_lists(self, text: str, texts: list[str]) -> None:
        assert list(variable(text).texts) == texts

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("a.b", "no path and values"),
            ("a b=1:2:3", "no path and values"),
            ("a=1:2", "neither a range nor a list"),
            ("a=1:2 mm:3", "write it at both"),
            ("a=1 s:2 mm:3", "not units of the same thing"),
            ("a=1 furlong:2 furlong:3", "is not a number"),
            ("a=1:2:1", "allowed are 2 to 100000"),
            ("a=1:2:1e3", "no count"),
            ("a=[1, 1]", "stands twice"),
            ("a=[1, 2", "not YAML"),
            ("a=[]", "not a list of values"),
            ("a=[*x]", "anchors and aliases"),
        ],
    )
    def test_what_is_neither_is_refused_in_a_line(self, text: str, message: str) -> None:
        with pytest.raises(SpecError, match=message) as error:
            variable(text)
        assert "--over" in str(error.value) and "\n" not in str(error.value)

    @given(st.text(st.characters(exclude_categories=("C", "Z"), include_characters=" "), max_size=20))
    def test_a_text_of_a_list_reads_back(self, text: str) -> None:
        from mdlgen.spec.load import parse

        assert parse(value_text(text), "value").data == text

    def test_a_grid_is_every_combination_in_order(self) -> None:
        cases = grid([variable("a=1:2:2"), variable("b,c=[x, y]")])
        assert [case.index for case in cases] == [0, 1, 2, 3]
        assert cases[1].overrides == ("a=1", "b=y", "c=y")
        assert [case.values[0][1] for case in cases] == ["1", "1", "2", "2"]
        with pytest.raises(SpecError, match="given twice"):
            grid([variable("a=1:2:2"), variable("b,a=1:2:2")])
        with pytest.raises(SpecError, match="1000000 cases; allowed are 100000"):
            grid([variable("a=1:2:1000"), variable("b=1:2:1000")])

    def test_quantities(self) -> None:
        assert quantity("180 rad/s") == (180.0, "rad/s")
        assert quantity("-.5e3") == (-500.0, "")
        assert quantity("12 monkeys") is None and quantity("[1, 2]") is None

    @pytest.mark.parametrize("kind", ["lhs", "sobol"])
    def test_a_sample_is_the_same_for_the_same_seed(self, kind: str) -> None:
        texts = [f"{FRICTION}=normal(0.3, 0.05, 0.1:0.5)", "run.duration=1 ms:3 ms"]
        cases, how = sweep.over(texts, (kind, 16), 7)
        assert cases == sweep.over(texts, (kind, 16), 7)[0] and how == f"{kind} 16, seed 7"
        assert cases != sweep.over(texts, (kind, 16), 8)[0]
        assert all(0.1 <= float(case.values[0][1]) <= 0.5 for case in cases)
        assert all(case.values[1][1].endswith(" ms") for case in cases)


NAMES = {"a": 2.0, "b.c": -3.0, "rollers.in.force": 4.0, "v": (3.0, 4.0, 0.0), "v.x": 3.0, "none": None}


class TestExpressions:
    @pytest.mark.parametrize(
        ("text", "value"),
        [
            ("1 - a/8", 0.75),
            ("abs(b.c) ** 2 - sqrt(rollers.in.force)", 7.0),
            ("min(a, b.c, 7) + max(a, b.c) - -1", 0.0),
            ("norm(v) - v.x", 2.0),
            ("a < 3 and not b.c > 0", 1.0),
            ("a > 3 or b.c == -3", 1.0),
            ("1 < a < 2", 0.0),
            ("a != 2", 0.0),
            ("none", None),
            ("none > 1 or a > 1", None),
            ("1.e1 + .5", 10.5),
        ],
    )
    def test_what_they_come_to(self, text: str, value: float | None) -> None:
        assert expression.read(text, "--measure").value(NAMES.get) == value

    @pytest.mark.parametrize(
        ("text", "message"),
        [("1/(a - 2)", "division by zero"), ("sqrt(b.c)", "sqrt"), ("b.c**0.5", "no finite number"),
         ("(9**9**9) * a", "large|no finite|range"), ("v + 1", "is a vector"), ("norm(a)", "takes a vector")],
    )  # fmt: skip
    def test_what_has_no_number_says_why(self, text: str, message: str) -> None:
        with pytest.raises(ValueError, match=message):
            expression.read(text, "--measure").value(NAMES.get)

    @pytest.mark.parametrize(
        "text",
        ["__import__('os').system('true')", "a.b.c()", "(lambda: a)()", "a[0]", "[a for a in b]", "f'{a}'",
         "a if b else c", "x := 1", "abs", "abs(a, key=b)", "min(a)", "abs(*a)", "sqrt(1, 2)", "'text'", "1j",
         "1e999", "a // 2", "a % 2", "a @ b", "a << 2", "~a", "a is b", "a in b", "await a", "{a}", "(a,)",
         "(" * 300 + "a" + ")" * 300, "-" * 900 + "a", "a;b", "a\nb", "norm(v - v)", "True", "a" * 1001, ""],
    )  # fmt: skip
    def test_what_is_more_than_arithmetic_is_refused_or_a_name(self, text: str) -> None:
        try:
            found = expression.read(text, "--measure")
        except SpecError as error:
            assert "--measure" in str(error) and len(str(error)) < 400
        else:  # a name, which no run has
            assert text in ("True", "abs") and found.names == (text,)

    @given(st.text(alphabet="ab.()+-*/<>=!,1e_ andortmisxqu", max_size=40))
    def test_any_text_is_an_expression_or_a_line(self, text: str) -> None:
        try:
            found = expression.read(text, "--measure")
        except SpecError:
            return
        try:
            value = found.value(lambda name: 1.5)
        except ValueError:
            return
        assert value is None or isinstance(value, float)


@pytest.fixture(scope="module")
def names() -> dict[str, measure.Value]:
    return measure.known(mdlgen.lower(mdlgen.load(FOUR, ["sheets.note.boxes=[3,4]"])))


class TestMeasures:
    def test_the_names_are_those_of_a_run(self) -> None:
        """A name that is offered before the run must be there after it, and the other way round."""
        model = mdlgen.lower(mdlgen.load(INCLINE, SHORT))
        ran = measure.flat(summary(mdlgen.solve(model)))
        offered = measure.known(model)
        assert set(ran) <= set(offered)
        assert {name for name in offered if not name.startswith("events.")} <= set(ran)
        assert {n for n, v in ran.items() if isinstance(v, tuple)} == {
            n for n, v in offered.items() if isinstance(v, tuple)
        }

    def test_names_and_expressions(self, names: dict[str, measure.Value]) -> None:
        found = measure.measures(
            ["sheets.note.yaw_deg", "slip=1 - sheets.note.travel_mm.x/93", "v=sheets.note.speed_mm_per_s",
             "events.jam.motor_1_left", "sheets.note.strain.max_md", "energy.balance_error"],
            names, "--measure",
        )  # fmt: skip
        assert [name for name, _ in found] == [
            "sheets.note.yaw_deg", "slip", "v.x", "v.y", "v.z", "events.jam.motor_1_left",
            "sheets.note.strain.max_md", "energy.balance_error",
        ]  # fmt: skip
        assert dict(found)["v.y"] == "sheets.note.speed_mm_per_s.y"

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("sheets.note.yaw_degg", "did you mean 'sheets.note.yaw_deg'?"),
            ("slip=1 - sheets.note.travl_mm.x", "did you mean 'sheets.note.travel_mm.x'?"),
            ("zzz", "it has t_end_ms, steps"),
            ("1 - sheets.note.travel_mm", "is a vector; write sheets.note.travel_mm.x"),
            ("wall_s", "times.csv has it"),
            ("solver", "there is no number 'solver'"),
            ("status=steps", "stands twice"),
        ],
    )
    def test_what_is_not_there_is_told_with_what_is(
        self, names: dict[str, measure.Value], text: str, message: str
    ) -> None:
        with pytest.raises(SpecError) as error:
            measure.measures([text], names, "--measure")
        assert message in str(error.value)

    def test_events_are_counted(self) -> None:
        events = [
            {"kind": "double_feed", "sheet": "a", "other": "b", "roller": "r"},
            {"kind": "double_feed", "sheet": "a", "other": "c", "roller": "r"},
        ]
        found = measure.flat({"events": events})
        assert found["events.double_feed"] == 2.0 and found["events.jam"] == 0.0
        assert found["events.double_feed.b"] == 1.0 and found["events.double_feed.a"] == 2.0

    def test_only_what_is_asked_for_is_worked_out(self, monkeypatch: pytest.MonkeyPatch) -> None:
        asked = wanted(f"{FRICTION}=0.1:0.2:2")

        def never(*_: object) -> None:
            raise AssertionError("worked out for nothing")

        monkeypatch.setattr("mdlgen.results.events.events", never)
        monkeypatch.setattr("mdlgen.results.strain.strains", never)
        assert perform.perform(asked.task, asked.cases[0]).ok
        events = replace(asked.task, measures=(("jams", "events.jam"),))
        assert "worked out for nothing" in perform.perform(events, asked.cases[0]).status


class TestCase:
    def test_a_row_has_the_numbers_of_the_run(self) -> None:
        asked = wanted(f"{FRICTION}=0.1:0.2:2", measures=["v=norm(sheets.block.speed_mm_per_s)", "steps"])
        row = perform.perform(asked.task, asked.cases[1])
        result = mdlgen.solve(mdlgen.lower(mdlgen.load(INCLINE, [*SHORT, f"{FRICTION}=0.2"])))
        record = result.summary()
        assert row.kind == OK and row.status == "ok" and row.solver == "lattice"
        speed = record["sheets"]["block"]["speed_mm_per_s"]
        assert row.measures["v"] == pytest.approx(sum(v * v for v in speed) ** 0.5, rel=1e-15)
        assert row.measures["steps"] == record["steps"] and row.error_estimate == record["error_estimate"]
        assert row.times.case_s > 0.0

    @pytest.mark.parametrize(
        ("sets", "measured", "kind", "message"),
        [
            (["sheets.block.thickness=5 m"], "steps", REFUSED, "sheets.block.thickness: 5 m is outside"),
            ([], "1/events.jam", FAILED, "division by zero"),
            ([], "sheets.block.nothing", FAILED, "this case has no sheets.block.nothing"),
            (["run.step=1 ms", "run.tolerance=1e-12"], "steps", INACCURATE, "above run.tolerance"),
        ],
    )
    def test_what_goes_wrong_is_a_row_with_its_reason(
        self, sets: list[str], measured: str, kind: str, message: str
    ) -> None:
        asked = task(INCLINE, [*SHORT, *sets], measures=(("m", measured),), check_step=kind == INACCURATE)
        row = perform.perform(asked, Case(3, ((FRICTION, "0.2"),)))
        assert (row.index, row.kind) == (3, kind) and message in row.status
        assert row.measured == (kind == INACCURATE) and bool(row.measures) == row.measured

    def test_a_failed_run_and_an_internal_error_too(self, monkeypatch: pytest.MonkeyPatch) -> None:
        asked = task(INCLINE, SHORT, measures=(("steps", "steps"),))
        case = Case(0, ((FRICTION, "0.2"),))
        good = mdlgen.solve(asked.model(case))
        monkeypatch.setattr("mdlgen.registry.solve", lambda *_: good.failed("went wrong at 1 ms"))
        row = perform.perform(asked, case)
        assert (row.kind, row.status, row.measures) == (FAILED, "went wrong at 1 ms", {})

        def broken(*_: object) -> None:
            raise ZeroDivisionError("oh")

        monkeypatch.setattr("mdlgen.registry.solve", broken)
        assert perform.perform(asked, case).status == "internal error: ZeroDivisionError: oh"

    def test_a_row_comes_back_from_its_line(self) -> None:
        row = CaseRow(
            2, (("a", "1 mm"),), OK, "ok", {"m": 0.1, "n": None}, 1e-5, "lattice", Times(0.5), "here"
        )
        assert CaseRow.of(json.loads(json.dumps(row.json()))) == row


def twelve() -> sweep.Sweep:
    return wanted(f"{FRICTION}=0.1:0.3:6", "sheets.block.thickness=[10 mm, 10.0 mm]")


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a sweep that nothing disturbed."""
    folder = tmp_path_factory.mktemp("sweep") / "whole"
    rows, ran = swept(folder, twelve())
    assert ran == len(rows) == 12
    return folder


class TestSweep:
    def test_a_row_for_each_case(self, whole: Path) -> None:
        rows = read(whole / "table.csv")
        assert [row["case"] for row in rows] == [str(k) for k in range(12)]
        assert rows[3][FRICTION] == "0.14" and rows[3]["sheets.block.thickness [mm]"] == "10.0"
        travel = [float(row["sheets.block.travel_mm.x"]) for row in rows]
        assert travel[::2] == travel[1::2] and travel == sorted(travel, reverse=True)
        assert not any(
            "_s" in name.rpartition(".")[2] for name in rows[0] if name != "status" and "mm" not in name
        )
        assert float(read(whole / "times.csv")[0]["case_s"]) > 0.0

    @pytest.mark.parametrize("done", [0, 5, 12])
    def test_an_interrupt_and_resume_give_the_same_table(
        self, whole: Path, tmp_path: Path, done: int
    ) -> None:
        folder = tmp_path / "cut"
        if done < 12:
            with pytest.raises(KeyboardInterrupt):
                swept(folder, twelve(), stop=done)
        else:
            swept(folder, twelve())
        path = folder / journal.NAME
        path.write_bytes(path.read_bytes() + b'{"index": 11, "kind": "o')  # as a power cut leaves it
        rows, ran = swept(folder, twelve(), resume=True)
        assert ran == 12 - done and len(rows) == 12
        assert (folder / "table.csv").read_bytes() == (whole / "table.csv").read_bytes()
        # and all lines of the journal are whole
        assert len(journal.read(folder)[1]) == 12

    def test_what_was_lost_is_run_again(self, whole: Path, tmp_path: Path) -> None:
        folder = tmp_path / "lost"
        asked = twelve()
        with journal.Journal.create(folder, asked.asked()) as kept:
            for row in journal.read(whole)[1].values():
                kept.append(replace(row, kind=LOST, status="killed", measures={}) if row.index == 4 else row)
        _, ran = swept(folder, asked, resume=True)
        assert ran == 1
        assert (folder / "table.csv").read_bytes() == (whole / "table.csv").read_bytes()

    def test_another_sweep_is_refused_by_name(self, whole: Path) -> None:
        with pytest.raises(RefusedError, match=r"holds a sweep \(12 cases\) already; --resume"):
            sweep.opened(whole, twelve(), False)
        base = twelve()
        for other, message in (
            (replace(base, cases=base.cases[:5]), "--over"),
            (replace(base, task=replace(base.task, sets=())), "--set"),
            (replace(base, task=replace(base.task, text=base.task.text + "\n")), "the scene"),
            (replace(base, task=replace(base.task, measures=())), "--measure"),
            (replace(base, task=replace(base.task, solver="exudyn")), "--solver"),
            (replace(base, model="0"), "a file that the scene names has changed"),
        ):
            with pytest.raises(RefusedError, match=message):
                sweep.opened(whole, other, True)

    def test_other_versions_are_refused_by_name(self, whole: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr("numpy.__version__", "1.0")
        with pytest.raises(RefusedError, match=r"numpy \(.*, now 1.0\) has changed"):
            sweep.opened(whole, None, True)

    def test_only_one_process_at_a_time(self, whole: Path) -> None:
        with journal.Journal.resume(whole), pytest.raises(OutputError, match="another process is at work"):
            journal.Journal.resume(whole)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("", "was cut off before it began"),
            ('{"mdlgen":1', "was cut off before it began"),
            ('{"mdlgen":2,"asked":{}}\n', ":1: is not a line of a study"),
            ('{"mdlgen":1,"asked":{"what":"sweep"}}\n', "not of a sweep"),
            ('{"mdlgen":1,"asked":{"what":"else"}}\n', "not of a sweep"),
            ('{"mdlgen":1,"asked":{}}\n{"index":0}\n', ":2: is not a line of a study"),
            ("[" * 5000 + "\n", ":1: is not a line of a study"),
        ],
    )
    def test_a_journal_that_is_none_ends_in_a_line(self, tmp_path: Path, text: str, message: str) -> None:
        (tmp_path / journal.NAME).write_text(text)
        code, _, err = cli("sweep", "--resume", tmp_path)
        assert code == 3 and message in err and len(err.splitlines()) == 1

    def test_a_measure_may_not_have_the_name_of_a_value(self) -> None:
        with pytest.raises(SpecError, match="'name' stands twice in the table"):
            wanted("name=[a, b]", measures=["name=steps"])

    def test_runs_are_kept_where_asked_for(self, tmp_path: Path) -> None:
        rows, _ = swept(tmp_path / "kept", wanted(f"{FRICTION}=0.1:0.2:2", keep=True))
        result = mdlgen.Result.load(tmp_path / "kept" / "case_1")
        assert f"# --set {FRICTION}=0.2\n" in result.source
        note = json.loads((tmp_path / "kept" / "case_1" / "summary.json").read_text())["sheets"]["block"]
        assert rows[1].measures["sheets.block.yaw_deg"] == note["yaw_deg"]
        assert "files" not in rows[1].json()

    def test_the_summary_line_names_what_failed(self) -> None:
        bad = [CaseRow(k, (), REFUSED, "no such thing") for k in range(3)]
        rows = [
            *bad,
            CaseRow(3, (), FAILED, "did not converge"),
            *(CaseRow(k, (), OK, "ok") for k in range(4, 40)),
        ]
        assert sweep.summary(rows) == (
            "4 of 40 cases failed: 3 x no such thing (case 0); 1 x did not converge (case 3)"
        )
        assert sweep.summary(rows[4:]) == "36 cases, none failed"


class TestTable:
    ROWS = (
        CaseRow(1, (("a", "2 mm"), ("b", "x")), OK, "ok", {"m": 0.1, "n": None}, 1e-5, "lattice"),
        CaseRow(0, (("a", "1.5 mm"), ("b", "y, z")), REFUSED, 'the "thing"'),
    )

    def test_numbers_have_all_their_digits_and_gaps_are_empty(self) -> None:
        assert table.csv_text(table.columns(self.ROWS, ["m", "n"])) == (
            "case,a [mm],b,m,n,status,reason,error_estimate,solver\n"
            '0,1.5,"y, z",,,refused,"the ""thing""",,\n'
            "1,2.0,x,0.1,,ok,,1e-05,lattice\n"
        )

    def test_parquet_holds_the_same(self) -> None:
        arrow = pytest.importorskip("pyarrow.parquet")
        found = arrow.read_table(io.BytesIO(table.parquet(table.columns(self.ROWS, ["m", "n"])))).to_pydict()
        assert found["a [mm]"] == [1.5, 2.0] and found["m"] == [None, 0.1] and found["n"] == [None, None]
        assert found["status"] == ["refused", "ok"] and found["case"] == [0, 1]

    def test_without_pyarrow_it_is_refused_before_anything_runs(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(table, "installed", lambda: False)
        over = ["--over", f"{FRICTION}=0.1:0.2:2"]
        code, _, err = cli("sweep", INCLINE, *over, "--parquet", "-o", tmp_path / "x")
        assert code == 2 and "pip install 'mdlgen[sweep]'" in err and len(err.splitlines()) == 1
        assert not (tmp_path / "x").exists()


class Deadly(Case):
    """A case that kills the process which runs it."""

    @property
    def overrides(self) -> tuple[str, ...]:
        os.kill(os.getpid(), signal.SIGKILL)
        return ()


class TestProcesses:
    """By real processes, one module's worth of them: each takes seconds to import a solver."""

    def test_a_dying_process_costs_its_case_alone(self) -> None:
        asked = wanted(f"{FRICTION}=0.1:0.3:8", sets=["run.duration=20 ms"])
        cases = [*asked.cases[:7], Deadly(7, asked.cases[7].values)]
        alone = [perform.perform(asked.task, case) for case in asked.cases[:7]]
        with workers.Workers(2) as runner:
            rows: list[CaseRow] = []
            for row in runner.rows(asked.task, cases):
                rows.append(row)
                if len(rows) == 2:  # in mid-sweep
                    slot = next(s for s in runner._slots if s is not None)
                    slot.process.kill()
            again = list(runner.rows(asked.task, cases[:1]))
            pids = [slot.process.pid for slot in runner._slots if slot is not None]
        rows.sort(key=lambda row: row.index)
        assert [row.kind for row in rows] == [OK] * 7 + [LOST]
        assert rows[7].status == "its process was killed by SIGKILL, 2 times"
        names = list(alone[0].measures)
        bits = table.csv_text(table.columns(alone, names))
        assert table.csv_text(table.columns(rows[:7], names)) == bits
        assert [row.measures for row in again] == [alone[0].measures]
        for pid in pids:
            with pytest.raises(ProcessLookupError):
                os.kill(pid, 0)

    def test_interrupt_and_resume_from_the_command_line(self, tmp_path: Path) -> None:
        folder, whole = tmp_path / "cut", tmp_path / "whole"
        sets = ["run.duration=20 ms"]
        over = [f"{FRICTION}=0.1:0.3:10", "sheets.block.thickness=[10 mm, 5 m]"]
        swept(whole, wanted(*over, sets=sets))
        args = [*(part for text in over for part in ("--over", text)), "--set", sets[0], "--workers", "1"]
        command = [sys.executable, "-m", "mdlgen", "sweep", str(INCLINE), *args, "-o", str(folder)]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, start_new_session=True)
        path = folder / journal.NAME
        while not path.exists() or path.read_bytes().count(b"\n") < 4:
            assert process.poll() is None, process.communicate()
            time.sleep(0.02)
        os.killpg(process.pid, signal.SIGINT)
        _, err = process.communicate(timeout=60)
        assert process.returncode == 130
        assert f"mdlgen sweep --resume {folder} goes on" in err.decode() and "Traceback" not in err.decode()
        done = len(journal.read(folder)[1])
        assert 3 <= done < 20
        code, out, _ = cli("sweep", "--resume", folder, "--workers", "1")
        assert code == 0
        assert out.startswith("10 of 20 cases failed: 10 x sheets.block.thickness: 5 m is outside")
        assert (folder / "table.csv").read_bytes() == (whole / "table.csv").read_bytes()


def test_a_process_that_cannot_be_started_ends_the_sweep(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(12, "Cannot allocate memory")

    monkeypatch.setattr(subprocess, "Popen", full)
    asked = task(INCLINE, SHORT)
    with workers.Workers(2) as runner, pytest.raises(OutputError, match="Cannot allocate memory"):
        list(runner.rows(asked, [Case(0, ()), Case(1, ())]))


class TestCommand:
    OVER = ("--over", f"{FRICTION}=0.1:0.2:2")

    @pytest.mark.parametrize(
        ("args", "code", "message"),
        [
            ([], 2, "name a scene"),
            ([INCLINE], 2, "name what is to differ"),
            ([INCLINE, "--over", "contacts.0.frction=0.1:0.2:2"], 2, "did you mean 'friction'?"),
            ([INCLINE, "--over", "contacts.9.friction=0.1:0.2:2"], 2, "no item '9'"),
            ([INCLINE, *OVER, "--solver", "latice"], 2, "did you mean 'lattice'?"),
            ([INCLINE, *OVER, "--measure", "sheets.blok.yaw_deg"], 2, "did you mean 'sheets.block.yaw_deg'?"),
            ([INCLINE, *OVER, "--scheduler", "here"], 2, "is no address"),
            ([INCLINE, *OVER, "--scheduler", "tcp://a:1", "--workers", "2"], 2, "--workers are processes"),
            ([INCLINE, *OVER, "--sample", "lhs", "4"], 2, FRICTION),
            (["nowhere.yaml", *OVER], 3, "nowhere.yaml"),
            (["--resume", "nowhere"], 3, "holds no study to go on with"),
            (["--resume", "nowhere", "--measure", "steps"], 2, "takes scene, values, measures"),
        ],
    )
    def test_what_cannot_be_meant_ends_in_a_line(
        self, args: list[object], code: int, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.chdir(tmp_path)
        found, out, err = cli("sweep", *args)
        assert (found, out) == (code, "") and message in err, err
        assert len(err.splitlines()) == 1 and not (tmp_path / "out").exists()

    def test_when_all_fail_it_says_so(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def failed(self: workers.Workers, task: Task, cases: Sequence[Case]) -> Iterator[CaseRow]:
            yield from (CaseRow(case.index, case.values, FAILED, "no") for case in cases)

        monkeypatch.setattr(workers.Workers, "rows", failed)
        code, out, err = cli("sweep", INCLINE, *self.OVER, "-o", tmp_path / "x")
        assert code == 4 and out.startswith("2 of 2 cases failed: 2 x no (case 0)")
        assert "all cases failed" in err and len(read(tmp_path / "x" / "table.csv")) == 2
