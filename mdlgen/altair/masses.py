"""Masses of bodies as texts have them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.model.tables import Floats, MachinePart, Model, MovingPart


class Masses(NamedTuple):
    """Of all bodies: mass [g], inertia about the axes of each [g mm^2], and where its middle is [mm]."""

    mass: Floats  # (n,)
    inertia: Floats  # (n, 3)
    place: Floats  # (n, 3)


def masses(model: Model) -> Masses:
    """Those of the Model, with what moves with a body: the rotor of a roller's motor, behind the gear; all
    that slides with a part, or turns with it about a pivot, as a ball about its centre of mass."""
    mass, inertia = model.bodies.mass.copy(), model.bodies.inertia.copy()
    place = model.bodies.position.copy()
    for roller in model.rollers:
        if roller.axle is not None:
            inertia[roller.body, 2] += roller.axle.inertia
    for part, moving in model.gates:
        if moving.free and not moving.turns:
            mass[part.body] = moving.inertia
        elif moving.free:
            inertia[part.body] = own_inertia(model, part, moving)
            place[part.body] = moving.pivot + moving.moment / mass[part.body]
    return Masses(mass, inertia, place)


def own_inertia(model: Model, part: MachinePart, moving: MovingPart) -> float:
    """Of what turns freely about a pivot, about an axis through its centre of mass [g mm^2]: below 0 where
    its mass that far from the pivot has more than is given."""
    mass = float(model.bodies.mass[part.body])
    arm = np.cross(moving.axis, moving.moment / mass)
    return moving.inertia - mass * float(arm @ arm)
