"""A stand-in for msolve: its classes record what is made, and refuse what the table of forms does not have.

It checks names of classes and keywords, kinds and lengths of values, and that nothing needed is missing. It
solves nothing: `Model.simulate` records how it is called, and ends the script with Simulated.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from mdlgen.backends.msolve.forms import ANALYSES, FORMS, Form
from mdlgen.backends.msolve.reader.shapes.kinds import SHAPES

KNOWN = {**FORMS, **{name: shape.form for name, shape in SHAPES.items()}}

_LENGTHS = {"three": 3, "six": 6}


class FormError(TypeError):
    """A call that no form allows."""


class Simulated(Exception):
    """The script has come to its simulation, with these arguments."""

    def __init__(self, arguments: dict[str, Any]):
        self.arguments = arguments
        super().__init__("simulate")


class Point(NamedTuple):
    """A place [mm]; Point(x, y, z) is SEEN."""

    x: float
    y: float
    z: float


class Thing:
    """One object of a model. Keywords are attributes, which may be given later too."""

    form: Form
    _made: list[Thing]

    def __init__(self, **given: Any):
        self.id = len(self._made) + 1
        self.given: dict[str, Any] = {}
        for name, value in given.items():
            setattr(self, name, value)
        missing = sorted(self.form.needed - set(given))
        if missing:
            raise FormError(f"{type(self).__name__} has no {', '.join(missing)}")
        self._record()

    def _record(self) -> None:
        self._made.append(self)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in ("id", "given"):
            object.__setattr__(self, name, value)
            return
        kind = type(self).__name__
        if name not in self.form.keywords:
            raise FormError(f"{kind} has no keyword {name}")
        wanted = self.form.keywords[name].kind
        if not fits(value, wanted):
            raise FormError(f"{kind}.{name} is {_shown(value)}, not {wanted}")
        self.given[name] = value

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["given"][name]
        except KeyError:
            raise AttributeError(f"{type(self).__name__} has no {name}") from None


def _shown(value: Any) -> str:
    text = type(value).__name__ if isinstance(value, Thing) else repr(value)
    return text if len(text) <= 60 else f"{text[:56]} ..."


def _number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _numbers(value: Any, length: int | None = None) -> bool:
    return isinstance(value, list) and all(map(_number, value)) and length in (None, len(value))


def _count(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _of(value: Any, *names: str) -> bool:
    return isinstance(value, Thing) and type(value).__name__ in names


_KINDS: dict[str, Callable[[Any], bool]] = {
    "text": lambda v: isinstance(v, str),
    "number": _number,
    "count": _count,
    "yes": lambda v: isinstance(v, bool),
    "point": lambda v: isinstance(v, Point) and all(map(_number, v)),
    "three": lambda v: _numbers(v, 3),
    "six": lambda v: _numbers(v, 6),
    "numbers": lambda v: _numbers(v) and len(v) > 1,
    "triples": lambda v: isinstance(v, list) and all(_numbers(row, 3) for row in v),
    "counts": lambda v: isinstance(v, list) and all(_numbers(row, 3) and all(map(_count, row)) for row in v),
    "shapes": lambda v: (
        _of(v, *SHAPES) or (isinstance(v, list) and len(v) > 0 and all(_of(one, *SHAPES) for one in v))
    ),
}


def fits(value: Any, kind: str) -> bool:
    """True if a value is of a kind of the table of forms."""
    if kind in KNOWN:
        return _of(value, kind)
    if kind in _KINDS:
        return _KINDS[kind](value)
    return isinstance(value, str) and value in kind.split("|")


def _simulate(self: Thing, **given: Any) -> None:
    analysis = given.get("type")
    if analysis not in ANALYSES:
        raise FormError(f"simulate has no type {_shown(analysis)}")
    known = {"type", "returnResults", *ANALYSES[analysis]}
    if set(given) != known:
        raise FormError(
            f"simulate({analysis}) takes {', '.join(sorted(known))}, not {', '.join(sorted(given))}"
        )
    for name in ANALYSES[analysis]:
        if not _number(given[name]):
            raise FormError(f"simulate: {name} is {_shown(given[name])}, not number")
    raise Simulated(given)


def names(most: int) -> tuple[dict[str, Any], list[Thing]]:
    """Names of `from msolve import *`, and the list to which all objects are added, at most `most`."""

    class Bounded(list[Thing]):
        def append(self, item: Thing) -> None:
            if len(self) >= most:
                raise FormError(f"more than {most} objects")
            super().append(item)

    made: list[Thing] = Bounded()
    found: dict[str, Any] = {"Point": Point}
    for name, form in KNOWN.items():
        body: dict[str, Any] = {"form": form, "_made": made}
        if name == "Model":
            body["simulate"] = _simulate
        found[name] = type(name, (Thing,), body)
    return found, made
