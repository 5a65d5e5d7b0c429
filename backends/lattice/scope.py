"""Checks that this solver can represent a Model, without importing compiled code."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.mechanics.solved import refuse_unsolved
from mdlgen.model.external import refuse_externals
from mdlgen.model.meshes import check_balance
from mdlgen.model.still import refuse_moving
from mdlgen.model.tables import BOX_BOX, Model
from mdlgen.model.yielding import refuse_static_yield


def refuse_passing_yield(model: Model) -> None:
    """Raises RefusedError where sheets come in or leave, and one yields: hinges are those of all sheets."""
    late = next((sheet.name for sheet in model.sheets if sheet.passes), None)
    if late is not None and len(model.plastic):
        raise RefusedError(
            f"lattice: {late} comes in or leaves during the run, which does not go with a material that "
            "yields; leave yield out",
            ("sheets", late),
        )


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that this solver cannot represent."""
    refuse_externals(model, "lattice")
    refuse_unsolved(model, "lattice")
    check_balance(model)
    refuse_static_yield(model, "lattice")
    refuse_moving(model, "lattice")
    refuse_passing_yield(model)
    if model.run.analysis == "static" and any(roller.speed for roller in model.rollers):
        # a driven roller slips on the bodies that it touches, and a static run has no friction of motion
        raise RefusedError(
            "lattice: a static analysis with driven rollers is not there yet", ("run", "analysis")
        )
    if model.run.analysis == "static" and bool((model.contacts.kind == BOX_BOX).any()):
        raise RefusedError(
            "lattice: a static analysis with a contact between two sheets is not there yet",
            ("run", "analysis"),
        )
    for roller in model.rollers:
        if roller.arm is not None and model.run.analysis == "static":
            raise RefusedError(
                f"lattice: a static analysis with an arm ({roller.name}) is not there yet",
                ("rollers", roller.name, "arm"),
            )
        if roller.press is not None and abs(float(roller.press.direction @ roller.axis)) > 1e-9:
            raise RefusedError(
                f"lattice: roller {roller.name} is pressed along its own axis, which is not modelled",
                ("rollers", roller.name, "press"),
            )
    if bool(model.bodies.fixed[: sum(s.count for s in model.sheets)].all()) and not (
        model.rollers or model.plates or any(moving.free for _, moving in model.gates)
    ):
        raise RefusedError("lattice: nothing in this scene can move")
