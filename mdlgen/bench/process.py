"""Runs a task in a process of its own, on one thread, with a limit of time."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from mdlgen.bench.child import Job
from mdlgen.bench.row import Outcome

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
# A process takes this long to import a solver and load its compiled code, beyond the run itself [s].
STARTING = 30.0


def sender() -> Callable[[object], None]:
    """Returns a function that pickles messages to standard output. All other output of this process goes to
    standard error from now on."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)

    def send(message: object) -> None:
        pickle.dump(message, answers)
        answers.flush()

    return send


def run(task: Job, checkout: Path | None = None) -> Outcome:
    """The outcome of a task; a crash, a hang or an internal error is an outcome with its reason. `checkout`:
    a folder with another state of mdlgen, which runs it."""
    first = [] if checkout is None else [str(checkout.resolve())]
    limit = task.case.limit * max(1, task.repeats) + STARTING
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-m", "mdlgen.bench.child"],
            input=pickle.dumps(task),
            capture_output=True,
            timeout=limit,
            env={
                **os.environ,
                **dict.fromkeys(THREADS, "1"),
                "PYTHONPATH": os.pathsep.join([*first, *sys.path]),
            },
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Outcome(f"no end within {limit:g} s; stopped")
    if done.returncode < 0:
        return Outcome(f"the process crashed: {signal.Signals(-done.returncode).name}")
    if done.returncode or not done.stdout:
        record = done.stderr.decode("utf-8", "replace").strip().splitlines()
        return Outcome(f"the process ended with code {done.returncode}: {record[-1] if record else ''}"[:300])
    return pickle.loads(done.stdout)
