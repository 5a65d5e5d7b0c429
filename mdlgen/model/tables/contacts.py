"""Contacts between parts, and pairs of bodies that may touch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints
from mdlgen.model.tables.bodies import Frozen
from mdlgen.model.tables.frictions import Frictions

# kinds of contact
BOX_CYLINDER, BOX_PLANE, CYLINDER_CYLINDER, EXTERNAL, BOX_GUIDE, BOX_BOX, BOX_MESH = 0, 1, 2, 3, 4, 5, 6
CYLINDER_PLANE, CYLINDER_GUIDE, CYLINDER_MESH = 7, 8, 9
# those of a roller with a part that it does not turn with, and all between parts of the machine
ON_PARTS = (CYLINDER_PLANE, CYLINDER_GUIDE, CYLINDER_MESH)
OF_MACHINE = (CYLINDER_CYLINDER, *ON_PARTS)
# those of a sheet with a plate that has ends
ON_PLATES = (BOX_PLANE, BOX_GUIDE)


@dataclass(frozen=True)
class Contacts(Frozen):
    """One row per pair of parts in contact."""

    entry: Ints  # index in the spec's list, (n,)
    part_a: tuple[str, ...]  # sheet or roller
    part_b: tuple[str, ...]  # sheet, roller, plane, guide, mesh or external part
    kind: Ints  # one of the kinds above, BOX_CYLINDER to CYLINDER_MESH
    stiffness: Floats  # k [N/mm^1.5]
    restitution: Floats  # c_R
    mu_static: Floats
    mu_dynamic: Floats
    stiction_velocity: Floats  # [mm/ms]
    friction_velocity: Floats
    smoothing: Floats  # [mm/ms]
    rolling: Floats  # coefficient of rolling resistance
    share: tuple[str, ...]  # width or pair
    spread: Floats  # of a roller that faces another one: radius of the round its force is spread as [mm]; 0
    air_viscosity: Floats  # of the air between sheets [N ms/mm^2]; 0: none
    air_roughness: Floats  # [mm]
    sticking: Floats  # of two sheets: stiffness along the faces of one pair that sticks [N/mm]; 0: none
    name: tuple[str, ...] = ()  # of the entries that have one, "" of others; none where no entry has
    frictions: Frictions | None = None  # as measured; None: the coefficients are all there is

    def __len__(self) -> int:
        return len(self.part_a)

    def called(self, row: int) -> str:
        """The user's name of the entry of a row, or its index in the list."""
        return (self.name[row] if self.name else "") or str(self.entry[row])

    @property
    def of_machine(self) -> NDArray[np.bool_]:
        """True where both parts are of the machine, (n,)."""
        return np.isin(self.kind, OF_MACHINE)


@dataclass(frozen=True)
class Pairs(Frozen):
    """Body pairs that may touch, and the bounds from which that was decided."""

    contact: Ints  # row of Contacts, (n,)
    a: Ints  # box or roller, (n,)
    b: Ints  # roller, plane, guide, mesh or box of another sheet, (n,)
    possible: int
    margin: float  # [mm]
    low: Floats  # bounds of the centres of boxes and what is pressed, -inf: not watched [mm], (bodies, 3)
    high: Floats
    searched: Ints  # rows of Contacts between two sheets that can meet in too many pairs to list, (rows,)

    def __len__(self) -> int:
        return len(self.a)


@dataclass(frozen=True)
class ExternalPairs(Frozen):
    """Boxes and the external parts that they may touch; all there are, since none can be left out."""

    contact: Ints  # row of Contacts, (n,)
    box: Ints  # body, (n,)
    part: Ints  # index in Model.externals, (n,)

    def __len__(self) -> int:
        return len(self.box)
