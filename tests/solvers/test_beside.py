"""Two passes of a run at the same time: the same bits as one after the other, and what ends one of them."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
from asked import as_asked
from machines import MACHINE
from same import bits

import mdlgen
from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.integrate.beside import Stopped
from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.errors import OutputError, SpecError
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.io.store import hdf5
from mdlgen.results.result import Result
from mdlgen.runs.checkpoint import Checkpointer
from mdlgen.spec.load import loads

GIVEN = ["run.duration=4 ms", "run.step=0.1 ms", "run.print_step=0.4 ms"]
SCENES = {
    # a step that follows from the tolerance, of flexible sheets and of a rigid block: two passes are enough;
    # a third one is needed; one at twice the first step as well
    "transport_4x4": ["sheets.note.boxes=[3,5]", "run.duration=6 ms"],
    "transport_4x4, three": ["sheets.note.boxes=[3,5]", "run.duration=12 ms"],
    "transport_4x4, four": ["sheets.note.boxes=[3,5]", "run.duration=7 ms"],
    "verify/flip": ["run.duration=20 ms"],
    # a step that is given; pairs that a search finds, meshes, a rim and an arm
    "transport_tilted": ["sheets.note.boxes=[3,5]", *GIVEN],
    "stack": ["sheets.note_4.boxes=[4,5]", *GIVEN],
    "pick": GIVEN,
    "peel": GIVEN,
}
COUNTS = {"transport_4x4, three": 3, "transport_4x4, four": 4}


@pytest.fixture(autouse=True)
def shipped() -> None:
    if PROGRAM.why_not() is not None:
        pytest.skip("numba compiles, since the program does not fit, and its code keeps the lock of Python")


@pytest.fixture
def passes(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the threads in which passes are run, as they begin."""
    seen: list[str] = []
    once = lattice.one_pass

    def watched(*args: Any, **named: Any) -> Result:
        seen.append(threading.current_thread().name)
        return once(*args, **named)

    monkeypatch.setattr(lattice, "one_pass", watched)
    return seen


def model_of(name: str, *sets: str) -> Model:
    sample = name.partition(",")[0]
    return mdlgen.lower(mdlgen.load(samples() / f"{sample}.yaml", [*SCENES[name], *sets]))


@pytest.fixture(params=["short", "long"])
def third(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> bool:
    """Whether a third pass is begun beside the second: where the first took long."""
    monkeypatch.setattr(lattice, "SHORT", 0.0 if request.param == "long" else 1e9)
    return request.param == "long"


@pytest.mark.parametrize("name", [*SCENES, "halved"])
def test_two_at_once_find_the_same_bits(name: str, third: bool, passes: list[str]) -> None:
    halved = ["run.step=0.1 ms", "run.print_step=0.1 ms"]
    model = mdlgen.lower(loads(MACHINE, name, halved)) if name == "halved" else model_of(name)
    one = lattice.solve(model)
    assert as_asked(one), one.status
    assert len(set(passes)) == 1
    count = len(passes)
    two = lattice.solve(model, threads=2)
    # of flexible sheets a third one may be begun whether it is needed or not
    assert len(passes) == 2 * count + (third and name == "transport_4x4") and len(set(passes[count:])) == 2
    assert count == COUNTS.get(name, 2)
    assert bits(hdf5(two)) == bits(hdf5(one))
    assert (two.steps, two.iterations, two.touched) == (one.steps, one.iterations, one.touched)
    assert two.energy == one.energy


@pytest.mark.parametrize("name", ["transport_tilted", "transport_4x4, three"])
def test_reported_is_the_finer_pass(name: str, third: bool) -> None:
    record: list[tuple[float, float]] = []
    thread = threading.current_thread()

    def progress(time: float, end: float, steps: int, touching: int) -> None:
        assert threading.current_thread() is thread
        record.append((time, steps))

    model = model_of(name)
    result = lattice.solve(model, progress, threads=2)
    assert [time for time, _ in record] == pytest.approx(result.time[1:])
    assert record[-1][1] == result.steps


def test_a_pass_that_failed_needs_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """The coarser one stops soon, and what it would find is dropped."""
    once, ended = lattice.one_pass, []

    def watched(*args: Any, **named: Any) -> Result:
        if not args[3].hidden:
            return once(*args, **named).failed("no end")
        assert args[3].stop.wait(60.0)
        try:
            return once(*args, **named)
        except Stopped:
            ended.append("stopped")
            raise

    monkeypatch.setattr(lattice, "one_pass", watched)
    assert lattice.solve(model_of("transport_tilted"), threads=2).status == "no end"
    assert ended == ["stopped"]


def test_a_third_pass_stops_where_two_are_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lattice, "SHORT", 0.0)
    once, ended = lattice.one_pass, []

    def watched(*args: Any, **named: Any) -> Result:
        if args[3].number < 2:
            return once(*args, **named)
        assert args[3].stop.wait(60.0)
        try:
            return once(*args, **named)
        except Stopped:
            ended.append("stopped")
            raise

    monkeypatch.setattr(lattice, "one_pass", watched)
    result = lattice.solve(model_of("transport_4x4"), threads=2)
    assert as_asked(result) and result.step == 0.1
    assert ended == ["stopped"]


