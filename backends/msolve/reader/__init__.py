"""Reads a script back, without running a line of it: its values are taken as literals, and its program must
be the one that mdlgen writes, which then makes the model of these values in a stand-in for msolve."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from mdlgen.backends.msolve.reader.build import MOST, Made, made
from mdlgen.backends.msolve.reader.split import Script, split
from mdlgen.backends.msolve.reader.values import comparable, values

__all__ = ["Reading", "read"]


class Reading:
    """A script, read. Raises SpecError with file:line where the text cannot be meant as one, or where it
    makes more than `most` objects."""

    most: int = MOST

    def __init__(self, text: str, file: str):
        self._script: Script = split(text, file)
        self._file = file

    @property
    def same_program(self) -> bool:
        """True if all except the values is as mdlgen writes it."""
        return self._script.same_program

    @cached_property
    def made(self) -> Made:
        """Objects that the program makes from the values."""
        return made(self._script, self._file, self.most)

    @cached_property
    def values(self) -> dict[str, Any]:
        """Every entity by kind and name, in mm, N, kg, s, rad; see `values`."""
        return values(self.made, self._file)

    def objects(self) -> list[tuple[tuple[str, str], dict[str, Any]]]:
        """Class and label of every object, and its arguments; objects in it by their labels."""
        return comparable(self.made)


def read(text: str, file: str = "<script>") -> Reading:
    """One reading of a script. Raises SpecError with file:line where the text is none."""
    return Reading(text, file)
