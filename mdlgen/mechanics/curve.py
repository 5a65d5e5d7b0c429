"""The spring of a joint that follows a measured curve: monotone cubics between points, odd, exact in energy.

A joint is a record with, among others, the fields of FOLLOWS; `points` is an array of POINT. Its own axis
`way` has the force area * stress(elongation / length) in place of k times the elongation.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.vector import (
    add,
    back,
    cross,
    exp_rotation,
    log_rotation,
    mat,
    matmul,
    nine,
    rotate,
    scale,
    sub,
    three,
    transpose_matmul,
    vec,
)
from mdlgen.model.tables import Curves, Ints
from mdlgen.program.kernel import njit

POINT = np.dtype([("strain", "f8"), ("stress", "f8"), ("slope", "f8"), ("energy", "f8")])
FOLLOWS = [
    ("first", "i8"),  # first of its points, -1: a linear spring
    ("last", "i8"),
    ("row", "i8"),  # row of the Model's bushings
    ("way", "i8"),
    ("length", "f8"),
    ("area", "f8"),
    ("rise", "f8"),  # slope beyond the last point
    ("refuses", "i8"),  # may not go there
]


def curve_points(curves: Curves, stress: float = 1.0) -> np.ndarray:
    """All points as records, stresses times `stress`."""
    points = np.zeros(len(curves.strain), POINT)
    points["strain"] = curves.strain
    for name in ("stress", "slope", "energy"):
        points[name] = stress * getattr(curves, name)
    return points


def follow(joints: np.ndarray, curves: Curves, rows: Ints, length: float = 1.0, stress: float = 1.0) -> None:
    """Fills the fields FOLLOWS of joints that are the bushings `rows`; factors are of units."""
    of = curves.of[rows]
    joints["first"], joints["row"] = -1, rows
    bent = of >= 0
    number = of[bent]
    for name, values in (
        ("first", curves.start[number]),
        ("last", curves.start[number + 1] - 1),
        ("way", curves.axis[rows][bent]),
        ("length", length * curves.length[rows][bent]),
        ("area", length**2 * curves.area[rows][bent]),
        ("rise", stress * curves.rise[number]),
        ("refuses", ~curves.linear[number]),
    ):
        joints[name][bent] = values


@njit(cache=True, error_model="numpy")
def curve_spring(points, joint, elongation):
    """(force, its derivative by the elongation, stored energy) of a joint that follows a curve."""
    strain = abs(elongation) / joint.length
    low, high = joint.first, joint.last
    end = points[high]
    if strain >= end.strain:
        more = strain - end.strain
        stress, slope = end.stress + joint.rise * more, joint.rise
        energy = end.energy + more * (end.stress + 0.5 * joint.rise * more)
    else:
        while high - low > 1:
            middle = (low + high) // 2
            if points[middle].strain <= strain:
                low = middle
            else:
                high = middle
        a, b = points[low], points[high]
        h = b.strain - a.strain
        t = (strain - a.strain) / h
        # stress = y + t (m + t (c + t d)) with these, over the piece
        m, rise = h * a.slope, b.stress - a.stress
        c, d = 3.0 * rise - 2.0 * m - h * b.slope, m + h * b.slope - 2.0 * rise
        stress = a.stress + t * (m + t * (c + t * d))
        slope = (m + t * (2.0 * c + 3.0 * t * d)) / h
        energy = a.energy + h * t * (a.stress + t * (m / 2.0 + t * (c / 3.0 + t * d / 4.0)))
    force = math.copysign(joint.area * stress, elongation)
    return force, joint.area * slope / joint.length, joint.area * joint.length * energy


@njit(cache=True, error_model="numpy")
def curve_excess(points, joint, middle, gap, ra, rb):
    """Excess force of a bushing with a curve over one that has the linear spring k along its axis.

    Args: middle frame and gap of the bushing, and both arms (global), as in `bushing`. Returns (force on b,
    torque on b, torque on a, stored energy).
    """
    way = joint.way
    axis = (middle[way], middle[3 + way], middle[6 + way])
    elongation = axis[0] * gap[0] + axis[1] * gap[1] + axis[2] * gap[2]
    spring, _, energy = curve_spring(points, joint, elongation)
    k = joint.k[way]
    force = scale(k * elongation - spring, axis)
    torque_b = cross(sub(rb, scale(0.5, gap)), force)
    torque_a = scale(-1.0, cross(add(ra, scale(0.5, gap)), force))
    return force, torque_b, torque_a, energy - 0.5 * k * elongation * elongation


@njit(cache=True, error_model="numpy")
def middle_and_gap(xa, fa, ra, xb, fb, rb):
    """Frame halfway between two bushing frames, and the vector from one attachment to the other (global)."""
    theta = log_rotation(transpose_matmul(fa, fb))
    return matmul(fa, exp_rotation(scale(0.5, theta))), sub(add(xb, rb), add(xa, ra))


@njit(cache=True, error_model="numpy")
def overstretched(points, joints, x, r):
    """(joint, strain) furthest beyond the last point of a curve that may not be exceeded; joint -1: none.

    x, r: centres and rotations of the bodies; the last one is the ground.
    """
    worst, most, strain = -1, 0.0, 0.0
    for j in range(joints.size):
        joint = joints[j]
        if joint.first < 0 or joint.refuses == 0:
            continue
        a, b = joint.a if joint.a >= 0 else x.shape[0] - 1, joint.b
        ma, mb = mat(r, a), mat(r, b)
        fa, fb = matmul(ma, nine(joint.fa)), matmul(mb, nine(joint.fb))
        ra, rb = rotate(ma, three(joint.ra)), rotate(mb, three(joint.rb))
        middle, gap = middle_and_gap(vec(x, a), fa, ra, vec(x, b), fb, rb)
        own = back(middle, gap)
        now = (own[0] if joint.way == 0 else own[1]) / joint.length
        # round-off of a joint at the last point does not count as beyond it
        more = abs(now) / points[joint.last].strain - 1.0
        if more > 1e-9 and not more <= most:
            worst, most, strain = j, more, now
    return worst, strain
