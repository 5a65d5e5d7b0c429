"""All kinds of parts of which a script is written."""

from __future__ import annotations

from typing import Any, NamedTuple

from mdlgen.altair.parts import by_kind
from mdlgen.backends.msolve.writer import parts
from mdlgen.backends.msolve.writer.parts.kind import Kind
from mdlgen.model.parts.kinds import KINDS
from mdlgen.model.tables import MachinePart

WRITTEN: dict[type[MachinePart], Kind[Any]] = by_kind(parts)


class Written(NamedTuple):
    """A kind by its names in a script."""

    name: str  # of one: roller
    variable: str  # of all: ROLLERS
    part: type[MachinePart]
    kind: Kind[Any]


MACHINE = [
    Written(kind.name, kind.table.upper(), kind.part, WRITTEN[kind.part])
    for kind in KINDS
    if kind.part in WRITTEN
]
