"""Parts of the machine in a deck, by kind: one file for each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from mdlgen.backends.motionsolve.writer import guides, meshes, planes, rollers
from mdlgen.backends.motionsolve.writer.facets import Shown
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.model.tables import GuidePart, MeshPart, Model, PlanePart, RollerPart


def _nothing(deck: Deck, model: Model, part: Any) -> None:
    pass


def _no_boxes(model: Model, part: Any) -> list[Shown]:
    return []


class Kind(NamedTuple):
    """What a deck has of one kind, behind the bodies."""

    frame: Callable[[Deck, Model, Any], None] = _nothing  # its axes
    shown: Callable[[Model, Any], list[Shown]] = _no_boxes  # the boxes that show it
    shell: Callable[[Deck, Model, Any], None] = _nothing  # the triangles that show it
    moves: Callable[[Deck, Model, Any], None] = _nothing  # joints, springs, drives, what is recorded


# in the order of their rows
WRITTEN: dict[type, Kind] = {
    GuidePart: Kind(frame=guides.add_frame, shown=guides.shown),
    MeshPart: Kind(frame=meshes.add_frame, shell=meshes.add_shell),
    RollerPart: Kind(frame=rollers.add_frame, shown=rollers.shown, moves=rollers.add_roller),
    PlanePart: Kind(moves=planes.add_plane),
}


def written(model: Model) -> Iterator[tuple[Kind, Any]]:
    """All parts of a machine in the order of their rows, each with its kind."""
    for type_, kind in WRITTEN.items():
        for part in model.machine:
            if isinstance(part, type_):
                yield kind, part
