"""Shipped programs: what a small one gives, where it is damaged, missing, or prepared twice at once."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mdlgen import paths
from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.paths import samples
from mdlgen.program import build, emit, file

KERNELS = '''
from pathlib import Path
from typing import NamedTuple

import math
import numpy as np

from mdlgen.program.kernel import njit
from mdlgen.program.ship import Program

TIMES = 2.0


class Pair(NamedTuple):
    one: np.ndarray
    two: np.ndarray


@njit(cache=True, error_model="numpy")
def _square(x):
    return TIMES * x * x + math.sin(0.0 * x)


@njit(cache=True, error_model="numpy")
def total(rows, pair, scale, half):
    """Sums; squares go to pair.two, through an array of its own."""
    room = np.zeros(pair.one.size)
    for i in range(pair.one.size):
        room[i] = _square(pair.one[i])
    found = 0.0
    for i in range(pair.one.size):
        pair.two[i] = room[i]
        found += room[i] * rows[i].weight[1]
    return scale, (0.5 * found if half else found), half


@njit(cache=True, error_model="numpy")
def fill(grid, value):
    for i in range(grid.shape[0]):
        for j in range(grid.shape[1]):
            grid[i, j] = value


PROGRAM = Program(Path(__file__).with_name("tiny.program"), ("tiny",), (total, fill))
ROW = np.dtype([("kind", "i8"), ("weight", "f8", 2)])


def use():
    rows = np.zeros(3, ROW)
    rows["weight"][:, 1] = 1.0, 10.0, 100.0
    pair, grid = Pair(np.array([1.0, 2.0, 3.0]), np.zeros(3)), np.zeros((2, 3))
    found = total(rows, pair, 7, False), total(rows, pair, 7, True)
    fill(grid, 3.0)
    return [*found, pair.two.tolist(), grid.sum()]
'''
FOUND = [(7, 2.0 + 80.0 + 1800.0, False), (7, 941.0, True), [2.0, 8.0, 18.0], 18.0]
USE = "import sys, tiny.kernels as k; print([k.use(), 'numba' in sys.modules, k.PROGRAM.why_not()])"
MAKE = """
import tiny.kernels as k
from mdlgen.program import build
types = build.watched(k.PROGRAM)
build.SHIPPED = ()
k.use()
build.write(k.PROGRAM, types)
"""


def python(code: str, folder: Path, cache: Path, *args: str, **more: str) -> subprocess.Popen[str]:
    """Python in a folder, with a cache of its own."""
    surroundings = {k: v for k, v in os.environ.items() if k != "MDLGEN_NUMBA"}
    return subprocess.Popen(
        [sys.executable, *args, "-c", code],
        cwd=folder,
        env={**surroundings, "MDLGEN_CACHE": str(cache), **more},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def answer(process: subprocess.Popen[str]) -> Any:
    """What it printed, evaluated; on standard error it says nothing."""
    out, err = process.communicate(timeout=300)
    assert (process.returncode, err) == (0, "")
    return eval(out, {"np": np})


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A program for the kernels above."""
    folder = tmp_path_factory.mktemp("made")
    package(folder, None)
    process = python(MAKE, folder, folder / "cache", NUMBA_OPT="0", MDLGEN_NUMBA="1", PYTHONWARNINGS="ignore")
    assert process.communicate(timeout=300)[1] == ""
    return (folder / "tiny" / "tiny.program").read_bytes()


def package(folder: Path, program: bytes | None) -> Path:
    """The package `tiny` in a folder; where its program stands."""
    (folder / "tiny").mkdir()
    (folder / "tiny" / "__init__.py").write_text("")
    (folder / "tiny" / "kernels.py").write_text(KERNELS)
    path = folder / "tiny" / "tiny.program"
    if program is not None:
        path.write_bytes(program)
    return path


def test_a_program_is_called_without_numba(tmp_path: Path, made: bytes) -> None:
    """Where no library lies beside it: LLVM makes machine code of its bitcode, once."""
    package(tmp_path, made)
    assert answer(python(USE, tmp_path, tmp_path / "cache")) == [FOUND, False, None]
    kept = list((tmp_path / "cache" / "programs").iterdir())
    assert [path.suffix for path in kept] == [".o"]
    before = kept[0].stat().st_mtime_ns
    assert answer(python(USE, tmp_path, tmp_path / "cache")) == [FOUND, False, None]
    assert kept[0].stat().st_mtime_ns == before, "it is loaded, not made again"
    assert answer(python(USE, tmp_path, tmp_path / "cache", MDLGEN_NUMBA="1"))[:2] == [FOUND, True]


