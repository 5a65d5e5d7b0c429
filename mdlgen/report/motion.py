"""Where bodies are at stored states, as pictures and exports show them."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Floats, Ints, Model
from mdlgen.results.result import Result


def poses(result: Result, at: Ints) -> tuple[Floats, Floats]:
    """Centres [mm], (t, bodies, 3), and Euler parameters, scalar first, (t, bodies, 4), of all bodies at the
    stored states `at`.

    A solver need not tell how far a roller has turned, since nothing depends on it: here it is the
    integral of its speed over the stored states.
    """
    from scipy.spatial.transform import Rotation

    place, turn = result.position[at], result.rotation[at].copy()
    for roller in result.model.rollers:
        speed = result.spin[:, roller.body] @ roller.axis
        steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(result.time)
        angle = np.concatenate([[0.0], np.cumsum(steps)])[at]
        start = Rotation.from_matrix(result.model.bodies.rotation[roller.body])
        turned = Rotation.from_rotvec(angle[:, None] * roller.axis) * start
        turn[:, roller.body] = np.roll(turned.as_quat(), 1, axis=1)
    return place, turn


def start(model: Model) -> tuple[Floats, Floats]:
    """As `poses` where a run begins, (bodies, 3) and (bodies, 4)."""
    from scipy.spatial.transform import Rotation

    return model.bodies.position, np.roll(Rotation.from_matrix(model.bodies.rotation).as_quat(), 1, axis=1)
