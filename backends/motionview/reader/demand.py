"""Values that are evaluated on demand and cached.

A chain of points, each from the one before, may be as long as the file. So the recursion of `demand` is
limited. At the limit it stops, evaluates the deepest value first, and starts again with that one known.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mdlgen.backends.motionview.reader.report import Trouble

MOST_CALLS = 300  # calls in calls before a demand starts again from below
_AT_WORK = object()
_MISSING = object()


class Deeper(Exception):
    """Raised for a value beyond the limit of recursion, which must be evaluated first."""

    def __init__(self, thing: Any, key: str):
        super().__init__(key)
        self.thing = thing
        self.key = key


class Demand:
    """Properties of entities, each evaluated once."""

    def __init__(self) -> None:
        self.calls = 0
        self._waiting: set[tuple[int, str]] = set()  # values that wait for deeper ones
        self._begun: tuple[int, str] = (0, "")  # the value that is evaluated now
        self._inside = False  # of force

    def demand(self, thing: Any, key: str) -> Any:
        """A property of an entity. Raises Trouble, always the same one for the same reason."""
        memo = thing.memo
        value = memo.get(key, _MISSING)
        if value is not _MISSING:
            if value is _AT_WORK:
                raise Trouble("cycle", f"{thing} needs its own {key} to find its {key}")
            if value.__class__ is Trouble:
                raise value.with_traceback(None)  # else it grows with each that depends on it
            return value
        if self._waiting and (id(thing), key) in self._waiting and (id(thing), key) != self._begun:
            raise Trouble("cycle", f"{thing} needs its own {key} to find its {key}")
        if self.calls > MOST_CALLS:
            raise Deeper(thing, key)
        memo[key] = _AT_WORK
        self.calls += 6
        try:
            value = thing.compute(key)
        except Trouble as trouble:
            memo[key] = trouble.with_traceback(None)
            raise
        except BaseException:
            del memo[key]
            raise
        finally:
            self.calls -= 6
        memo[key] = value
        return value

    def force(self, find: Callable[[], Any]) -> Any:
        """Runs `find` to its end, however long the chain below it is."""
        self.calls = 0
        self._inside = True
        try:
            return find()
        except Deeper:
            return self._forced(find)
        finally:
            self._inside = False

    def _forced(self, find: Callable[[], Any]) -> Any:
        tasks: list[tuple[Callable[[], Any], int, str]] = [(find, 0, "")]
        self._waiting = set()
        while True:
            run, thing, key = tasks[-1]
            self.calls = 0
            self._begun = (thing, key)
            try:
                value = run()
            except Deeper as deeper:
                self._waiting.add((id(deeper.thing), deeper.key))
                tasks.append((_later(self, deeper), id(deeper.thing), deeper.key))
                continue
            except Trouble:
                if len(tasks) == 1:
                    raise
                value = None
            tasks.pop()
            if not tasks:
                return value
            self._waiting.discard((thing, key))


def _later(demand: Demand, deeper: Deeper) -> Callable[[], Any]:
    return lambda: demand.demand(deeper.thing, deeper.key)
