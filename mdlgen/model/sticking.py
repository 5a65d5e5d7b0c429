"""Friction that sticks, and the outputs that do not have it."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_sticking(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a contact whose friction sticks: `who` does not have it."""
    for row, value in enumerate(model.contacts.sticking.tolist()):
        if value > 0.0:
            one, two = model.contacts.part_a[row], model.contacts.part_b[row]
            raise RefusedError(
                f"{who}: the contact of {one} and {two} has friction that sticks, which it does not have; "
                "run it with lattice, or leave friction.sticking out",
                ("contacts", int(model.contacts.entry[row]), "friction", "sticking"),
            )
