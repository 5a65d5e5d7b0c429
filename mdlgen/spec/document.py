"""YAML or JSON text -> plain data with the place of every key and value.

The text is read as a stream of events, so that depth, size and duplicate keys are checked before
anything is built; anchors and tags are refused. Plain scalars follow YAML 1.2 (`1e-3` is a number).
"""

from __future__ import annotations

import math
import re
from copy import deepcopy
from functools import lru_cache
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from mdlgen.errors import Place, SpecError
from mdlgen.spec.limits import DEFAULT, Limits

MAX_DEPTH = 40
_KEPT = 20_000  # characters of a text whose parsed form is cached: some MB for all of them
SpecPath = tuple[str | int, ...]

_INT = re.compile(r"[-+]?[0-9]{1,18}")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_WORDS: dict[str, Any] = {"": None, "~": None, "null": None, "Null": None, "NULL": None}
_WORDS.update({w: w.lower() == "true" for w in ("true", "True", "TRUE", "false", "False", "FALSE")})


class Document:
    """Plain data of a spec with the place of every key and value."""

    def __init__(
        self, data: Any, places: dict[SpecPath, Place], keys: dict[SpecPath, Place], file: str, text: str = ""
    ):
        self.data, self.places, self.keys, self.file, self.text = data, places, keys, file, text
        self.origins: dict[SpecPath, SpecPath] = {}  # where what is copied or moved stands in the text
        self.made: set[SpecPath] = set()  # mappings that --set made on its way
        self.new_parameters: list[str] = []  # that --set added

    def place(self, path: SpecPath, prefer_key: bool = False) -> Place:
        """Place of `path`, or of the nearest enclosing value that stands in the text."""
        for end in range(len(path), -1, -1):
            for table in (self.keys, self.places) if prefer_key else (self.places, self.keys):
                if path[:end] in table:
                    return table[path[:end]]
        return Place(self.file, 1, 1)

    def copy(self) -> Document:
        """A copy that can be changed without changing this document."""
        return Document(deepcopy(self.data), dict(self.places), dict(self.keys), self.file, self.text)

    def line(self, place: Place | None) -> str:
        """The line of the text at a place; "" where it is not of this text."""
        if place is None or place.file != self.file:
            return ""
        lines = self.text.splitlines()
        return lines[place.line - 1] if place.line <= len(lines) else ""


def parse(text: str, file: str, limits: Limits = DEFAULT) -> Document:
    """Plain data with places; no anchors, tags, duplicate keys, or more than the stated limits."""
    return _kept(text, file, limits).copy() if len(text) <= _KEPT else _parsed(text, file, limits)


@lru_cache(maxsize=64)  # one text is often read with one value changed after the other
def _kept(text: str, file: str, limits: Limits) -> Document:
    return _parsed(text, file, limits)


def _parsed(text: str, file: str, limits: Limits) -> Document:
    places: dict[SpecPath, Place] = {}
    keys: dict[SpecPath, Place] = {}
    result: list[Any] = []
    stack: list[_Open] = []
    count = 0
    try:
        for event in YAML(typ="safe", pure=True).parse(text):
            mark = getattr(event, "start_mark", None)
            place = Place(file, mark.line + 1, mark.column + 1) if mark else Place(file, 1, 1)
            if isinstance(event, (MappingEndEvent, SequenceEndEvent)):
                stack.pop()
                continue
            if not isinstance(event, (ScalarEvent, MappingStartEvent, SequenceStartEvent, AliasEvent)):
                if type(event).__name__ == "DocumentStartEvent" and result:
                    raise SpecError("a second document in one file; give one scene", place=place)
                continue
            count += 1
            if isinstance(event, AliasEvent) or event.anchor:
                raise SpecError("anchors and aliases are not allowed; write the value out", place=place)
            if getattr(event, "ctag", None) or getattr(event, "tag", None):
                raise SpecError("tags are not allowed; write the plain value", place=place)
            if record := limits.exceeded("values", count, "values in the text"):
                raise SpecError(record, place=place)
            if len(stack) >= MAX_DEPTH:
                raise SpecError(f"nested deeper than {MAX_DEPTH} levels", place=place)
            if stack and stack[-1].takes_key:
                stack[-1].set_key(event, place, keys)
                continue
            if isinstance(event, ScalarEvent):
                value, opened = _scalar(event, place), None
            else:
                value = {} if isinstance(event, MappingStartEvent) else []
                opened = value
            path = stack[-1].add(value) if stack else ()
            if not stack:
                result.append(value)
            places[path] = place
            if opened is not None:
                stack.append(_Open(opened, path))
    except (MarkedYAMLError, YAMLError, RecursionError, ValueError) as error:
        mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
        place = Place(file, mark.line + 1, mark.column + 1) if mark else Place(file, 1, 1)
        what = getattr(error, "problem", None) or str(error).split("\n")[0] or type(error).__name__
        raise SpecError(f"not YAML: {what}"[:300], place=place) from None
    return Document(result[0] if result else None, places, keys, file, text)


class _Open:
    """A mapping or list that is being filled."""

    def __init__(self, value: dict | list, path: SpecPath):
        self.value, self.path = value, path
        self.key: str | None = None

    @property
    def takes_key(self) -> bool:
        return isinstance(self.value, dict) and self.key is None

    def set_key(self, event: Any, place: Place, keys: dict[SpecPath, Place]) -> None:
        if not isinstance(event, ScalarEvent):
            raise SpecError("a key must be a plain name", self.path, place)
        if event.value in self.value:
            first = keys[(*self.path, event.value)].line
            raise SpecError(
                f"the key {event.value[:80]!r} stands twice, first in line {first}; write one key with "
                "all of it, or rename one",
                (*self.path, event.value[:80]),
                place,
            )
        self.key = event.value
        keys[(*self.path, event.value)] = place

    def add(self, value: Any) -> SpecPath:
        if isinstance(self.value, list):
            self.value.append(value)
            return (*self.path, len(self.value) - 1)
        assert self.key is not None
        key, self.key = self.key, None
        self.value[key] = value
        return (*self.path, key)


def _scalar(event: Any, place: Place) -> Any:
    text = event.value
    if event.style is not None:
        return text
    if text in _WORDS:
        return _WORDS[text]
    if _INT.fullmatch(text):
        return int(text)
    if _FLOAT.fullmatch(text):
        value = float(text)
        if not math.isfinite(value):
            raise SpecError(f"{text[:40]} is not finite; allowed are values below 1.8e308", place=place)
        return value
    return text
