"""Reads a deck back into the same values as the reader of MDL files."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from mdlgen.backends.motionsolve.reader.elements import Key, elements
from mdlgen.backends.motionsolve.reader.parse import root
from mdlgen.backends.motionsolve.reader.values import values

__all__ = ["Reading", "read"]


class Reading:
    """A deck, read. Raises SpecError with file:line where the text cannot be meant as one."""

    def __init__(self, text: str, file: str):
        self._root = root(text, file)
        self._file = file

    @cached_property
    def values(self) -> dict[str, Any]:
        """Every entity by kind and name, in mm, N, kg, s, rad; see `values`."""
        return values(self._root, self._file)

    def elements(self) -> list[tuple[Key, int, dict[str, str]]]:
        """Key (section, kind, name), line and attributes of every element; ids are names there."""
        return list(elements(self._root))


def read(text: str, file: str = "<deck>") -> Reading:
    """One reading of a deck. Raises SpecError with file:line where the text is none."""
    return Reading(text, file)
