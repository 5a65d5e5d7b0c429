"""The worker of a session, seen from the server: jobs go to it, frames come back, and it can be ended."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from mdlgen.live.frames import HEAD, lengths, packed
from mdlgen.live.job import Job

# Libraries of linear algebra would start threads of their own, where the solver has its own.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")

Heard = Callable[[dict[str, Any], bytes], None]


class Worker:
    """One process; `heard` is called with each frame, `died` where it ends by itself."""

    def __init__(self, heard: Heard, died: Callable[[], None]):
        self._heard, self._died = heard, died
        self._process: asyncio.subprocess.Process | None = None
        self._reader: asyncio.Task[None] | None = None

    async def start(self) -> None:
        """Raises OSError where there is none to be had."""
        self._process = await asyncio.create_subprocess_exec(
            sys.executable,
            "-m",
            "mdlgen.live.worker",
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
            env={**os.environ, **dict.fromkeys(THREADS, "1"), "PYTHONPATH": os.pathsep.join(sys.path)},
        )
        self._reader = asyncio.create_task(self._read(self._process))

    async def _read(self, process: asyncio.subprocess.Process) -> None:
        import json

        assert process.stdout is not None
        with contextlib.suppress(asyncio.IncompleteReadError, OSError):
            while True:
                length, more = lengths(await process.stdout.readexactly(HEAD))
                record = json.loads(await process.stdout.readexactly(length))
                self._heard(record, await process.stdout.readexactly(more))
        if process is self._process:
            self._process = None
            await process.wait()
            self._died()

    def ask(self, job: Job) -> None:
        self._write(asdict(job))

    def cancel(self, number: int) -> None:
        """Ends the job of that number, and those before it."""
        self._write({"ended": number})

    def _write(self, record: dict[str, Any]) -> None:
        if self._process is not None and self._process.stdin is not None:
            with contextlib.suppress(OSError):  # it has ended, which is heard where its answers are read
                self._process.stdin.write(packed(record))

    async def end(self) -> None:
        """Ends the process, whatever it does."""
        process, self._process = self._process, None
        if self._reader is not None:
            self._reader.cancel()
        if process is not None and process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
            await process.wait()