@pytest.mark.parametrize("harm", ["cut", "changed", "foreign", "empty", "other kernels", "of a later LLVM"])
def test_a_program_that_does_not_fit_is_compiled_by_numba(tmp_path: Path, made: bytes, harm: str) -> None:
    head, _, code = made.partition(b"\n")
    bitcode = b"BC\xc0\xde" + bytes(2000)
    packed, digest = file.pack([bitcode])
    unlike = {"digest": "0" * 64, "statements": "0" * 64}
    alike = {**json.loads(head), "code": digest, "parts": [len(bitcode)]}
    program = {
        "cut": made[:-100],
        "changed": made[:-50] + bytes([made[-50] ^ 1]) + made[-49:],
        "foreign": b"\x89PNG\r\n\x1a\n" + bytes(100),
        "empty": b"",
        "other kernels": json.dumps({**json.loads(head), **unlike}).encode() + b"\n" + code,
        "of a later LLVM": json.dumps(alike).encode() + b"\n" + packed,
    }[harm]
    package(tmp_path, program)
    found, by_numba, why = answer(python(USE, tmp_path, tmp_path / "cache"))
    assert (found, by_numba) == (FOUND, True)
    assert {"other kernels": "other kernels", "of a later LLVM": "LLVM"}.get(harm, "damaged") in why


def test_machine_code_that_is_damaged_is_made_again(tmp_path: Path, made: bytes) -> None:
    package(tmp_path, made)
    assert answer(python(USE, tmp_path, tmp_path / "cache")) == [FOUND, False, None]
    (kept,) = (tmp_path / "cache" / "programs").iterdir()
    whole = kept.read_bytes()
    for harm in (whole[:-40], b"", whole[:200] + b"\xff\xff" + whole[202:]):
        kept.write_bytes(harm)
        assert answer(python(USE, tmp_path, tmp_path / "cache")) == [FOUND, False, None]
        assert kept.read_bytes()[:32] == hashlib.sha256(kept.read_bytes()[32:]).digest()


def test_a_home_that_nobody_writes_to_does_no_harm(tmp_path: Path, made: bytes) -> None:
    """A folder below a file cannot be made by anybody, not even by root."""
    package(tmp_path, made)
    (tmp_path / "file").write_text("")
    for kind in ("0", "1"):
        found = answer(python(USE, tmp_path, tmp_path / "file" / "cache", MDLGEN_NUMBA=kind))
        assert found[:2] == [FOUND, kind == "1"]


def test_first_runs_at_once_give_the_same(tmp_path: Path, made: bytes) -> None:
    package(tmp_path, made)
    all_of_them = [python(USE, tmp_path, tmp_path / "cache") for _ in range(3)]
    assert [answer(process) for process in all_of_them] == [[FOUND, False, None]] * 3
    assert [path.suffix for path in (tmp_path / "cache" / "programs").iterdir()] == [".o"]


def test_arguments_of_other_types_are_numbas(tmp_path: Path, made: bytes) -> None:
    package(tmp_path, made)
    code = (
        "import sys, numpy as np, tiny.kernels as k\n"
        "whole = np.zeros((2, 6))\n"
        "k.fill(whole, 1.0)\nfirst = 'numba' in sys.modules\n"
        "k.fill(whole[:, ::2], 2.0)\n"  # in another order
        "k.fill(whole[:1], 3)\n"  # a whole number is a number
        "print([first, 'numba' in sys.modules, whole.tolist()])"
    )
    found = [[3.0] * 6, [2.0, 1.0] * 3]
    assert answer(python(code, tmp_path, tmp_path / "cache")) == [False, True, found]


def test_memory_stays_flat(tmp_path: Path, made: bytes) -> None:
    """Arrays of compiled code are given back: 400 calls that make one of 8 MB each."""
    package(tmp_path, made)
    code = (
        "import resource, numpy as np, tiny.kernels as k\n"
        "most = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
        "rows, pair = np.zeros(1_000_000, k.ROW), k.Pair(np.ones(1_000_000), np.zeros(1_000_000))\n"
        "found = [k.total(rows, pair, 1, False) and most() for _ in range(400)]\n"
        "k.PROGRAM.release()\n"
        "print([found[-1] - found[2]])"
    )
    (grown,) = answer(python(code, tmp_path, tmp_path / "cache"))
    assert grown < 20_000, "kB, of 3,200,000 made"


