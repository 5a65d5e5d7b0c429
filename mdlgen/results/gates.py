"""Positions over time of parts that turn about a pivot, or slide, and sheets as such a part sees them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mdlgen.model.moved import since
from mdlgen.model.rotations import turns
from mdlgen.model.tables import Floats, MachinePart, MovingPart

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def motion_of(part: MachinePart) -> MovingPart | None:
    """Motion of a part; None: it has no pivot and no slide."""
    return getattr(part, "moving", None)


def place(result: Result, part: MachinePart) -> Floats | None:
    """Angle [rad] of its turn about the pivot, or way [mm] along its slide, from where it is given, (t,);
    None of a part without either."""
    moving = motion_of(part)
    if moving is None:
        return None
    if not moving.turns:
        return (result.position[:, part.body] - result.model.bodies.position[part.body]) @ moving.axis
    turned = _turned(result, part.body)
    least = np.eye(3)[np.abs(moving.axis).argmin()]
    one = np.cross(moving.axis, least)
    one /= np.linalg.norm(one)
    now = turned @ one
    return np.unwrap(np.arctan2(now @ np.cross(moving.axis, one), now @ one))


def shown(result: Result, part: MachinePart) -> tuple[str, Floats] | None:
    """Its place over time as files have it, with the key: in degrees or mm."""
    found, moving = place(result, part), motion_of(part)
    if found is None or moving is None:
        return None
    return ("angle_deg", np.degrees(found)) if moving.turns else ("slide_mm", found)


def record(result: Result, part: MachinePart) -> dict[str, Any]:
    """Its place at the end, and its extremes over the stored times; nothing of a part that does not move."""
    found = shown(result, part)
    if found is None:
        return {}
    key, way = found
    numbers = (way[-1], way.max(), way.min()) if len(way) else (None, None, None)
    return dict(zip((key, f"max_{key}", f"min_{key}"), numbers, strict=True))


class Seen(NamedTuple):
    """Boxes of sheets as a part sees them that has moved: moved with it back to where it begins."""

    place: Floats  # (t, n, 3) [mm]
    turn: Floats  # (t, n, 3, 3)
    rate: Floats  # of their centres against the part there, (t, n, 3) [mm/ms]
    spin: Floats  # (t, n, 3) [rad/ms]


def seen(result: Result, part: MachinePart, boxes: Any, at: Any) -> Seen:
    """Boxes at the stored states `at`."""
    body, states = part.body, np.ix_(np.arange(len(result.time))[at], boxes)
    back = _turned(result, body)[at]
    arm = result.position[states] - result.position[at, body][:, None]
    spin = result.spin[at, body][:, None]
    rate = result.velocity[states] - result.velocity[at, body][:, None] - np.cross(spin, arm)
    return Seen(
        arm @ back + result.model.bodies.position[body],
        np.swapaxes(back, 1, 2)[:, None] @ turns(result.rotation[states]),
        rate @ back,
        (result.spin[states] - spin) @ back,
    )


def _turned(result: Result, body: int) -> Floats:
    """Rotation of a body since the run began, (t, 3, 3)."""
    return since(result.model.bodies, body, turns(result.rotation[:, body]))
