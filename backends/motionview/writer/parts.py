"""Parts of the machine in a text, by kind: one file for each."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from mdlgen.altair.rims import WHOLE, graphics
from mdlgen.backends.motionview.writer.guides import guide_graphics, guide_view
from mdlgen.backends.motionview.writer.meshes import mesh_graphics, mesh_view
from mdlgen.backends.motionview.writer.planes import plane_graphics, plane_view
from mdlgen.backends.motionview.writer.rollers import roller_view
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.model.tables import GuidePart, MachinePart, MeshPart, Model, PlanePart, RollerPart


class Kind(NamedTuple):
    """What a text has of one kind."""

    view: Callable[[Model, Any, list[Value]], Any]  # the row for its template
    graphics: Callable[[Any], list[str]]  # names of what shows it


def _roller_graphics(roller: RollerPart) -> list[str]:
    return graphics(roller, WHOLE)


WRITTEN: dict[type, Kind] = {
    RollerPart: Kind(roller_view, _roller_graphics),
    PlanePart: Kind(plane_view, plane_graphics),
    GuidePart: Kind(guide_view, guide_graphics),
    MeshPart: Kind(mesh_view, mesh_graphics),
}


def graphics_of(part: MachinePart) -> list[str]:
    """Names of the graphics that show a part, all of it."""
    return WRITTEN[type(part)].graphics(part)
