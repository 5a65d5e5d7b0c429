"""Which contacts have a rolling resistance that acts, and the outputs that cannot say it."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import BOX_CYLINDER, BOX_MESH, OF_MACHINE, Model


def rolls(model: Model, row: int) -> bool:
    """Whether a part of a contact is a roller, or a mesh on one."""
    kind = int(model.contacts.kind[row])
    if kind == BOX_MESH:
        return any(m.name == model.contacts.part_b[row] and m.on >= 0 for m in model.meshes)
    return kind == BOX_CYLINDER or kind in OF_MACHINE


def refuse_rolling(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a contact whose rolling resistance acts: no entity with a
    documented form is known for a couple that follows a normal force."""
    for row, value in enumerate(model.contacts.rolling.tolist()):
        if value > 0.0 and rolls(model, row):
            one, two = model.contacts.part_a[row], model.contacts.part_b[row]
            raise RefusedError(
                f"{who}: the contact of {one} and {two} has a rolling_resistance of {value:g}, a couple that "
                "follows the normal force, and no statement with a documented meaning says that; run it "
                "locally, or leave rolling_resistance out",
                ("contacts", int(model.contacts.entry[row]), "rolling_resistance"),
            )
