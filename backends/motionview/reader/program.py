"""Parses statements into definitions, conditions and contexts: the nested file, before any instance."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from mdlgen.backends.motionview.reader.report import Notes
from mdlgen.backends.motionview.reader.statement import Statement

_CLOSING = {
    "enddefine": "*Define...",
    "endcontext": "*BeginContext",
    "endif": "*if",
    "elseif": "*if",
    "else": "*if",
    "endmdl": "*BeginMDL",
}


class Guard(NamedTuple):
    """The condition around a statement, and the outer ones."""

    outer: Guard | None
    condition: Statement
    wanted: bool


class Item(NamedTuple):
    """A statement with the conditions and the contexts around it."""

    statement: Statement
    guard: Guard | None
    contexts: tuple[Statement, ...] = ()


class Definition:
    """A *Define... with its contents; also the model itself."""

    def __init__(self, statement: Statement | None):
        self.statement = statement
        self.kind = statement.key.removeprefix("define") if statement else "model"
        self.name = statement.arg(0) if statement else ""
        self.items: list[Item] = []
        self.used = False

    def attachments(self) -> dict[str, Statement]:
        """The statements that declare its arguments, by argument."""
        found = (item.statement for item in self.items if item.statement.key == "attachment")
        return {statement.arg(0): statement for statement in found}

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the arguments; a typed system has three words for its type before them."""
        if self.statement is None:
            return ()
        args = self.statement.args[1:]
        return args[3:] if args[:1] == ("TYPED",) else args


class Program:
    """The whole text."""

    def __init__(self) -> None:
        self.model = Definition(None)
        self.begin: Statement | None = None
        self.definitions: dict[str, Definition] = {}
        self.includes: list[Statement] = []
        self.analysis: Statement | None = None
        self.mode = "MOTIONSOLVE"
        self.statements: list[Statement] = []

    def alone(self) -> list[Definition]:
        """The outermost systems of a file that has definitions only."""
        if self.model.items:
            return []
        held = {s.arg(2) for s in self.statements if s.key == "system"}
        systems = [d for d in self.definitions.values() if d.kind == "system"]
        return [d for d in systems if d.name not in held] or systems


class _Open(NamedTuple):
    statement: Statement
    definition: Definition
    guard: Guard | None
    contexts: tuple[Statement, ...]


def program(statements: Iterable[Statement], notes: Notes) -> Program:
    """The program of a file. Raises nothing: wrongly nested statements are reported and omitted."""
    made = Program()
    open_: list[_Open] = []
    definition, guard, contexts = made.model, None, ()
    for statement in statements:
        made.statements.append(statement)
        key = statement.key
        if key not in _FRAME and not key.startswith("define"):  # the most frequent case
            definition.items.append(Item(statement, guard, contexts))
            continue
        if key in _CLOSING:
            if open_ and _CLOSES[key] == _block(open_[-1].statement.key):
                last = open_[-1]
                if key == "elseif":
                    previous = guard if guard else Guard(last.guard, last.statement, True)
                    guard = Guard(previous._replace(wanted=False), statement, True)
                elif key == "else":
                    guard = guard._replace(wanted=False) if guard else None
                else:
                    open_.pop()
                    definition, guard, contexts = last.definition, last.guard, last.contexts
            else:
                message = f"*{statement.name} closes no {_CLOSING[key]}"
                if open_:
                    last = open_[-1].statement
                    where = last.place().seen_from(statement.source.file)
                    message += f"; open is *{last.name} of {where}"
                notes.add("error", "block", statement.place(), message)
            continue
        block = _block(key)
        if block:
            open_.append(_Open(statement, definition, guard, contexts))
        if block == "define":
            definition, guard, contexts = Definition(statement), None, ()
            _define(made, definition, notes)
        elif block == "context":
            contexts = (*contexts, statement)
        elif block == "if":
            guard = Guard(guard, statement, True)
        elif block == "mdl":
            made.begin = statement
        else:
            _header(made, statement)
    for left in open_:
        if left.statement.key != "beginmdl":
            notes.add("error", "block", left.statement.place(), f"*{left.statement.name} is not closed")
    return made


_CLOSES = {
    "enddefine": "define",
    "endcontext": "context",
    "endif": "if",
    "elseif": "if",
    "else": "if",
    "endmdl": "mdl",
}


_OPENING = {"if": "if", "begincontext": "context", "beginmdl": "mdl"}
_INCLUDING = ("include", "definitioninclude", "standardinclude", "loadpreferencefile")
# Statements that nest others or concern the file as a whole; definitions, too.
_FRAME = {*_CLOSING, *_OPENING, *_INCLUDING, "setcurrentsolvermode", "setactiveanalysis"}


def _block(key: str) -> str:
    return "define" if key.startswith("define") else _OPENING.get(key, "")


def _define(made: Program, definition: Definition, notes: Notes) -> None:
    statement = definition.statement
    assert statement is not None
    if definition.name in made.definitions:
        before = made.definitions[definition.name].statement
        assert before is not None
        here = statement.place(0)
        first = before.place().seen_from(here.file)
        message = f"{definition.name} is defined a second time; first in {first}"
        notes.add("error", "duplicate", here, message)
        return
    made.definitions[definition.name] = definition


def _header(made: Program, statement: Statement) -> None:
    """Statements about the file as a whole."""
    key = statement.key
    if key in _INCLUDING:
        made.includes.append(statement)
    elif key == "setcurrentsolvermode":
        made.mode = statement.arg(0).upper()
    else:
        made.analysis = statement
