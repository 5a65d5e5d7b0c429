"""A program as machine code: shipped, or made by LLVM once for a processor; cached, loaded, called."""

from __future__ import annotations

import contextlib
import ctypes
import hashlib
import logging
import os
import platform
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from mdlgen import paths
from mdlgen.errors import OutputError
from mdlgen.processors import processors
from mdlgen.program import emit, file
from mdlgen.program.emit import Target
from mdlgen.program.file import Head, Unfit, Variant
from mdlgen.program.layout import Misfit, Write, part_writers, reader, words

LOG = logging.getLogger("mdlgen.compiling")

_NOTHING: Any = object()
# How long another process may take for its part after this one has made its own [s].
PATIENCE = 120.0


def bitcode_only() -> bool:
    """True if machine code is made here, whatever is shipped: MDLGEN_BITCODE is set."""
    return os.environ.get("MDLGEN_BITCODE", "0") not in ("", "0")


def load(path: Path, head: Head) -> Machine:
    """The machine code of a program for this processor: the library that is shipped for such a one, or else
    what LLVM makes of the bitcode, or what it made before.

    Raises Unfit.
    """
    if ctypes.sizeof(ctypes.c_void_p) != 8 or sys.byteorder != "little":
        raise Unfit("addresses are not of 64 bits here, the low ones first")
    target = None if bitcode_only() else emit.shipped()
    digest = head.libraries.get(target or "")
    shipped = None if target is None or digest is None else _library(file.library(path, target), digest)
    if target is None or digest is None or shipped is None:
        return _made(path, head)
    return Machine(shipped, f"shipped for {target}", digest)


def _library(path: Path, digest: str) -> Callable[[str], int] | None:
    """A lookup of addresses in a shared library; None: it is missing or damaged, or the system cannot load
    it. A library that needs a different C library is such a case."""
    try:
        if hashlib.sha256(path.read_bytes()).hexdigest() != digest:
            LOG.debug("%s is damaged", path)
            return None
        library = ctypes.CDLL(str(path))
    except OSError as error:
        LOG.debug("%s", error)
        return None
    return lambda symbol: ctypes.cast(getattr(library, symbol), ctypes.c_void_p).value or 0


def _made(path: Path, head: Head) -> Machine:
    """The machine code that LLVM makes of a program's bitcode here, or made before. Raises Unfit."""
    try:
        import llvmlite
        import llvmlite.binding as llvm
    except ImportError:
        raise Unfit(f"no library of {path.name} runs here and llvmlite is not installed") from None
    target = emit.host()
    message = (head.code, *target, llvmlite.__version__, platform.python_version())
    key = hashlib.sha256("\n".join(message).encode()).hexdigest()[:24]
    for symbol in head.external:
        if llvm.address_of_symbol(symbol) is None:
            llvm.add_symbol(symbol, _address(symbol))
    folder = paths.cache("programs")
    count = len(head.parts) if target.form == emit.APART else 1
    kept = [folder / f"{path.stem}_{key}_{k}.o" if folder else None for k in range(count)]
    codes = [_kept(one) for one in kept]
    if missing := [k for k, code in enumerate(codes) if code is None]:
        LOG.info("%s is prepared", path.stem)
        made = emitted(target, file.read(path)[1], missing)
        for k, code in zip(missing, made, strict=True):
            codes[k] = code
            _keep(kept[k], code)
    whole = [code for code in codes if code is not None]
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), emit.machine(target))
    for code in whole:
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    digest = hashlib.sha256(b"".join(whole)).hexdigest()
    return Machine(engine.get_function_address, f"made for {target.name}", digest)


def emitted(target: Target, parts: Sequence[bytes], wanted: Sequence[int] = (0,)) -> list[bytes]:
    """The `wanted` object files of a program in parts. This process makes the first one. The others are made
    at the same time by processes of their own, if there are processors. Files that such a process fails to
    make are made here. Raises Unfit."""
    try:
        every, machine = emit.units(target, parts), emit.machine(target)
        units = [every[k] for k in wanted]
        if len(units) == 1 or processors() == 1:
            return [emit.emit(machine, unit) for unit in units]
        with contextlib.ExitStack() as stack:
            others = [stack.enter_context(_elsewhere(target, unit)) for unit in units[1:]]
            codes = [emit.emit(machine, units[0])]
            for unit, answer in zip(units[1:], others, strict=True):
                codes.append(answer() or emit.emit(machine, unit))
            return codes
    except RuntimeError as error:  # bitcode of a later LLVM, for one
        record = str(error).strip().splitlines() or ["it cannot be read"]
        raise Unfit(f"LLVM does not take it: {record[0]}") from None


