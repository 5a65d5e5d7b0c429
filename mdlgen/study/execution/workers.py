"""Processes of this machine that run cases: each at its own pace, on one thread, and one that dies costs its
case alone."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import tempfile
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from queue import Empty, SimpleQueue
from threading import Event, Lock, Thread
from typing import Protocol

from mdlgen.errors import OutputError
from mdlgen.processors import processors
from mdlgen.study.design.case import Case
from mdlgen.study.design.task import Task
from mdlgen.study.execution.row import LOST, REFUSED, CaseRow
from mdlgen.study.execution.worker import BEGUN, COMPILING, PREPARING

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
TRIES = 2  # of a case whose process dies
MOST = 256

Heard = Callable[[str], None]


class Runner(Protocol):
    """A runner of cases: processes of this machine, or a cluster."""

    def rows(self, task: Task, cases: Sequence[Case]) -> Iterator[CaseRow]:
        """The rows of the cases, as they are done."""
        ...

    def close(self) -> None: ...


class _Process:
    """One worker; it gets the task once."""

    def __init__(self) -> None:
        self.log = tempfile.TemporaryFile()  # noqa: SIM115
        self.process = subprocess.Popen(
            [sys.executable, "-m", "mdlgen.study.execution.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.log,
            env={**os.environ, **dict.fromkeys(THREADS, "1"), "PYTHONPATH": os.pathsep.join(sys.path)},
        )
        self.task: Task | None = None

    def ask(self, task: Task, case: Case, heard: Heard) -> CaseRow | None:
        """The row of a case; None where the process ended before it."""
        assert self.process.stdin is not None and self.process.stdout is not None
        try:
            if self.task is not task:
                pickle.dump(task, self.process.stdin)
                self.task = task
            pickle.dump(case, self.process.stdin)
            self.process.stdin.flush()
            while not isinstance(message := pickle.load(self.process.stdout), CaseRow):
                heard(message)
        except (EOFError, OSError, ValueError, pickle.UnpicklingError):
            return None
        return message

    def ended(self) -> str:
        """How it died."""
        self.kill()
        code = self.process.returncode
        if code < 0:
            with contextlib.suppress(ValueError):
                return f"was killed by {signal.Signals(-code).name}"
            return f"was killed by signal {-code}"
        self.log.seek(0, os.SEEK_END)
        self.log.seek(max(0, self.log.tell() - 2000))
        record = self.log.read().decode("utf-8", "replace").strip().splitlines()
        return f"ended with code {code}{': ' + record[-1] if record else ''}"[:300]

    def kill(self) -> None:
        with contextlib.suppress(OSError):
            self.process.stdin.close()  # type: ignore[union-attr]
        try:
            self.process.wait(0.2)  # one that died by itself says how
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


class Workers:
    """`count` processes (None: one for each processor), started when they are needed.

    `heard` is called with PREPARING or COMPILING once where the solver is, which one process does for all.
    """

    def __init__(self, count: int | None = None, heard: Heard = lambda word: None):
        self.count = count or processors()
        self._heard = heard
        self._slots: list[_Process | None] = [None] * self.count
        self._lock = Lock()
        self._closed = False

    def rows(self, task: Task, cases: Sequence[Case]) -> Iterator[CaseRow]:
        """The rows of the cases, as they are done; of a case that kills its process twice, what killed it.

        Raises OutputError where no process can be started.
        """
        todo = deque(cases)
        done: SimpleQueue[CaseRow | Exception] = SimpleQueue()
        compiled = Event()  # before that a second process would compile the same
        threads = [
            Thread(target=self._work, args=(slot, task, todo, done, compiled), daemon=True)
            for slot in range(min(self.count, len(cases)))
        ]
        for thread in threads:
            thread.start()
        for _ in cases:
            row: CaseRow | Exception | None = None
            while row is None:
                with contextlib.suppress(Empty):
                    row = done.get(timeout=0.5)  # some systems hear an interrupt only between two waits
            if isinstance(row, Exception):
                raise row
            yield row

    def _work(
        self,
        slot: int,
        task: Task,
        todo: deque[Case],
        done: SimpleQueue[CaseRow | Exception],
        compiled: Event,
    ) -> None:
        if slot:
            compiled.wait()

        def heard(word: str) -> None:
            if word == BEGUN:
                compiled.set()
            elif word in (COMPILING, PREPARING):
                self._heard(word)

        try:
            while not self._closed:
                try:
                    case = todo.popleft()
                except IndexError:
                    return
                row = self._row(slot, task, case, heard)
                if row.kind != REFUSED:
                    compiled.set()
                done.put(row)
        except OSError as error:
            done.put(OutputError(f"a process cannot be started: {error.strerror or error}"))
        except Exception as error:  # it is raised where the rows are waited for
            done.put(error)
        finally:
            compiled.set()

    def _row(self, slot: int, task: Task, case: Case, heard: Heard) -> CaseRow:
        why = ""
        for _ in range(TRIES):
            process = self._process(slot)
            row = process.ask(task, case, heard) if process else None
            if row is not None:
                return replace(row, worker=f"process {slot}")
            if process is None or self._closed:
                break
            why = process.ended()
            self._slots[slot] = None
        return CaseRow(
            case.index, case.values, LOST, f"its process {why}, {TRIES} times", worker=f"process {slot}"
        )

    def _process(self, slot: int) -> _Process | None:
        """The process of a slot, a new one where there is none; None where all is at an end."""
        with self._lock:
            if self._closed:
                return None
            found = self._slots[slot] = self._slots[slot] or _Process()
            return found

    def close(self) -> None:
        """Ends the processes, whatever they do."""
        with self._lock:
            self._closed = True
        for process in self._slots:
            if process is not None:
                process.process.kill()
                process.kill()

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
