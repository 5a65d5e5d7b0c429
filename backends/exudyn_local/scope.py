"""Checks that this solver can represent a Model."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.external import refuse_externals
from mdlgen.model.sheet_pairs import refuse_searched
from mdlgen.model.sticking import refuse_sticking
from mdlgen.model.still import refuse_moving
from mdlgen.model.tables import BOX_BOX, Model
from mdlgen.model.yielding import refuse_static_yield


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that it cannot represent."""
    refuse_externals(model, "Exudyn")
    refuse_sticking(model, "Exudyn", kinds=(BOX_BOX,))
    refuse_searched(model, "Exudyn")
    refuse_static_yield(model, "Exudyn")
    refuse_moving(model, "Exudyn")
    refuse_with_passing(model)


def refuse_with_passing(model: Model) -> None:
    """Raises RefusedError for what parts of a run do not carry over: air and hinges."""
    for name, there in (
        ("air between sheets", bool((model.contacts.air_viscosity > 0.0).any())),
        ("a material that yields", bool(len(model.plastic))),
        ("a sheet that leaves at rest", any(sheet.out_at_rest for sheet in model.sheets)),
    ):
        if there and any(sheet.passes for sheet in model.sheets):
            who = next(sheet.name for sheet in model.sheets if sheet.passes)
            raise RefusedError(
                f"Exudyn: {who} comes in or leaves during the run, which does not go with {name}",
                ("sheets", who),
            )
