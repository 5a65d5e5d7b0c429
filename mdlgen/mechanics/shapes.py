"""Shapes that take more than a body's record: meshes, and rims in sectors."""

from __future__ import annotations

from typing import NamedTuple

from mdlgen.mechanics.mesh_tables import Meshes, mesh_tables
from mdlgen.mechanics.rim import rim_table
from mdlgen.model.tables import Floats, Model


class Shapes(NamedTuple):
    """The meshes and the rims of a Model for compiled code."""

    meshes: Meshes
    rims: Floats  # as in mechanics.rim, (pieces, PIECE)


def shape_tables(model: Model, mm: float = 1.0) -> Shapes:
    """Of a Model; `mm` is a millimetre in the solver's unit."""
    return Shapes(mesh_tables(model, mm), rim_table(model, mm))
