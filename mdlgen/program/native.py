"""A program as machine code: made by LLVM once for a processor, kept, loaded, called."""

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
from mdlgen.program import emit
from mdlgen.program.file import Head, Unfit, Variant
from mdlgen.program.layout import Misfit, Write, part_writers, reader, words

LOG = logging.getLogger("mdlgen.compiling")

_NOTHING: Any = object()
# How long another process may take for its part after this one has made its own [s].
PATIENCE = 120.0


def load(name: str, head: Head, bitcode: Callable[[], Sequence[bytes]]) -> Machine:
    """The machine code of a program for this processor; the `bitcode` of its parts is asked for where it is
    not kept.

    Raises Unfit.
    """
    import llvmlite
    import llvmlite.binding as llvm

    if ctypes.sizeof(ctypes.c_void_p) != 8 or sys.byteorder != "little":
        raise Unfit("addresses are not of 64 bits here, the low ones first")
    machine = emit.host()
    processor, features = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    message = (head.code, llvm.get_process_triple(), processor, features, llvmlite.__version__)
    key = hashlib.sha256("\n".join((*message, platform.python_version())).encode()).hexdigest()[:24]
    for symbol in head.external:
        if llvm.address_of_symbol(symbol) is None:
            llvm.add_symbol(symbol, _address(symbol))
    folder = paths.cache("programs")
    count = len(head.parts) if emit.apart() else 1
    kept = [folder / f"{name}_{key}_{k}.o" if folder else None for k in range(count)]
    codes = [_kept(path) for path in kept]
    if missing := [k for k, code in enumerate(codes) if code is None]:
        LOG.info("%s is prepared", name)
        made = emitted(machine, bitcode(), missing)
        for k, code in zip(missing, made, strict=True):
            codes[k] = code
            _keep(kept[k], code)
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
    for code in codes:
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return Machine(engine)


def emitted(machine: Any, parts: Sequence[bytes], wanted: Sequence[int] = (0,)) -> list[bytes]:
    """The `wanted` object files of a program in parts: the first one is made by this process, each other one
    at the same time by one of its own, where there are processors. What another process does not give is
    made here. Raises Unfit."""
    try:
        every = emit.units(parts)
        units = [every[k] for k in wanted]
        if len(units) == 1 or processors() == 1:
            return [emit.emit(machine, unit) for unit in units]
        with contextlib.ExitStack() as stack:
            others = [stack.enter_context(_elsewhere(unit)) for unit in units[1:]]
            codes = [emit.emit(machine, units[0])]
            for unit, answer in zip(units[1:], others, strict=True):
                codes.append(answer() or emit.emit(machine, unit))
            return codes
    except RuntimeError as error:  # bitcode of a later LLVM, for one
        record = str(error).strip().splitlines() or ["it cannot be read"]
        raise Unfit(f"LLVM does not take it: {record[0]}") from None


@contextlib.contextmanager
def _elsewhere(part: bytes) -> Iterator[Callable[[], bytes | None]]:
    """Another process that emits a part; what it is called for waits for its machine code, None: it gave
    none. It does not outlive the block."""
    surroundings = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    try:
        process = subprocess.Popen(
            [sys.executable, "-P", emit.__file__],
            env=surroundings,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
    except (OSError, ValueError):  # no room for it, or Python is part of another program
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
    """Where a function of the system stands. Raises Unfit."""
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
    """Machine code that was kept; None where there is none, or where it is not whole."""
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
    """Machine code in this process."""

    def __init__(self, engine: Any):
        self._engine = engine

    def entry(self, name: str, variant: Variant) -> Call:
        """What calls an entry with arguments of some types."""
        return Call(name, variant, self._engine.get_function_address(variant.symbol))


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
        """The result. Raises Misfit for arguments of other types, MemoryError where room is wanting."""
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
