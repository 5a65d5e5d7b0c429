"""Kernels: functions that numba can compile, and that a shipped program may hold.

numba is imported where a kernel that no program has is called from Python, and not before.
"""

from __future__ import annotations

import dis
import functools
import hashlib
import importlib
import inspect
import logging
import os
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING, Any

from mdlgen import paths
from mdlgen.errors import RefusedError
from mdlgen.extras import advice

if TYPE_CHECKING:
    from mdlgen.program.ship import Program

LOG = logging.getLogger("mdlgen.compiling")

# Compiled code counts the references to an array, by an atomic operation at each begin and end of a function.
# For one of many arrays that is called for each pair this took a tenth of a run. A kernel marked BORROWS
# leaves the counting to its caller, and cannot make an array. Kernels that it calls inherit the mark, unless
# they are marked OWNS because they make arrays.
BORROWS: dict[str, Any] = {"_nrt": False}
OWNS: dict[str, Any] = {"_nrt": True}
# A kernel without its own forceinline inherits it from the kernel that calls it first. Inlining also decides
# where sums are rounded. A kernel marked CALLED is not inlined into kernels that are inlined themselves.
CALLED: dict[str, Any] = {"forceinline": False}
# A sum of products may be rounded once, where the processor has an instruction for it.
FUSED: dict[str, Any] = {"fastmath": {"contract"}}

# Package of the laws that kernels of all solvers call.
LAWS = "mdlgen.mechanics"

_lock = RLock()
_parts = count(1)


def alone() -> bool:
    """True if numba is to compile all kernels, whatever is shipped: MDLGEN_NUMBA is set."""
    return os.environ.get("MDLGEN_NUMBA", "0") not in ("", "0")


def njit(**options: Any) -> Callable[[Callable[..., Any]], Kernel]:
    """Makes a Kernel of a function; `options` are those of `numba.njit`."""
    return lambda function: Kernel(function, options)


class Kernel:
    """A function that is called as compiled code: that of a program which has it, or else numba's."""

    __name__: str

    def __init__(self, function: Callable[..., Any], options: dict[str, Any], text: str = ""):
        functools.update_wrapper(self, function)
        self.py_func = function
        self.options = options
        self.text = text  # that the function was made from, where no file has it
        self.programs: list[Program] = []  # that have it as an entry
        self._call: Callable[..., Any] = self._first
        self._made: dict[bool, Any] = {}

    def __call__(self, *args: Any) -> Any:
        """Calls the compiled code; all arguments by their places."""
        return self._call(*args)

    def __repr__(self) -> str:
        return f"<kernel {self.__module__}.{self.__name__}>"

    def _first(self, *args: Any) -> Any:
        # of two the one that is loaded already
        for program in sorted(self.programs, key=lambda program: not program.loaded):
            entry = program.entry(self)
            if entry is not None:
                self._call = entry
                return entry(*args)
        self._call = self.compiled
        return self.compiled(*args)

    def compiled(self, *args: Any) -> Any:
        """Calls the code of numba; compilations in the first call are logged."""
        dispatcher = self.dispatcher
        with _logged():
            found = dispatcher(*args)
        if self._call == self.compiled:
            self._call = dispatcher  # else some arguments are the program's
        return found

    def watch(self, watch: Callable[[tuple[Any, ...]], None]) -> None:
        """Calls `watch` with the arguments before each call from Python, which numba's code does."""

        def watched(*args: Any) -> Any:
            watch(args)
            return self.dispatcher(*args)

        self._call = watched

    @property
    def dispatcher(self) -> Any:
        """numba's object for this function, for calls from Python."""
        return self._dispatcher(True)

    @property
    def piece(self) -> Any:
        """numba's object for this function, for calls from other kernels; see mdlgen.program.pieces."""
        return self._dispatcher(False)

    def _dispatcher(self, whole: bool) -> Any:
        if whole not in self._made:
            with _lock:
                if whole not in self._made:
                    self._made[whole] = _dispatcher(self, whole)
        return self._made[whole]

    @property
    def full_name(self) -> str:
        """Module and name; no other kernel has the same."""
        return f"{self.__module__}.{self.__name__}"

    @functools.cached_property
    def own_digest(self) -> str:
        """Digest of the function's own source, options and values, and of the names of called kernels."""
        return _own_digest(self)

    @functools.cached_property
    def digest(self) -> str:
        """Digest of the function and of all kernels below it."""
        below = (f"{one.full_name} {one.digest}" for one in _compiled_from(self.py_func)[1])
        return hashlib.sha256("\n".join([self.own_digest, *below]).encode()).hexdigest()[:16]

    @property
    def _numba_type_(self) -> Any:
        # by this numba knows a kernel among the globals of a function that it compiles
        return self.piece._numba_type_


