"""The errors, one class per exit code.

Exit codes: 0 done, 2 bad spec, 3 input/output, 4 no usable result, 5 a result whose error is above the
tolerance or unknown, 6 a requirement of the scene missed, 130 interrupted. A solver that fails is not an
exception but a Result with a reason; the command line turns it into exit code 4.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple


def printable(text: str) -> str:
    """`text` in one line: what a key or a file name may hold must not look like another line."""
    return "".join(c if c.isprintable() else " " for c in text)


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """`; did you mean 'motor'?` for what is nearly a known name, without regard to case; else nothing."""
    import difflib

    lower = {other.lower(): other for other in known}
    close = difflib.get_close_matches(name.lower(), lower, n=1)
    return f"; did you mean {lower[close[0]]!r}?" if close else ""


class Place(NamedTuple):
    """Where a value stands in a file; line and column count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"

    def seen_from(self, file: str) -> str:
        """`line 3`, or the whole place where it is in another file."""
        return f"line {self.line}" if self.file == file else str(self)


class MdlgenError(Exception):
    """Base of all errors that are reported to the user in one line."""

    exit_code = 1


class SpecError(MdlgenError):
    """The scene cannot be meant as it is written.

    `path` is the way to the value (`("sheets", "note", "thickness")`), `place` where it stands, `source` its
    line of the text where that is at hand. `others` are further mistakes of the same scene, in the order of
    their places.
    """

    exit_code = 2

    def __init__(self, message: str, path: tuple[str | int, ...] = (), place: Place | None = None):
        self.message = " ".join(str(message).split())
        self.path = tuple(path)
        self.place = place
        self.source = ""
        self.others: tuple[SpecError, ...] = ()
        super().__init__(str(self))

    def __str__(self) -> str:
        head = [str(self.place)] if self.place else []
        if self.path:
            head.append(".".join(str(p) for p in self.path))
        return printable(": ".join([*head, self.message]))

    def with_others(self, others: Iterable[SpecError]) -> SpecError:
        """The same error, the first of several; a traceback lists the others below it."""
        self.others = tuple(others)
        for other in self.others:
            self.add_note(str(other))
        return self

    @property
    def marked(self) -> str:
        """The line of the text and a caret below the column, two lines for a terminal; "" where unknown."""
        if not self.source or self.place is None:
            return ""
        # a line of a thousand values is shown around the column
        first = max(0, self.place.column - 60)
        shown = printable(self.source[first : first + 100])
        return f"    {shown}\n    {' ' * (self.place.column - 1 - first)}^"


class RefusedError(SpecError):
    """A valid scene that this backend cannot represent; the message names the part and the reason."""


class OutputError(MdlgenError):
    """A file could not be read or written."""

    exit_code = 3


class AccuracyError(MdlgenError):
    """There is a result; its error is above what was asked for, or is not known."""

    exit_code = 5


class RequirementError(MdlgenError):
    """A run that is right does not do what its scene requires."""

    exit_code = 6
