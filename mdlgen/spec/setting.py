"""`--set PATH=VALUE` on the plain data of a scene."""

from __future__ import annotations

import re
from copy import deepcopy
from fnmatch import fnmatchcase
from typing import Any

from mdlgen.errors import Place, SpecError, did_you_mean
from mdlgen.spec.alternatives import others
from mdlgen.spec.document import Document, SpecPath, parse
from mdlgen.spec.nip import contacts_of
from mdlgen.spec.nip import names_of as rollers_of
from mdlgen.spec.pile import names_of as sheets_of
from mdlgen.spec.rows import KINDS, expanded
from mdlgen.spec.stream import names_of as sheets_of_stream

_PATTERN = re.compile(r"[*?]")
WORD = re.compile(r"[A-Za-z0-9_*?]{1,64}")  # of a path
MADE = (("rollers",), ("contacts",), ("sheets",))  # tables that nips and piles add to
MOST_PLACES = 10_000  # that one pattern may meet


def set_value(document: Document, override: str) -> None:
    """Apply one `PATH=VALUE` to the plain data; `*` and `?` in a part of PATH meet every name that fits.

    Raises SpecError; the data is then as it was.
    """
    path_text, equals, value_text = override.partition("=")
    file = f"--set {path_text}"
    here = Place(file, 1, 1)
    words = path_text.strip().split(".")
    if not equals or not all(WORD.fullmatch(w) for w in words):
        raise SpecError(
            f"{override[:80]!r} is not PATH=VALUE; write like sheets.note.boxes=[20,30]", place=here
        )
    value = parse(value_text, file)
    _write_out(document, words)
    for path in met(document.data, words, here):
        _put(document, path, value.copy(), here)


def _write_out(document: Document, words: list[str]) -> None:
    """Puts what a `repeat` or a `mirror` makes in the place of its entry, where the words mean a part that it
    makes and not the entry itself. The scene stays the same."""
    if len(words) < 2 or not isinstance(document.data, dict):
        return
    kind, word = words[:2]
    table = document.data.get(kind)
    if kind not in KINDS or not isinstance(table, dict):
        return
    entries: dict[Any, Any] = {}
    for name, entry in table.items():
        made = expanded({kind: {name: entry}}, {})[kind]
        if fnmatchcase(str(name), word) or not any(fnmatchcase(str(own), word) for own in made):
            entries[name] = entry
            continue
        entries.update({own: deepcopy(item) for own, item in made.items()})  # none shares a mapping
        for known in (document.places, document.keys):
            for path, place in [(p, at) for p, at in known.items() if p[:2] == (kind, name)]:
                known.update({(kind, own, *path[2:]): place for own in made})
    document.data[kind] = entries


def met(data: Any, words: list[str], here: Place) -> list[SpecPath]:
    """Every path that words with patterns mean in plain data; keys that are not there yet are made where no
    pattern is. Raises SpecError where there is none."""
    found: list[tuple[SpecPath, Any]] = [((), data)]
    for word in words:
        step: list[tuple[SpecPath, Any]] = []
        for path, node in found:
            if path in MADE and _PATTERN.search(word) and not isinstance(node, list):
                node = {**dict.fromkeys(made(data, path[0])), **(node or {})}
            step += [((*path, key), inner) for key, inner in _inside(node, word, path, here)]
        if not step:
            known = dict.fromkeys(str(key) for _, node in found for key in node or ())
            if found[0][0] in MADE:
                known |= dict.fromkeys(made(data, found[0][0][0]))
            raise SpecError(
                f"nothing here fits {word!r}{did_you_mean(word, known) or ';'} "
                f"there are: {', '.join(known)[:200] or 'none'}",
                tuple(words[: len(found[0][0])]),
                here,
            )
        if len(step) > MOST_PLACES:
            raise SpecError(f"{word!r} meets more than {MOST_PLACES} values", place=here)
        found = step
    return [path for path, _ in found]


def made(data: Any, kind: str | int) -> list[str]:
    """The names of the rollers, or of the contacts, that nips make, or of the sheets of piles and
    streams."""
    if kind == "sheets":
        given = data.get("piles") if isinstance(data, dict) else None
        piles = given if isinstance(given, dict) else {}
        own = [sheet for name, pile in piles.items() for sheet in sheets_of(name, pile)]
        given = data.get("streams") if isinstance(data, dict) else None
        streams = given if isinstance(given, dict) else {}
        return own + [sheet for name, item in streams.items() for sheet in sheets_of_stream(name, item)]
    given = expanded({"nips": data.get("nips")} if isinstance(data, dict) else {}, {}).get("nips")
    nips = given if isinstance(given, dict) else {}
    if kind == "rollers":
        return [roller for name, nip in nips.items() for roller in rollers_of(name, nip)]
    return [
        called
        for name, nip in nips.items()
        for called, (first, *_) in contacts_of(name).items()
        if isinstance(nip, dict) and isinstance(nip.get(first), dict)
    ]


def _inside(node: Any, word: str, path: SpecPath, here: Place) -> list[tuple[str | int, Any]]:
    """(key, value) of what a word means in a mapping or a list."""
    pattern = _PATTERN.search(word) is not None
    if node is None:
        node = {}
    if isinstance(node, list):
        if pattern:
            return [(k, item) for k, item in enumerate(node) if fnmatchcase(str(k), word)]
        if not re.fullmatch(r"[0-9]{1,6}", word) or int(word) >= len(node):
            raise SpecError(f"no item {word!r}; the list has {len(node)}, counted from 0", path, here)
        return [(int(word), node[int(word)])]
    if isinstance(node, dict):
        if pattern:
            return [(key, item) for key, item in node.items() if fnmatchcase(str(key), word)]
        return [(word, node.get(word))]
    raise SpecError(f"has a plain value; it has no part {word!r}", path, here)


def _put(document: Document, path: SpecPath, value: Document, here: Place) -> None:
    """Put a value at a path, with the mappings that lead to it."""
    node: Any = document.data
    for depth, key in enumerate(path[:-1]):
        if isinstance(node, dict) and node.get(key) is None:
            node[key] = {}
            document.made.add(path[: depth + 1])
        node = node[key]
    last = path[-1]
    if len(path) == 2 and path[0] == "parameters":
        if last not in node:
            document.new_parameters.append(str(last))
        elif isinstance(node[last], dict) and not isinstance(value.data, dict):
            # a parameter with the range of its slider: only its value changes
            return _put(document, (*path, "value"), value, here)
    if isinstance(node, dict):
        for other in others(last, path[-2] if len(path) > 1 else None):
            node.pop(other, None)
    node[last] = value.data
    for table, source in ((document.places, value.places), (document.keys, value.keys)):
        for known in [p for p in table if p[: len(path)] == path]:
            del table[known]
        table.update({path + tail: Place(here.file, *place[1:]) for tail, place in source.items()})
    document.keys.setdefault(path, here)
