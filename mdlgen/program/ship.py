"""A shipped program: the entries of a solver's kernels, and whether it fits here."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from pathlib import Path
from threading import RLock
from typing import Any, ParamSpec, TypeVar

from mdlgen.program import file, native
from mdlgen.program.digests import sources_digest, statements_digest
from mdlgen.program.file import Unfit
from mdlgen.program.kernel import Kernel, alone
from mdlgen.program.layout import Misfit

_lock = RLock()
P = ParamSpec("P")
T = TypeVar("T")


class Program:
    """The compiled kernels of some packages, in a file, as far as it fits.

    `entries` are the kernels that Python calls; none of them is called by another one.
    """

    def __init__(self, path: Path, rooms: Sequence[str], entries: Sequence[Kernel]):
        self.path, self.rooms, self.entries = path, tuple(rooms), tuple(entries)
        self._machine: native.Machine | None = None
        self._head: file.Head | None = None
        self._why: str | None = None
        self._made: list[Entry] = []
        for kernel in entries:
            kernel.programs.append(self)

    @property
    def name(self) -> str:
        """Name of the program."""
        return self.path.stem

    @property
    def loaded(self) -> bool:
        """True if it is in use."""
        return self._machine is not None

    def head(self) -> file.Head:
        """The head of the file, if it was made from these kernels. Raises Unfit."""
        head = file.read_head(self.path)
        if head.digest != sources_digest(self.rooms) and head.statements != statements_digest(self.rooms):
            raise Unfit(f"{self.path.name} was made from other kernels")
        return head

    def why_not(self) -> str | None:
        """Why it is not used, so that numba compiles; None where it is."""
        with _lock:
            if self._machine is None and self._why is None:
                self._load()
            return self._why

    def code(self) -> str:
        """The machine code that runs, with the beginning of its digest, for the record of a run."""
        if self.why_not() is not None or self._machine is None:
            return "compiled by numba"
        return f"{self._machine.kind}, {self._machine.digest[:16]}"

    def _load(self) -> None:
        if alone():
            self._why = "MDLGEN_NUMBA is set"
            return
        try:
            head = self.head()
            self._machine = native.load(self.path, head)
            self._head = head
        except Unfit as error:
            self._why = str(error)

    def entry(self, kernel: Kernel) -> Entry | None:
        """The compiled entry for a kernel; None where numba compiles it."""
        if self.why_not() is not None or self._head is None or self._machine is None:
            return None
        name = kernel.__name__
        calls = [self._machine.entry(name, variant) for variant in self._head.entries.get(name, ())]
        if not calls:
            return None
        entry = Entry(kernel, calls)
        self._made.append(entry)
        return entry

    def releases(self, work: Callable[P, T]) -> Callable[P, T]:
        """Makes a function forget the arguments of its last calls as it ends."""

        @functools.wraps(work)
        def worked(*args: P.args, **named: P.kwargs) -> T:
            try:
                return work(*args, **named)
            finally:
                self.release()

        return worked

    def release(self) -> None:
        """Forgets the arguments of the last calls, which are cached for the next ones."""
        for entry in self._made:
            entry.release()


class Entry:
    """Calls a kernel in its program, and numba's where arguments are of types that the program has not."""

    def __init__(self, kernel: Kernel, calls: list[native.Call]):
        self._kernel, self._calls, self._best = kernel, calls, calls[0]

    def __call__(self, *args: Any) -> Any:
        """The result."""
        try:
            return self._best(*args)
        except Misfit:
            return self._other(args)

    def _other(self, args: tuple[Any, ...]) -> Any:
        for call in self._calls:
            try:
                found = call(*args)
            except Misfit:
                continue
            self._best = call
            return found
        return self._kernel.compiled(*args)

    def release(self) -> None:
        """Forgets the arguments of the last calls."""
        for call in self._calls:
            call.release()
