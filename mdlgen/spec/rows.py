"""Rows of parts that are said once: one entry repeated at equal distances, or mirrored, written out."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import Field

from mdlgen.spec.fields import Length, Name, Position
from mdlgen.spec.quantities import default
from mdlgen.spec.strict import Strict

Path = tuple[str | int, ...]
ZERO = re.compile(r"[-+]?(?:0+\.?0*|\.0+)\s*[^\d\s]+\d?")
KINDS = ("rollers", "planes", "nips")
MOST = 1000  # of one entry
_PLACES = ("center", "at")
_DIRECTIONS = ("normal", "along")
_ALONE = frozenset(("pivot", "slide"))  # keys of an entry that stands as it is given


class Repeat(Strict):
    """An entry that stands several times, each a step further."""

    count: Annotated[int, Field(ge=1, le=MOST)] = Field(description=f"how many there are, 1 to {MOST}")
    step: Position = Field(description="from one to the next")
    names: tuple[Name, ...] | None = Field(
        default=None,
        strict=False,
        description="what stands for `*` in the names; 1, 2, ... where left out",
    )


class Mirror(Strict):
    """An entry that stands twice, the second as its mirror image."""

    across: Literal["x", "y", "z"] = Field(description="the axis that the mirror plane is square to")
    at: Length = Field(default=default("0 mm"), description="where the mirror plane is on it")
    names: Annotated[tuple[Name, ...], Field(min_length=2, max_length=2)] = Field(
        default=("1", "2"),
        validate_default=False,
        strict=False,
        description="what stands for `*` in the two names; 1 and 2 where left out",
    )


def expanded(data: dict[str, Any], origins: dict[Path, Path]) -> dict[str, Any]:
    """The entries of rollers, planes and nips one by one. Entries of a wrong form stay as they are."""
    made = dict(data)
    for kind in KINDS:
        table = data.get(kind)
        if not isinstance(table, dict):
            continue
        entries: dict[Any, Any] = {}
        for name, entry in table.items():
            for own, item in _row(name, entry):
                entries[own] = item
                if own != name:
                    origins[kind, own] = (kind, name)
        made[kind] = entries
    return made


def _row(name: Any, entry: Any) -> list[tuple[Any, Any]]:
    """The names and entries that one entry is expanded to."""
    if not isinstance(entry, dict) or not isinstance(name, str) or not _ALONE.isdisjoint(entry):
        return [(name, entry)]
    row = [(name, {key: value for key, value in entry.items() if key not in ("repeat", "mirror")})]
    repeat, mirror = entry.get("repeat"), entry.get("mirror")
    if repeat is not None:
        words = _repeated(repeat)
        if words is None:
            return [(name, entry)]
        row = [
            (_named(own, word), _called(_moved(item, repeat["step"], k), word))
            for own, item in row
            for k, word in enumerate(words)
        ]
    if mirror is not None:
        words = _mirrored(mirror)
        if words is None:
            return [(name, entry)]
        row = [
            (_named(own, word), _called(_image(item, mirror) if k else item, word))
            for own, item in row
            for k, word in enumerate(words)
        ]
    return row


def _repeated(repeat: Any) -> list[str] | None:
    """Replacements for `*` in each name; None where `repeat` is not of the right form."""
    if not isinstance(repeat, dict) or set(repeat) - {"count", "step", "names"}:
        return None
    count, step = repeat.get("count"), repeat.get("step")
    names = repeat.get("names")
    if type(count) is not int or not 1 <= count <= MOST or not _three(step):
        return None
    if names is None:
        return [str(k + 1) for k in range(count)]
    good = isinstance(names, list) and len(names) == count and all(isinstance(n, str) for n in names)
    return names if good else None


def _mirrored(mirror: Any) -> list[str] | None:
    if not isinstance(mirror, dict) or set(mirror) - {"across", "at", "names"}:
        return None
    names = mirror.get("names", ["1", "2"])
    good = isinstance(names, list) and len(names) == 2 and all(isinstance(n, str) for n in names)
    return names if good and mirror.get("across") in ("x", "y", "z") else None


def _three(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(isinstance(v, str) for v in value)


def _named(name: str, word: str) -> str:
    """A name with the first `*` filled in, or the word behind it."""
    return name.replace("*", word, 1) if "*" in name else f"{name}_{word}"


def _called(item: dict[str, Any], word: str) -> dict[str, Any]:
    """A nip with the names of its rollers filled in, as far as they have a `*`."""
    item = dict(item)
    for side in ("lower", "upper"):
        own = item.get(side)
        if isinstance(own, dict) and isinstance(own.get("name"), str) and "*" in own["name"]:
            item[side] = {**own, "name": own["name"].replace("*", word, 1)}
    return item


def _moved(item: dict[str, Any], step: list[str], times: int) -> dict[str, Any]:
    return _with_places(item, lambda place: [_sum(p, s, times) for p, s in zip(place, step, strict=True)])


def _sum(place: Any, step: str, times: int) -> Any:
    if times == 0 or not isinstance(place, str) or ZERO.fullmatch(step):
        return place
    return f"({place}) + {times}*({step})"


def _image(item: dict[str, Any], mirror: dict[str, Any]) -> dict[str, Any]:
    """The mirror image: places and directions change sides, an axis of rotation the other way round."""
    axis = "xyz".index(mirror["across"])
    at = mirror.get("at")

    def place(values: list[Any]) -> list[Any]:
        own = values[axis]
        image = f"-({own})" if at is None else f"2*({at}) - ({own})"
        return [*values[:axis], image if isinstance(own, str) else own, *values[axis + 1 :]]

    item = _with_places(item, place)
    for key in _DIRECTIONS:
        if key in item:
            item[key] = _turned(item[key], axis, False)
    if "axis" in item:
        item["axis"] = _turned(item["axis"], axis, True)
    for side in ("lower", "upper"):
        if isinstance(item.get(side), dict):
            item[side] = _image_of_roller(item[side], axis)
    return _image_of_roller(item, axis)


def _image_of_roller(item: dict[str, Any], axis: int) -> dict[str, Any]:
    """The directions of a roller's press and drive."""
    item = dict(item)
    for key in ("press", "drive"):
        inner = item.get(key)
        if isinstance(inner, dict) and "direction" in inner:
            item[key] = {**inner, "direction": _turned(inner["direction"], axis, False)}
    return item


def _with_places(item: dict[str, Any], change: Any) -> dict[str, Any]:
    return {
        key: change(value) if key in _PLACES and isinstance(value, list) and len(value) == 3 else value
        for key, value in item.items()
    }


def _turned(direction: Any, across: int, rotates: bool) -> Any:
    """A direction in the mirror; that of a rotation keeps its part along the axis, and turns the rest."""
    if isinstance(direction, str) and re.fullmatch(r"[-+]?[xyz]", direction):
        if ("xyz".index(direction[-1]) == across) is rotates:
            return direction
        return direction[-1] if direction[0] == "-" else f"-{direction[-1]}"
    if isinstance(direction, list) and all(type(v) in (int, float) for v in direction):
        return [-v if (k == across) is not rotates else v for k, v in enumerate(direction)]
    return direction
