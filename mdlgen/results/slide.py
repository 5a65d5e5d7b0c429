"""Positions of pressed rollers and plates along the direction that they are pressed in."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mdlgen.model.tables import Floats, PlanePart, RollerPart

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def slide(result: Result, part: RollerPart | PlanePart) -> Floats | None:
    """Way of its centre along its press direction from where it is given [mm], (t,): it grows as the spring
    presses the part on, and falls as a sheet lifts it. None of one without a press."""
    if part.press is None:
        return None
    return (result.position[:, part.body] - part.center) @ part.press.direction
