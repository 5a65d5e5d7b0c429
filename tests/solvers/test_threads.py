"""Threads that share the steps of a pass: the same bits for any number, and none that outlives its pass."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from asked import as_asked
from same import bits

import mdlgen
from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.integrate import helpers
from mdlgen.backends.lattice.integrate.beside import Stopped
from mdlgen.backends.lattice.kernels import entries, parallel
from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.backends.lattice.kernels.integrate import integrate
from mdlgen.errors import SpecError
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import solve
from mdlgen.results.io.store import hdf5
from mdlgen.results.result import Result

PILE = ["piles.cassette.count=4", "contacts.pick.between=[cassette_4, pick]", "probes.lead.sheet=cassette_4"]
SOFT = "{stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 1 mm/s}"
SETS = [
    *PILE,
    f"piles.cassette.contact={SOFT}",
    "contacts.floor.stiffness=100 N/mm^1.5",
    "sheets.note.boxes=[4,6]",
    "run.duration=4 ms",
    "require=[]",
]


def pile(threads: int, *sets: str) -> Model:
    model = mdlgen.lower(mdlgen.load(samples() / "pile.yaml", [*SETS, *(sets or ["run.step=0.025 ms"])]))
    return replace(model, run=replace(model.run, threads=threads))


@pytest.fixture
def shipped() -> None:
    if PROGRAM.why_not() is not None:
        pytest.skip("numba compiles, since the program does not fit, and its code keeps the lock of Python")


@pytest.fixture(autouse=True)
def ended() -> Any:
    """No helper is left after a test."""
    yield
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("helper")]


@pytest.fixture
def passes(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, bool]]:
    """Threads of each pass as it begins, and whether it goes on beside another."""
    found: list[tuple[int, bool]] = []
    once = lattice.one_pass

    def watched(*args: Any, **named: Any) -> Result:
        found.append((args[3].threads, args[3].hidden))
        return once(*args, **named)

    monkeypatch.setattr(lattice, "one_pass", watched)
    return found


def taken(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Parts that helpers took, call by call."""
    found: list[int] = []
    once = entries.help

    def watched(*args: Any) -> int:
        found.append(once(*args))
        return found[-1]

    monkeypatch.setattr(entries, "help", watched)
    return found


AIR = "piles.cassette.contact.air={viscosity: 18.2 uPa*s}"


