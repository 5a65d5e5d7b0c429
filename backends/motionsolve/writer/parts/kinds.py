"""All kinds of parts of which a deck is written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from mdlgen.altair.parts import by_kind
from mdlgen.backends.motionsolve.writer import parts
from mdlgen.backends.motionsolve.writer.parts.kind import Kind
from mdlgen.model.tables import MachinePart, Model

WRITTEN: dict[type[MachinePart], Kind[Any]] = by_kind(parts)


def written(model: Model) -> Iterator[tuple[Kind[Any], Any]]:
    """All parts of a machine in the order of their rows, each with its kind."""
    for type_, kind in sorted(WRITTEN.items(), key=lambda item: item[1].rank):
        for part in model.parts_of(type_):
            yield kind, part
