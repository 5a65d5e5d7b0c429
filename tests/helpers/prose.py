"""Sentences of the manual, of docstrings and of comments, and faults that make one hard to read."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

# Private turns of phrase: what the field says in their place.
PHRASES = {
    r"anew": "again, rebuilt, recomputed",
    r"besides?": "next to, compared with, in parallel with",
    r"claps?|clapping": "collides repeatedly",
    r"let go|lets go": "released, dropped",
    r"stands? (?:apart|inside|aside)": "is condensed, is part of the system matrix",
    r"goes? on|went on|gone on": "continues, resumes",
    r"in times": "relative to",
    r"the same bits": "bitwise identical",
    r"mend(?:s|ed|ing)?": "fix",
    r"rooms?": "package, module, workspace",
    r"told|tells": "reported, reports",
    r"lively": "hard to converge",
    r"by chance": "accidentally",
    r"what is (?:known|left|round|fast|free|deep|light)": "the noun",
}
PHRASE = re.compile(rf"\b(?:{'|'.join(PHRASES)})\b", re.I)
# Openings of a clause that stands where the subject should.
OPENING = re.compile(r"(?:What|Whether|Which|That which|Of|Else|So is|So are)\b")
MOST_WORDS = 32
SHORT = 3  # a sentence of fewer words is a heading


class Fault(NamedTuple):
    """A sentence that must be read twice, and why."""

    place: str  # file:line
    kind: str  # 'opening', 'phrase' or 'long'
    sentence: str


def faults(file: Path, root: Path) -> Iterator[Fault]:
    """Faults of a page or a module."""
    for line, text in paragraphs(file):
        for sentence in sentences(text):
            words = len(re.findall(r"[A-Za-z]{2,}", sentence))
            if words < SHORT:
                continue
            opens = OPENING.match(sentence) and not sentence.endswith("?")
            kind = "opening" if opens else "phrase" if PHRASE.search(sentence) else ""
            kind = kind or ("long" if words > MOST_WORDS else "")
            if kind:
                yield Fault(f"{file.relative_to(root).as_posix()}:{line}", kind, sentence)


def sentences(text: str) -> list[str]:
    """Sentences, and clauses that a colon or a semicolon ends; code in a line is one word."""
    return re.split(r"(?<=[.:;!?])\s+", re.sub(r"`[^`]+`", "`code`", text))


def paragraphs(file: Path) -> Iterator[tuple[int, str]]:
    """Paragraphs of a page without code and tables, or docstrings and comments of a module; their lines."""
    text = file.read_text("utf-8")
    yield from _of_page(text) if file.suffix == ".md" else _of_module(text)


def _of_page(text: str) -> Iterator[tuple[int, str]]:
    code, start, lines = False, 1, []
    for number, line in enumerate([*text.splitlines(), ""], 1):
        fence = line.lstrip().startswith("```")
        code ^= fence
        if fence or code or not line.strip() or line.startswith(("|", "#", "<", "    ")):
            if lines:
                yield start, " ".join(lines)
            lines = []
            continue
        start = start if lines else number
        lines.append(line.strip(" -*>"))


def _of_module(text: str) -> Iterator[tuple[int, str]]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            yield getattr(node, "lineno", 1), " ".join((ast.get_docstring(node) or "").split())
    start, lines = 0, []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type != tokenize.COMMENT:
            continue
        own = not token.line[: token.start[1]].strip()  # a comment behind code is one for itself
        if lines and not (own and token.start[0] == start + len(lines)):
            yield start, " ".join(lines)
            lines = []
        start = start if lines else token.start[0]
        lines.append(token.string.lstrip("# "))
    if lines:
        yield start, " ".join(lines)
