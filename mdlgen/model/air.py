"""Air between sheets, and the outputs that do not have it."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_air(model: Model, who: str, why: str) -> None:
    """Raises RefusedError, by name and path, for a contact with air: `who` does not have it, and `why`."""
    for row, value in enumerate(model.contacts.air_viscosity.tolist()):
        if value > 0.0:
            one, two = model.contacts.part_a[row], model.contacts.part_b[row]
            raise RefusedError(
                f"{who}: the contact of {one} and {two} has air, {why}; "
                f"leave it out there: --set contacts.{model.contacts.called(row)}.air=null",
                ("contacts", int(model.contacts.entry[row]), "air"),
            )
