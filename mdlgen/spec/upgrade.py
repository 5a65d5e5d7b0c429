"""What a scene of an older version must say today, written into its text: comments and form stay."""

from __future__ import annotations

from typing import Any, NamedTuple

from mdlgen.errors import Place
from mdlgen.spec.document import Document, SpecPath, parse
from mdlgen.spec.limits import DEFAULT, Limits


class Change(NamedTuple):
    """What is written, and where in the text before."""

    path: SpecPath
    place: Place
    text: str

    def __str__(self) -> str:
        return f"{self.place.file}:{self.place.line}: {'.'.join(map(str, self.path))}: {self.text}"


def upgraded(text: str, file: str, limits: Limits = DEFAULT) -> tuple[str, list[Change]]:
    """The text with `friction: 0` in each contact that gives none, which it meant before friction had to be
    given; and what was changed. Raises SpecError for what is not YAML."""
    document = parse(text, file, limits)
    changes = [Change(path, document.place(path), "friction: 0") for path in _without_friction(document.data)]
    lines = text.splitlines(keepends=True)
    marks = sorted(((*_mark(document, change.path), change) for change in changes), reverse=True)
    for line, column, change in marks:
        before, after = lines[line - 1][: column - 1], lines[line - 1][column - 1 :]
        if document.line(change.place)[change.place.column - 1 :].startswith("{"):
            key = '"friction"' if after.startswith('"') else "friction"
            lines[line - 1] = f"{before}{key}: 0, {after}"
        else:  # one key a line, the first perhaps behind a dash
            end = "\r\n" if lines[line - 1].endswith("\r\n") else "\n"
            lines[line - 1] = f"{before}friction: 0{end}{' ' * (column - 1)}{after}"
    return "".join(lines), changes


def _without_friction(data: Any) -> list[SpecPath]:
    """The contacts that have no friction, their own or by default."""
    if not isinstance(data, dict):
        return []
    defaults = data.get("defaults")
    given = defaults.get("contacts") if isinstance(defaults, dict) else None
    if isinstance(given, dict) and "friction" in given:
        return []
    contacts = data.get("contacts")
    if not isinstance(contacts, (dict, list)):
        return []
    items = contacts.items() if isinstance(contacts, dict) else enumerate(contacts)
    return [
        ("contacts", key)
        for key, item in items
        if isinstance(item, dict) and "between" in item and "friction" not in item
    ]


def _mark(document: Document, path: SpecPath) -> tuple[int, int]:
    """Line and column of the key that the new one is put before: the stiffness, or the first."""
    keys = [place for key, place in document.keys.items() if key[:-1] == path and len(key) == len(path) + 1]
    stiffness = document.keys.get((*path, "stiffness"))
    place = stiffness if stiffness is not None else min(keys, key=lambda p: (p.line, p.column))
    return place.line, place.column
