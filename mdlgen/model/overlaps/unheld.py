"""What no contact holds apart: parts, sheets, and a sheet and itself. A run in which two of them come to
overlap ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mdlgen.model.overlaps.fold import Folds
from mdlgen.model.overlaps.parts import Overlaps
from mdlgen.model.overlaps.sheets import SheetOverlaps
from mdlgen.model.tables import Floats, Model


class Unheld:
    """All such pairs of a Model."""

    def __init__(self, model: Model, solved: NDArray[np.bool_] | None = None) -> None:
        """`solved` (bodies,): those whose places are known, of a scene that is halved by its symmetry."""
        self.solved = solved
        self._parts = Overlaps(model)
        self._sheets, self._folds = SheetOverlaps(model, solved), Folds(model, solved)

    def in_each_other(self, one: int, two: int, position: Floats, rotation: Floats) -> float:
        """How deep two sheets, by their numbers, are in each other [mm]; 0: no more than contacts press
        them."""
        return self._sheets.in_each_other(one, two, position, rotation)

    def found(
        self, position: Floats, rotation: Floats, time: float, there: NDArray[np.bool_] | None = None
    ) -> str | None:
        """Why a run cannot go on from places (n, 3) [mm] and rotations (n, 9) of bodies at a time [ms]; None:
        it can. `there` (sheets,): sheets that are, None: all."""
        return (
            self._parts.found(position, time)
            or self._sheets.found(position, rotation, time, there)
            or self._folds.found(position, rotation, time, there)
        )
