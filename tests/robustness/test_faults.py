"""Full disks, folders that refuse, killed processes: the old files whole, or the new ones complete."""

from __future__ import annotations

import os
import re
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from kills import kills
from synthetic import moving

import mdlgen
from mdlgen import paths
from mdlgen.errors import OutputError
from mdlgen.paths import NOTE, STALE, TEMPORARY, recover, samples, write_together
from mdlgen.results.io.store import save

SAMPLE = samples() / "transport_4x4.yaml"
OLD = {"a.txt": b"old a", "b.txt": b"old b"}
NEW = {"a.txt": b"new a", "b.txt": b"new b", "c.txt": b"new c"}


def held(folder: Path) -> dict[str, bytes]:
    return {p.name: p.read_bytes() for p in sorted(folder.iterdir()) if not p.name.startswith(".")}


def write(folder: Path, files: dict[str, bytes]) -> None:
    write_together({folder / name: content for name, content in files.items()})


CALLS = ("replace", "link", "fsync", "unlink", "chmod", "open", "fdopen")


def at_call(number: int, act: Callable[[], None], monkeypatch: pytest.MonkeyPatch) -> Callable[[], int]:
    """Does `act` before the call of that number to what writes; tells how many there were."""
    count = 0

    def counting(call: Callable) -> Callable:
        def run(*args: object, **options: object) -> object:
            nonlocal count
            count += 1
            if count == number:
                act()
            return call(*args, **options)

        return run

    for name in CALLS:
        monkeypatch.setattr(paths.os, name, counting(getattr(os, name)))
    return lambda: count


def calls(tmp_path: Path) -> int:
    """How many calls it takes to write NEW over OLD."""
    write(tmp_path, OLD)
    with pytest.MonkeyPatch.context() as patch:
        report = at_call(0, lambda: None, patch)
        write(tmp_path, NEW)
        return report()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills a process of its own")
def test_killed_before_each_call(tmp_path: Path) -> None:
    (tmp_path / "count").mkdir()
    most = calls(tmp_path / "count")
    assert most > 15
    kinds = []
    for number in range(1, most + 1):
        folder = tmp_path / str(number)
        folder.mkdir()
        write(folder, OLD)
        child = os.fork()
        if child == 0:  # pragma: no cover
            with pytest.MonkeyPatch.context() as patch:
                at_call(number, lambda: os._exit(9), patch)
                write(folder, NEW)
            os._exit(1)
        _, status = os.waitpid(child, 0)
        assert os.waitstatus_to_exitcode(status) == 9
        recover(folder)
        assert held(folder) in (OLD, NEW), number
        assert not (folder / NOTE).exists()
        kinds.append(held(folder) == NEW)
        write(folder, NEW)
        assert held(folder) == NEW
    # first the old ones, from some call on the new
    assert kinds == sorted(kinds) and True in kinds and False in kinds


def test_refused_at_each_call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "count").mkdir()
    most = calls(tmp_path / "count")

    def full() -> None:
        raise OSError(28, "No space left on device")

    for number in range(1, most + 1):
        folder = tmp_path / str(number)
        folder.mkdir()
        write(folder, OLD)
        with monkeypatch.context() as patch:
            at_call(number, full, patch)
            try:
                write(folder, NEW)
            except OutputError as error:
                assert "No space left" in str(error) and "\n" not in str(error)
                assert held(folder) == OLD, number
            else:
                assert held(folder) == NEW, number
        recover(folder)
        assert held(folder) in (OLD, NEW)
        assert not (folder / NOTE).exists()


def test_interrupted_at_each_call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "count").mkdir()
    most = calls(tmp_path / "count")

    def interrupt() -> None:
        raise KeyboardInterrupt

    for number in range(1, most + 1):
        folder = tmp_path / str(number)
        folder.mkdir()
        write(folder, OLD)
        with monkeypatch.context() as patch:
            at_call(number, interrupt, patch)
            with pytest.raises(KeyboardInterrupt):
                write(folder, NEW)
        recover(folder)
        assert held(folder) in (OLD, NEW), number


def test_what_a_killed_process_left_is_removed_when_it_is_old(tmp_path: Path) -> None:
    old, young = (tmp_path / f".a.txt.{name}{TEMPORARY}" for name in ("old", "young"))
    mine = tmp_path / ".mine.txt"
    for path in (old, young, mine):
        path.write_text("x")
    for path in (old, mine):
        os.utime(path, times=(time.time() - 2 * STALE,) * 2)
    write(tmp_path, OLD)
    assert (old.exists(), young.exists(), mine.exists()) == (False, True, True)


@pytest.mark.parametrize(
    "note",
    [
        "no note",
        "[]",
        '{"a": 1}',
        '{"../x": "../y"}',
        '{"a.txt": "b.txt"}',
        '{".b.txt.1.mdlgen~": "../b.txt"}',
        '{"/etc/passwd": "b.txt"}',
        "[" * 100_000,
    ],
)
def test_a_note_of_someone_else_is_not_followed(tmp_path: Path, note: str) -> None:
    write(tmp_path, OLD)
    (tmp_path / NOTE).write_text(note)
    with pytest.raises(OutputError, match="is not the list of files"):
        write(tmp_path, NEW)
    assert held(tmp_path) == OLD


