"""What texts have of guides, planes and meshes that move, and which of them none can say yet."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.altair.masses import own_inertia
from mdlgen.errors import RefusedError
from mdlgen.model.frames import frame
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import Floats, Model, MovingPart

DISPLACED = "DISP"  # what is prescribed of their joints


def joint_of(moving: MovingPart) -> tuple[str, str]:
    """What a joint is called behind the name of the part, and its type."""
    return ("pivot", "REVOLUTE") if moving.turns else ("slide", "TRANSLATIONAL")


def places(moving: MovingPart, times: Floats) -> Floats:
    """Angles [rad] or places [mm] of what a profile moves at times [ms]: by 3 s^2 - 2 s^3 between corners."""
    at, place = moving.corners[:, 0], moving.corners[:, 1]
    found = np.full(np.shape(times), place[0])
    for k in range(len(at) - 1):
        s = np.clip((times - at[k]) / (at[k + 1] - at[k]), 0.0, 1.0)
        found = found + (place[k + 1] - place[k]) * s * s * (3.0 - 2.0 * s)
    return found


def spring_axes(moving: MovingPart) -> Floats:
    """Axes of the spring of what moves freely, in columns: z along its line or its pivot, x near the global
    axis that is farthest from that, (3, 3)."""
    return frame(moving.axis, np.eye(3)[np.argmin(np.abs(moving.axis))])


def refuse_moving(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for what turns freely with a mass that is too far from its pivot
    for its inertia, for stops half a turn away, and for those of a press that has a mesh on its roller."""
    for part, moving in model.gates:
        if moving.free and moving.turns and (own := own_inertia(model, part, moving)) <= 0.0:
            raise RefusedError(
                f"{who}: {part.name} has an inertia of {moving.inertia:g} g*mm^2 about its pivot, less than "
                f"its mass has there; its centre of mass would have {own:.4g} g*mm^2",
                (kind_of(part).table, part.name, "pivot", "inertia"),
            )
        if (
            moving.turns
            and moving.free
            and moving.stops is not None
            and max(map(abs, moving.ends)) >= math.pi
        ):
            raise RefusedError(
                f"{who}: a stop of {part.name} is half a turn or more from where it begins, and no page says "
                "how AZ continues there; run it locally",
                (kind_of(part).table, part.name, "pivot", "stops"),
            )
    for part in model.rollers:
        if part.press is not None and part.press.stops is not None and part.carried[0] > 0.0:
            raise RefusedError(
                f"{who}: the press of {part.name}, with a mesh on its roller, has stops, whose damping would "
                "follow from both masses; leave the stops out, or run it locally",
                ("rollers", part.name, "press", "stops"),
            )
