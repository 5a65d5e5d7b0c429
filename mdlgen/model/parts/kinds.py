"""All kinds of parts of a machine, in the order in which their bodies are numbered."""

from __future__ import annotations

from typing import Any

from mdlgen.model.parts.guide import GUIDE
from mdlgen.model.parts.kind import Kind
from mdlgen.model.parts.mesh import MESH
from mdlgen.model.parts.plane import PLANE
from mdlgen.model.parts.roller import ROLLER

KINDS: tuple[Kind[Any], ...] = (ROLLER, PLANE, GUIDE, MESH)
# by the kind of the contacts of sheets with it
WITH_SHEET: dict[int, Kind[Any]] = {kind.with_sheet: kind for kind in KINDS}


def kind_of(part: object) -> Kind[Any]:
    """The kind of a part of the machine."""
    return next(kind for kind in KINDS if isinstance(part, kind.part))
