"""Poses of bodies at stored states, as pictures and exports show them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model.rotations import euler_parameters, matrices
from mdlgen.model.tables import Floats, Ints, Model
from mdlgen.report.meshes import on_arms

if TYPE_CHECKING:
    from mdlgen.results.result import Result


def poses(result: Result, at: Ints) -> tuple[Floats, Floats]:
    """Centres [mm], (t, bodies, 3), and Euler parameters, scalar first, (t, bodies, 4), of all bodies at the
    stored states `at`; after the bodies come arms.

    A solver need not give how far a roller has turned, since nothing depends on it: here it is the
    integral of its speed over the stored states.
    """
    place, turn = result.position[at], result.rotation[at].copy()
    for roller in result.model.rollers:
        speed = result.spin[:, roller.body] @ roller.axis
        steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(result.time)
        angle = np.concatenate([[0.0], np.cumsum(steps)])[at]
        start = result.model.bodies.rotation[roller.body]
        turn[:, roller.body] = euler_parameters(matrices(angle[:, None] * roller.axis) @ start)
    return _with_arms(result.model, place, turn)


def start(model: Model) -> tuple[Floats, Floats]:
    """As `poses` where a run begins, (bodies, 3) and (bodies, 4)."""
    turn = euler_parameters(model.bodies.rotation)
    place, turn = _with_arms(model, model.bodies.position[None], turn[None])
    return place[0], turn[0]


def names(model: Model) -> list[str]:
    """Names of what `poses` gives the place of."""
    return [*model.bodies.name, *(f"{roller.name}_arm" for roller in on_arms(model))]


def _with_arms(model: Model, place: Floats, turn: Floats) -> tuple[Floats, Floats]:
    """Poses with those of arms, which follow from their rollers': at the pivot, level with the roller's
    middle, x to the roller's axis and z along it."""
    for roller in on_arms(model):
        assert roller.arm is not None
        way = place[:, roller.body] - roller.arm.pivot
        level = (way @ roller.axis)[:, None] * roller.axis
        x = (way - level) / np.linalg.norm(way - level, axis=1)[:, None]
        z = np.broadcast_to(roller.axis, x.shape)
        axes = np.stack([x, np.cross(z, x), z], axis=2).astype(float)
        turned = euler_parameters(axes)
        place = np.concatenate([place, (roller.arm.pivot + level)[:, None]], axis=1)
        turn = np.concatenate([turn, turned[:, None]], axis=1)
    return place, turn
