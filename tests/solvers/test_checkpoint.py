"""Runs that are cut off: what they leave, and that they go on to the same bits."""

from __future__ import annotations

import functools
import json
import os
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from asked import as_asked
from called import Ended, runner
from cutting import Cut, Cutting, written_with
from machines import MACHINE, OVERRUN
from nip import FORTH_AND_BACK
from same import bits
from stacks import stack

import mdlgen
import mdlgen.errors
from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.kernels import entries
from mdlgen.errors import OutputError
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.io.store import hdf5, read
from mdlgen.results.result import Result
from mdlgen.runs.checkpoint import Checkpointer
from mdlgen.runs.provenance import digest
from mdlgen.spec.load import loads

SCENES = {
    "transport_4x4": ["sheets.note.boxes=[3,5]", "run.duration=8 ms", "run.tolerance=0.01"],
    "transport_tilted": ["sheets.note.boxes=[3,5]", "run.duration=4 ms", "run.step=0.1 ms"],
    "channel": ["run.duration=3 ms", "run.step=0.05 ms"],
    "verify/flip": ["run.duration=8 ms", "run.step=0.1 ms"],
    "verify/drop": ["run.duration=110 ms", "run.step=0.05 ms", "run.print_step=2 ms"],
    # the uppermost note slides by 36 mm, so that other boxes of two sheets meet than at the start
    "stack": [
        "sheets.note_4.boxes=[4,5]",
        "sheets.note_4.velocity=[3000 mm/s, 500 mm/s, 0 mm/s]",
        *("run.duration=12 ms", "run.step=0.1 ms", "run.print_step=0.4 ms"),
    ],
    # air between sheets
    "pile": [
        "piles.cassette.contact.air={viscosity: 18.2 uPa*s}",
        *("run.duration=4 ms", "run.step=0.1 ms", "run.print_step=0.2 ms"),
    ],
    # meshes; rims, an arm and a slide; two notes with all of these and a profile; measured curves
    "pick": ["run.duration=12 ms", "run.step=0.1 ms", "run.print_step=0.4 ms"],
    "peel": ["run.duration=4 ms", "run.step=0.1 ms", "run.print_step=0.2 ms"],
    "feeder": [
        *("sheets.note_1.boxes=[6,2]", "sheets.note_2.boxes=[4,2]"),
        *("run.duration=2 ms", "run.print_step=0.05 ms"),
    ],
    # weight that changes, a spin and a lifted roller that has landed
    "verify/spun": ["gravity_profile=[[0 ms,1],[4 ms,0.5]]", "run.duration=6 ms", "run.step=0.02 ms"],
    # while a sheet yields, of a halved scene
    "crease": ["run.duration=1 ms", "run.step=0.02 ms", "run.print_step=0.05 ms"],
    "snatch": ["run.duration=3 ms", "run.step=0.1 ms", "run.print_step=0.1 ms"],
    # while a gate turns
    "diverter": [
        "guides.gate.pivot.profile=[[0 ms, closed], [5 ms, open]]",
        *("run.duration=4 ms", "run.step=0.05 ms", "run.print_step=0.2 ms"),
    ],
}
OFTEN = ["run.step=0.1 ms", "run.print_step=0.1 ms"]
SHORT = ["run.duration=12 ms", "run.step=0.1 ms", "run.print_step=0.4 ms"]
# the uppermost note slides, the others stick
STUCK = stack(3, "[3, 4]").replace(
    "friction: 0.3}", "friction: {static: 0.3, dynamic: 0.2, sticking: 9 N/mm}}", 2
)
FALLS = "  late: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [2, 2], "
SLEEPY = (
    STUCK.replace("planes:", FALLS + "center: [0 mm, 0 mm, 3 mm]}\nplanes:")
    .replace("contacts:", "contacts:\n  - {between: [note_2, late], stiffness: 100 N/mm^1.5, friction: 0.3}")
    .replace("run: {duration: 20 ms", "run: {duration: 30 ms, step: 0.1 ms, tolerance: 0.01")
)
MORE = {
    "sticking": (STUCK, ["sheets.note_2.velocity=[3000 mm/s, 500 mm/s, 0 mm/s]", *SHORT]),
    # of the nips of a halved scene, while the note enters one
    "bristles": (
        MACHINE,
        ["contacts.*.friction={static: 0.5, dynamic: 0.4, sticking: 40 N/mm}", *OFTEN],
    ),
    # a pile that falls asleep, and wakes as another note falls on it; with friction that sticks
    "asleep": (SLEEPY, []),
    "one way": (FORTH_AND_BACK, [*OVERRUN, *SHORT]),
    "halved": (MACHINE, OFTEN),
}


