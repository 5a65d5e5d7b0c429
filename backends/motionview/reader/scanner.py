"""Splits a text into statements. Unreadable parts are reported and skipped, up to the next line with a
statement."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mdlgen.backends.motionview.reader.report import Notes
from mdlgen.backends.motionview.reader.source import Source
from mdlgen.backends.motionview.reader.statement import NEXT, Split, Statement

# A statement as nearly all are written, read in one step: a word first, perhaps a label, no brackets.
_USUAL = r"""\s*([\w.]++)\s*+(?:,\s*("[^"\\\n]*+")\s*+)?(?:,([^()\[\]{}"`*]*+))?\)"""
_HEAD = re.compile(rf"\s*\*(\w+)[ \t]*(\()(?:{_USUAL})?")
_BEGIN = re.compile(r"^[ \t]*\*BeginMDL[ \t]*\(", re.I | re.M)
_DEFINITION = re.compile(r"^[ \t]*\*DefineSystem[ \t]*\(", re.I | re.M)
_SPACE = re.compile(r"\s*")
_PLAIN = re.compile(r"""([^()\[\]{}"`*]*)\)""")
_TEMPLATE_END = re.compile(r"^[ \t]*\*EndDefine[ \t]*\([ \t]*\)", re.I | re.M)


def statements(source: Source, notes: Notes, part: bool = False) -> Iterator[Statement]:
    """From *BeginMDL to *EndMDL; the text before and after is ignored, as MotionView does.

    A `part` of a model, and a file of definitions, has no *BeginMDL; all from the first statement on counts.
    """
    text = source.text
    whole = None if part else _BEGIN.search(text)
    begin = whole or (NEXT.search(text) if part or _DEFINITION.search(text) else None)
    if begin is None and part:
        return
    if begin is None:
        message = f"there is no *BeginMDL( name, label ) in this text{source.hint()}"
        notes.add("error", "no-model", source.place(0), message)
        return
    at = begin.start()
    tails: dict[str, tuple[str, ...]] = {}
    while True:
        head = _HEAD.match(text, at)
        if head is None:
            at = _stray(source, notes, at)
            if at < 0:
                if whole is not None:
                    notes.add("error", "block", source.place(begin.start()), "*BeginMDL has no *EndMDL()")
                return
            continue
        statement, at = _statement(source, notes, head, tails)
        if statement is None:
            continue
        yield statement
        if statement.key == "endmdl":
            return
        if statement.key == "definetemplate":
            at = _template(source, notes, statement, at)


def _statement(
    source: Source, notes: Notes, head: re.Match[str], tails: dict[str, tuple[str, ...]]
) -> tuple[Statement | None, int]:
    """A statement and where it ends; `tails` keeps what follows the first argument, as sheets repeat it."""
    name, _, first, label, rest = head.groups()
    text, start, opening = source.text, head.start(1) - 1, head.end(2)
    if first is not None:
        if rest is None:
            args = (first,) if label is None else (first, label)
        elif label is not None:
            args = (first, label, *[a.strip() for a in rest.split(",")])
        else:
            tail = tails.get(rest)
            if tail is None:
                tail = tails[rest] = tuple([a.strip() for a in rest.split(",")])
            args = (first, *tail)
        return Statement(source, name, args, start, opening), head.end()
    if (plain := _PLAIN.match(text, opening)) is not None:
        inner = plain[1]
        args = tuple([a.strip() for a in inner.split(",")]) if inner.strip() else ()
        return Statement(source, name, args, start, opening), plain.end()
    split = Split(text, opening)
    if split.end >= 0:
        return Statement(source, name, tuple(split.args), start, opening), split.end
    notes.add("error", "syntax", source.place(start), f"*{name}{_unclosed(source, split.stopped)}")
    following = NEXT.search(text, opening)
    return None, following.start() if following else len(text)


def _unclosed(source: Source, at: int) -> str:
    place = source.place(at)
    where = f"line {place.line}, column {place.column}"
    c = source.text[at : at + 1]
    if c in ('"', "`"):
        return f": the {c} at {where} is not closed"
    if c and c in ")]}":
        return f": {c} at {where} closes nothing"
    return f" has no closing parenthesis; it was sought up to {where}"


def _stray(source: Source, notes: Notes, at: int) -> int:
    """Reports text that is no statement; gives where the next one starts, -1 at the end."""
    text = source.text
    space = _SPACE.match(text, at)
    at = space.end() if space else at
    following = NEXT.search(text, at)
    if at < len(text):
        end = text.find("\n", at)
        shown = text[at : end if end >= 0 else len(text)][:40]
        if shown.startswith("//"):
            message = "a comment inside *BeginMDL: no MotionView file has one; before *BeginMDL it is safe"
            notes.add("warning", "comment", source.place(at), message)
            return end
        notes.add("error", "syntax", source.place(at), f"here a statement *Name( is due, not {shown!r}")
    return following.start() if following else -1


def _template(source: Source, notes: Notes, statement: Statement, at: int) -> int:
    end = _TEMPLATE_END.search(source.text, at)
    if end is None:
        notes.add("error", "block", statement.place(), "*DefineTemplate has no *EndDefine()")
        return len(source.text)
    statement.body = source.text[at : end.start()]
    return end.start()
