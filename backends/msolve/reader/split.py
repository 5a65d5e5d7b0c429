"""A script as its values, which are literals, and the rest, which must be the program of the template."""

from __future__ import annotations

import ast
import re
from functools import lru_cache
from typing import Any, NamedTuple

from mdlgen.altair.literals import literal, name_of, without_notes, wrong
from mdlgen.backends.msolve.environment import environment
from mdlgen.backends.msolve.writer.parts.kinds import MACHINE
from mdlgen.errors import Place, SpecError

TABLES = (
    *("NAME", "GRAVITY", "RUN", "CURVES", "SHEETS", "LISTED", *(of.variable for of in MACHINE)),
    *("SPINS", "MOVES", "STOPS", "SUPPORTS", "LOADS", "FACTORS", "PROBES", "CONTACTS", "FORCES"),
)
_ALWAYS = ("NAME", "GRAVITY", "RUN")
_HEAD = "import csv\nfrom msolve import *\n"
_IMPORTS = 2
_CODING = re.compile(r"[ \t\f]*#.*?coding[:=][ \t]*([-\w.]+)")
"""In one of the first two lines it says that Python takes the bytes of a file as other than UTF-8."""


class Script(NamedTuple):
    """The values by name, and the program that mdlgen writes for a scene that has these."""

    values: dict[str, Any]
    program: str
    same_program: bool


def split(text: str, file: str) -> Script:
    """Raises SpecError with the place of what is no literal, or no Python."""
    tree = _parsed(text, file)
    values: dict[str, Any] = {}
    rest: list[ast.stmt] = []
    for statement in tree.body:
        name = name_of(statement)
        if name not in TABLES or len(without_notes(rest)) != _IMPORTS:  # values are below the imports
            rest.append(statement)
            continue
        assert isinstance(statement, ast.Assign)
        if name in values:
            raise wrong(f"{name} is given twice", statement, file)
        values[name] = literal(statement, file)
    for name in _ALWAYS:
        if name not in values:
            raise SpecError(
                f"there is no {name} below its imports: this is no script of mdlgen", place=Place(file, 1, 1)
            )
    program = _program(values)
    same = ast.dump(ast.Module(without_notes(rest), [])) == _tree(program)
    return Script(values, program, same)


@lru_cache(maxsize=8)
def _tree(program: str) -> str:
    return ast.dump(ast.parse(_HEAD + program))


def _program(values: dict[str, Any]) -> str:
    """The program for the tables that there are."""
    there = {name for name, value in values.items() if value}
    run = values["RUN"]
    template = environment().get_template("program.py.j2")
    return template.render(tables=there, machine=MACHINE, static=isinstance(run, dict) and "end" not in run)


def _parsed(text: str, file: str) -> ast.Module:
    for line, row in enumerate(text.splitlines()[:2], 1):
        coding = _CODING.match(row)
        if coding and coding[1].lower() not in ("utf-8", "utf8"):
            raise SpecError(f"it is in {coding[1]}: utf-8 is due", place=Place(file, line, 1))
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        place = Place(file, getattr(error, "lineno", None) or 1, getattr(error, "offset", None) or 1)
        raise SpecError(f"this is no Python: {error}", place=place) from None
