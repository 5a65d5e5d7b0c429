"""Parts and sheets that no contact separates: parts, sheets, and a sheet and itself. A run in which two of
them come to overlap ends."""

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
        self.solved, self._model = solved, model
        self._parts = Overlaps(model)
        self._sheets, self._folds = SheetOverlaps(model, solved), Folds(model, solved)

    def taken(
        self,
        comes: NDArray[np.bool_],
        there: NDArray[np.bool_],
        position: Floats,
        rotation: Floats,
        time: float,
    ) -> str | None:
        """Why one of the sheets that come in (sheets,) cannot: another one that is there, or comes, is in its
        place. None: none is."""
        for one in np.flatnonzero(comes).tolist():
            for other in np.flatnonzero(there | comes).tolist():
                if other == one or (comes[other] and other < one):
                    continue
                deep = self._sheets.in_each_other(one, other, position, rotation)
                if deep > 0.0:
                    names = [self._model.sheets[k].name for k in (one, other)]
                    return (
                        f"sheet {names[0]} comes in at {time:.6g} ms where sheet {names[1]} still is: they "
                        f"overlap by {deep:.3g} mm; let it come in later, or elsewhere"
                    )
        return None

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
