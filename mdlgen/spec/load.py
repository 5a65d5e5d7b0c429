"""YAML or JSON text -> Scene, with file:line:column in every error.

The text is read as a stream of events, so that depth, size and duplicate keys are checked before
anything is built; anchors and tags are refused. Plain scalars follow YAML 1.2 (`1e-3` is a number).
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any

from pydantic import ValidationError
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

from mdlgen import paths
from mdlgen.errors import Place, SpecError
from mdlgen.spec.limits import DEFAULT, Limits, Tally
from mdlgen.spec.scene import Scene

MAX_BYTES, MAX_DEPTH = 2_000_000, 40
SpecPath = tuple[str | int, ...]

# With --set, giving one of these takes the other away, so that an alternative can be tried.
_ALTERNATIVES = (
    {"k_tx", "D_cd"},
    {"k_ty", "D_md"},
    {"E_md", "curve_md"},
    {"E_cd", "curve_cd"},
    {"points", "file"},
    {"turn", "rotation"},
    {"speed", "profile"},
    {"ramp", "profile"},
    {"at", "edge"},
    {"force", "moment", "stress"},
    {"mass", "density"},
    {"time", "loss_factor"},
    {"time", "at"},
    *({old, new} for old in ("ratio", "ratio_ty", "rotation") for new in ("time", "loss_factor", "at")),
)

_INT = re.compile(r"[-+]?[0-9]{1,18}")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_WORDS: dict[str, Any] = {"": None, "~": None, "null": None, "Null": None, "NULL": None}
_WORDS.update({w: w.lower() == "true" for w in ("true", "True", "TRUE", "false", "False", "FALSE")})


class Document:
    """Plain data of a spec with the place of every key and value."""

    def __init__(self, data: Any, places: dict[SpecPath, Place], keys: dict[SpecPath, Place], file: str):
        self.data, self.places, self.keys, self.file = data, places, keys, file

    def place(self, path: SpecPath, prefer_key: bool = False) -> Place:
        """Place of `path`, or of the nearest enclosing value that stands in the text."""
        for end in range(len(path), -1, -1):
            for table in (self.keys, self.places) if prefer_key else (self.places, self.keys):
                if path[:end] in table:
                    return table[path[:end]]
        return Place(self.file, 1, 1)

    def copy(self) -> Document:
        """One that can be changed beside this one."""
        return Document(deepcopy(self.data), dict(self.places), dict(self.keys), self.file)


def load(path: str | Path, overrides: Iterable[str] = (), limits: Limits = DEFAULT) -> Scene:
    """Read a spec file; `overrides` are `PATH=VALUE` texts as of `--set`. Raises SpecError, OutputError."""
    return loads(read(path), str(path), overrides, Path(path).parent, limits)


def read(path: str | Path) -> str:
    """The text of a spec file, not larger than MAX_BYTES. Raises SpecError, OutputError."""
    raw = paths.read_at_most(Path(path), MAX_BYTES + 1)
    if len(raw) > MAX_BYTES:
        raise SpecError(f"larger than {MAX_BYTES} bytes", place=Place(str(path), 1, 1))
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise SpecError("not UTF-8 text", place=Place(str(path), line, 1)) from None


def loads(
    text: str,
    file: str = "scene",
    overrides: Iterable[str] = (),
    folder: Path | None = None,
    limits: Limits = DEFAULT,
) -> Scene:
    """The Scene of a YAML or JSON text; files that it names are looked for in `folder`, None: not at all.

    Raises SpecError with its place.
    """
    return meant(parse(text, file, limits), overrides, folder, limits)


def meant(
    document: Document, overrides: Iterable[str], folder: Path | None, limits: Limits = DEFAULT
) -> Scene:
    """The Scene of a text that has been parsed, in which `overrides` are set; as `loads`."""
    if not isinstance(document.data, dict):
        raise SpecError("a scene is a mapping of keys to values", place=document.place(()))
    for override in overrides:
        _override(document, override)
    try:
        context = {"folder": folder, "limits": limits, "tally": Tally(limits)}
        return Scene.model_validate(document.data, context=context)
    except ValidationError as error:
        raise _first_error(error, document) from None


def parse(text: str, file: str, limits: Limits = DEFAULT) -> Document:
    """Plain data with places; no anchors, tags, duplicate keys, or more than the stated limits."""
    places: dict[SpecPath, Place] = {}
    keys: dict[SpecPath, Place] = {}
    result: list[Any] = []
    stack: list[_Open] = []
    count = 0
    try:
        for event in YAML(typ="rt", pure=True).parse(text):
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
            if told := limits.exceeded("values", count, "values in the text"):
                raise SpecError(told, place=place)
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
    return Document(result[0] if result else None, places, keys, file)


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
            raise SpecError(
                f"the key {event.value[:80]!r} stands twice", (*self.path, event.value[:80]), place
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


def _override(document: Document, override: str) -> None:
    """Apply one `PATH=VALUE` to the plain data."""
    path_text, equals, value_text = override.partition("=")
    file = f"--set {path_text}"
    here = Place(file, 1, 1)
    words = path_text.strip().split(".")
    if not equals or not all(re.fullmatch(r"[A-Za-z0-9_]{1,64}", w) for w in words):
        raise SpecError(
            f"{override[:80]!r} is not PATH=VALUE; write like sheets.note.boxes=[20,30]", place=here
        )
    value = parse(value_text, file)
    node: Any = document.data
    path: SpecPath = ()
    for depth, word in enumerate(words):
        last = depth == len(words) - 1
        if isinstance(node, list):
            if not re.fullmatch(r"[0-9]{1,6}", word) or int(word) >= len(node):
                raise SpecError(f"no item {word!r}; the list has {len(node)}, counted from 0", path, here)
            key: Any = int(word)
        elif isinstance(node, dict):
            key = word
            if last:
                for group in _ALTERNATIVES:
                    if word in group:
                        for other in group - {word}:
                            node.pop(other, None)
            elif key not in node or node[key] is None:
                node[key] = {}
        else:
            raise SpecError(f"has a plain value; it has no part {word!r}", path, here)
        path = (*path, key)
        if last:
            node[key] = value.data
            for table, source in ((document.places, value.places), (document.keys, value.keys)):
                for known in [p for p in table if p[: len(path)] == path]:
                    del table[known]
                table.update({path + tail: Place(file, *place[1:]) for tail, place in source.items()})
            document.keys.setdefault(path, here)
        else:
            node = node[key]


def _first_error(error: ValidationError, document: Document) -> SpecError:
    """One line for the error that stands first in the text."""
    errors = error.errors(include_url=False)
    # a misspelt key is also a missing one: say the former
    told = [e for e in errors if e["type"] != "missing"] or errors
    found = [_describe(e, document) for e in told]
    return min(found, key=lambda e: (e.place is None, e.place and (e.place.line, e.place.column)))


def _describe(error: Any, document: Document) -> SpecError:
    path = _as_written(tuple(p for p in error["loc"] if p != "[key]"), document)
    kind, context = error["type"], error.get("ctx") or {}
    prefer_key = error["loc"][-1:] == ("[key]",)
    if kind == "spec":
        message = context["text"]
        if context.get("path") is not None or context.get("within"):
            path = tuple(context["path"] or (*path, *context["within"]))
            prefer_key = path in document.keys and not isinstance(_at(document.data, path), str)
    elif kind == "extra_forbidden":
        message, prefer_key = f"unknown key {path[-1]!r}{_did_you_mean(path, document)}", True
    elif kind == "missing":
        message = f"the key {path[-1]!r} is missing"
        path = path[:-1]
    else:
        said = re.sub(
            r"valid dictionary or instance of \w+|valid dictionary or object.*", "mapping", error["msg"]
        )
        if kind in ("tuple_type", "list_type") and isinstance(error["input"], dict):
            said = "expected a list, each item begun with '- '"
        message = f"{said.replace('valid tuple', 'list')}, got {error['input']!r}"[:300]
    return SpecError(message, path, document.place(path, prefer_key))


def _as_written(path: SpecPath, document: Document) -> SpecPath:
    """A list stands for {points: list}: without that key where the text has none."""
    for k, key in enumerate(path):
        if key == "points" and isinstance(_at(document.data, path[:k]), list):
            return path[:k] + path[k + 1 :]
    return path


def _at(data: Any, path: Sequence[str | int]) -> Any:
    for key in path:
        try:
            data = data[key]
        except (KeyError, IndexError, TypeError):
            return None
    return data


def _did_you_mean(path: SpecPath, document: Document) -> str:
    known = _allowed_keys(path[:-1])
    close = difflib.get_close_matches(str(path[-1]), known, n=1)
    if close:
        return f"; did you mean {close[0]!r}?"
    return f"; allowed: {', '.join(known)}" if known else ""


def _allowed_keys(path: SpecPath) -> list[str]:
    """Keys that the model at `path` knows, found by walking the annotations of Scene."""
    from mdlgen.spec.schema import keys, model_at

    model = model_at(path)
    return list(keys(model)) if model else []