@pytest.mark.usefixtures("shipped")
@pytest.mark.parametrize(
    "sets", [[], ["run.tolerance=0.1"], [AIR]], ids=["given step", "chosen step", "with air"]
)
def test_any_number_finds_the_same_bits(sets: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    one = lattice.solve(pile(1, *sets))
    assert as_asked(one), one.status
    parts = taken(monkeypatch)
    for threads in (2, 3):
        parts.clear()
        more = lattice.solve(pile(threads, *sets), threads=threads)
        assert sum(parts) > 0
        assert bits(hdf5(replace(more, model=one.model))) == bits(hdf5(one))
        assert (more.steps, more.iterations, more.energy) == (one.steps, one.iterations, one.energy)


@pytest.mark.usefixtures("shipped")
def test_passes_go_on_beside_each_other_where_threads_are_enough_for_both(
    passes: list[tuple[int, bool]],
) -> None:
    lattice.solve(pile(2), threads=3)
    assert passes == [(2, False), (2, False)]
    passes.clear()
    lattice.solve(pile(2), threads=4)
    assert sorted(passes) == [(2, False), (2, True)]
    passes.clear()
    lattice.solve(pile(8), threads=1)
    assert passes == [(1, False), (1, False)]


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, Stopped])
def test_a_pass_that_is_cut_short_leaves_no_thread(
    error: type[BaseException], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Here in the middle of a job of which no part was done."""
    begun = []

    def failing(work: Any, *_: Any) -> Any:
        if work.pool.words[parallel.HELPERS] == 0:
            return integrate.DONE, 0.0  # warm
        begun.append([thread.name for thread in threading.enumerate() if thread.name.startswith("helper")])
        raise error

    monkeypatch.setattr(integrate, "run", failing)
    monkeypatch.setattr(lattice, "PROGRAM", SimpleNamespace(loaded=True))
    monkeypatch.setattr(lattice, "processors", lambda: 3)
    with pytest.raises(error):
        lattice.solve(pile(3))
    assert begun == [["helper 1", "helper 2"]]


@pytest.mark.usefixtures("shipped")
def test_a_pass_that_fails_leaves_no_thread() -> None:
    """Notes that are pressed right through each other."""
    model = pile(2, "run.step=0.1 ms", "rollers.pick.press.preload=5000 N")
    assert not lattice.solve(model, threads=2).ok


def test_helpers_sleep_where_there_is_nothing_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    slept = _waits(monkeypatch, 8)
    monkeypatch.setattr(entries, "help", lambda *_: 0)
    monkeypatch.setattr(helpers, "LATE", 1e9)
    work: Any = SimpleNamespace(pool=parallel.empty(2, 0))
    with helpers.Helpers(work, 2):
        while len(slept) < 8:
            time.sleep(0.001)
    assert slept[0] == helpers.SHORTEST and max(slept) == helpers.LONGEST
    assert work.pool.words[parallel.HELPERS] == 0 and work.pool.words[parallel.CLOSED] == 1


def test_a_helper_that_waited_for_a_processor_stays_away(monkeypatch: pytest.MonkeyPatch) -> None:
    slept = _waits(monkeypatch, 12)
    monkeypatch.setattr(entries, "help", lambda *_: 5)
    monkeypatch.setattr(helpers, "LATE", -1.0)
    work: Any = SimpleNamespace(pool=parallel.empty(2, 0))
    with helpers.Helpers(work, 2):
        while len(slept) < 12:
            time.sleep(0.001)
    assert slept[:2] == [helpers.AWAY, 2.0 * helpers.AWAY] and slept[-1] == helpers.FAR_AWAY


def _waits(monkeypatch: pytest.MonkeyPatch, many: int) -> list[float]:
    """How long helpers wait, so many times, which they do not."""
    slept: list[float] = []

    class Waited(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            if timeout is None or len(slept) >= many:
                return super().wait(timeout)
            slept.append(timeout)
            return self.is_set()

    monkeypatch.setattr(helpers, "Event", Waited)
    return slept


def test_a_sheet_alone_has_no_helper() -> None:
    work: Any = SimpleNamespace(pool=parallel.empty(1, 0))
    with helpers.Helpers(work, 2):
        assert work.pool.words[parallel.HELPERS] == 0


def test_threads_that_the_system_does_not_give_are_done_without(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threading.Thread, "start", refuse)
    work: Any = SimpleNamespace(pool=parallel.empty(2, 0))
    with helpers.Helpers(work, 3):
        pass


@pytest.mark.parametrize("threads", ["0", "-1", "1.5", "true"])
def test_no_other_number_is_taken(threads: str) -> None:
    with pytest.raises(SpecError, match=r"run\.threads"):
        mdlgen.load(samples() / "pile.yaml", [f"run.threads={threads}"])
    assert mdlgen.lower(mdlgen.load(samples() / "pile.yaml", ["run.threads=2"])).run.threads == 2
    assert mdlgen.lower(mdlgen.load(samples() / "pile.yaml")).run.threads == 1


@pytest.mark.usefixtures("shipped")
def test_sweeps_take_one(passes: list[tuple[int, bool]]) -> None:
    scene = mdlgen.load(samples() / "pile.yaml", [*SETS, "run.step=0.4 ms", "run.threads=2"])
    scene.sweep({"gravity.2": ["-9.81 m/s^2"]}, measure=["energy.balance_error"])
    assert {threads for threads, _ in passes} == {1}
    passes.clear()
    solve(mdlgen.lower(scene), "lattice", threads=2)
    assert {threads for threads, _ in passes} == {2}


def test_a_job_is_done_in_parts_from_the_last_one() -> None:
    """Without helpers, in Python."""
    pool = parallel.empty(3, 0)
    parallel.begin.py_func(pool, parallel.STEP, 3)
    assert [parallel.take.py_func(pool) for _ in range(4)] == [2, 1, 0, -1]
    parallel.finish.py_func(pool, 3)
    assert np.all(pool.words[: parallel.HELPERS] == 0)
