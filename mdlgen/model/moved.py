"""Parts that turn about a pivot or slide: their tables, and where they may be."""

from __future__ import annotations

import numpy as np

from mdlgen.model.rotations import matrices
from mdlgen.model.tables import Bodies, Floats, MovingPart, StopsPart
from mdlgen.spec.moving import Pivot, PivotStops, Slide, SlideStops

_TURN = np.radians(5.0)  # from one angle at which bounds are taken to the next, at most
# A stop yields: distance beyond it that a part may reach, relative to the distance between both stops. A
# convention; a run ends where a part is beyond.
BEYOND = 0.1
EASE = 1e-6  # mm: round-off of a centre that does not move


def lower_motion(motion: Pivot | Slide | None, mass: float) -> MovingPart | None:
    """The moving part for a pivot or a slide of a part of that mass [g]; None: it does not move."""
    if motion is None:
        return None
    corners = np.zeros((len(motion.profile or ()), 3))
    corners[:, :2] = np.array(motion.profile or (), dtype=float).reshape(-1, 2)
    positions = motion.positions or {}
    turns = isinstance(motion, Pivot)
    inertia = motion.inertia if isinstance(motion, Pivot) else motion.mass
    if inertia is None and not len(corners):
        corners = np.zeros((1, 3))  # it stands until a rule commands it
    pivot = np.array(motion.at) if isinstance(motion, Pivot) else np.zeros(3)
    moment = np.zeros(3)
    if isinstance(motion, Pivot) and motion.center is not None:
        moment = mass * (np.array(motion.center) - pivot)
    return MovingPart(
        turns=turns,
        axis=np.array(motion.axis if isinstance(motion, Pivot) else motion.direction),
        pivot=pivot,
        corners=corners,
        names=tuple(sorted(positions)),
        places=np.array([positions[name] for name in sorted(positions)], dtype=float),
        inertia=inertia or 0.0,
        stiffness=motion.stiffness,
        damping=motion.damping,
        force=motion.torque if isinstance(motion, Pivot) else motion.force,
        moment=moment,
        stops=lower_stops(motion.stops),
    )


def lower_stops(stops: PivotStops | SlideStops | None) -> StopsPart | None:
    """The stops of a pivot, a slide, an arm or a press; None: there are none."""
    return None if stops is None else StopsPart(stops.low, stops.high, stops.stiffness, stops.restitution)


def displaced(moving: MovingPart, places: Floats, points: Floats) -> Floats:
    """Points (n, 3) of a part as it is given, with the part at some places (k,): (k, n, 3)."""
    if not moving.turns:
        return points + places[:, None, None] * moving.axis
    turns = matrices(places[:, None] * moving.axis)
    return moving.pivot + np.einsum("kij,nj->kni", turns, points - moving.pivot)


def ends_of(moving: MovingPart) -> tuple[float, float]:
    """The least and the greatest place, with what stops yield."""
    low, high = moving.ends
    more = BEYOND * (high - low) if moving.stops is not None else 0.0
    return low - more, high + more


def stations(moving: MovingPart) -> Floats:
    """Places between both ends that are so close that bounds over them are those of the motion, but for
    `sag`."""
    low, high = ends_of(moving)
    many = 1 + int(np.ceil((high - low) / _TURN)) if moving.turns else 1
    return np.linspace(low, high, many + 1)


def swept(moving: MovingPart, points: Floats) -> tuple[Floats, Floats]:
    """Least and greatest coordinates of points (n, 3) of a part, wherever it may be, (3,) each [mm]."""
    at = stations(moving)
    found = displaced(moving, at, points)
    sag = 0.0
    if moving.turns:
        arms = np.linalg.norm(points - moving.pivot, axis=1).max()
        sag = float(arms * (1.0 - np.cos(0.5 * (at[1] - at[0]))))
    return found.min(axis=(0, 1)) - sag, found.max(axis=(0, 1)) + sag


def carries(moving: MovingPart, points: Floats) -> Floats:
    """How far a part carries what lies on it at most along each axis, either way, (3,) [mm]."""
    found = displaced(moving, stations(moving), points)
    return np.abs(found - points).max(axis=(0, 1))


def since(bodies: Bodies, body: int, rotation: Floats) -> Floats:
    """Rotation of a body since the run began, (..., 3, 3), from its rotation now."""
    return rotation @ bodies.rotation[body].T


def as_begun(bodies: Bodies, body: int, position: Floats, turned: Floats, points: Floats) -> Floats:
    """Points (..., 3) as they stand to a part that is at a place (3,) and has `turned` (3, 3), moved with the
    part back to where it begins."""
    return (points - position) @ turned + bodies.position[body]


def watched(moving: MovingPart, center: Floats) -> tuple[Floats, Floats] | None:
    """Bounds of the centre of a part whose stops a run is to end beyond; None: it has none."""
    if moving.stops is None:
        return None
    low, high = swept(moving, center[None])
    return low - EASE, high + EASE


def moves(moving: MovingPart) -> str:
    """Motion of a part, in words."""
    way = "turns about a pivot" if moving.turns else "slides"
    low, high = (np.degrees(end) if moving.turns else end for end in moving.ends)
    unit = "deg" if moving.turns else "mm"
    by = "freely" if moving.free else "by its profile"
    if moving.free and moving.stops is None:
        return f"{way} {by}"
    return f"{way} {by}, from {low:.4g} to {high:.4g} {unit}"
