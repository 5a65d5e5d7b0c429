"""Momentum and energy of the sheets over time, from the states alone."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import GROUND, Floats
from mdlgen.results.result import Result


def momentum(result: Result) -> tuple[Floats, Floats]:
    """Linear [g mm/ms] and angular momentum about the origin [g mm^2/ms] of all boxes, (t, 3) each."""
    count = sum(sheet.count for sheet in result.model.sheets)
    mass = result.model.bodies.mass[:count, None]
    linear = (mass * result.velocity[:, :count]).sum(axis=1)
    angular = np.cross(result.position[:, :count], mass * result.velocity[:, :count]).sum(axis=1)
    turns = rotations(result.rotation[:, :count])
    inertia = result.model.bodies.inertia[:count]
    own = np.einsum("tbji,tbj->tbi", turns, result.spin[:, :count]) * inertia
    return linear, angular + np.einsum("tbij,tbj->ti", turns, own)


def energy(result: Result) -> Floats:
    """Kinetic plus elastic energy of all boxes [N mm], (t,); the bushings by the law that solvers share."""
    from mdlgen.mechanics.bushing import bushing

    count = sum(sheet.count for sheet in result.model.sheets)
    bodies, bushings = result.model.bodies, result.model.bushings
    turns = rotations(result.rotation[:, :count])
    body_spin = np.einsum("tbji,tbj->tbi", turns, result.spin[:, :count])
    total = 0.5 * np.einsum("b,tbi,tbi->t", bodies.mass[:count], *[result.velocity[:, :count]] * 2)
    total += 0.5 * np.einsum("bi,tbi->t", bodies.inertia[:count], body_spin**2)
    zero = (0.0, 0.0, 0.0)
    for row in range(len(bushings)):
        sides = [_side(result, turns, body, row) for body in (bushings.a[row], bushings.b[row])]
        k, kt = tuple(bushings.k[row, :3].tolist()), tuple(bushings.k[row, 3:].tolist())
        for t in range(len(result.time)):
            (xa, fa, ra), (xb, fb, rb) = (tuple(tuple(v[t].ravel().tolist()) for v in side) for side in sides)
            total[t] += bushing(xa, fa, zero, zero, ra, xb, fb, zero, zero, rb, k, kt, zero, zero)[3]
    return total


def rotations(parameters: Floats) -> Floats:
    """Rotation matrices (..., 3, 3) of Euler parameters (..., 4), scalar first."""
    w, x, y, z = np.moveaxis(parameters, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def _side(result: Result, turns: Floats, body: int, row: int) -> tuple[Floats, Floats, Floats]:
    """Centre, bushing frame and arm of one side of a bushing over time."""
    bodies, bushings = result.model.bodies, result.model.bushings
    origin, axes = bushings.origin[row], bushings.axes[row]
    times = len(result.time)
    if body == GROUND:
        held = np.broadcast_to(origin, (times, 3)), np.broadcast_to(axes, (times, 3, 3))
        return *held, np.zeros((times, 3))
    start = bodies.rotation[body]
    arm = start.T @ (origin - bodies.position[body])
    return result.position[:, body], turns[:, body] @ (start.T @ axes), turns[:, body] @ arm
