"""Where a sheet leaves the machine: beyond a plane, or at rest in a tray."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, WithJsonSchema, model_serializer

from mdlgen.spec.fields import Length
from mdlgen.spec.strict import Strict, fail
from mdlgen.units import exact_quantity

REST = "at rest"
_BEYOND = re.compile(r"\s*beyond\s+([xyz])\s*=\s*(.+?)\s*", re.ASCII)
FORMS = "beyond x = 400 mm (or y, z), at rest, or a list of these"
MOST = 10  # of one sheet


class Out(Strict):
    """One way to leave; without an axis: at rest."""

    axis: Literal["x", "y", "z"] | None = None
    at: Length | None = None

    @model_serializer
    def _said(self) -> str:
        return REST if self.axis is None else f"beyond {self.axis} = {exact_quantity(self.at or 0.0, 'mm')}"


def _read(value: Any) -> Any:
    if isinstance(value, Out):
        return value
    if isinstance(value, str) and " ".join(value.split()) == REST:
        return Out()
    found = _BEYOND.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        raise fail(f"{str(value)[:80]!r} is not understood; allowed: {FORMS}")
    return {"axis": found[1], "at": found[2]}


def _listed(value: Any) -> Any:
    given = list(value) if isinstance(value, (list, tuple)) else [value]
    if len(given) > MOST:
        raise fail(f"{len(given)} ways to leave; allowed are {MOST}")
    return tuple(given)


_TEXT = {"type": "string", "examples": ["beyond x = 400 mm", REST]}
Outs = Annotated[
    tuple[Annotated[Out, BeforeValidator(_read)], ...],
    BeforeValidator(_listed),
    WithJsonSchema({"anyOf": [_TEXT, {"type": "array", "items": _TEXT}]}),
]
