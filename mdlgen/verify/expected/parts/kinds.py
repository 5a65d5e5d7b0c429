"""All kinds of parts of which a text must say something."""

from __future__ import annotations

from typing import Any

from mdlgen.errors import RefusedError
from mdlgen.model.tables import GuidePart, MachinePart, MeshPart, PlanePart, RollerPart
from mdlgen.verify.expected.parts.guide import GUIDE
from mdlgen.verify.expected.parts.kind import Kind
from mdlgen.verify.expected.parts.mesh import MESH
from mdlgen.verify.expected.parts.plane import PLANE
from mdlgen.verify.expected.parts.roller import ROLLER

KINDS: dict[type, Kind[Any]] = {RollerPart: ROLLER, PlanePart: PLANE, GuidePart: GUIDE, MeshPart: MESH}


def kind_of(part: MachinePart) -> Kind[Any]:
    """The kind of a part. Raises RefusedError by name for one of which nothing is expected yet."""
    kind = KINDS.get(type(part))
    if kind is None:
        raise RefusedError(f"verify: {part.name} is a {part.kind}, of which no text is expected yet")
    return kind
