"""Check for contacts without a law in the solvers."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.mechanics.pair import WITH_LAW
from mdlgen.model.tables import EXTERNAL, Model


def refuse_unsolved(model: Model, who: str) -> None:
    """Raises RefusedError, with the name, for a contact of a kind that has no law."""
    table = model.contacts
    for row, kind in enumerate(table.kind.tolist()):
        if kind not in WITH_LAW and kind != EXTERNAL:
            raise RefusedError(
                f"{who}: there is no law yet for the contact of {table.part_a[row]} and {table.part_b[row]}",
                ("contacts", int(table.entry[row])),
            )
