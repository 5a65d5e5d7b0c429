"""Rollers on arms that pivot: their motion with the rotation of the arm, and the torques on it.

The unknown of such a roller's slide is the angle of its arm. A free roller's spin is counted against ground;
a driven one's drive is against the arm, with which the roller turns. A body record has `swings`, 1 where it
is on an arm and 2 where it is also driven (0: its slide, if any, is straight; beyond 2: see mechanics.gate);
`pivot`, a point of the arm's axis; `turn`, that axis; and `hang`, the arm's own mass times the vector from
the pivot to its centre of mass, as the run begins. Its `press` has torsional stiffness and damping, the
torque at the angle 0, and the moment of inertia of all bodies that turn about the pivot.
"""

from __future__ import annotations

import numpy as np

from mdlgen.mechanics.driven import prescribed
from mdlgen.mechanics.vector import add, cross, dot, exp_rotation, rotate, scale, sub, three
from mdlgen.model.rotations import matrices
from mdlgen.model.tables import RollerPart
from mdlgen.program.kernel import njit

# Columns of a body record's `press`: stiffness and damping of a slide or an arm, its force or torque at the
# start, the mass or the inertia that it moves, and the roller's inertia about its own axis.
STIFFNESS, DAMPING, FORCE_0, INERTIA, AXIAL, PRESS = 0, 1, 2, 3, 4, 5
ARM = [("swings", "i8"), ("pivot", "f8", 3), ("turn", "f8", 3), ("hang", "f8", 3)]


def arm(row: np.void, roller: RollerPart, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> None:
    """Fills the fields of ARM and `press` of a body record for a roller; the factors are a millimetre, a gram
    and a millisecond in the solver's units, where a newton stays one."""
    part = roller.arm
    if part is None:
        return
    row["swings"] = 1 if roller.speed is None else 2
    row["pivot"], row["turn"] = part.pivot * length, roller.axis
    hang = part.center - part.pivot
    if part.angle != 0.0:  # angles of a run are from where it begins
        hang = matrices(part.angle * roller.axis[None])[0] @ hang
    row["hang"] = part.mass * mass * hang * length
    inertia = roller.swung_inertia * mass * length**2
    row["press"][:AXIAL] = (
        part.stiffness * length,
        part.damping * length * time,
        (part.torque - part.stiffness * part.angle) * length,
        inertia,
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def way_of(body, x):
    """Velocity of a roller at x per unit rate of its slide: along it, or round the pivot of its arm."""
    if body.swings == 0:
        return three(body.way)
    return cross(three(body.turn), sub(x, three(body.pivot)))


@njit(cache=True, error_model="numpy", forceinline=True)
def turn_of(body):
    """Angular velocity of a roller per unit rate of its slide."""
    return three(body.turn) if body.swings == 2 else (0.0, 0.0, 0.0)


@njit(cache=True, error_model="numpy", forceinline=True)
def moved(body, x, amount):
    """Place of a roller, now at x, after its slide has moved by an amount."""
    if body.swings == 0:
        return add(x, scale(amount, three(body.way)))
    pivot = three(body.pivot)
    return add(pivot, rotate(exp_rotation(scale(amount, three(body.turn))), sub(x, pivot)))


@njit(cache=True, error_model="numpy")
def hung(body, angle, gravity):
    """Potential energy of the weight of an arm itself at its angle, relative to its pivot."""
    return -dot(rotate(exp_rotation(scale(angle, three(body.turn))), three(body.hang)), gravity)


@njit(cache=True, error_model="numpy")
def torque_of(body, angle, gravity, t, h):
    """Torque about the pivot, on the unknown of the slide: of the arm's own weight, and of the acceleration
    of a driven roller from t - h to t + h."""
    at = rotate(exp_rotation(scale(angle, three(body.turn))), three(body.hang))
    torque = dot(three(body.turn), cross(at, gravity))
    return torque - speeding(body, t, h)


@njit(cache=True, error_model="numpy")
def speeding(body, t, h):
    """Torque that accelerates a driven roller, on average from t - h to t + h."""
    if body.swings != 2:
        return 0.0
    return body.press[AXIAL] * (prescribed(body, t + h) - prescribed(body, t - h)) / (2.0 * h)
