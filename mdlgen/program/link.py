"""Shared libraries of a program's object files, by LLVM's linker, which the package ziglang has.

A library needs the C library of Linux alone, shows its entries alone, and is the same bytes each time.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from mdlgen.program import emit
from mdlgen.program.emit import Target

# The linker's names of the machines, by the beginning of their triples.
MACHINES = {"x86_64": "elf_x86_64", "aarch64": "aarch64linux"}
# Libraries of the system that have the functions which a program may call (build.SYSTEM).
NEEDED = ("libm.so.6", "libc.so.6")


def linked(target: Target, codes: Sequence[bytes], name: str, symbols: Sequence[str]) -> bytes:
    """A shared library of that name of object files for a target; it shows the `symbols`.

    Raises subprocess.CalledProcessError where the linker refuses, or is not there; it says why.
    """
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        linker = [sys.executable, "-m", "ziglang", "ld.lld"]
        linker += ["-m", MACHINES[target.triple.partition("-")[0]], "-shared", "--build-id=none"]

        def link(out: str, soname: str, *args: str) -> bytes:
            subprocess.run([*linker, "-soname", soname, "-o", out, *args], cwd=folder, check=True)
            return (folder / out).read_bytes()

        # in place of the system's libraries stand empty ones: no version of a function is asked for
        (folder / "empty.o").write_bytes(_empty(target))
        for needed in NEEDED:
            link(needed, needed, "empty.o")
        objects = [f"{k}.o" for k in range(len(codes))]
        for one, code in zip(objects, codes, strict=True):
            (folder / one).write_bytes(code)
        shown = " ".join(f"{symbol};" for symbol in symbols)
        (folder / "symbols").write_text(f"{{ global: {shown} local: *; }};", "ascii")
        options = ["--version-script", "symbols", "--strip-all", "-z", "now", "--no-as-needed"]
        return link("made.so", name, *options, *objects, *NEEDED)


def _empty(target: Target) -> bytes:
    import llvmlite.binding as llvm

    machine, module = emit.machine(target), llvm.parse_assembly("")
    module.triple = target.triple
    return machine.emit_object(module)
