"""What texts have of motors, torque limiters and bearings, and which of them none can say."""

from __future__ import annotations

from itertools import pairwise

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model
from mdlgen.model.tables.axle import CONTROLLED, STEPPER, AxlePart


def pieces(axle: AxlePart) -> list[tuple[float, float]]:
    """Of a motor's curve: each speed, from 0 on, by which it is slower than without load [rad/ms], and by how
    much its torque grows more with that from there on than before [N mm ms/rad]."""
    slow, torque = axle.curve.T
    slopes = ((torque[1:] - torque[:-1]) / (slow[1:] - slow[:-1])).tolist()
    more = [slopes[0], *(b - a for a, b in pairwise(slopes))]
    return list(zip(slow[:-1].tolist(), more, strict=True))


def refuse_axles(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a motor with speed control, a stepper, and a shaft that
    couples rollers."""
    for roller in model.rollers:
        axle, path = roller.axle, ("rollers", roller.name, "drive", "motor")
        if roller.leader >= 0 or (axle is not None and axle.shaft):
            at = roller.leader if roller.leader >= 0 else roller.body
            leads = next(r for r in model.rollers if r.body == at)
            assert leads.axle is not None, "the one that leads has the shaft"
            raise RefusedError(
                f"{who}: shaft {leads.axle.shaft}, which couples {roller.name} to others by its torque, "
                "is not written: Altair's pages and files contradict each other on the sign of a coupler's "
                "ratio; give the shaft a prescribed speed, or run it by mdlgen run",
                ("shafts", leads.axle.shaft),
            )
        if axle is None:
            continue
        if axle.kind == CONTROLLED:
            raise RefusedError(
                f"{who}: the motor of {roller.name} has speed control, whose integral is held at limits "
                "from step to step: no expression says that; leave control out, or run it by mdlgen run",
                (*path, "control"),
            )
        if axle.kind == STEPPER:
            raise RefusedError(
                f"{who}: the motor of {roller.name} is a stepper, whose torque follows its angle over many "
                "turns: no page says how AZ continues beyond one; run it by mdlgen run",
                (*path, "steps"),
            )
