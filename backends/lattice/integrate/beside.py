"""Passes of a run that execute in parallel with another one: in their own thread, on their own tables."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from threading import Event, Thread
from typing import Any, Generic, TypeVar

from mdlgen.backends.lattice.arrays import System

T = TypeVar("T")


class Stopped(Exception):
    """Raised in a parallel pass whose result is no longer needed."""


class Beside(Generic[T]):
    """Executes `work` in parallel with the body of a `with` statement. Compiled code of a program does not
    hold Python's global lock, so the two use two processors.

    `work` takes an event, and raises Stopped soon after that is set, at the end of the body. `then` is called
    when it has ended.
    """

    def __init__(self, work: Callable[[Event], T], then: Callable[[], None]):
        self._then = then
        self._stop = Event()
        self._found: list[T] = []
        self._failed: list[BaseException] = []
        self._thread = Thread(target=self._do, args=(work,), daemon=True)

    def _do(self, work: Callable[[Event], T]) -> None:
        try:
            self._found.append(work(self._stop))
        except BaseException as error:
            self._failed.append(error)
        self._then()

    def __enter__(self) -> Beside[T]:
        self._thread.start()
        return self

    def __exit__(self, *_: Any) -> None:
        self._stop.set()
        self._thread.join()

    def result(self) -> T:
        """Waits for the result of `work` and returns it. Raises the exception of `work`."""
        self._thread.join()
        if self._failed:
            raise self._failed[0]
        return self._found[0]

    def raises(self, but: type[BaseException]) -> None:
        """Waits for the end of `work` and raises its exception, unless it is of type `but`."""
        self._thread.join()
        if self._failed and not isinstance(self._failed[0], but):
            raise self._failed[0]


def own(system: System) -> System:
    """The same System in its own arrays: a pass writes into some of them."""
    return deepcopy(system._replace(mirror=None))._replace(mirror=system.mirror)
