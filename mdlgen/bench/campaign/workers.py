"""Processes that run scenes of a campaign. If one crashes or exceeds its limit, one scene has no result."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import tempfile
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import replace
from queue import Empty, SimpleQueue
from threading import Lock, Thread, Timer

from mdlgen.bench.campaign.row import NONE, CampaignRow, Finer
from mdlgen.bench.campaign.task import FINER, Begun, Task
from mdlgen.bench.process import STARTING, THREADS
from mdlgen.errors import OutputError

# Limit of wall time relative to that of processor time. It ends a process that waits forever, and allows for
# other programs. Where the system cannot limit processor time, wall time is the limit.
WALL = 5.0 if hasattr(signal, "SIGXCPU") else 1.0
# Preparing a solver may compile it, which takes minutes [s].
COMPILING = 1800.0


class _Process:
    """One worker process."""

    def __init__(self) -> None:
        self.log = tempfile.TemporaryFile()  # noqa: SIM115
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", "mdlgen.bench.campaign.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.log,
            env={**os.environ, **dict.fromkeys(THREADS, "1"), "PYTHONPATH": os.pathsep.join(sys.path)},
        )
        self.late = False  # true if it was ended because it took too long

    def send(self, task: Task) -> None:
        """Raises OSError where the process has ended."""
        assert self.process.stdin is not None
        pickle.dump(task, self.process.stdin)
        self.process.stdin.flush()

    def next(self, limit: float) -> object:
        """Returns its next message within a limit [s]. Raises EOFError if it ends first."""
        assert self.process.stdout is not None

        def stop() -> None:
            self.late = True
            self.process.kill()

        timer = Timer(limit, stop)
        timer.start()
        try:
            return pickle.load(self.process.stdout)
        except (OSError, ValueError, pickle.UnpicklingError) as error:
            raise EOFError from error
        finally:
            timer.cancel()

    @property
    def exceeded(self) -> bool:
        """True if the system ended it at its limit of processor time."""
        return hasattr(signal, "SIGXCPU") and self.process.returncode == -signal.SIGXCPU

    def ended(self) -> str:
        """Ends the process and returns how it ended."""
        self._wait()
        code = self.process.returncode
        self.log.seek(0, os.SEEK_END)
        self.log.seek(max(0, self.log.tell() - 2000))
        record = self.log.read().decode("utf-8", "replace").strip().splitlines()
        self.log.close()
        if code >= 0:
            return f"the process ended with code {code}{': ' + record[-1] if record else ''}"[:300]
        with contextlib.suppress(ValueError):
            return f"the process crashed: {signal.Signals(-code).name}"
        return f"the process was ended by signal {-code}"

    def close(self) -> None:
        """Ends the process at once."""
        self.process.kill()
        self._wait()
        self.log.close()

    def _wait(self) -> None:
        with contextlib.suppress(OSError):
            self.process.stdin.close()  # type: ignore[union-attr]
        try:
            self.process.wait(0.2)  # one that died by itself says how
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()  # type: ignore[union-attr]


class Workers:
    """`count` processes, started when they are needed."""

    def __init__(self, count: int, solver: str = "auto"):
        self._count, self._solver = count, solver
        self._slots: list[_Process | None] = [None] * count
        self._lock = Lock()
        self._closed = False

    def rows(self, tasks: Sequence[Task]) -> Iterator[CampaignRow]:
        """Yields the rows in the order in which they finish. Raises OutputError where no process starts."""
        todo, done = deque(tasks), SimpleQueue[CampaignRow | Exception]()
        for slot in range(min(self._count, len(tasks))):
            Thread(target=self._work, args=(slot, todo, done), daemon=True).start()
        for _ in tasks:
            row: CampaignRow | Exception | None = None
            while row is None:
                with contextlib.suppress(Empty):
                    row = done.get(timeout=0.5)  # some systems hear an interrupt only between two waits
            if isinstance(row, Exception):
                raise row
            yield row

    def _work(self, slot: int, todo: deque[Task], done: SimpleQueue[CampaignRow | Exception]) -> None:
        try:
            while not self._closed:
                try:
                    task = todo.popleft()
                except IndexError:
                    return
                done.put(self._row(slot, task))
        except OSError as error:
            done.put(OutputError(f"a process cannot be started: {error.strerror or error}"))
        except Exception as error:  # it is raised where the rows are waited for
            done.put(error)

    def _row(self, slot: int, task: Task) -> CampaignRow:
        """Returns the row of a scene, also where its process crashes."""
        row = CampaignRow(task.number, task.kind, NONE)
        process, limit = self._process(slot), STARTING
        try:
            process.send(task)
            said = process.next(limit)
            if isinstance(said, Begun):
                row = replace(row, kind=said.kind, boxes=said.boxes, rejected=said.rejected)
                limit = task.limit
                said = process.next(WALL * limit)
            assert isinstance(said, CampaignRow)
            row = said
            if not (task.fine and row.status != NONE and not row.chaotic and row.step_ms):
                return row
            limit = FINER * task.limit
            said = process.next(WALL * limit)
            assert isinstance(said, CampaignRow)
            return said
        except (EOFError, OSError):
            why = process.ended()
            self._slots[slot] = None
            late = process.late or process.exceeded
            why = f"above {limit:g} s; stopped" if late else why
            if row.status != NONE:  # the run is there, and a finer one is not
                return replace(row, finer=Finer(failed=f"at finer steps: {why}"))
            return replace(row, reason=why, stopped=late, cpu_s=limit if late else None)

    def _process(self, slot: int) -> _Process:
        """Returns the process of a slot, with its solver loaded. Starts one if needed."""
        with self._lock:
            if self._closed:
                raise OSError("closed")
        found = self._slots[slot]
        if found is None:
            found = self._slots[slot] = _Process()
            with self._lock:  # a second process would compile the same
                found.send(Task(0, 0, False, self._solver, compile=True))
                with contextlib.suppress(EOFError):
                    found.next(COMPILING)
        return found

    def close(self) -> None:
        """Ends all processes at once."""
        self._closed = True
        for process in self._slots:
            if process is not None:
                process.close()

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
