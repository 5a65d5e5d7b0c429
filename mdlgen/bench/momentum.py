"""Momentum and energy of the sheets over time, from the states alone."""

from __future__ import annotations

import numpy as np

from mdlgen.model.rotations import turns
from mdlgen.model.tables import GROUND, Floats
from mdlgen.results.result import Result


def momentum(result: Result) -> tuple[Floats, Floats]:
    """Linear [g mm/ms] and angular momentum about the origin [g mm^2/ms] of all boxes, (t, 3) each."""
    count = sum(sheet.count for sheet in result.model.sheets)
    mass = result.model.bodies.mass[:count, None]
    linear = (mass * result.velocity[:, :count]).sum(axis=1)
    angular = np.cross(result.position[:, :count], mass * result.velocity[:, :count]).sum(axis=1)
    turned = turns(result.rotation[:, :count])
    inertia = result.model.bodies.inertia[:count]
    own = np.einsum("tbji,tbj->tbi", turned, result.spin[:, :count]) * inertia
    return linear, angular + np.einsum("tbij,tbj->ti", turned, own)


def energy(result: Result) -> Floats:
    """Kinetic plus elastic energy of all boxes [N mm], (t,); the bushings by the law that solvers share. It
    holds for sheets without poisson."""
    from mdlgen.mechanics.bushing import bushing
    from mdlgen.mechanics.frame import Frame

    count = sum(sheet.count for sheet in result.model.sheets)
    bodies, bushings = result.model.bodies, result.model.bushings
    turned = turns(result.rotation[:, :count])
    body_spin = np.einsum("tbji,tbj->tbi", turned, result.spin[:, :count])
    total = 0.5 * np.einsum("b,tbi,tbi->t", bodies.mass[:count], *[result.velocity[:, :count]] * 2)
    total += 0.5 * np.einsum("bi,tbi->t", bodies.inertia[:count], body_spin**2)
    zero = (0.0, 0.0, 0.0)
    for row in range(len(bushings)):
        sides = [_side(result, turned, body, row) for body in (bushings.a[row], bushings.b[row])]
        k, kt = tuple(bushings.k[row, :3].tolist()), tuple(bushings.k[row, 3:].tolist())
        for t in range(len(result.time)):
            (xa, fa, ra), (xb, fb, rb) = (tuple(tuple(v[t].ravel().tolist()) for v in side) for side in sides)
            a, b = Frame(xa, fa, zero, zero), Frame(xb, fb, zero, zero)
            total[t] += bushing(a, ra, b, rb, k, kt, zero, zero)[3]
    return total


def _side(result: Result, turned: Floats, body: int, row: int) -> tuple[Floats, Floats, Floats]:
    """Centre, bushing frame and arm of one side of a bushing over time."""
    bodies, bushings = result.model.bodies, result.model.bushings
    origin, axes = bushings.origin[row], bushings.axes[row]
    times = len(result.time)
    if body == GROUND:
        held = np.broadcast_to(origin, (times, 3)), np.broadcast_to(axes, (times, 3, 3))
        return *held, np.zeros((times, 3))
    start = bodies.rotation[body]
    arm = start.T @ (origin - bodies.position[body])
    return result.position[:, body], turned[:, body] @ (start.T @ axes), turned[:, body] @ arm