def scene(name: str) -> Model:
    if name in MORE:
        text, sets = MORE[name]
        return mdlgen.lower(loads(text, name, sets))
    return mdlgen.lower(mdlgen.load(samples() / f"{name}.yaml", SCENES[name]))


@pytest.mark.parametrize("name", [*SCENES, *MORE])
def test_a_run_goes_on_to_the_same_bits(name: str, tmp_path: Path) -> None:
    goes_on(name, tmp_path, 1)


@pytest.mark.parametrize("name", ["transport_4x4", "transport_tilted"])
def test_two_passes_at_once_go_on_to_the_same_bits(name: str, tmp_path: Path) -> None:
    """Of a step that follows from the tolerance, and one that is given."""
    goes_on(name, tmp_path, 2)


@pytest.mark.parametrize("threads", [(1, 2), (2, 1)])
def test_passes_are_known_by_their_steps(threads: tuple[int, int], tmp_path: Path) -> None:
    """One at a time or two, begun in another order, go on with each other's states."""
    model = mdlgen.lower(
        mdlgen.load(samples() / "transport_4x4.yaml", ["sheets.note.boxes=[3,5]", "run.duration=6 ms"])
    )
    whole = lattice.solve(model)
    provenance: Callable[[], dict[str, str]] | None = written_with
    for cut in range(1, 100):
        try:
            keep = Cutting(tmp_path / "c", provenance, 17)
            result = lattice.solve(model, keep=keep, threads=threads[cut % 2])
            break
        except Cut:
            provenance = None
    else:
        raise AssertionError("it does not come to its end")
    assert cut > 2
    assert bits(hdf5(result)) == bits(hdf5(whole))
    assert (result.steps, result.iterations, result.energy) == (whole.steps, whole.iterations, whole.energy)


def goes_on(name: str, tmp_path: Path, threads: int) -> None:
    """Cuts a run off, again and again, until it has come to its end."""
    model = scene(name)
    whole = lattice.solve(model)
    assert as_asked(whole), whole.status
    assert whole.halved == (name in ("halved", "feeder", "asleep", "crease"))
    cuts = 0
    provenance: Callable[[], dict[str, str]] | None = written_with
    while True:
        try:
            # what is written before the last two takes time alone
            keep = Cutting(tmp_path / "c", provenance, 8 + 5 * cuts, most=2)
            result = lattice.solve(model, keep=keep, threads=threads)
            break
        except Cut:
            cuts += 1
            provenance = None
            starts_like(whole, keep)
    assert cuts >= (3 if threads == 1 else 1)  # the other pass goes on meanwhile
    assert bits(hdf5(result)) == bits(hdf5(whole))
    assert (result.steps, result.iterations, result.touched) == (whole.steps, whole.iterations, whole.touched)
    assert (result.energy, result.error_estimate) == (whole.energy, whole.error_estimate)


def starts_like(whole: Result, keep: Checkpointer) -> None:
    """What is kept as a part, at the step of the whole, is its beginning."""
    assert keep.part is not None
    part = keep.part()
    count = len(part.time)
    if part.step == whole.step:
        for name in ("time", "position", "rotation", "velocity", "spin"):
            assert np.array_equal(getattr(part, name), getattr(whole, name)[:count])
        # those at its last time the next step tells
        assert np.array_equal(part.contact_force[:-1], whole.contact_force[: count - 1])


def test_pairs_that_are_searched_change_in_a_run() -> None:
    """Else going on with two sheets would show nothing."""
    model = scene("stack")
    system = lattice.build(model, fold=True)
    assert lattice.one_pass(model, system, 0.1).ok
    at_the_end = system.pairs[["a", "b"]].copy()
    entries.look(system.pairs, system.search, model.bodies.position.copy())
    assert (system.pairs[["a", "b"]] != at_the_end).any()


