"""Exit of a sheet from the machine: beyond a plane, or at rest in a tray."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from mdlgen.spec.parameter import Computed
from mdlgen.spec.quantities import quantity
from mdlgen.spec.strict import fail
from mdlgen.units import exact_quantity

REST = "at rest"
_BEYOND = re.compile(r"\s*beyond\s+([xyz])\s*=\s*(.+?)\s*", re.ASCII)
FORMS = "beyond x = 400 mm (or y, z), at rest, or a list of these"
MOST = 10  # of one sheet
_LENGTH = quantity("mm")


@dataclass(frozen=True)
class Out:
    """One way to leave: beyond a plane that is square to an axis, at a place on it [mm]; no axis: at rest."""

    axis: str | None = None
    at: float = 0.0

    def __str__(self) -> str:
        """The text in the form of a scene."""
        if self.axis is None:
            return REST
        at = self.at.formula if isinstance(self.at, Computed) else exact_quantity(self.at, "mm")
        return f"beyond {self.axis} = {at}"


def _read(value: Any) -> Out:
    if isinstance(value, Out):
        return value
    if isinstance(value, str) and " ".join(value.split()) == REST:
        return Out()
    found = _BEYOND.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        raise fail(f"{str(value)[:80]!r} is not understood; allowed: {FORMS}")
    return Out(found[1], _LENGTH.read(found[2]))


def _all(value: Any) -> tuple[Out, ...]:
    if not isinstance(value, (list, tuple)):
        return (_read(value),)
    if len(value) > MOST:
        raise fail(f"{len(value)} ways to leave; allowed are {MOST}")
    ways: list[Out] = []
    for k, item in enumerate(value):
        try:
            ways.append(_read(item))
        except PydanticCustomError as error:
            raise fail(str((error.context or {})["text"]), within=(k,)) from None
    return tuple(ways)


def _texts(ways: tuple[Out, ...] | None) -> list[str] | None:
    return None if ways is None else [str(way) for way in ways]


_TEXT = {"type": "string", "examples": ["beyond x = 400 mm"]}
Outs = Annotated[
    tuple[Out, ...],
    PlainValidator(_all),
    PlainSerializer(_texts),
    WithJsonSchema({"anyOf": [_TEXT, {"type": "array", "items": _TEXT}]}),
]
