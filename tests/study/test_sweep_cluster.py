"""The same sweep on a Dask cluster: a scheduler and two workers, each a process of its own, on loopback."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.errors import RefusedError
from mdlgen.paths import samples
from mdlgen.study import sweep
from mdlgen.study.analysis import table
from mdlgen.study.design.case import Case
from mdlgen.study.design.task import task
from mdlgen.study.execution import journal, perform

pytest.importorskip("distributed")

INCLINE = samples() / "verify" / "incline.yaml"
OVER = ("contacts.0.friction=0.1:0.3:10", "sheets.block.thickness=[10 mm, 5 m]")
SETS = ["run.duration=50 ms"]


class Local(NamedTuple):
    """A cluster on loopback."""

    address: str
    workers: dict[str, subprocess.Popen[bytes]]


def dask(*args: str, folder: Path) -> subprocess.Popen[bytes]:
    """A process of Dask, which writes into `folder/log`."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    log = (folder / "log").open("ab")
    command = [sys.executable, "-m", "dask", *args, "--no-dashboard", "--host", "127.0.0.1"]
    return subprocess.Popen(command, cwd=folder, env=environment, stdout=log, stderr=log)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Local]:
    folder = tmp_path_factory.mktemp("dask")
    note = str(folder / "scheduler.json")
    processes = [dask("scheduler", "--port", "0", "--scheduler-file", note, folder=folder)]
    workers = {}
    for name in ("one", "two"):
        args = ("worker", "--scheduler-file", note, "--nthreads", "1", "--no-nanny", "--name", name)
        workers[name] = dask(*args, folder=folder)
    processes += workers.values()
    try:
        end = time.monotonic() + 240.0
        while not Path(note).exists() or not Path(note).read_text().endswith("}"):
            assert time.monotonic() < end, (folder / "log").read_text()
            time.sleep(0.1)
        yield Local(json.loads(Path(note).read_text())["address"], workers)
    finally:
        for process in processes:
            process.kill()
            process.wait()


def arguments(folder: Path, *more: str) -> list[str]:
    over = [part for text in OVER for part in ("--over", text)]
    return ["sweep", str(INCLINE), *over, "--set", SETS[0], "-o", str(folder), *more]


@pytest.fixture(scope="module")
def asked() -> sweep.Sweep:
    cases, how = sweep.over(OVER, None, 1)
    return sweep.sweep(task(INCLINE, SETS), cases, how)


@pytest.fixture(scope="module")
def expected(asked: sweep.Sweep) -> str:
    """The table, from runs in this process."""
    rows = [perform.perform(asked.task, case) for case in asked.cases]
    return table.csv_text(table.columns(rows, [name for name, _ in asked.task.measures]))


def test_the_table_is_the_same_to_the_last_bit(cluster: Local, expected: str, tmp_path: Path) -> None:
    from distributed import Client

    with Client(cluster.address, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=240)
    done = CliRunner().invoke(app, arguments(tmp_path / "x", "--scheduler", cluster.address))
    assert done.exit_code == 0, done.stderr
    assert done.stdout.startswith("10 of 20 cases failed: 10 x sheets.block.thickness: 5 m is outside")
    assert (tmp_path / "x" / "table.csv").read_text() == expected
    where = {row.worker for row in journal.read(tmp_path / "x")[1].values()}
    assert len(where) == 2 and all(name.startswith("tcp://127.0.0.1:") for name in where)


def test_a_worker_with_other_versions_is_refused_by_name(
    cluster: Local, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from mdlgen.study.execution import cluster as room

    monkeypatch.setattr(room, "_here", lambda: {**room.versions(), "numpy": "1.0"})
    done = CliRunner().invoke(app, arguments(tmp_path / "x", "--scheduler", cluster.address))
    assert done.exit_code == 2 and "this worker has numpy" in done.stderr and ", here 1.0;" in done.stderr
    assert len(done.stderr.splitlines()) == 1 and not (tmp_path / "x").exists()


def test_a_worker_that_comes_later_is_looked_at_too() -> None:
    from mdlgen.study.execution import cluster as room

    assert room.differences(room.versions(), room.versions()) == ""
    with pytest.raises(RuntimeError, match=r"other code of the solver; numba .*, here 0.1"):
        room.checked(task(INCLINE), Case(0, ()), {**room.versions(), "code": "x", "numba": "0.1"})


def test_a_worker_killed_in_mid_sweep_costs_its_case_alone(
    cluster: Local, asked: sweep.Sweep, expected: str
) -> None:
    from mdlgen.study.execution.cluster import Cluster

    rows = []
    with closing(Cluster(cluster.address)) as runner:
        for row in runner.rows(asked.task, asked.cases):
            rows.append(row)
            if len(rows) == 3:
                cluster.workers["one"].send_signal(signal.SIGKILL)
    assert table.csv_text(table.columns(rows, [name for name, _ in asked.task.measures])) == expected


def test_no_scheduler_and_no_dask_end_in_a_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from mdlgen.study.execution import cluster as room

    monkeypatch.setattr(room, "PATIENCE", 0.5)
    done = CliRunner().invoke(app, arguments(tmp_path / "x", "--scheduler", "tcp://127.0.0.1:9"))
    assert done.exit_code == 3 and "no scheduler answers there" in done.stderr
    assert len(done.stderr.splitlines()) == 1 and not (tmp_path / "x").exists()
    missing: Any = None
    monkeypatch.setitem(sys.modules, "distributed", missing)
    with pytest.raises(RefusedError, match=r"pip install 'mdlgen\[cluster\]'"):
        room.Cluster("tcp://127.0.0.1:9")
