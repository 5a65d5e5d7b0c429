"""Passes of a run that go on beside another one: in a thread of their own, on tables of their own."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from threading import Event, Thread
from typing import Any, Generic, TypeVar

from mdlgen.backends.lattice.arrays import System

T = TypeVar("T")


class Stopped(Exception):
    """What such a pass would find is not needed any more."""


class Beside(Generic[T]):
    """Does `work` while the body of a `with` statement is run. Compiled code of a program holds no lock of
    Python's, so the two keep two processors busy.

    `work` is given an event, and raises Stopped soon after that is set, which it is at the end of the body.
    `then` is called when it has ended.
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
        """What it found, once it has. Raises what it raised."""
        self._thread.join()
        if self._failed:
            raise self._failed[0]
        return self._found[0]

    def raises(self, but: type[BaseException]) -> None:
        """Raises what it raised, `but` that, once it has ended."""
        self._thread.join()
        if self._failed and not isinstance(self._failed[0], but):
            raise self._failed[0]


def own(system: System) -> System:
    """The same System in arrays of its own: a pass writes into some of them."""
    return deepcopy(system._replace(mirror=None))._replace(mirror=system.mirror)
