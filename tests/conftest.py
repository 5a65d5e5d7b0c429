"""Random tests are the same every time, and never fail for a machine that is slow; tests run in an order in
which two workers do not compile the same for minutes."""

from __future__ import annotations

import functools
import gc
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import ran
import typer.main
from hypothesis import settings

from mdlgen.__main__ import MANY
from mdlgen.program import build
from mdlgen.program.file import Unfit
from mdlgen.program.kernel import Kernel, alone
from mdlgen.program.layout import Misfit
from mdlgen.program.ship import Entry, Program

pytest.register_assert_rewrite("motionview_cases")  # so that a failing check of a helper shows its values

# A process makes its commands ready once; tests that call hundreds of them in one process would each time.
typer.main.get_command = functools.cache(typer.main.get_command)

gc.set_threshold(MANY)  # cycles are looked for as rarely as in a command

settings.register_profile("mdlgen", deadline=None, derandomize=True)
settings.load_profile("mdlgen")

# The first test of each compiles nearly all that there is, or prepares what is shipped.
COMPILING = ("test_lattice", "test_lattice_static", "test_exudyn")
# Folders whose tests need nothing compiled, or little.
PLAIN = ("spec", "model", "text", "deck", "script")


@pytest.fixture(scope="session", autouse=True)
def _shared_runs(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Workers read the results of each other's runs; see ran.solved."""
    if os.environ.get("PYTEST_XDIST_WORKER"):
        ran.folder = tmp_path_factory.getbasetemp().parent / "ran"


@pytest.fixture(scope="session", autouse=True)
def _shipped_alone() -> Iterator[None]:
    """What a solver calls has arguments that its program knows: numba would compile for minutes otherwise."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Entry, "_other", _shipped_call)
        yield


def _shipped_call(entry: Any, args: tuple[Any, ...]) -> Any:
    """As Entry._other, but that nothing is left to numba."""
    why = []
    for call in entry._calls:
        try:
            found = call(*args)
        except Misfit as error:
            why.append(str(error))
            continue
        entry._best = call
        return found
    raise AssertionError(f"the shipped program has no {entry._kernel.__name__} for: {'; '.join(why)}")


@pytest.fixture(scope="module")
def as_python() -> Iterator[None]:
    """Kernels that tests call, but no solver from Python, run as Python: in less time than numba compiles
    them. MDLGEN_NUMBA=1 has them compiled."""
    rooms = [vars(room) for name, room in sys.modules.items() if name.startswith("mdlgen.")]
    kernels = {k for room in rooms for k in room.values() if isinstance(k, Kernel) and not k.programs}
    with pytest.MonkeyPatch.context() as patch:
        for kernel in () if alone() else kernels:
            patch.setattr(kernel, "_call", functools.partial(_python, kernel.py_func))
        yield


def _python(function: Callable[..., Any], *args: Any) -> Any:
    return function(*map(_by_names, args))


class _Record(np.record):
    """Fields are attributes, as in compiled code."""

    @property
    def size(self) -> Any:
        """A field, too."""
        return self["size"]


def _by_names(value: Any) -> Any:
    if isinstance(value, (np.ndarray, np.void)) and value.dtype.names is not None:
        return value.view(np.dtype((_Record, value.dtype)))
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return type(value)(*map(_by_names, value))
    return value


@functools.cache
def _before_a_release() -> list[str]:
    """Names of the tests in release.txt."""
    lines = Path(__file__).with_name("release.txt").read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def pytest_itemcollected(item: pytest.Item) -> None:
    if item.nodeid in _before_a_release():
        item.add_marker(pytest.mark.release)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What compiles comes first, on one worker; then what needs nothing compiled, for the other one.

    Of what is shipped each of two workers prepares one program: the second begins in the middle of the list.
    """
    first = [next((i for i in items if i.path.stem == name), None) for name in COMPILING]
    shipped = _shipped()
    begin = [i for i in (first[:1] if shipped else first) if i is not None]
    plain = [i for i in items if i.path.parent.name in PLAIN]
    early = {id(i) for i in (*begin, *plain)}
    items[:] = [*begin, *plain, *(i for i in items if id(i) not in early)]
    if shipped and first[-1] is not None:
        items.remove(first[-1])
        items.insert((len(items) + 1) // 2, first[-1])


@pytest.hookimpl(tryfirst=True)
def pytest_unconfigure() -> None:
    """What is left at the end goes with the process: to look through it for cycles takes seconds."""
    gc.freeze()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Each worker takes one part of the list, and from the other's once it is at its end: tests of one file
    share what they run. Not where numba compiles, which the order is for then."""
    if config.getvalue("dist") != "load" or not _shipped():
        return None
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)


def _shipped() -> bool:
    """Whether all that solvers run is shipped, and numba compiles for tests of single laws alone."""
    return not alone() and all(map(_fits, build.programs()))


def _fits(program: Program) -> bool:
    try:
        program.head()
    except Unfit:
        return False
    return True


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Says what the solvers ran by: what is shipped, or what numba compiled."""
    for program in build.programs():
        try:
            program.head()
            message = "numba, since MDLGEN_NUMBA is set" if alone() else "as shipped"
        except Unfit as error:
            message = f"numba, since {error}"
        terminalreporter.write_line(f"solver code, {program.name}: {message}")
