"""All kinds of parts of which a text must say something."""

from __future__ import annotations

from typing import Any

from mdlgen.altair.parts import by_kind
from mdlgen.errors import RefusedError
from mdlgen.model.tables import MachinePart, Model
from mdlgen.verify.expected import parts
from mdlgen.verify.expected.parts.kind import Kind
from mdlgen.verify.tables import Table

KINDS: dict[type[MachinePart], Kind[Any]] = by_kind(parts)


def kind_of(part: MachinePart) -> Kind[Any]:
    """The kind of a part. Raises RefusedError by name for one of which nothing is expected yet."""
    kind = KINDS.get(type(part))
    if kind is None:
        raise RefusedError(f"verify: {part.name} is a {part.kind}, of which no text is expected yet")
    return kind


def own_tables(model: Model) -> dict[str, Table]:
    """The tables that hold one kind of part each."""
    found: dict[str, Table] = {}
    for kind in KINDS.values():
        found |= kind.tables(model)
    return found