@contextlib.contextmanager
def _elsewhere(target: Target, part: bytes) -> Iterator[Callable[[], bytes | None]]:
    """Starts another process that emits a part for a target. Yields a function that waits for its machine
    code; None: it gave none. The process does not outlive the block."""
    surroundings = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    try:
        process = subprocess.Popen(
            [sys.executable, "-P", emit.__file__, *target],
            env=surroundings,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
    except (OSError, ValueError):  # no memory for it, or Python is part of another program
        yield lambda: None
        return
    found: list[bytes] = []

    def talk() -> None:
        with contextlib.suppress(OSError, ValueError):  # it is gone
            found.append(process.communicate(part)[0])

    talking = threading.Thread(target=talk, daemon=True)
    talking.start()

    def answer() -> bytes | None:
        talking.join(PATIENCE)
        return found[0] if found and found[0] and process.returncode == 0 else None

    try:
        yield answer
    finally:
        if process.poll() is None:
            process.kill()
        talking.join()


def _address(symbol: str) -> int:
    """Address of a function of the system. Raises Unfit."""
    names = ("ucrtbase", "msvcrt", "vcruntime140") if sys.platform == "win32" else (None, "libm.so.6")
    for name in names:
        try:
            found = getattr(ctypes.CDLL(name), symbol)
        except (OSError, AttributeError):
            continue
        address = ctypes.cast(found, ctypes.c_void_p).value
        if address:
            return address
    raise Unfit(f"this system has no {symbol}")


def _kept(path: Path | None) -> bytes | None:
    """Cached machine code; None where there is none, or where it is incomplete."""
    if path is None:
        return None
    try:
        raw = path.read_bytes()
    except OSError:
        return None
    return raw[32:] if hashlib.sha256(raw[32:]).digest() == raw[:32] else None


def _keep(path: Path | None, code: bytes) -> None:
    if path is None:
        return
    try:
        paths.write_atomic(path, hashlib.sha256(code).digest() + code)
    except OutputError as error:
        LOG.debug("machine code is not kept: %s", error)


class Machine:
    """Machine code in this process: `kind` names its target, `digest` is SHA-256 of it."""

    def __init__(self, address: Callable[[str], int], kind: str, digest: str):
        self._address, self.kind, self.digest = address, kind, digest

    def entry(self, name: str, variant: Variant) -> Call:
        """A function that calls an entry with arguments of some types."""
        return Call(name, variant, self._address(variant.symbol))


class ArgumentWords(threading.local):
    """The words of one thread's calls, and the arguments that they were made of; `items` has how many each
    argument has that is a tuple, 0 for the others."""

    def __init__(self, size: int, items: Sequence[int], result: int):
        self.words = ctypes.create_string_buffer(8 * size)
        self.result = ctypes.create_string_buffer(max(8, result))
        self.error = ctypes.create_string_buffer(8)
        self.last: list[Any] = [_NOTHING] * len(items)
        self.items: list[list[Any]] = [[_NOTHING] * count for count in items]
        self.address = ctypes.addressof(self.words)
        head = (ctypes.c_int64 * 2).from_buffer(self.words)
        head[0], head[1] = ctypes.addressof(self.result), ctypes.addressof(self.error)


class Call:
    """Calls one variant of an entry.

    Arguments that are the same objects as the last time are not looked at again, nor are such items of a
    tuple: their words stand there.
    """

    def __init__(self, name: str, variant: Variant, address: int):
        self.name = name
        at, self._writers = 2, []
        for kind in variant.arguments:
            self._writers.append(part_writers(kind, at))
            at += words(kind)
        size, self._read = reader(variant.result)
        self._count = len(self._writers)
        items = [0 if callable(writers) else len(writers) for writers in self._writers]
        self._row = ArgumentWords(at, items, size)
        self._function = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p)(address)

    def __call__(self, *args: Any) -> Any:
        """The result. Raises Misfit for arguments of other types, MemoryError where memory is short."""
        row = self._row
        last = row.last
        if len(args) != self._count:
            raise Misfit(f"{len(args)} arguments for {self._count}")
        for k, arg in enumerate(args):
            if arg is not last[k]:
                last[k] = _NOTHING
                write = self._writers[k]
                if callable(write):
                    write(row.words, arg)
                else:
                    _write_items(write, row.words, arg, row.items[k])
                last[k] = arg
        if self._function(row.address) != 0:
            raise MemoryError(f"{self.name}: not enough memory for its arrays")
        return self._read(row.result)

    def release(self) -> None:
        """Forgets the arguments of this thread's last call."""
        row = self._row
        row.last[:] = [_NOTHING] * self._count
        for items in row.items:
            items[:] = [_NOTHING] * len(items)


def _write_items(writers: list[Write], buffer: Any, value: Any, last: list[Any]) -> None:
    """Writes the items of a tuple that are others than the last time. Raises Misfit."""
    if not isinstance(value, tuple) or len(value) != len(writers):
        raise Misfit(f"a {type(value).__name__} for a tuple of {len(writers)}")
    for k, item in enumerate(value):
        if item is not last[k]:
            last[k] = _NOTHING
            writers[k](buffer, item)
            last[k] = item
