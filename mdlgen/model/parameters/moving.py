"""What the user gave of how guides, planes and meshes move."""

from __future__ import annotations

from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.tables import Parameter
from mdlgen.spec.moving import MovingPart, Pivot


def moving_rows(name: str, part: MovingPart, base: tuple[str, str]) -> list[Parameter]:
    """Pivot, and corners of a profile but for the first place, which is 0; of one that stands nothing."""
    motion = part.moves
    if motion is None:
        return []
    turns, rows = isinstance(motion, Pivot), []
    path = (*base, "pivot" if turns else "slide")
    if isinstance(motion, Pivot):
        for k, axis in enumerate(NAMED_AXES):
            rows.append(Parameter(name, f"a_{axis}", f"Pivot {axis}", motion.at[k], "mm", (*path, "at", k)))
    corners = motion.profile or ()
    for k, (time, place) in enumerate(corners if len(corners) > 1 else ()):
        at = (*path, "profile", k)
        rows.append(Parameter(name, f"t_{k}", f"Time of corner {k}", time, "ms", (*at, 0)))
        if k:
            what, unit = ("Angle at corner %d (deg)", "rad") if turns else ("Place at corner %d", "mm")
            rows.append(Parameter(name, f"q_{k}", what % k, place, unit, (*at, 1)))
    return rows