def test_a_run_that_failed_says_so_again(tmp_path: Path) -> None:
    """The pair of boxes that ended it is one that was searched: a note falls, as it flies by 23 mm."""
    sets = [
        "sheets.note_4.center=[0 mm, 0 mm, 3.45 mm]",
        "sheets.note_4.velocity=[3000 mm/s, 500 mm/s, 0 mm/s]",
        "gravity=[0 m/s^2, 0 m/s^2, -100 m/s^2]",
        "contacts.3.stiffness=1e-5 N/mm^1.5",
    ]
    sets += ["run.duration=12 ms", "run.step=0.1 ms", "run.print_step=0.4 ms"]
    model = mdlgen.lower(mdlgen.load(samples() / "stack.yaml", sets))
    first = lattice.solve(model, keep=Checkpointer(tmp_path / "c", 0.0, written_with))
    again = lattice.solve(model, keep=Checkpointer(tmp_path / "c", 0.0))
    assert "more than three quarters of its thickness into box note_4" in first.status
    assert first.time[-1] > 6.0
    assert again.status == first.status
    assert bits(hdf5(again)) == bits(hdf5(first))


def test_what_a_run_reads_does_not_change_in_it() -> None:
    """Else it would have to be kept too."""
    model = scene("transport_4x4")
    system = lattice.build(model, fold=True)
    before = digest(list(system.tables))
    assert lattice.one_pass(model, system, 0.05).ok
    assert digest(list(system.tables)) == before


def kept(folder: Path) -> Model:
    """A run that is cut off in `folder`."""
    model = scene("verify/drop")
    with pytest.raises(Cut):
        lattice.solve(model, keep=Cutting(folder, written_with, 9))
    return model


@pytest.mark.parametrize(
    "what", ["empty", "text", "cut", "compressed", "pickle", "other shape", "other type", "gone"]
)
def test_a_damaged_state_is_refused(tmp_path: Path, what: str) -> None:
    folder = tmp_path / "c"
    model = kept(folder)
    path = folder / "pass_0.npz"
    with np.load(path) as file:
        state = dict(file)
    if what == "empty":
        path.write_bytes(b"")
    elif what == "text":
        path.write_text("PK\x03\x04 no zip")
    elif what == "cut":
        path.write_bytes(path.read_bytes()[:-200])
    elif what == "compressed":
        np.savez_compressed(path, **state)
    elif what == "pickle":
        state["state.x"] = np.array([{}], dtype=object)
        np.savez(path, **state)
    elif what == "other shape":
        state["state.x"] = state["state.x"][:-1]
        np.savez(path, **state)
    elif what == "other type":
        state["state.x"] = state["state.x"].astype(np.float32)
        np.savez(path, **state)
    else:
        del state["stored.u"]
        np.savez(path, **state)
    with pytest.raises(OutputError) as raised:
        lattice.solve(model, keep=Checkpointer(folder, 60.0))
    assert "is not a state of this run" in str(raised.value) and "\n" not in str(raised.value)


def test_a_linked_folder_is_not_written_through(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "c").symlink_to("real")
    with pytest.raises(OutputError, match="symbolic link"):
        lattice.solve(scene("verify/drop"), keep=Cutting(tmp_path / "c", written_with, 1))
    assert list((tmp_path / "real").iterdir()) == []


def test_the_digest_sees_one_bit() -> None:
    model = scene("verify/drop")
    before = digest(model)
    assert digest(scene("verify/drop")) == before
    position = model.bodies.position.copy()
    position[0, 2] = np.nextafter(position[0, 2], 1.0)
    assert digest(replace(model, bodies=replace(model.bodies, position=position))) != before


# ---------------------------------------------------------------- the command

LONG = [
    str(samples() / "transport_4x4.yaml"),
    *("--set", "sheets.note.boxes=[3,5]", "--set", "run.duration=60 ms", "--set", "run.step=2 us"),
]


