"""A text with a name, and where in it an offset is."""

from __future__ import annotations

import re
from bisect import bisect_right
from functools import cached_property

from mdlgen.errors import Place

_MARK = "\ufeff"


class Source:
    """The text of one file, with LF line ends and no byte order mark, and whether it came so.

    `returns` is where the first line ended otherwise, -1 where none did.
    """

    def __init__(self, text: str, file: str):
        self.marked = text.startswith(_MARK)
        text = text.removeprefix(_MARK)
        self.returns = text.find("\r")
        if self.returns >= 0:
            text = text.replace("\r\n", "\n").replace("\r", "\n")
        self.text = text
        self.file = file

    def hint(self) -> str:
        """Why nothing may have been found in it: what is no text in ASCII or UTF-8."""
        if not self.text.strip():
            return ": it is empty"
        if self.text.count("\0") > len(self.text) // 4:
            return ": it looks like UTF-16; save it as plain ASCII"
        if "\0" in self.text or self.text.count("\ufffd") > len(self.text) // 20:
            return ": it looks like no text at all"
        return ""

    @cached_property
    def _lines(self) -> list[int]:
        return [0, *(m.end() for m in re.finditer("\n", self.text))]

    def place(self, offset: int) -> Place:
        """Line and column, counted from 1."""
        line = bisect_right(self._lines, offset)
        return Place(self.file, line, offset - self._lines[line - 1] + 1)
