"""Sheets that yield, and the outputs and analyses that do not have that."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_yield(model: Model, who: str) -> None:
    """Raises RefusedError, by the name of the sheet, where one yields: `who` has elastic bushings alone."""
    if len(model.plastic):
        raise RefusedError(
            f"{who}: the material of {_first(model)} has a yield curvature, and bushings are elastic there; "
            "run it with lattice or exudyn, or leave yield out",
            _path(model),
        )


def refuse_static_yield(model: Model, who: str) -> None:
    """Raises RefusedError for a static analysis of a sheet that yields: what it comes to depends on the way
    there."""
    if len(model.plastic) and model.run.analysis == "static":
        raise RefusedError(
            f"{who}: a static analysis of a sheet that yields ({_first(model)}) is not there: where it comes "
            "to rest depends on the way there; give run.analysis: transient",
            ("run", "analysis"),
        )


def _path(model: Model) -> tuple[str | int, ...]:
    """Path of the key in the scene."""
    name = _first(model)
    found = (row.path for row in model.parameters if row.data_set == name and row.path)
    return next(((*path[:2], "yield") for path in found if path[0] == "materials"), ())


def _first(model: Model) -> str:
    """The first sheet that yields."""
    return model.sheets[int(model.bushings.sheet[model.plastic.bushing[0]])].name
