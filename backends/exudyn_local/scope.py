"""What this solver can represent."""

from __future__ import annotations

from mdlgen.model.external import refuse_externals
from mdlgen.model.sheet_pairs import refuse_searched
from mdlgen.model.sticking import refuse_sticking
from mdlgen.model.still import refuse_moving
from mdlgen.model.tables import BOX_BOX, Model
from mdlgen.model.yielding import refuse_static_yield


def check(model: Model) -> None:
    """Raises RefusedError by name for what it cannot."""
    refuse_externals(model, "Exudyn")
    refuse_sticking(model, "Exudyn", kinds=(BOX_BOX,))
    refuse_searched(model, "Exudyn")
    refuse_static_yield(model, "Exudyn")
    refuse_moving(model, "Exudyn")
