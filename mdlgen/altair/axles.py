"""Motors, torque limiters, bearings and shafts, which no text says yet."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model
from mdlgen.model.tables.axle import FREE, LIMITER


def refuse_axles(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a roller that a motor turns, or a limiter, a bearing or a
    shaft acts on."""
    for roller in model.rollers:
        axle, path = roller.axle, ("rollers", roller.name)
        if roller.leader >= 0 or (axle is not None and axle.shaft):
            at = roller.leader if roller.leader >= 0 else roller.body
            leads = next(r for r in model.rollers if r.body == at)
            assert leads.axle is not None, "the one that leads has the shaft"
            raise RefusedError(
                f"{who}: shaft {leads.axle.shaft}, which couples {roller.name} to other rollers, is not "
                "written: no form of a coupler of joints is known; run it by mdlgen run",
                ("shafts", leads.axle.shaft),
            )
        if axle is None:
            continue
        word, key = ("limiter", "limiter") if axle.kind == LIMITER else ("motor", "drive")
        word, key = ("bearing", "bearing") if axle.kind == FREE else (word, key)
        raise RefusedError(
            f"{who}: the {word} of {roller.name} is not written: its torque over the speed is what the "
            "solvers alone have; run it by mdlgen run",
            (*path, key),
        )
