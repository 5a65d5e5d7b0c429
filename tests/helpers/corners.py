"""How far the corners of neighbouring boxes of a Result are apart, which coincide in a flat sheet."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from mdlgen.model.tables import Floats
from mdlgen.results.result import Result


class Gaps(NamedTuple):
    """Distances [mm] of corners in the mid-plane that neighbours share, at each stored time (times, corners).

    `step` is the part across the sheet, along the mean of both boxes' normals, `opening` the rest; `twist` is
    half of the shared side times the angle [rad] by which the boxes twist against each other, about the line
    from one to the next.
    """

    opening: Floats
    step: Floats
    twist: Floats

    def widest(self) -> float:
        """The greatest distance over boxes and time [mm]."""
        return float(np.hypot(self.opening, self.step).max())


def gaps(result: Result, index: int = 0) -> Gaps:
    """Of the sheet `index`, whose boxes are all alike."""
    sheet = result.model.sheets[index]
    members = slice(sheet.first, sheet.first + sheet.count)
    grid = (len(result.time), sheet.n_y, sheet.n_x)
    center = result.position[:, members].reshape(*grid, 3)
    turn = Rotation.from_quat(np.roll(result.rotation[:, members], -1, axis=2).reshape(-1, 4))
    frame = turn.as_matrix().reshape(*grid, 3, 3)
    half = result.model.bodies.half[sheet.first]
    columns: list[list[Floats]] = [[], [], []]
    for along in (0, 1):
        first = (..., slice(None, -1)) if along == 0 else (slice(None), slice(None, -1))
        second = (..., slice(1, None)) if along == 0 else (slice(None), slice(1, None))
        one, two = (_picked(frame, pick) for pick in (first, second))
        relative = Rotation.from_matrix((np.swapaxes(one, -1, -2) @ two).reshape(-1, 3, 3)).as_rotvec()
        angle = np.abs(relative[:, along]).reshape(one.shape[:-2])
        normal = one[..., 2] + two[..., 2]
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        for side in (-1.0, 1.0):
            ends = []
            for sign, pick, axes in ((1.0, first, one), (-1.0, second, two)):
                arm = np.zeros(3)
                arm[along], arm[1 - along] = sign * half[along], side * half[1 - along]
                ends.append(_picked(center, pick) + axes @ arm)
            apart = ends[1] - ends[0]
            step = np.abs((apart * normal).sum(axis=-1))
            opening = np.sqrt(np.maximum((apart**2).sum(axis=-1) - step**2, 0.0))
            for column, value in zip(columns, (opening, step, angle * half[1 - along]), strict=True):
                column.append(value.reshape(grid[0], -1))
    return Gaps(*(np.concatenate(parts, axis=1) for parts in columns))


def _picked(table: Floats, pick: tuple) -> Floats:
    """Rows of a table (times, n_y, n_x, ...) of boxes by their columns, or by their rows."""
    if pick[0] is Ellipsis:
        return table[:, :, pick[1]]
    return table[:, pick[1]]
