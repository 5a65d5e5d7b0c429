"""One statement `*Name( a, b, ... )`, and the split of its arguments."""

from __future__ import annotations

import re

from mdlgen.backends.motionview.reader.source import Source
from mdlgen.errors import Place

# A string may run over lines, but not into a line that starts a statement: then a quote is missing.
_LINE = r"\n(?![ \t]*\*\w+[ \t]*\()"
TEXT = rf'"(?:[^"\\\n]|\\.|{_LINE})*"'
SOLVER = rf"`(?:[^`\n]|{_LINE})*`"
_PIECE = re.compile(rf"""[^()\[\]{{}},"`\n]+|{_LINE}|{TEXT}|{SOLVER}|[()\[\]{{}},]""")
# An argument without texts, with brackets three deep: the common case, read in one step.
_FLAT = r"""[^()\[\]{}"`]++"""
_ROUND = r"""\([^()"`]*+\)"""
_BRACE = rf"""\{{(?:{_FLAT}|{_ROUND})*+\}}"""
_INDEX = r"""\[[^\[\]{}()"`]*+\]"""
_SIMPLE = re.compile(
    rf"""(?:[^()\[\]{{}},"`]++|\((?:{_FLAT}|{_ROUND}|{_BRACE}|{_INDEX})*+\)|{_BRACE}|{_INDEX})*+"""
)
NEXT = re.compile(r"^[ \t]*\*\w+[ \t]*\(", re.M)
_HIDDEN = re.compile(r"\n[ \t]*\*\w+[ \t]*\(")  # as NEXT, but of another line; far quicker to seek
_CLOSING = {"(": ")", "[": "]", "{": "}"}


class Statement:
    """Name as written, arguments as stripped text; empty arguments are empty texts."""

    __slots__ = ("args", "body", "key", "name", "opening", "source", "start")

    def __init__(self, source: Source, name: str, args: tuple[str, ...], start: int, opening: int):
        self.source = source
        self.name = name
        self.key = name.lower()
        self.args = args
        self.start = start
        self.opening = opening  # offset after the opening parenthesis
        self.body = ""  # free text of a template

    def place(self, arg: int | None = None, shift: int = 0) -> Place:
        """Place of the statement, or of a character of an argument."""
        if arg is None or not 0 <= arg < len(self.args):
            return self.source.place(self.start)
        begin = Split(self.source.text, self.opening).starts[arg]
        return self.source.place(begin + shift)

    def __str__(self) -> str:
        inner = ", ".join(" ".join(a.split()) for a in self.args)
        return f"*{self.name}( {inner} )" if inner else f"*{self.name}()"

    def arg(self, index: int) -> str:
        """An argument, empty where it is omitted."""
        return self.args[index] if index < len(self.args) else ""


class Split:
    """Arguments from an offset to the matching parenthesis, with braces, strings and solver text whole.

    `end` is the offset after the closing parenthesis, or -1 where there is none; then `stopped` is where
    the reading stopped.
    """

    def __init__(self, text: str, opening: int):
        self.args: list[str] = []
        self.starts: list[int] = []
        self.end = -1
        if self._simple(text, opening):
            return
        self.args.clear()
        self.starts.clear()
        stack = [")"]
        begin = at = opening
        match = _PIECE.match
        while True:
            piece = match(text, at)
            if piece is None:
                self.stopped = at
                return
            at = piece.end()
            if at - piece.start() > 1:
                continue
            c = text[at - 1]
            if c == ",":
                if len(stack) == 1:
                    self._add(text, begin, at - 1)
                    begin = at
            elif c in "([{":
                stack.append(_CLOSING[c])
            elif c in ")]}":
                if c != stack[-1]:
                    self.stopped = at - 1
                    return
                stack.pop()
                if not stack:
                    break
        if self.args or text[begin : at - 1].strip():
            self._add(text, begin, at - 1)
        self.end = self.stopped = at

    def _simple(self, text: str, begin: int) -> bool:
        opening, match = begin, _SIMPLE.match
        while True:
            simple = match(text, begin)
            at = simple.end() if simple else begin
            c = text[at : at + 1]
            if c == "," or (c == ")" and (self.args or text[begin:at].strip())):
                self._add(text, begin, at)
            if c == ",":
                begin = at + 1
                continue
            if c != ")" or _HIDDEN.search(text, opening, at):
                return False
            self.end = self.stopped = at + 1
            return True

    def _add(self, text: str, begin: int, end: int) -> None:
        raw = text[begin:end]
        self.args.append(raw.strip())
        self.starts.append(begin + len(raw) - len(raw.lstrip()))
