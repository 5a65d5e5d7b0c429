"""What texts have of guides, planes and meshes that move, and which of them none can say yet."""

from __future__ import annotations

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import Floats, Model, MovingPart

DISPLACED = "DISP"  # what is prescribed of their joints


def joint_of(moving: MovingPart) -> tuple[str, str]:
    """What a joint is called behind the name of the part, and its type."""
    return ("pivot", "REVOLUTE") if moving.turns else ("slide", "TRANSLATIONAL")


def places(moving: MovingPart, times: Floats) -> Floats:
    """Angles [rad] or places [mm] of what a profile moves at times [ms]: by 3 s^2 - 2 s^3 between corners."""
    at, place = moving.corners[:, 0], moving.corners[:, 1]
    found = np.full(np.shape(times), place[0])
    for k in range(len(at) - 1):
        s = np.clip((times - at[k]) / (at[k + 1] - at[k]), 0.0, 1.0)
        found = found + (place[k + 1] - place[k]) * s * s * (3.0 - 2.0 * s)
    return found


def refuse_moving(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a part that forces move, and for stops."""
    for part, moving in model.gates:
        if moving.free:
            word, key = ("pivot", "inertia") if moving.turns else ("slide", "mass")
            raise RefusedError(
                f"{who}: {part.name} moves freely about or along its {word}, which is not written yet; run "
                f"it locally, or give the {word} a profile in place of {key}",
                (kind_of(part).table, part.name, word, key),
            )
    for part in model.stopped:
        word = "arm" if part.press is None else "press"
        raise RefusedError(
            f"{who}: the {word} of {part.name} has stops, which are not written yet. Run it locally, or "
            "leave the stops out",
            (kind_of(part).table, part.name, word, "stops"),
        )
