"""Ends of plates under sheets that lean along them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mdlgen.mechanics.frame import Box, Frame, Law, Plate
from mdlgen.mechanics.plate import STRAIGHT, box_plane
from mdlgen.mechanics.point import MOST_POINTS, OUT, POINT

pytestmark = pytest.mark.usefixtures("as_python")

ZERO, EYE = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
PLAIN = (0.0, 0.0, 0.0, 1.0, 1.0, 1.0)
HALF, PLATE = (1.7, 5.0, 0.05), (100.0, 150.0, 0.5)  # a box of a sheet; a plate of 1 mm from x = 0 on
K = 100.0
TABLE = Frame((100.0, 0.0, -0.5), EYE, ZERO, ZERO)


def test_an_edge_is_the_same_all_along_a_sheet_that_leans():
    """A sheet that leans along the end is above the plate here, and below it farther along the end."""
    plate = Plate(STRAIGHT, PLATE, PLATE[2], 15, (0.1, 0.1, 0.0), 0)
    axes = tuple(Rotation.from_rotvec([0.05, -0.3, 0.0]).as_matrix().ravel().tolist())
    pushes = []
    for y in (0.0, -60.0, 90.0):
        out = np.zeros(OUT + 1 + POINT * MOST_POINTS)
        frame = Frame((0.2, y, 0.0), axes, ZERO, ZERO)
        box_plane(out, frame, Box(HALF, 0), TABLE, plate, Law(K, True, *PLAIN))
        pushes.append(out[:6])
    assert pushes[0][2] > 0.0
    assert pushes[1] == pytest.approx(pushes[0], rel=1e-9) and pushes[2] == pytest.approx(pushes[0], rel=1e-9)
