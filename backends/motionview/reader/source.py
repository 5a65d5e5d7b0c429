"""A text with a name, and where in it an offset is."""

from __future__ import annotations

import re
from bisect import bisect_right
from functools import cached_property

from mdlgen.errors import Place


class Source:
    """The text of one file."""

    def __init__(self, text: str, file: str):
        self.text = text
        self.file = file

    @cached_property
    def _lines(self) -> list[int]:
        return [0, *(m.end() for m in re.finditer("\n", self.text))]

    def place(self, offset: int) -> Place:
        """Line and column, counted from 1."""
        line = bisect_right(self._lines, offset)
        return Place(self.file, line, offset - self._lines[line - 1] + 1)