@pytest.mark.parametrize("name", ["summary.json", "result.h5"])
def test_links_are_not_written_through(tmp_path: Path, name: str) -> None:
    result = moving(mdlgen.lower(mdlgen.load(SAMPLE, ["sheets.note.boxes=[2,3]"])))
    (tmp_path / "mine").write_text("mine")
    (tmp_path / "d").mkdir()
    (tmp_path / "d" / name).symlink_to(tmp_path / "mine")
    with pytest.raises(OutputError, match="symbolic link"):
        save(result, tmp_path / "d")
    assert [p.name for p in (tmp_path / "d").iterdir()] == [name]
    (tmp_path / "d" / name).unlink()
    (tmp_path / "l").symlink_to("d")
    with pytest.raises(OutputError, match="symbolic link"):
        save(result, tmp_path / "l")
    with pytest.raises(OutputError, match="name"):
        save(result, tmp_path / "d", {"../mine": b""})
    assert (tmp_path / "mine").read_text() == "mine"
    assert list((tmp_path / "d").iterdir()) == []


def limited(size: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def test_a_disk_that_is_full(tmp_path: Path) -> None:
    (tmp_path / "note.mdl").write_text("old")
    sets = ["--set", "sheets.note.boxes=[3,5]", "--set", "run.duration=1 ms", "--set", "run.step=0.1 ms"]
    mdlgen.solve(mdlgen.lower(mdlgen.load(SAMPLE, sets[1::2])))  # what it compiles has room to be kept
    for args, file in ((["mdl", "-o", "note.mdl"], "note.mdl"), (["run", "-o", "d", *sets], "d/result.h5")):
        done = subprocess.run(
            [sys.executable, "-B", "-m", "mdlgen", *args, str(SAMPLE)],
            cwd=tmp_path,
            preexec_fn=limited(60_000),
            capture_output=True,
            text=True,
            check=False,
        )
        *lints, last = done.stderr.splitlines()
        assert (done.returncode, last) == (3, f"{file}: cannot write: File too large")
        assert all(re.match(r"W1[0-9]{2} ", lint) for lint in lints)
    assert [p.name for p in tmp_path.rglob("*") if p.is_file()] == ["note.mdl"]
    assert (tmp_path / "note.mdl").read_text() == "old"


def test_compiled_code_that_finds_no_room_is_used_all_the_same(tmp_path: Path) -> None:
    (tmp_path / "room").mkdir()
    (tmp_path / "room" / "__init__.py").write_text("")
    body = (
        "@njit(cache=True)\ndef twice(x):\n    return 2 * x\n"
        "@njit(cache=True)\ndef four(x):\n    return twice(twice(x))\n"
    )
    (tmp_path / "room" / "plain.py").write_text(f"from numba import njit\n{body}")
    (tmp_path / "room" / "kernel.py").write_text(f"from mdlgen.program.kernel import njit\n{body}")
    done = [
        subprocess.run(
            [sys.executable, "-B", "-c", f"from room.{name} import four; print(four(1.5))"],
            cwd=tmp_path,
            env={**os.environ, **dict.fromkeys(("NUMBA_CACHE_DIR", "MDLGEN_CACHE"), str(tmp_path / "cache"))},
            preexec_fn=limited(100),
            capture_output=True,
            text=True,
            check=False,
        )
        for name in ("plain", "kernel")
    ]
    assert "File too large" in done[0].stderr  # numba alone
    assert (done[1].returncode, done[1].stdout, done[1].stderr) == (0, "6.0\n", "")


def test_compiled_templates_that_find_no_room_are_used_all_the_same(tmp_path: Path) -> None:
    code = (
        "import pathlib, sys\nfrom mdlgen import templating\n"
        "templating.cache = lambda name: pathlib.Path(sys.argv[1])\n"
        "made = templating.environment('report', autoescape=True)\n"
        "print(made.get_template('page.html.j2').name)"
    )
    for size, kept in ((100, False), (1_000_000, True)):
        done = subprocess.run(
            [sys.executable, "-B", "-c", code, str(tmp_path)],
            preexec_fn=limited(size),
            capture_output=True,
            text=True,
            check=False,
        )
        assert (done.returncode, done.stdout, done.stderr) == (0, "page.html.j2\n", "")
        assert bool(list(tmp_path.iterdir())) == kept


def test_a_folder_that_cannot_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path, OLD)

    def refuse(*args: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(paths.tempfile, "mkstemp", refuse)
    with pytest.raises(OutputError, match=r"a\.txt: cannot write: Permission denied"):
        write(tmp_path, NEW)
    assert held(tmp_path) == OLD


@pytest.mark.skipif(not hasattr(os, "fork"), reason="signals of POSIX")
def test_kills_at_random_moments() -> None:
    killed = kills(4, seed=2)
    assert killed.old + killed.new == 4
