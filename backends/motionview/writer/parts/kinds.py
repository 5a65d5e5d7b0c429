"""All kinds of parts of which a text is written."""

from __future__ import annotations

from typing import Any

from mdlgen.altair.parts import by_kind
from mdlgen.backends.motionview.writer import parts
from mdlgen.backends.motionview.writer.parts.kind import Kind
from mdlgen.model.tables import MachinePart

WRITTEN: dict[type[MachinePart], Kind[Any]] = by_kind(parts)


def graphics_of(part: MachinePart) -> list[str]:
    """Names of the graphics that show a part, all of it."""
    return WRITTEN[type(part)].graphics(part)
