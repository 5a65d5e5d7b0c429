"""Air between sheets, which no text can say."""

from __future__ import annotations

from mdlgen.model import air
from mdlgen.model.tables import Model


def refuse_air(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a contact with air: its pressures follow from those of all
    boxes together."""
    air.refuse_air(model, who, "whose pressure no entity of MotionSolve has: it is one of all boxes")
