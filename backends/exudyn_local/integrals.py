"""By what angles rollers with an axle are behind their shafts, and the integrals of speed control.

The angle of a roller is a coordinate, and that of its shaft a law of time: the integral of the error of the
speed is their difference. Where speed control asks for more than the limits of its motor at the end of a
step, the integral becomes what asks for these (anti-windup): the part that is given up is kept in `given_up`
of the System, which all that follows is counted from.
"""

from __future__ import annotations

import numpy as np

from mdlgen.backends.exudyn_local.system import MS, System
from mdlgen.mechanics.driven import prescribed, turned
from mdlgen.model.tables import Floats, Model
from mdlgen.model.tables.axle import CONTROLLED


def lags(model: Model, system: System, q: Floats, t: float) -> Floats:
    """By what angles rollers with an axle are behind their shafts, in their order [rad], (axles,)."""
    found = []
    rows, given_up = system.bodies.view(np.recarray), iter(system.given_up.tolist())
    for roller in model.rollers:
        if roller.axle is not None:
            at, own = int(system.bodies["spin"][roller.body]), next(given_up)
            shaft = turned.py_func(rows[roller.body], t) if roller.speed is not None else 0.0
            found.append(shaft - q[at] - own if at >= 0 else 0.0)
    return np.array(found)


class Integrals:
    """Those of a Model along a run."""

    def __init__(self, model: Model, system: System):
        """Begins a run: the integral of a motor that asks for more than it can give is what it can give."""
        axles = [(roller, roller.axle) for roller in model.rollers if roller.axle is not None]
        self._own = [
            (row, roller, axle)
            for row, (roller, axle) in enumerate(axles)
            if axle.kind == CONTROLLED and axle.integral > 0.0
        ]
        system.given_up[:] = 0.0
        for row, roller, axle in self._own:
            system.given_up[row] = -axle.begins_behind(float(roller.prescribed(0.0)))

    def hold(self, system: System, q: Floats, v: Floats, t: float) -> None:
        """Keeps the integrals within the limits of their motors at the end of a step [s]."""
        if not self._own:
            return
        rows = system.bodies.view(np.recarray)
        for row, roller, axle in self._own:
            at = int(system.bodies["spin"][roller.body])
            spin = float(v[at]) * MS
            low, high = axle.limits(np.array([spin]))
            by_rate = axle.proportional * (prescribed.py_func(rows[roller.body], t) * MS - spin)
            behind = turned.py_func(rows[roller.body], t) - q[at] - system.given_up[row]
            least, most = ((float(end[0]) - by_rate) / axle.integral for end in (low, high))
            system.given_up[row] += behind - min(max(behind, least), most)
