"""Mistakes in a scene: each in one line, with its place in the text and an example."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterator, Sequence
from copy import deepcopy
from functools import partial
from typing import Any

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from mdlgen import formulas
from mdlgen.errors import SpecError, did_you_mean
from mdlgen.spec.alternatives import others
from mdlgen.spec.between import known, matching
from mdlgen.spec.document import Document, SpecPath
from mdlgen.spec.reacting import check_units
from mdlgen.spec.scene import Scene
from mdlgen.spec.setting import MADE, made
from mdlgen.spec.shorthand import in_the_text, written_out

MOST = 20
# Tables of parts by name: a table that --set would create here is more often a misspelt name.
_MOST_LOOKS = 1000  # greatest number of similar names tried, over all mistakes
_PARTS = ("sheets", *Scene.machine_tables(), "parts")
_TABLES = ("parameters", "materials", *_PARTS, "nips", "piles", "streams", "probes")
_NAMED = ("contacts", *_TABLES)
# Text after a decimal comma: digits, perhaps with a unit.
_REST = re.compile(r"[0-9]+(?: *[A-Za-z%][\w/*^.%]*)?")


class Mistakes:
    """The mistakes of a document, in the order of their places; those of --set first."""

    def __init__(self, document: Document):
        self.document = document
        self.found: list[tuple[tuple[Any, ...], SpecError]] = []

    def add(self, error: SpecError, missing: bool = False) -> None:
        """One that has its place."""
        place = error.place
        order = (0, 0, 0) if place is None else (int(place.file == self.document.file), *place[1:])
        self.found.append(((*order, missing), error))

    def take(self, error: ValidationError) -> None:
        """All that validation found."""
        errors = [e for record in error.errors(include_url=False) for e in _each(record)]
        # a formula over a parameter that has a mistake: the mistake is reported where it is
        errors = [e for e in errors if e["type"] != "unknown"] or errors
        split = {e["loc"][:-1] + before for e in errors if (before := _before_comma(e, self.document))}
        errors = [e for e in errors if e["loc"] not in split]
        misspelt = {e["loc"][:-1] for e in errors if e["type"] == "extra_forbidden"}
        unmade: dict[SpecPath, list[str]] = {}
        for record in errors:
            path = tuple(record["loc"])
            if record["type"] == "missing":
                owner = in_the_text(path[:-1], self.document.origins)
                made = next((m for m in self.document.made if owner == m and m[0] in _NAMED), None)
                if made is not None:
                    unmade.setdefault(made, []).append(str(path[-1]))
                    continue
                if path[:-1] in misspelt and self._spelt_otherwise(path, errors):
                    continue
            self.add(_describe(record, self.document), record["type"] == "missing")
        # of a part that is not there, nothing else
        self.found = [item for item in self.found if item[1].path[:2] not in unmade]
        for path, keys in unmade.items():
            self.add(self._not_there(path, keys))
        # the scene itself checks undefined names, once each value is valid
        renamed = any(
            e["loc"][-1:] == ("[key]",) or (e["type"] == "extra_forbidden" and len(e["loc"]) == 1)
            for e in errors
        )
        if not renamed and not unmade and not any(e["loc"] == () for e in errors):
            for record in _dangling(self.document.data):
                self.add(_describe({"type": "spec", "loc": (), "ctx": record.context}, self.document))

    def _spelt_otherwise(self, path: SpecPath, errors: Sequence[Any]) -> bool:
        """True if a key is missing because it is misspelt: the misspelling is reported instead."""
        given = [
            str(e["loc"][-1]) for e in errors if e["type"] == "extra_forbidden" and e["loc"][:-1] == path[:-1]
        ]
        known = _allowed_keys(path[:-1])
        if len(given) > MOST:
            return True
        meant = {path[-1], *others(path[-1])}  # mass, and grammage in its place
        return any(set(difflib.get_close_matches(key, known, n=1)) & meant for key in given)

    def _not_there(self, path: SpecPath, missing: list[str]) -> SpecError:
        """A part that --set would make without its required keys."""
        table, name = str(path[0]), str(path[1])
        there = [key for key in self.document.data[table] if (table, key) not in self.document.made]
        there += made(self.document.data, table) if (table,) in MADE else []
        text = (
            f"there is no {name!r} in {table}{did_you_mean(name, there) or ';'} "
            f"there are: {', '.join(map(str, there))[:200] or 'none'}; "
            f"a new one needs {', '.join(missing)}"
        )
        keys = self.document.keys
        place = next((keys[p] for p in keys if p[:2] == path), self.document.place(path))
        return SpecError(text, path, place)

    def unused(self, scene: Scene) -> None:
        """Parameters that --set made and that nothing follows from: names that are misspelt."""
        new = [name for name in self.document.new_parameters if name in scene.parameters]
        if not new:
            return
        used = {name for text in scene.formulas.values() for name in formulas.names(text)}
        for value in scene.parameters.values():
            if isinstance(value, str) and formulas.is_formula(value, scene.parameters):
                used |= set(formulas.names(value))
        there = [name for name in scene.parameters if name not in new]
        for name in new:
            if name not in used:
                path = ("parameters", name)
                message = (
                    f"there is no {name!r} in parameters{did_you_mean(name, there) or ';'} there are: "
                    f"{', '.join(there)[:200] or 'none'}; nothing follows from a new one"
                )
                self.add(SpecError(message, path, self.document.place(path, prefer_key=True)))

    def error(self) -> SpecError:
        """The first of them; the others are its `others`, MOST in all."""
        message: dict[str, SpecError] = {}
        for _, error in sorted(self.found, key=lambda item: item[0]):
            message.setdefault(str(error), error)
        errors = list(message.values())
        for error in errors[:MOST]:
            error.source = self.document.line(error.place)
        first, *others = errors[:MOST]
        if len(errors) > MOST:
            others.append(SpecError(f"{len(errors) - MOST} more errors; correct these first"))
        return first.with_others(others)


def _before_comma(error: Any, document: Document) -> tuple[str, ...]:
    """The key whose value a decimal comma has cut off, where an unknown key is the rest of it, as in
    `{radius: 7,5 mm, width: 8 mm}`; else ()."""
    path = in_the_text(error["loc"], document.origins)
    if error["type"] != "extra_forbidden" or not _REST.fullmatch(str(path[-1])):
        return ()
    keys = list(_at(document.data, path[:-1]) or ())
    at = keys.index(path[-1]) if path[-1] in keys else 0
    value = _at(document.data, (*path[:-1], keys[at - 1])) if at else None
    return (str(keys[at - 1]),) if type(value) in (int, float) else ()


def _each(error: Any) -> Iterator[Any]:
    """The errors that one of the scene's own stands for."""
    context = error.get("ctx") or {}
    if error["type"] != "spec" or not context.get("several"):
        yield error
        return
    for own in context["several"]:
        yield {**error, "ctx": own}


