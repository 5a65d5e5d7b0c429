"""The process that runs the scenes with one number changed after the other.

It compiles the solver once and then runs the scenes of each row in a copy of itself (a fork). So a crash or a
hang concerns one scene, and a change one row. It writes pickled references and rows to standard output.
"""

from __future__ import annotations

import multiprocessing
import signal
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mdlgen.bench.process import sender
from mdlgen.bench.tuning.numbers import Number, numbers
from mdlgen.bench.tuning.row import CUT, Outcome, Reference, TuningRow
from mdlgen.bench.tuning.scenes import SCENES, TuningScene
from mdlgen.bench.tuning.varied import TABLE, install

if TYPE_CHECKING:
    from mdlgen.results.result import Result

FACTORS = (0.5, 2.0)
# A run is ended at so many times the processor time of its reference, and not before LEAST [s].
TIMES, LEAST = 10.0, 1.0
# Wall time allowed, relative to processor time: other programs may use the processor, too.
WALL = 20.0


class Found(NamedTuple):
    """The parts of a run that are compared."""

    status: str
    ended: bool
    steps: int
    iterations: int
    states: tuple[Any, ...]  # all stored times, positions, rotations and velocities
    cpu_s: float


def found(result: Result, cpu: float) -> Found:
    """The parts of a result that are compared."""
    states = (result.time, result.position, result.rotation, result.velocity, result.spin)
    return Found(result.status, result.usable, result.steps, result.iterations or 0, states, cpu)


def compared(scene: str, travel: float, before: Found, now: Found | str) -> Outcome:
    """The outcome of a run; `now` is the reason where it has no result."""
    if isinstance(now, str):
        return Outcome(scene, now, ended=False, decided=before.ended)
    alike = zip(before.states, now.states, strict=True)
    same = before.status == now.status and all(np.array_equal(a, b, equal_nan=True) for a, b in alike)
    moved = None
    if now.ended and before.ended and travel > 0.0:
        apart = np.linalg.norm(now.states[1][-1] - before.states[1][-1], axis=-1)
        moved = float(apart.max()) / travel
    return Outcome(
        scene,
        now.status,
        ended=now.ended,
        decided=now.ended != before.ended,
        same=same,
        moved=moved,
        iterations=now.iterations / before.iterations if before.iterations else None,
        steps=now.steps / before.steps if before.steps else None,
    )


Work = tuple[Callable[[], Found], float]  # a function to run, and its limit of processor time [s]


def apart(works: Sequence[Work]) -> list[Found | str]:
    """The results of `works`, each in a copy of this process, or the reason of a failure. If a copy ends
    early, another one does the remaining work."""
    answers: list[Found | str] = []
    while len(answers) < len(works):
        left = works[len(answers) :]
        got, reason = _copy(left)
        answers += got if len(got) == len(left) else [*got, reason]
    return answers


def _copy(works: Sequence[Work]) -> tuple[list[Found | str], str]:
    """The answers of one copy, and why it ended before the last one."""
    context = multiprocessing.get_context("fork")
    receives, sends = context.Pipe(duplex=False)
    process = context.Process(target=_answer, args=(works, sends))
    process.start()
    sends.close()
    answers: list[Found | str] = []
    try:
        for _, limit in works:
            if not receives.poll(WALL * limit):
                return answers, f"no answer within {WALL * limit:g} s of wall time"
            answers.append(receives.recv())
    except EOFError:
        process.join()
    finally:
        process.kill()
        process.join()
        receives.close()
    code = process.exitcode or 0
    if code == -signal.SIGPROF:
        return answers, CUT
    ended = f"the process crashed: {signal.Signals(-code).name}" if code < 0 else f"ended with code {code}"
    return answers, ended


def _answer(works: Sequence[Work], sends: Any) -> None:
    for work, limit in works:
        # without a handler this signal ends a process, also inside compiled code
        signal.setitimer(signal.ITIMER_PROF, limit)
        try:
            answer: Found | str = work()
        except Exception as error:
            answer = f"{type(error).__name__}: {error}"[:200]
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        sends.send(answer)


class Bench:
    """The scenes and their references, with all numbers as they are."""

    def __init__(self, places: dict[str, int], scenes: Sequence[TuningScene] = SCENES):
        self._places = places
        self._models = {scene.name: scene.model() for scene in scenes}
        self._meanings = {scene.name: scene.meaning for scene in scenes}
        self._before: dict[str, tuple[Found, float]] = {}

    def references(self, limit: float) -> list[Reference]:
        """Compiles what the scenes call, and runs each twice more. Raises RuntimeError where both runs
        differ."""
        for name in self._models:
            self._run(name)
        works = [(partial(self._run, name), limit) for name in self._models]
        found = []
        for (name, model), one, two in zip(self._models.items(), apart(works), apart(works), strict=True):
            if isinstance(one, str) or isinstance(two, str):
                raise RuntimeError(f"{name}: {one if isinstance(one, str) else two}")
            way = np.linalg.norm(one.states[1][-1] - model.bodies.position, axis=-1)
            travel = float(way.max())
            if not compared(name, travel, one, two).same:
                raise RuntimeError(f"{name}: two runs differ")
            self._before[name] = (one, travel)
            counts = one.steps, one.iterations
            found.append(
                Reference(name, self._meanings[name], one.status, one.ended, *counts, travel, one.cpu_s)
            )
        return found

    def row(self, number: Number, factor: float) -> TuningRow:
        """All scenes with one number changed."""
        value = number.times(factor)
        change = self._places[number.name], value
        works = [
            (partial(self._run, name, change), max(LEAST, TIMES * before.cpu_s))
            for name, (before, _) in self._before.items()
        ]
        both = zip(self._before.items(), apart(works), strict=True)
        outcomes = tuple(compared(name, travel, before, now) for (name, (before, travel)), now in both)
        return TuningRow(number.name, factor, value, outcomes)

    def _run(self, name: str, change: tuple[int, float] | None = None) -> Found:
        from mdlgen import registry

        if change is not None:  # of this process alone, which ends with the run
            TABLE[change[0]] = change[1]
        begun = time.process_time()
        result = registry.solver("lattice").solve(self._models[name])
        return found(result, time.process_time() - begun)


# Processor time of a reference; all of them take less than a second [s].
REFERENCE = 60.0


def main() -> None:
    """Entry point of `python -m mdlgen.bench.tuning.worker`."""
    send = sender()
    every = numbers()
    bench = Bench(install(every))
    for reference in bench.references(REFERENCE):
        send(reference)
    for number in every:
        for factor in () if number.frozen else FACTORS:
            send(bench.row(number, factor))


if __name__ == "__main__":
    main()
