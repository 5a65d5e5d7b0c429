"""Rows of how guides, planes and meshes move."""

from __future__ import annotations

from typing import NamedTuple

from mdlgen.backends.motionview.writer.axes import axis_of
from mdlgen.backends.motionview.writer.rows import Axis
from mdlgen.model.tables import MovingPart


class MovingView(NamedTuple):
    """A turn about an axis, or a slide along a line, by a profile."""

    turns: bool
    axis: Axis
    corners: int  # of the profile; 1: it stands


def moving_view(name: str, moving: MovingPart | None) -> MovingView | None:
    """Of a part; None: it is fixed."""
    if moving is None:
        return None
    return MovingView(moving.turns, axis_of(f"v_{name}_moves", moving.axis), len(moving.corners))