def intrinsic(function: Callable[..., Any], plain: Callable[..., Any]) -> Intrinsic:
    """Makes an Intrinsic of a function, which is as for `numba.extending.intrinsic`; `plain` does the same in
    Python."""
    return Intrinsic(function, plain)


class Intrinsic:
    """A function of LLVM, on vectors, that kernels call and Python does not have."""

    def __init__(self, function: Callable[..., Any], plain: Callable[..., Any]):
        functools.update_wrapper(self, function)
        self._function, self._plain = function, plain
        self._made: Any = None

    def __call__(self, *args: Any) -> Any:
        """The same function in Python."""
        return self._plain(*args)

    @property
    def _numba_type_(self) -> Any:
        if self._made is None:
            with _lock:
                if self._made is None:
                    make = importlib.import_module("numba.core.typing.templates").make_intrinsic_template
                    template = make(self, self._function, self._function.__name__, kwargs={})
                    self._made = importlib.import_module("numba").types.Function(template)
        return self._made


def _dispatcher(kernel: Kernel, whole: bool) -> Any:
    """A dispatcher whose code is kept in our folder; the settings of numba are afterwards as they were.

    Raises RefusedError where numba is not installed."""
    try:
        numba = importlib.import_module("numba")
    except ImportError:
        why = "; ".join(filter(None, (program.why_not() for program in kernel.programs)))
        what = f"compiling the kernel {kernel.__name__}, since {why or 'no program has it'},"
        raise RefusedError(f"{what} {advice('numba')}") from None
    settings = importlib.import_module("numba.core.config").__dict__  # made at run time
    pieces = importlib.import_module("mdlgen.program.pieces")
    function = kernel.py_func
    options = {
        **kernel.options,
        "cache": False,
        "pipeline_class": pieces.compiler_of(kernel.full_name, whole),
    }
    made = numba.njit(**options)(function)
    folder = _folder(kernel, whole) if kernel.options.get("cache") else None
    if folder is None:
        return made
    before = settings["CACHE_DIR"]
    settings["CACHE_DIR"] = str(folder)
    try:
        if whole:
            kept = pieces.WholeCache(function)
        else:
            kept = pieces.PieceCache(function, lambda name: _called(kernel, name))
        made._cache = _Unfailing(kept)
    except RuntimeError:  # numba finds no place there
        return made
    finally:
        settings["CACHE_DIR"] = before
    return made


def _called(kernel: Kernel, name: str) -> Any:
    """numba's object for the kernel of that name that a kernel calls, or None."""
    return next((one.piece for one in _compiled_from(kernel.py_func)[1] if one.full_name == name), None)


class _Unfailing:
    """A dispatcher's cache that cannot fail: code that cannot be stored, as on a full disk, is still used.

    numba raises OSError in the middle of a compilation. That would end a run that needs no disk space at all.
    """

    def __init__(self, cache: Any):
        self._cache = cache

    def __getattr__(self, name: str) -> Any:
        return getattr(self._cache, name)

    def load_overload(self, *args: Any) -> Any:
        """The cached code, None where it cannot be read."""
        try:
            return self._cache.load_overload(*args)
        except OSError as error:
            LOG.debug("compiled code is not read: %s", error.strerror)
            return None

    def save_overload(self, *args: Any) -> None:
        """Keeps it, if that can be done."""
        try:
            self._cache.save_overload(*args)
        except OSError as error:
            LOG.debug("compiled code is not kept: %s", error.strerror)


def _folder(kernel: Kernel, whole: bool) -> Path | None:
    """Cache folder of numba for a kernel: one for exactly its sources.

    numba notices that a function's own file has changed, but not a file whose functions it calls: a solver
    would go on with an older law without a word.
    """
    if "." not in kernel.__module__:
        return None
    if whole:
        return paths.cache(f"compiled/{kernel.full_name}_{kernel.digest}")
    return paths.cache(f"pieces/{kernel.full_name}_{kernel.own_digest}")


