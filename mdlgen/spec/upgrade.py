"""Upgrades a scene of an older version in its text: comments and form stay."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from mdlgen.errors import MdlgenError, Place
from mdlgen.spec.document import Document, SpecPath, parse
from mdlgen.spec.limits import DEFAULT, Limits
from mdlgen.spec.load import meant
from mdlgen.spec.shorthand import in_the_text
from mdlgen.spec.smoothing import following

FRICTION, SMOOTHING = ("friction", "0"), ("smoothing", "1 mm/s")


class Change(NamedTuple):
    """A text to write, and its place in the text before."""

    path: SpecPath
    place: Place
    key: str
    value: str

    def __str__(self) -> str:
        path = ".".join(map(str, self.path))
        return f"{self.place.file}:{self.place.line}: {path}: {self.key}: {self.value}"


def upgraded(
    text: str, file: str, limits: Limits = DEFAULT, folder: Path | None = None
) -> tuple[str, list[Change]]:
    """The text with what each contact meant where it left a key out, and what was changed.

    `friction: 0`: before it had to be given. `smoothing: 1 mm/s`: before it followed the scene, which is only
    looked at in a scene that is otherwise valid; `folder` is where its files are. Raises SpecError for what
    is not YAML.
    """
    document = parse(text, file, limits)
    changes = _changes(document, _without_friction(document.data), FRICTION)
    text = _with(text, document, changes)
    fast = _following(text, file, limits, folder)
    if not fast:
        return text, changes
    text = _with(text, again := parse(text, file, limits), _changes(again, fast, SMOOTHING))
    changes += _changes(document, fast, SMOOTHING)
    return text, sorted(changes, key=lambda change: (change.place.line, change.place.column))


def _changes(document: Document, paths: list[SpecPath], what: tuple[str, str]) -> list[Change]:
    return [Change(path, document.place(path), *what) for path in paths]


def _with(text: str, document: Document, changes: list[Change]) -> str:
    """A text with one more key in some mappings of its document."""
    lines = text.splitlines(keepends=True)
    marks = sorted(((*_mark(document, change.path), change) for change in changes), reverse=True)
    for line, column, change in marks:
        before, after = lines[line - 1][: column - 1], lines[line - 1][column - 1 :]
        if document.line(change.place)[change.place.column - 1 :].startswith("{"):
            quoted = after.startswith('"')
            key = f'"{change.key}"' if quoted else change.key
            value = f'"{change.value}"' if quoted and " " in change.value else change.value
            lines[line - 1] = f"{before}{key}: {value}, {after}"
        else:  # one key a line, the first perhaps behind a dash
            end = "\r\n" if lines[line - 1].endswith("\r\n") else "\n"
            lines[line - 1] = f"{before}{change.key}: {change.value}{end}{' ' * (column - 1)}{after}"
    return "".join(lines)


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


def _following(text: str, file: str, limits: Limits, folder: Path | None) -> list[SpecPath]:
    """The contacts whose smoothing follows from the scene and is not 1 mm/s; not those of nips, which are
    younger than that."""
    document = parse(text, file, limits)
    try:
        scene = meant(document, (), folder, limits)
    except MdlgenError:
        return []
    paths = [in_the_text(("contacts", k), document.origins) for k in following(scene)]
    return [path for path in paths if path[0] == "contacts" and (*path, "smoothing") not in document.keys]


def _mark(document: Document, path: SpecPath) -> tuple[int, int]:
    """Line and column of the key that the new one is put before: the stiffness, or the first."""
    keys = [place for key, place in document.keys.items() if key[:-1] == path and len(key) == len(path) + 1]
    stiffness = document.keys.get((*path, "stiffness"))
    place = stiffness if stiffness is not None else min(keys, key=lambda p: (p.line, p.column))
    return place.line, place.column