def _dangling(data: Any) -> list[PydanticCustomError]:
    """Names in plain data of materials, sheets and parts that there are not, and conditions that compare
    unlike units; other mistakes aside."""
    data = written_out(data, {})
    tables = {name: data[name] for name in _TABLES if isinstance(data.get(name), dict)}
    sheets, materials = tables.get("sheets", {}), tables.get("materials", {})
    parts = [name for kind in _PARTS for name in tables.get(kind, {})]
    looks: list[Callable[[], object]] = []
    for name, sheet in sheets.items():
        if isinstance(word := _at(sheet, ("material",)), str):
            looks.append(partial(known, word, materials, "material", ("sheets", name, "material")))
    for kind in ("probes", "loads", "supports"):
        for key, item in _items(data.get(kind)):
            if isinstance(word := _at(item, ("sheet",)), str):
                looks.append(partial(known, word, sheets, "sheet", (kind, key, "sheet")))
    for key, contact in _items(data.get("contacts")):
        for k, word in _items(_at(contact, ("between",))):
            if isinstance(word, str):
                looks.append(partial(matching, word, parts, ("contacts", key, "between", k)))
    for k, rule in _items(data.get("rules")):
        if isinstance(word := _at(rule, ("when",)), str):
            looks.append(partial(check_units, word, ("rules", k, "when")))
    found = []
    for look in looks[:_MOST_LOOKS]:
        try:
            look()
        except PydanticCustomError as error:
            found.append(error)
        if len(found) > MOST:
            break
    return found


