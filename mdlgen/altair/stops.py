"""What texts have of the stops of presses, arms, and parts that move freely."""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.altair.moving import joint_of
from mdlgen.model.tables import Floats, Model, StopsPart

# Added to a speed that a rate is divided by [mm/s, rad/s], where that speed is 0: far below round-off else.
LEAST = "1E-15"


class Stopped(NamedTuple):
    """What is stopped: a joint of a body to ground, whose place counts from where it begins."""

    name: str  # of the part
    joint: str  # what its joint is called behind that name
    turns: bool
    body: str
    axis: Floats  # of the joint, (3,)
    stops: StopsPart
    begins: float  # place at the start, as places of the stops count
    inertia: float  # of all that moves [g, g mm^2]
    smooth: float  # of the speed of an impact, below which the damping changes its sign

    @property
    def ends(self) -> tuple[float, float]:
        """Places of both stops in the joint."""
        return self.stops.low - self.begins, self.stops.high - self.begins

    @property
    def share(self) -> float:
        """beta of the damping, by Eq. 11."""
        square = self.stops.restitution**2
        return (1.0 - square) / (1.0 + square)

    @property
    def blunt(self) -> float:
        """Rate over place beyond a stop, at which its damping has changed its sign [1/ms]."""
        return self.smooth * math.sqrt(self.stops.stiffness / self.inertia)


def stopped(model: Model, smooth: float) -> list[Stopped]:
    """All that has stops, by kind and name of the part; `smooth` is BLUNT of mechanics.gate."""
    found = []

    def add(
        name: str, joint: str, body: str, axis: Floats, own: StopsPart, begins: float, inertia: float
    ) -> None:
        found.append(Stopped(name, joint, joint == "pivot", body, axis, own, begins, inertia, smooth))

    for part in model.rollers:
        press, arm = part.press, part.arm
        if press is not None and press.stops is not None:
            mass, body = part.loaded_mass + press.carrier_mass, f"b_{part.name}_carrier"
            add(part.name, "slide", body, press.direction, press.stops, press.start, mass)
        if arm is not None and arm.stops is not None:
            add(part.name, "pivot", f"b_{part.name}_arm", part.axis, arm.stops, arm.angle, part.swung_inertia)
    for plate, press in model.plates:
        if press.stops is not None:
            mass, body = plate.sliding_mass, f"b_{plate.name}"
            add(plate.name, "slide", body, press.direction, press.stops, press.start, mass)
    for part, moving in model.gates:
        if moving.stops is not None:
            word, _ = joint_of(moving)
            add(part.name, word, f"b_{part.name}", moving.axis, moving.stops, 0.0, moving.inertia)
    return found


def stop_law(place: str, rate: str, ends: tuple[str, str], stiffness: str, share: str, blunt: str) -> str:
    """Force along a joint, or torque about it, as an expression of its place and rate: a spring beyond each
    end, times 1 + beta of the sign of the rate, which changes over the rate `blunt` times how far it is."""
    low, high = ends
    below, above = f"MAX(0,{low}-({place}))", f"MAX(0,{place}-({high}))"
    parts = []
    for sign, beyond, towards in (("", below, f"-({rate})"), ("-", above, rate)):
        over = f"({blunt}*{beyond}+{LEAST})"
        parts.append(f"{sign}{stiffness}*{beyond}*(1+{share}*STEP({towards}/{over},-1,-1,1,1))")
    return "".join(parts)
