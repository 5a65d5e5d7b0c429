"""The process that runs scenes for `mdlgen live`: it has all loaded, and does one run at a time.

Frames come on standard input: a job, or the number of one that is to end. It answers with frames on standard
output, and ends when its input does.
"""

from __future__ import annotations

import json
import logging
import os
import signal
import sys
from queue import SimpleQueue
from threading import Lock, Thread
from typing import IO, Any

from mdlgen.live.frames import HEAD, lengths, packed
from mdlgen.live.job import Job, perform


class _Inbox:
    """Jobs as they come, and which of them is to end."""

    def __init__(self, stream: IO[bytes]):
        self.jobs: SimpleQueue[Job] = SimpleQueue()
        self.ended = 0  # this job, and all before it
        self._stream = stream
        Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        while len(head := self._stream.read(HEAD)) == HEAD:
            length, more = lengths(head)
            record = json.loads(self._stream.read(length))
            self._stream.read(more)
            if "ended" in record:
                self.ended = record["ended"]
            else:
                self.jobs.put(Job.of(record))
        os._exit(0)  # nobody waits for an answer, and a run may go on for long


class _Words(logging.Handler):
    """Reports that a solver's program is prepared, or compiled."""

    def __init__(self, report: Any):
        super().__init__(logging.INFO)
        self._report = report

    def emit(self, record: logging.LogRecord) -> None:
        self._report("compiling" if getattr(record, "parts", 0) else "preparing")


def main() -> None:
    """Entry point of `python -m mdlgen.live.worker`."""
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal
    lock, number = Lock(), 0

    def send(record: dict[str, Any], body: bytes = b"") -> None:
        with lock:
            answer.write(packed({"number": number, **record}, body))
            answer.flush()

    log = logging.getLogger("mdlgen.compiling")
    log.setLevel(logging.INFO)
    log.propagate = False
    log.addHandler(_Words(lambda word: send({"kind": "word", "word": word})))
    inbox = _Inbox(sys.stdin.buffer)
    while True:
        job = inbox.jobs.get()
        number = job.number
        if number > inbox.ended:
            perform(job, send, lambda: inbox.ended >= number)  # noqa: B023  called before it changes
        else:
            send({"kind": "ended", "how": "cancelled"})


if __name__ == "__main__":
    try:
        main()
    except BrokenPipeError:  # nobody waits for it any more
        os._exit(0)