def _items(value: Any) -> list[tuple[Any, Any]]:
    """Keys and values of a mapping, or of a list."""
    if isinstance(value, dict):
        return list(value.items())
    return list(enumerate(value)) if isinstance(value, list) else []


def _describe(error: Any, document: Document) -> SpecError:
    inner = tuple(p for p in error["loc"] if p != "[key]")
    path = _as_written(in_the_text(inner, document.origins), document)
    kind, context = error["type"], error.get("ctx") or {}
    prefer_key = error["loc"][-1:] == ("[key]",)
    if kind == "spec":
        message = context["text"]
        if context.get("path") is not None or context.get("within"):
            path = tuple(context["path"] or (*inner, *context["within"]))
            path = _as_written(in_the_text(path, document.origins), document)
            prefer_key = path in document.keys and not isinstance(_at(document.data, path), str)
    elif kind == "extra_forbidden":
        before, prefer_key = _before_comma(error, document), True
        message = f"unknown key {path[-1]!r}{_did_you_mean(inner)}"
        if before:
            meant = f"{before[0]}: {_at(document.data, (*path[:-1], *before))}.{path[-1]}"
            message += f"; write {meant}"
    elif kind == "missing":
        friction = "; write like friction: 0.5, or 0 where there is none; mdlgen upgrade FILE writes 0"
        example = friction if inner[-1] == "friction" else _example(inner)
        message = f"the key {path[-1]!r} is missing{example}"
        path = path[:-1]
    else:
        said = re.sub(
            r"valid dictionary or instance of \w+|valid dictionary or object.*", "mapping", error["msg"]
        )
        if kind in ("model_type", "dict_type", "dataclass_type"):
            keys = ", ".join(_allowed_keys(path))[:100]
            said = "expected a mapping" + (f" with keys of {keys}" if keys else " of keys to values")
        if kind in ("tuple_type", "list_type") and isinstance(error["input"], dict):
            said = "expected a list, each item begun with '- '"
        message = f"{said.replace('valid tuple', 'list')}, got {error['input']!r}"[:300] + _example(inner)
    return SpecError(message, path, document.place(path, prefer_key))


def located(error: SpecError, document: Document) -> SpecError:
    """An error of a later stage, and its others, with the path and the place that the value of each has in
    the text of the scene."""
    origins: dict[SpecPath, SpecPath] = {}
    written_out(deepcopy(document.data), origins)

    def placed(one: SpecError) -> SpecError:
        path = _as_written(in_the_text(one.path, origins), document)
        return SpecError(one.message, path, document.place(path))

    return placed(error).with_others(map(placed, error.others))


def _as_written(path: SpecPath, document: Document) -> SpecPath:
    """A list stands for {points: list}, a number for both frictions: without that key where the text
    has none."""
    for k, key in enumerate(path):
        given = _at(document.data, path[:k])
        if key == "points" and isinstance(given, list):
            return path[:k] + path[k + 1 :]
        if key in ("static", "dynamic") and given is not None and not isinstance(given, (dict, list)):
            return path[:k]
    return path


def _at(data: Any, path: Sequence[str | int]) -> Any:
    for key in path:
        try:
            data = data[key]
        except (KeyError, IndexError, TypeError):
            return None
    return data


def _did_you_mean(path: SpecPath) -> str:
    known = _allowed_keys(path[:-1])
    word = str(path[-1])
    if _REST.fullmatch(word):
        return ": a comma ends the value before it; decimals are written with a point"
    close = difflib.get_close_matches(word, known, n=1)
    if close:
        return f"; did you mean {close[0]!r}?"
    return f"; allowed: {', '.join(known)}" if known else ""


def _allowed_keys(path: SpecPath) -> list[str]:
    """Keys that the model at `path` knows, found by walking the annotations of Scene."""
    from mdlgen.spec.schema import keys, model_at

    model = model_at(path)
    return list(keys(model)) if model else []


def _example(path: SpecPath) -> str:
    """How the value of a key may look, as the end of a message; "" where that is not known."""
    from mdlgen.spec.schema import example, model_at

    end = len(path)
    while end > 1 and isinstance(path[end - 1], int):  # of an item, the whole list
        end -= 1
    if end == 0:
        return ""
    key = str(path[end - 1])
    model = model_at(path[: end - 1])
    shown = example(model, key) if model else ""
    return f"; write like {key}: {shown}" if shown else ""
