"""Caches values that follow from a Model alone, computed once for each."""

from __future__ import annotations

import functools
import weakref
from collections.abc import Callable
from typing import Generic, TypeVar

from mdlgen.model.tables import Model

T = TypeVar("T")


class Once(Generic[T]):
    """A function of a Model whose value is cached as long as that Model exists."""

    def __init__(self, make: Callable[[Model], T]):
        functools.update_wrapper(self, make)
        self._make = make
        self._found: dict[int, T] = {}

    def __call__(self, model: Model) -> T:
        """The value; two threads that ask for it at once may both work it out."""
        key = id(model)
        if key in self._found:
            return self._found[key]
        made = self._found[key] = self._make(model)
        weakref.finalize(model, self._found.pop, key, None).atexit = False
        return made
