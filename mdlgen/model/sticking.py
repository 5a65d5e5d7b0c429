"""Friction that sticks, and the outputs that do not have it."""

from __future__ import annotations

from collections.abc import Container

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_sticking(model: Model, who: str, kinds: Container[int] | None = None) -> None:
    """Raises RefusedError, by name and path, for a contact whose friction sticks: `who` does not have it.

    kinds: of contacts that are refused (model.tables.contacts), None: all.
    """
    for row, value in enumerate(model.contacts.sticking.tolist()):
        if value > 0.0 and (kinds is None or int(model.contacts.kind[row]) in kinds):
            one, two = model.contacts.part_a[row], model.contacts.part_b[row]
            raise RefusedError(
                f"{who}: the contact of {one} and {two} has friction that sticks, which it does not have; "
                "run it with lattice, or leave friction.sticking out",
                ("contacts", int(model.contacts.entry[row]), "friction", "sticking"),
            )