def test_memory_stays_flat_over_many_runs(tmp_path: Path) -> None:
    """Of 200 runs each leaves less than a thirtieth of what it held: memory grows by steps of some MB."""
    if PROGRAM.why_not() is not None:
        pytest.skip("numba compiles, since the program does not fit")
    sets = ["sheets.note.boxes=[2, 3]", "run.duration=4 ms", "run.step=0.1 ms", "run.print_step=1 ms"]
    code = (
        "import resource, tracemalloc, mdlgen\n"
        f"made = mdlgen.lower(mdlgen.load({str(samples() / 'transport_4x4.yaml')!r}, {sets!r}))\n"
        "def most(runs):\n"
        "    assert all(mdlgen.solve(made, 'lattice').ok for _ in range(runs))\n"
        "    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
        "before, after = most(30), most(200)\n"
        "tracemalloc.start()\n"
        "most(1)\n"
        "print([after - before, tracemalloc.get_traced_memory()[1] / 1024])"
    )
    cache = str(paths.user_cache())
    grown, held = answer(python(code, tmp_path, Path(cache), PYTHONPATH=os.pathsep.join(sys.path)))
    assert held > 500
    assert grown < 200 * held / 30, "kB"


def test_arguments_are_forgotten_as_a_solver_ends(tmp_path: Path, made: bytes) -> None:
    package(tmp_path, made)
    code = (
        "import weakref, numpy as np, tiny.kernels as k\n"
        "@k.PROGRAM.releases\n"
        "def solve():\n"
        "    grid = np.zeros((2, 2))\n"
        "    k.fill(grid, 1.0)\n"
        "    return weakref.ref(grid)\n"
        "print([solve()()])"
    )
    assert answer(python(code, tmp_path, tmp_path / "cache")) == [None]


def test_a_users_own_numba_stays_as_it_was(tmp_path: Path) -> None:
    """No setting and no patch is left: numba keeps the code of a user's file beside that file."""
    package(tmp_path, None)
    (tmp_path / "own.py").write_text(
        "from numba import njit\n@njit(cache=True)\ndef twice(x):\n    return 2 * x\n"
    )
    code = (
        "import numba.core.caching as c, numba.core.config as config\n"
        "before = config.CACHE_DIR, c.FunctionCache.save_overload\n"
        "import mdlgen, mdlgen.backends.lattice, mdlgen.backends.exudyn_local.shipped, tiny.kernels as k\n"
        "k.use()\n"
        "import own\n"
        "print([own.twice(2), (config.CACHE_DIR, c.FunctionCache.save_overload) == before])"
    )
    assert answer(python(code, tmp_path, tmp_path / "cache")) == [4, True]
    assert [path.name for path in (tmp_path / "__pycache__").glob("own.*.nbi")]
    kept = [path.stem for path in (tmp_path / "cache").rglob("*.nbi")]
    assert sorted(kept) == ["_square", "fill", "total"]


def test_a_process_that_has_numba_can_call_kernels_from_its_own(tmp_path: Path) -> None:
    package(tmp_path, None)
    code = (
        "from numba import njit\nfrom tiny.kernels import _square\n"
        "@njit\ndef twice(x):\n    return 2 * _square(x)\nprint([twice(3.0)])"
    )
    assert answer(python(code, tmp_path, tmp_path / "cache")) == [36.0]


@pytest.mark.parametrize(
    ("triple", "magic"),
    [
        ("x86_64-unknown-linux-gnu", b"\x7fELF"),
        ("aarch64-unknown-linux-gnu", b"\x7fELF"),
        ("arm64-apple-macosx11.0.0", b"\xcf\xfa\xed\xfe"),
        ("x86_64-pc-windows-msvc", b"\x64\x86"),
    ],
)
def test_machine_code_is_made_for_other_machines(
    made: bytes, tmp_path: Path, triple: str, magic: bytes
) -> None:
    """It is not run there."""
    import llvmlite.binding as llvm

    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    path = tmp_path / "tiny.program"
    path.write_bytes(made)
    bitcodes = [emit.joined(file.read(path)[1])]
    # that of lattice takes the most time; those for the machine that this runs on are made in any case
    wanted = "lattice" if triple.startswith("arm64") else "exudyn" if "x86_64-unknown" not in triple else None
    bitcodes += [
        emit.joined(file.read(program.path)[1])
        for program in build.programs()
        if program.name == wanted and program.path.exists()
    ]
    for bitcode in bitcodes:
        machine = llvm.Target.from_triple(triple).create_target_machine(opt=3, reloc="pic")
        code = emit.emit(machine, bitcode)
        assert code.startswith(magic) and len(code) > 1000
