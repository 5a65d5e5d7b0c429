"""All kinds of parts of a machine, in the order in which their bodies are numbered: that of a scene's tables.

A kind has the name of its class in `mdlgen.spec`, and a file of that name in this folder.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from mdlgen.model import parts
from mdlgen.model.parts.kind import Kind
from mdlgen.spec.machine_part import classes_of
from mdlgen.spec.scene import Scene

KINDS: tuple[Kind[Any], ...] = tuple(
    import_module(f"{parts.__name__}.{part.kind}").KIND for part in classes_of(Scene).values()
)
# by the kind of the contacts of sheets with it
WITH_SHEET: dict[int, Kind[Any]] = {kind.with_sheet: kind for kind in KINDS}


def kind_of(part: object) -> Kind[Any]:
    """The kind of a part of the machine."""
    return next(kind for kind in KINDS if isinstance(part, kind.part))