@pytest.mark.parametrize("name", ["transport_4x4", "verify/flip", "transport_tilted"])
@pytest.mark.parametrize("coarser", [False, True])
def test_an_error_in_either_is_raised(name: str, coarser: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    once = lattice.one_pass

    def failing(*args: Any, **named: Any) -> Result:
        if args[3].hidden == coarser:
            raise OutputError("the disk is full")
        return once(*args, **named)

    monkeypatch.setattr(lattice, "one_pass", failing)
    before = threading.active_count()
    with pytest.raises(OutputError, match="the disk is full"):
        lattice.solve(model_of(name), threads=2)
    assert threading.active_count() == before


def test_an_error_in_a_third_pass_is_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether it was needed or not."""
    monkeypatch.setattr(lattice, "SHORT", 0.0)
    once = lattice.one_pass

    def failing(*args: Any, **named: Any) -> Result:
        if args[3].number == 2:
            raise OutputError("the disk is full")
        return once(*args, **named)

    monkeypatch.setattr(lattice, "one_pass", failing)
    for name in ("transport_4x4", "transport_4x4, three"):
        with pytest.raises(OutputError, match="the disk is full"):
            lattice.solve(model_of(name), threads=2)


@pytest.mark.parametrize(("threads", "at_the_start"), [(1, True), (2, False), (3, True)])
def test_a_processor_is_free_where_no_pass_takes_it(
    threads: int, at_the_start: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep, seen, once = Checkpointer(), [], lattice.one_pass

    def watched(*args: Any, **named: Any) -> Result:
        if args[3].hidden or threads == 1:
            seen.append(keep.free.is_set())
        return once(*args, **named)

    monkeypatch.setattr(lattice, "one_pass", watched)
    assert not keep.free.is_set()
    lattice.solve(model_of("transport_tilted"), keep=keep, threads=threads)
    assert seen[0] is at_the_start
    assert keep.free.is_set()


@pytest.mark.parametrize("threads", ["0", "-1", "1.5", "true"])
def test_run_threads_of_older_scenes_is_a_number_still(threads: str) -> None:
    with pytest.raises(SpecError, match=r"run\.threads"):
        mdlgen.load(samples() / "pile.yaml", [f"run.threads={threads}"])


def test_run_threads_has_no_effect() -> None:
    one, two = (
        lattice.solve(mdlgen.lower(mdlgen.load(samples() / "stack.yaml", [*GIVEN, f"run.threads={n}"])))
        for n in (1, 2)
    )
    assert np.array_equal(one.position, two.position) and one.steps == two.steps
