"""The process in which cases of a study are run, one after the other.

A Task or a Case comes pickled on standard input; for each Case a Row goes pickled to standard output, and
before it the words about compiling. Whatever a solver prints goes to standard error.
"""

from __future__ import annotations

import logging
import os
import pickle
import signal
import sys
from typing import IO

from mdlgen.study.design.case import Case
from mdlgen.study.design.task import Task
from mdlgen.study.execution.perform import perform

# Words that stand before a row: the solver's program is prepared; something is compiled; the solver is at
# work, so all of it is there.
PREPARING, COMPILING, BEGUN = "preparing", "compiling", "begun"


class _Tell(logging.Handler):
    """Says once that a program is prepared, and once that something is compiled."""

    def __init__(self, stream: IO[bytes]):
        super().__init__(logging.INFO)
        self.stream, self.said = stream, set[str]()

    def emit(self, record: logging.LogRecord) -> None:
        word = COMPILING if getattr(record, "parts", 0) else PREPARING
        if word not in self.said:
            self.said.add(word)
            pickle.dump(word, self.stream)
            self.stream.flush()


def main() -> None:
    """Entry point of `python -m mdlgen.study.execution.worker`."""
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal
    log = logging.getLogger("mdlgen.compiling")
    log.setLevel(logging.INFO)
    log.propagate = False
    log.addHandler(_Tell(answer))
    task: Task | None = None

    def begun() -> None:
        pickle.dump(BEGUN, answer)
        answer.flush()

    while True:
        try:
            asked = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        if isinstance(asked, Task):
            task = asked
            continue
        assert task is not None and isinstance(asked, Case)
        pickle.dump(perform(task, asked, begun), answer)
        answer.flush()


if __name__ == "__main__":
    try:
        main()
    except BrokenPipeError:  # nobody waits for it any more
        os._exit(0)