def _own_digest(kernel: Kernel) -> str:
    found = hashlib.sha256(f"{options_of(kernel)}\n{kernel.text}".encode())
    lines, called = _compiled_from(kernel.py_func)
    found.update("\n".join([*lines, *(one.full_name for one in called)]).encode())
    package = kernel.py_func.__module__.rpartition(".")[0]
    for room in sorted({LAWS, room_of(package)} if package else ()):
        found.update("\n".join(_shapes(room)).encode())
    return found.hexdigest()[:16]


@functools.cache
def _compiled_from(function: Callable[..., Any]) -> tuple[list[str], list[Kernel]]:
    """The source of a kernel and the plain values that it names; and the kernels that it calls."""
    lines, called = [f"{function.__module__}.{function.__qualname__}", _source(function)], []
    for used in sorted(_names(function.__code__)):
        value = function.__globals__.get(used)
        if isinstance(value, Kernel):
            called.append(value)
        elif isinstance(value, Intrinsic):
            lines.append(_source(value.__wrapped__))  # pyright: ignore[reportAttributeAccessIssue]
        elif isinstance(value, (bool, int, float, str, tuple)):
            lines.append(f"{used}={value!r}")
    return lines, called


def _names(code: Any) -> set[str]:
    """Names of the globals that some code reads. `co_names` would add names of attributes."""
    inner = (_names(part) for part in code.co_consts if hasattr(part, "co_names"))
    own = {one.argval for one in dis.get_instructions(code) if one.opname in ("LOAD_GLOBAL", "LOAD_NAME")}
    return own.union(*inner)


def _source(function: Any) -> str:
    try:
        return inspect.getsource(function)
    except OSError:  # its text stands with the kernel
        return ""


@functools.cache
def _shapes(room: str) -> list[str]:
    """Fields of the named tuples of a package: compiled code accesses them by their positions."""
    found: list[str] = []
    for module in kernel_sources(room):
        for name, value in sorted(vars(importlib.import_module(module)).items()):
            if isinstance(value, type) and hasattr(value, "_fields"):
                found.append(f"{name}{value._fields}")  # pyright: ignore[reportAttributeAccessIssue]
    return found


def options_of(kernel: Kernel) -> dict[str, Any]:
    """The options of a kernel as plain values in order."""
    return {key: _plain(value) for key, value in sorted(kernel.options.items())}


@functools.cache
def room_of(package: str) -> str:
    """The package of kernels around a package: the topmost that has kernels itself, not only in packages."""
    names = package.split(".")
    around = (".".join(names[: k + 1]) for k in range(len(names)))
    return next((room for room in around if _with_kernels(_folder_of(room).glob("*.py"))), package)


def kernel_sources(room: str) -> dict[str, Path]:
    """Files with kernels in a package and in those inside it, by the names of their modules, sorted."""
    folder = _folder_of(room)
    found = _with_kernels(folder.rglob("*.py"))
    named = {".".join((room, *path.relative_to(folder).with_suffix("").parts)): path for path in found}
    return dict(sorted(named.items()))


def _folder_of(package: str) -> Path:
    return Path(str(importlib.import_module(package).__file__)).parent


_MAKES_CODE = re.compile(rb"@njit|@intrinsic|= intrinsic\(")


def _with_kernels(files: Iterable[Path]) -> list[Path]:
    """Those with kernels, or with what kernels call that is compiled."""
    return [path for path in files if _MAKES_CODE.search(path.read_bytes())]


def _plain(value: Any) -> Any:
    return sorted(value) if isinstance(value, set) else value


@contextmanager
def _logged() -> Iterator[None]:
    """Logs (INFO, how many so far) each function that numba compiles inside; loaded code is not logged."""
    event = importlib.import_module("numba.core.event")

    class Counter(event.Listener):
        def on_start(self, event: Any) -> None:
            """Nothing is done yet."""

        def on_end(self, event: Any) -> None:
            done = next(_parts)
            LOG.info("%d", done, extra={"parts": done})

    with event.install_listener("numba:compile", Counter()):
        yield
