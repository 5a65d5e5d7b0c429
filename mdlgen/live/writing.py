"""Values that were turned, put into the text of a scene: comments and form stay."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.events import ScalarEvent

from mdlgen.errors import SpecError
from mdlgen.spec.document import Document, SpecPath, parse
from mdlgen.spec.setting import set_value
from mdlgen.spec.source import text_of

_QUOTES = ("'", '"')


def with_values(text: str, file: str, turned: Mapping[str, str]) -> str:
    """The text with other values, by path as of `--set`. Each replaces the one before, and all else stays as
    it is. If a value has no place of its own, as for a part that a `repeat` makes, the whole text is written
    again with its comments. Raises SpecError."""
    document = parse(text, file)
    wanted = document.copy()
    for path, value in turned.items():
        set_value(wanted, f"{path}={value}")
    try:
        found = _in_place(document, wanted.data)
        if parse(found, file).data == wanted.data:
            return found
    except (SpecError, KeyError):
        pass
    return text_of(wanted)


def still_turned(before: str, after: str, turned: Mapping[str, str]) -> dict[str, str]:
    """The values that stay turned where the file was edited: not those that have another one there now."""
    try:
        old, new = parse(before, "before").data, parse(after, "after").data
    except SpecError:
        return dict(turned)
    return {path: text for path, text in turned.items() if _at(old, path) == _at(new, path)}


def _in_place(document: Document, data: Any) -> str:
    """The text with the plain values that differ in the data. Raises KeyError for one that has no place."""
    marks = {}
    for event in YAML(typ="rt", pure=True).parse(document.text):
        if isinstance(event, ScalarEvent):
            start = event.start_mark
            marks[start.line + 1, start.column + 1] = start.index, event.end_mark.index
    text = document.text
    changed = []
    for path, value in _different(document.data, data, ()):
        place = document.places[path]
        changed.append((*marks[place.line, place.column], value))
    for start, end, value in sorted(changed, key=lambda change: change[0], reverse=True):
        quote = text[start] if text[start] in _QUOTES and isinstance(value, str) else ""
        text = f"{text[:start]}{quote}{value}{quote}{text[end:]}"
    return text


def _different(one: Any, other: Any, path: SpecPath) -> Iterator[tuple[SpecPath, Any]]:
    """Where two plain data of one form have other values, and that of the second."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in {**one, **other}:
            yield from _different(one.get(key), other.get(key), (*path, key))
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for k, (a, b) in enumerate(zip(one, other, strict=True)):
            yield from _different(a, b, (*path, k))
    elif type(one) is not type(other) or one != other:
        yield path, other


def _at(data: Any, path: str) -> Any:
    """The value at a path; None where the text has none there."""
    for word in path.split("."):
        try:
            data = data[int(word)] if isinstance(data, list) else data[word]
        except (KeyError, IndexError, TypeError, ValueError):
            return None
    return data
