"""Poisson's effect, which no text can say."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_poisson(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a sheet with Poisson's effect: a bushing has the forces of
    its own two bodies alone, and each corner couples up to four."""
    if len(model.corners):
        name = model.sheets[int(model.corners.sheet[0])].name
        raise RefusedError(
            f"{who}: the material of sheet {name} has poisson, which couples bushings with each other, as no "
            "entity of MotionSolve does; run it with lattice or exudyn, or leave poisson out",
            ("sheets", name, "material"),
        )
