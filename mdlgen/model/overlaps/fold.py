"""Sheets that lie in themselves: no contact acts between two boxes of one sheet, so a run ends there.

A sheet can meet itself only where its normals turn by more than a right angle from their mean; until then
nothing else is looked at.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mdlgen.model.tables import Floats, Ints, Model, SheetPart

# Greatest depth of two boxes in each other, relative to the thinner one; less is round-off of a closed loop.
DEEP = 0.5


class Folds:
    """The sheets of a Model that bend, and whether one of them lies in itself at a state."""

    def __init__(self, model: Model, solved: NDArray[np.bool_] | None = None) -> None:
        """`solved` (bodies,): those whose places are known, of a scene that is halved by its symmetry."""
        self._model = model
        self._sheets: list[tuple[int, SheetPart, Ints]] = []
        for k, sheet in enumerate(model.sheets):
            boxes = np.arange(sheet.first, sheet.first + sheet.count)
            if solved is not None:
                boxes = boxes[solved[boxes]]
            if len(boxes) > 2:
                self._sheets.append((k, sheet, boxes))

    def found(
        self, position: Floats, rotation: Floats, time: float, there: NDArray[np.bool_] | None = None
    ) -> str | None:
        """Why a run cannot go on from places (n, 3) [mm] and rotations (n, 9) of bodies at a time [ms]; None:
        it can. `there` (sheets,): sheets that are, None: all."""
        for k, sheet, boxes in self._sheets:
            if there is not None and not there[k]:
                continue
            normals = rotation[boxes][:, 2::3]
            if not (normals @ normals.sum(axis=0) <= 0.0).any():
                continue
            two = self._meet(sheet, boxes, position, rotation)
            if two is not None:
                names = [self._model.bodies.name[body] for body in two]
                return (
                    f"sheet {sheet.name} lies in itself at {time:.6g} ms, box {names[0]} in box {names[1]}; "
                    "no contact holds a sheet apart from itself"
                )
        return None

    def _meet(
        self, sheet: SheetPart, boxes: Ints, position: Floats, rotation: Floats
    ) -> tuple[int, int] | None:
        """The two boxes that are the deepest in each other, None: none are."""
        from scipy.spatial import KDTree

        half = self._model.bodies.half[boxes]
        reach = 2.0 * float(np.linalg.norm(half, axis=1).max())
        pairs = KDTree(position[boxes]).query_pairs(reach, output_type="ndarray")
        # neighbours along the sheet overlap as it bends
        rows, columns = np.divmod(boxes - sheet.first, sheet.n_x)
        near = np.abs(rows[pairs[:, 0]] - rows[pairs[:, 1]]) * 2.0 * half[:, 1].min() <= _beside(half[:, 1:])
        near &= np.abs(columns[pairs[:, 0]] - columns[pairs[:, 1]]) * 2.0 * half[:, 0].min() <= _beside(
            half[:, ::2]
        )
        pairs = pairs[~near]
        if not len(pairs):
            return None
        one, two = boxes[pairs[:, 0]], boxes[pairs[:, 1]]
        least = self._model.bodies.half[:, 2]
        deep = overlaps(
            position[two] - position[one],
            rotation[one].reshape(-1, 3, 3),
            rotation[two].reshape(-1, 3, 3),
            self._model.bodies.half[one],
            self._model.bodies.half[two],
        ) / (2.0 * np.minimum(least[one], least[two]))
        worst = int(np.argmax(deep))
        return (int(one[worst]), int(two[worst])) if deep[worst] > DEEP else None


def _beside(half: Floats) -> float:
    """How far along a sheet boxes with half lengths (n, 2), along it and of its thickness, are neighbours:
    the next one, and as far as the sheet is thick."""
    return float(max(2.0 * half[:, 0].max(), 2.0 * half[:, 1].max())) * (1.0 + 1e-9)


def overlaps(gap: Floats, one: Floats, two: Floats, half_one: Floats, half_two: Floats) -> Floats:
    """How far blocks overlap, by the shortest way out, below zero where they are apart; (n,).

    gap: from the centre of block `one` to that of `two` (n, 3); axes in columns (n, 3, 3); half lengths.
    """
    ways = [one[:, :, i] for i in range(3)] + [two[:, :, i] for i in range(3)]
    ways += [np.cross(one[:, :, i], two[:, :, k]) for i in range(3) for k in range(3)]
    least = np.full(len(gap), np.inf)
    for way in ways:
        length = np.linalg.norm(way, axis=1)
        parallel = length < 1e-6  # such a way says no more than the axes do
        unit = way / np.where(parallel, 1.0, length)[:, None]
        reach = (np.abs(np.einsum("ni,nij->nj", unit, one)) * half_one).sum(axis=1)
        reach += (np.abs(np.einsum("ni,nij->nj", unit, two)) * half_two).sum(axis=1)
        apart = reach - np.abs(np.einsum("ni,ni->n", unit, gap))
        least = np.where(parallel, least, np.minimum(least, apart))
    return least
