"""How guides, planes and meshes move."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.model.tables.bodies import Frozen


@dataclass(frozen=True)
class StopsPart:
    """The two ends of a motion, in the units of its places."""

    low: float
    high: float
    stiffness: float  # stiffness of both, beyond them [N/mm, N mm/rad]
    restitution: float


@dataclass(frozen=True)
class MovingPart(Frozen):
    """A turn about a fixed axis, or a slide along a line. Its places, which are angles [rad] or ways [mm],
    count from where the part is given, as the run begins."""

    turns: bool  # true if it turns about an axis; else it slides
    axis: Floats  # unit vector of the axis, or the direction of the slide, (3,)
    pivot: Floats  # a point of the axis; zero for a slide [mm], (3,)
    corners: Floats  # prescribed motion: time [ms], place, and its rate there, (n, 3); (0, 3): it is free
    names: tuple[str, ...] = ()  # names of places that rules may command
    places: Floats = field(default_factory=lambda: np.zeros(0))  # places of these names, (names,)
    inertia: float = 0.0  # inertia of a free part: about the axis [g mm^2], or the mass [g]
    stiffness: float = 0.0
    damping: float = 0.0
    force: float = 0.0  # force of its spring at the place 0, or its torque
    moment: Floats = field(default_factory=lambda: np.zeros(3))  # mass by its arm from the pivot [g mm], (3,)
    stops: StopsPart | None = None

    @property
    def free(self) -> bool:
        """True if forces move it."""
        return self.inertia > 0.0

    @property
    def sprung(self) -> bool:
        """Whether a spring or a damper acts on it."""
        return self.stiffness != 0.0 or self.damping != 0.0 or self.force != 0.0

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the greatest place that it may have; of one that turns freely without stops a whole
        turn either way."""
        if not self.free:
            known = np.concatenate([[0.0], self.corners[:, 1], self.places])
            return float(known.min()), float(known.max())
        if self.stops is None:
            return -np.pi, np.pi
        return self.stops.low, self.stops.high