def command(folder: Path, *args: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "mdlgen", "run", *args],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.fixture(scope="module")
def cut(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, int, str, float]:
    """A folder with a run that Ctrl-C ended, its exit code, what it said, and how long its end took [s]."""
    folder = tmp_path_factory.mktemp("cut")
    process = command(folder, *LONG, "-o", "d", "--checkpoint", "0.05", "--keep-partial")
    while not (folder / "d" / "checkpoint" / "run.json").exists():
        assert process.poll() is None, process.communicate()
        time.sleep(0.02)
    before = time.monotonic()  # at once: the whole run takes a second or two
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert out == ""
    return folder, process.returncode, err, time.monotonic() - before


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_an_interrupt_leaves_a_part_that_says_so(cut: tuple[Path, int, str, float]) -> None:
    folder, code, err, took = cut
    assert code == 130
    assert "Traceback" not in err and "--resume d continues" in err
    # a second is what is promised; the machine may be busy
    assert took < 5.0
    assert not (folder / "d" / "summary.json").exists()
    record = json.loads((folder / "d" / "partial" / "summary.json").read_text())
    assert record["status"].startswith("partial: interrupted at ")
    assert 0.0 < record["t_end_ms"] < 60.0
    part = read(folder / "d" / "partial")
    assert part["status"].startswith("partial:")
    assert part["time"][-1] == record["t_end_ms"] and len(part["position"]) == len(part["time"])


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_resume(cut: tuple[Path, int, str, float], tmp_path: Path) -> None:
    folder, _, _, _ = cut
    process = command(folder, "--resume", "d", "-q")
    assert process.communicate() == ("", "") and process.returncode == 0
    assert not (folder / "d" / "checkpoint").exists()
    whole = command(tmp_path, *LONG, "-o", "w", "-q")
    assert whole.communicate() == ("", "") and whole.returncode == 0
    for name in ("result.h5", "series.csv"):
        one, two = ((place / name).read_bytes() for place in (folder / "d", tmp_path / "w"))
        assert (bits(one) == bits(two)) if name.endswith("h5") else (one == two)
    # and a part of it is its beginning
    part, all_of_it = read(folder / "d" / "partial"), read(tmp_path / "w")
    assert np.array_equal(part["position"], all_of_it["position"][: len(part["time"])])


@pytest.fixture
def mdlgen_run(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Ended]:
    """The command in this process, in the test's own folder."""
    return functools.partial(runner(capsys, tmp_path, monkeypatch), "run")


def test_what_cannot_go_on_is_refused_by_name(mdlgen_run: Callable[..., Ended]) -> None:
    def refused(*args: str) -> tuple[int, str]:
        code, out, err = mdlgen_run(*args)
        assert out == "" and len(err.splitlines()) == 1, (out, err)
        return code, err

    assert refused("--resume", "none")[0] == 3
    assert refused()[0] == 2
    assert refused(*LONG, "--resume", "d")[0] == 2
    code, err = refused(*LONG, "--solver", "exudyn", "--checkpoint", "1")
    assert code == 2
    assert "exudyn runs this scene" in err and "cannot be resumed; lattice can: give --solver lattice" in err
    assert refused(*LONG, "--solver", "exudyn", "--keep-partial")[0] == 2


def test_a_run_that_fails_leaves_nothing_to_go_on_with(
    tmp_path: Path, mdlgen_run: Callable[..., Ended]
) -> None:
    # the block falls through a floor that is too soft
    drop = str(samples() / "verify" / "drop.yaml")
    sets = [word for value in SCENES["verify/drop"] for word in ("--set", value)]
    sets += ["--set", "contacts.0.stiffness=1e-3 N/mm^1.5", "--set", "run.duration=140 ms"]
    code, _, err = mdlgen_run(drop, *sets, "-o", "d", "--checkpoint", "0")
    lint, reason = err.splitlines()
    assert lint.startswith("W133 contacts.0.stiffness")  # a lint said so
    assert code == 4 and "ended early, at " in reason
    assert not (tmp_path / "d" / "checkpoint").exists() and (tmp_path / "d" / "summary.json").exists()


def test_a_run_of_other_code_or_another_scene_is_refused(tmp_path: Path) -> None:
    from mdlgen.registry import packages
    from mdlgen.runs import resume as room

    spec = tmp_path / "scene.yaml"
    text = (samples() / "verify" / "tension.yaml").read_text("utf-8")
    spec.write_text(text)
    of = room.request(spec, None, None, "lattice", False)
    model = of.model()
    keep = room.checkpointer(tmp_path, of, model, 0.0, packages("lattice"))
    keep.save(0, {"x": np.zeros(1)})
    again, there = room.resumed(tmp_path)
    assert again == of and digest(again.model()) == digest(model)
    room.check_same(tmp_path, there, model, packages("lattice"))
    named = {"code": "solver's code", "numba": "numba", "model": "scene names", "processor": "proc"}
    for name, words in named.items():
        with pytest.raises(mdlgen.errors.RefusedError, match=words):
            room.check_same(tmp_path, {**there, name: "another"}, model, packages("lattice"))
    for bad in ("", "[]", '{"task": 1}', '{"task": {"spec": 1}}', "{" * 100_000):
        (tmp_path / "checkpoint" / "run.json").write_text(bad)
        with pytest.raises(OutputError):
            room.resumed(tmp_path)
    with zipfile.ZipFile(tmp_path / "checkpoint" / "pass_0.npz") as file:
        assert file.namelist() == ["x.npy"]
