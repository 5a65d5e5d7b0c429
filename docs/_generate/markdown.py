"""Pieces of Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

_SYMBOLS = ("k ", "f ")
NOTE = "<!-- Made by `python docs/_generate`. Do not edit. -->\n\n"


def cell(text: str) -> str:
    """Text in a table."""
    return " ".join(text.split()).replace("|", "\\|")


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    lines += [f"| {' | '.join(cell(text) for text in row)} |" for row in rows]
    return "\n".join(lines) + "\n"


def sentence(text: str) -> str:
    """With a capital and a full stop, unless it begins with a name."""
    text = " ".join(text.split())
    if not text:
        return text
    first = text.split(" ", 1)[0]
    if first.rstrip(",;.").replace("-", "").isalpha() and first.islower() and text[:2] not in _SYMBOLS:
        text = text[0].upper() + text[1:]
    return text if text[-1] in ".!?" else text + "."
