"""Objects of a MotionSolve script apart from the numbers of the Model: against the script of mdlgen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

from mdlgen.verify.tables import LIMIT, Difference

_MARKER = frozenset(("qp", "zp", "xp"))
_REACH = 1000.0  # of places [mm]: differences of coordinates are small against this


def object_differences(own: Any, given: Any, file: str) -> Iterator[Difference]:
    """Objects that are missing or too many, and what is given to them otherwise; `own` is of the script that
    mdlgen writes."""
    if not given.same_program:
        what = "its program is not the one that mdlgen writes; only its values may differ"
        yield Difference("msolve", "", f"{file}: {what}")
    due = dict(_counted(own.objects()))
    for key, attributes in _counted(given.objects()):
        mine = due.pop(key, None)
        if mine is None:
            yield Difference("msolve", "", f"{file}: {_named(key)} is not in the script that mdlgen writes")
            continue
        for name in sorted({*mine, *attributes}):
            want, have = mine.get(name), attributes.get(name)
            if not _same(want, have, _REACH if name in _MARKER else 0.0):
                what = f"{name} is {_shown(have)}, not {_shown(want)}"
                yield Difference("msolve", "", f"{file}: {_named(key)}: {what}")
    for key in due:
        yield Difference("msolve", "", f"{file}: {_named(key)} is missing")


def _counted(objects: Any) -> Iterator[tuple[tuple[str, str, int], dict[str, Any]]]:
    """Two things with one name differ by a number."""
    seen: Counter[tuple[str, str]] = Counter()
    for key, attributes in objects:
        seen[key] += 1
        yield (*key, seen[key]), attributes


def _same(want: Any, have: Any, scale: float) -> bool:
    if isinstance(want, list) and isinstance(have, list):
        numbers = [abs(v) for v in want if isinstance(v, (int, float))]
        scale = max([scale, *numbers])
        return len(want) == len(have) and all(_same(w, h, scale) for w, h in zip(want, have, strict=True))
    if isinstance(want, bool) or isinstance(have, bool):
        return want is have
    if isinstance(want, (int, float)) and isinstance(have, (int, float)):
        return abs(want - have) <= LIMIT * max(abs(want), abs(have), scale)
    return bool(want == have)


def _shown(value: Any) -> str:
    if value is None:
        return "not there"
    text = str(value)
    return text if len(text) <= 80 else f"{text[:76]} ..."


def _named(key: tuple[str, str, int]) -> str:
    kind, label, number = key
    return f"{kind} {label}".strip() + (f" ({number})" if number > 1 else "")
