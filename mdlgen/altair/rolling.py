"""Rolling resistance, which no text can say."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.rolling import rolls
from mdlgen.model.tables import Model


def refuse_rolling(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a contact whose rolling resistance acts: no entity with a
    documented form is known for a couple that follows a normal force."""
    for row, value in enumerate(model.contacts.rolling.tolist()):
        if value > 0.0 and rolls(model, row):
            one, two = model.contacts.part_a[row], model.contacts.part_b[row]
            raise RefusedError(
                f"{who}: the contact of {one} and {two} has a rolling_resistance of {value:g}, a couple that "
                "follows the normal force; it needs the index of that force in the function CONTACT, which "
                "stands in a part of Altair's page contact.htm that could not be read; run it locally, or "
                "leave rolling_resistance out",
                ("contacts", int(model.contacts.entry[row]), "rolling_resistance"),
            )
