"""Shipped libraries: what is loaded where, what follows where one is damaged, how they are made."""

from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.errors import RefusedError
from mdlgen.program import build, emit, file, kernel, native
from mdlgen.program.file import Unfit
from mdlgen.program.ship import Program

# Of an ELF file: what it begins with, and its machine, the 16 bits at byte 18.
ELF, MACHINES = b"\x7fELF", {emit.X86: 62, emit.ARM: 183}
CPUINFO = "processor\t: 0\nmodel name\t: Some CPU\nflags\t\t: fpu {} sse2\n"


@pytest.mark.parametrize("program", build.programs(), ids=lambda program: program.name)
def test_each_program_has_its_libraries(program: Program) -> None:
    if not program.path.exists():
        pytest.skip("there is no program")
    head = file.read_head(program.path)
    assert head.libraries.keys() == MACHINES.keys() == {target.name for target in emit.SHIPPED}
    for target, digest in head.libraries.items():
        code = file.library(program.path, target).read_bytes()
        assert hashlib.sha256(code).hexdigest() == digest
        assert code[:4] == ELF and int.from_bytes(code[18:20], "little") == MACHINES[target]
        for variants in head.entries.values():
            assert all(b"\0" + variant.symbol.encode() + b"\0" in code for variant in variants)


def test_the_library_of_this_machine_is_loaded_and_llvm_is_not() -> None:
    """A run of a sample imports neither numba nor llvmlite."""
    if PROGRAM.why_not() is not None or emit.shipped() is None:
        pytest.skip(f"the solver runs code that is {PROGRAM.code()}")
    code = (
        "import sys, mdlgen\n"
        "from mdlgen.paths import samples\n"
        "made = mdlgen.lower(mdlgen.load(samples() / 'transport_4x4.yaml', ['run.duration=1 ms']))\n"
        "result = mdlgen.solve(made, 'lattice')\n"
        "print(result.status, sorted({'numba', 'llvmlite'} & set(sys.modules)), result.versions['code'])"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    target = emit.shipped()
    assert target is not None
    digest = file.read_head(PROGRAM.path).libraries[target]
    assert out.strip() == f"ok [] shipped for {target}, {digest[:16]}"


@pytest.mark.parametrize("harm", ["missing", "changed", "for another machine", "not a library"])
def test_without_a_whole_library_the_bitcode_serves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, harm: str
) -> None:
    """Nothing damaged is loaded."""
    target = emit.X86 if emit.shipped() != emit.ARM else emit.ARM
    other = emit.ARM if target == emit.X86 else emit.X86
    path = tmp_path / PROGRAM.path.name
    head = file.read_head(shutil.copy(PROGRAM.path, path))
    code = file.library(PROGRAM.path, target).read_bytes()
    code = {"changed": code[:-9] + b"x" + code[-8:], "not a library": b"text"}.get(harm, code)
    if harm == "for another machine":
        code = file.library(PROGRAM.path, other).read_bytes()
    if harm != "missing":
        file.library(path, target).write_bytes(code)
    digest = head.libraries[target]
    if harm in ("for another machine", "not a library"):  # the head says that it is right
        digest = hashlib.sha256(code).hexdigest()
    head.libraries[target] = digest
    monkeypatch.setattr(emit, "shipped", lambda: target)
    monkeypatch.setattr(native, "_made", lambda path, head: "bitcode")
    assert native.load(path, head) == "bitcode"
    monkeypatch.setenv("MDLGEN_BITCODE", "1")
    assert native.load(PROGRAM.path, file.read_head(PROGRAM.path)) == "bitcode"


def test_a_library_is_for_processors_that_have_what_it_needs(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def found(system: str, machine: str, lacks: str = "") -> str | None:
        flags = " ".join(sorted(emit.V3 - {lacks}))
        monkeypatch.setattr(emit, "processor", lambda what: flags if what == "flags" else "")
        monkeypatch.setattr(sys, "platform", system)
        monkeypatch.setattr("platform.machine", lambda: machine)
        return emit.shipped()

    assert (found("linux", "x86_64"), found("linux", "aarch64")) == (emit.X86, emit.ARM)
    for flag in emit.V3:
        assert found("linux", "x86_64", flag) is None
    # other systems call functions in another way
    assert [found("win32", "AMD64"), found("darwin", "arm64"), found("linux", "riscv64")] == [None] * 3


def test_without_numba_and_llvmlite_the_message_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "llvmlite", None)
    monkeypatch.setitem(sys.modules, "numba", None)
    with pytest.raises(Unfit, match=r"no library of lattice\.program runs here and llvmlite"):
        native._made(PROGRAM.path, file.read_head(PROGRAM.path))

    def nothing() -> None:
        """A kernel that no program has."""

    with pytest.raises(
        RefusedError,
        match=r"kernel nothing, since no program has it, needs numba.* pip install 'mdlgen\[compile\]'",
    ):
        kernel.njit()(nothing)()


def test_libraries_are_the_same_bytes_each_time_and_run(tmp_path: Path) -> None:
    """Of the smaller program; `python -m mdlgen.program.build --verify` compares all that is shipped."""
    pytest.importorskip("ziglang")
    program = next(each for each in build.programs() if each.name == "exudyn")
    path = tmp_path / program.path.name
    head, parts = file.read(shutil.copy(program.path, path))
    build.write_libraries(path, head, file.pack(parts)[0], parts)
    assert path.read_bytes() == program.path.read_bytes()
    for target in emit.SHIPPED:
        there = file.library(program.path, target.name)
        assert file.library(path, target.name).read_bytes() == there.read_bytes()
