"""Labels, keywords and names of a text, against those of the text that mdlgen writes."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from itertools import zip_longest
from typing import Any

from mdlgen.verify.readback.values import Values
from mdlgen.verify.tables import LIMIT, Difference

_NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
# Fields whose numbers stand in a text of their own; they are compared as numbers elsewhere.
_SOLVER_TEXT = {"value", "variable", "expressions", "text"}


def wording(own: Values, given: Values, leave: frozenset[str] = frozenset()) -> Iterator[Difference]:
    """Differences apart from numbers; `leave` are fields of contacts that may be anything."""
    for kind, records in own.items():
        if kind == "commands":
            yield from _commands(records, given[kind])
            continue
        for name, record in records.items():
            if name not in given[kind]:
                yield Difference(kind, name, "is missing")
                continue
            if kind == "contacts":
                record = {k: v for k, v in record.items() if k not in leave}
            for where, mine, theirs in _leaves(record, given[kind][name], ""):
                if not (kind == "contacts" and where in leave):
                    yield Difference(kind, name, f"{where} is {theirs!r}, not {mine!r}")
        for name in given[kind]:
            if name not in records:
                yield Difference(kind, name, "is not in the text that mdlgen writes")


def _commands(own: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Difference]:
    """Differences in the text of templates, apart from numbers."""
    for name in {**own, **given}:
        mine, theirs = own.get(name, ()), given.get(name, ())
        words = [(m.get("command"), t.get("command")) for m, t in zip_longest(mine, theirs, fillvalue={})]
        odd = next((k for k, (m, t) in enumerate(words) if m != t), None)
        if odd is not None:
            due, there = words[odd]
            what = f"{len(theirs)} elements, not {len(mine)}; the first other one, {odd + 1}, is"
            yield Difference("commands", name, f"{what} {there or 'nothing'}, not {due or 'nothing'}")
            continue
        for k, (one, other) in enumerate(zip(mine, theirs, strict=True)):
            for attribute in {**one, **other}:
                want, have = one.get(attribute), other.get(attribute)
                if want != have and not _same_number(want, have):
                    what = f"{attribute} is {have or 'nothing'}, not {want or 'nothing'}"
                    yield Difference("commands", f"{name}, {one['command']} {k + 1}", what)


def _same_number(one: str | None, other: str | None) -> bool:
    try:
        return math.isclose(float(one or ""), float(other or ""), rel_tol=LIMIT, abs_tol=0.0)
    except ValueError:
        return False


def _leaves(mine: Any, theirs: Any, where: str) -> Iterator[tuple[str, Any, Any]]:
    """(where, mine, theirs) of all that is no number and differs."""
    if isinstance(mine, Mapping) and isinstance(theirs, Mapping):
        for key in {**mine, **theirs}:
            if key not in mine or key not in theirs:
                yield f"{where}{key}", mine.get(key), theirs.get(key)
            elif key in _SOLVER_TEXT:
                yield from _leaves(_masked(mine[key]), _masked(theirs[key]), f"{where}{key}")
            else:
                yield from _leaves(mine[key], theirs[key], f"{where}{key}")
    elif isinstance(mine, (tuple, list)) and isinstance(theirs, (tuple, list)) and len(mine) == len(theirs):
        for k, (one, other) in enumerate(zip(mine, theirs, strict=True)):
            yield from _leaves(one, other, f"{where}.{k}")
    elif isinstance(mine, float) and isinstance(theirs, float):
        return
    elif mine != theirs:
        yield where or "it", mine, theirs


def _masked(value: Any) -> Any:
    """Solver text without its numbers and its blanks."""
    if isinstance(value, str):
        return "".join(_NUMBER.sub("#", value).split())
    return tuple(_masked(v) for v in value) if isinstance(value, (tuple, list)) else value
