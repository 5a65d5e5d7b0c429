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

import pytest
from sweeps import FRICTION, INCLINE, SHORT, wanted
from typer.testing import CliRunner

import mdlgen
from mdlgen.cli import app
from mdlgen.errors import OutputError, RefusedError, SpecError
from mdlgen.study import sweep
from mdlgen.study.analysis import table
from mdlgen.study.design.case import Case
from mdlgen.study.design.task import Task, task
from mdlgen.study.execution import journal, perform, workers
from mdlgen.study.execution.row import FAILED, INACCURATE, LOST, OK, REFUSED, CaseRow, Times
from mdlgen.study.output.files import write


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
            (["run.step=1 ms", "run.tolerance=1e-12"], "steps", INACCURATE, "nothing was compared"),
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
        unknown = replace(good, status="inaccurate", error_unknown="the error is not known")
        monkeypatch.setattr("mdlgen.registry.solve", lambda *_, **__: unknown)
        row = perform.perform(asked, case)
        assert row.kind == INACCURATE and row.status == "the error is not known" and row.measures
        monkeypatch.setattr("mdlgen.registry.solve", lambda *_, **__: good.failed("went wrong at 1 ms"))
        row = perform.perform(asked, case)
        assert (row.kind, row.status, row.measures) == (FAILED, "went wrong at 1 ms", {})

        def broken(*_: object, **__: object) -> None:
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

    def test_of_a_scene_that_requires_something_the_share_that_passes_is_known(self, tmp_path: Path) -> None:
        asked = 'require=["sheets.block.travel above 1 um"]'
        code, out, _ = cli(
            *("sweep", INCLINE, "--set", "run.duration=2 ms", "--set", asked),
            *("--over", f"{FRICTION}=[0.1, 2.0]", "-o", tmp_path, "--workers", "1"),
        )
        assert code == 0 and [row["pass"] for row in read(tmp_path / "table.csv")] == ["1.0", "0.0"]
        assert "probability of pass: 0.5" in out and "1 of 2 cases" in out
        # verdicts that are asked for are enough
        own = wanted(f"{FRICTION}=[0.1, 2.0]", measures=["verdict.passed"], sets=[*SHORT, asked])
        assert own.task.events == () and wanted(f"{FRICTION}=[0.1, 2.0]").task.events == ()

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
        assert f"mdlgen sweep --resume {folder} continues" in err.decode() and "Traceback" not in err.decode()
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
            (["--resume", "nowhere"], 3, "holds no study to continue"),
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
