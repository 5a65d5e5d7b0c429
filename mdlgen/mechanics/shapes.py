"""Tables of data that do not fit into the record of a body or of a pair: meshes, rims in sectors, measured
friction, torques of motors, limiters and bearings."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.axle import NONE as NO_AXLES
from mdlgen.mechanics.axle import axle_table
from mdlgen.mechanics.measured import FRICTION
from mdlgen.mechanics.mesh_tables import Meshes, mesh_tables
from mdlgen.mechanics.pack import OWN, Units, pack_frictions
from mdlgen.mechanics.rim import rim_table
from mdlgen.model.tables import Floats, Model

NONE = np.zeros((0, FRICTION))


class Shapes(NamedTuple):
    """The meshes, the rims, the measured frictions and the axles of a Model for compiled code."""

    meshes: Meshes
    rims: Floats  # as in mechanics.rim, (pieces, PIECE)
    frictions: Floats = NONE  # as in mechanics.measured, one for each contact or none, (contacts, FRICTION)
    axles: Floats = NO_AXLES  # as in mechanics.axle, of rollers with a motor, a limiter or a bearing


def shape_tables(model: Model, units: Units = OWN) -> Shapes:
    """The Shapes of a Model, in a solver's units."""
    return Shapes(
        mesh_tables(model, units.mm),
        rim_table(model, units.mm),
        pack_frictions(model, units),
        axle_table(model, units.ms, units.mm),
    )
