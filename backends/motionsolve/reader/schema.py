"""Validation of a deck: elements and attributes by the schema, ids by kind."""

from __future__ import annotations

from functools import lru_cache

import lxml.etree as etree

from mdlgen.backends.motionsolve.reader.parse import root
from mdlgen.backends.motionsolve.reader.references import dangling
from mdlgen.errors import SpecError, printable
from mdlgen.paths import templates


@lru_cache(maxsize=1)
def schema() -> etree.RelaxNG:
    """Our schema of the contents of a deck."""
    return etree.RelaxNG(etree.parse(str(templates() / "motionsolve" / "deck.rng")))


def validate(text: str, file: str = "<deck>") -> list[str]:
    """Errors of a deck, as lines `file:line: message`; empty where it has none.

    Checks elements, attributes and their values by the schema; that ids are unique within a kind; and that no
    id that is used is missing.
    """
    try:
        found = root(text, file)
    except SpecError as error:
        return [str(error)]
    checker = schema()
    checker.validate(found)
    problems = [f"{file}:{entry.line}: {entry.message}" for entry in checker.error_log]
    problems += [f"{file}:{line}: {message}" for line, message in dangling(found)]
    return [printable(problem) for problem in problems]
