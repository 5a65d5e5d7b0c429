"""Runs the bench of the numbers and writes its files."""

from __future__ import annotations

import contextlib
import json
import multiprocessing
import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from mdlgen import paths
from mdlgen.bench.machine import machine, versions
from mdlgen.bench.process import THREADS
from mdlgen.bench.tuning.numbers import numbers
from mdlgen.bench.tuning.report import said, table
from mdlgen.bench.tuning.row import Reference, Tuning, TuningRow
from mdlgen.errors import OutputError
from mdlgen.extras import require

Say = Callable[[str], None]
# Rows between two writes of tuning.json; a bench that is killed loses fewer.
OFTEN = 20


def tuning(folder: Path, say: Say = lambda text: None) -> Tuning:
    """Halve and double each number of the lattice solver on all scenes.

    Writes tuning.json and tuning.md into `folder`. It compiles the solver first, which takes minutes. Raises
    OutputError where numba is not installed, where the system cannot copy a process, where a scene does not
    repeat, or for files that cannot be written.
    """
    require("numba")
    if "fork" not in multiprocessing.get_all_start_methods():
        raise OutputError("the suite tuning runs on Linux and macOS alone: it needs copies of a process")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot make this folder: {error.strerror or error}") from None
    found = Tuning(numbers(), dict(machine()), versions())
    say("compiling the solver with its numbers as variables")
    try:
        for message in _messages():
            if isinstance(message, Reference):
                found.references.append(message)
                say(f"{message.scene}: {message.status}, {message.steps} steps in {message.cpu_s:.3g} s")
                continue
            found.rows.append(message)
            say(f"{len(found.rows)}/{_rows(found)} {said(message)}")
            if len(found.rows) % OFTEN == 0:
                write(found, folder)
    finally:  # an interrupted bench keeps its rows
        write(found, folder)
    return found


def _rows(found: Tuning) -> int:
    from mdlgen.bench.tuning.worker import FACTORS

    return len(FACTORS) * sum(not number.frozen for number in found.numbers)


def _messages() -> Iterator[Reference | TuningRow]:
    """The messages of the worker. Raises OutputError where it ends early."""
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "mdlgen.bench.tuning.worker"],
            stdout=subprocess.PIPE,
            stderr=log,
            env={
                **os.environ,
                **dict.fromkeys(THREADS, "1"),
                "MDLGEN_NUMBA": "1",
                "PYTHONPATH": os.pathsep.join(sys.path),
            },
        )
        assert process.stdout is not None
        try:
            with contextlib.suppress(EOFError):
                while True:
                    yield pickle.load(process.stdout)
            if process.wait():
                log.seek(0)
                record = log.read().decode("utf-8", "replace").strip().splitlines()
                raise OutputError(f"the suite tuning ended early: {record[-1] if record else ''}"[:300])
        finally:
            process.kill()
            process.wait()


def write(found: Tuning, folder: Path) -> None:
    """tuning.json and tuning.md; both or none. Raises OutputError."""
    files: dict[Path, str | bytes] = {
        folder / "tuning.json": json.dumps(found.json(), indent=1, allow_nan=False) + "\n",
        folder / "tuning.md": table(found),
    }
    paths.write_together(files)
