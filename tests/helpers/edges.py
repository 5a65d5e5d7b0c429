"""A box and a plate of 1 mm, which begins at x = 0: what the box gets of it, and what the pair remembers."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from mdlgen.mechanics.beside import stands
from mdlgen.mechanics.frame import Box, Frame, Law, Plate
from mdlgen.mechanics.plate import STRAIGHT, as_guide, box_plane
from mdlgen.mechanics.point import MOST_POINTS, OUT, POINT

ZERO, EYE = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
PLAIN = (0.0, 0.0, 0.0, 1.0, 1.0, 1.0)
HALF, PLATE = (1.7, 5.0, 0.05), (100.0, 150.0, 0.5)  # a box of a sheet; a plate of 1 mm from x = 0 on
K = 100.0
TABLE = Frame((100.0, 0.0, -0.5), EYE, ZERO, ZERO)


def pushed(place, turn=0.0, edge=(0.1, 0.1, 0.0), exposed=2, beside=0, half=HALF, yaw=0.0):
    """What a box, turned about z and then about y, gets of the plate."""
    out = np.zeros(OUT + 1 + POINT * MOST_POINTS)
    turned = Rotation.from_rotvec([0.0, turn, 0.0]) * Rotation.from_rotvec([0.0, 0.0, yaw])
    axes = tuple(turned.as_matrix().ravel().tolist())
    plate = Plate(STRAIGHT, PLATE, PLATE[2], 15, edge, beside)
    box_plane(out, Frame(place, axes, ZERO, ZERO), Box(half, exposed), TABLE, plate, Law(K, True, *PLAIN))
    return out


def remembered(place, edge, exposed=2, beside=0, twist=0.0):
    """The sides of a box, turned about x, that stand before ends of the plate, with what was known."""
    plate = Plate(STRAIGHT, PLATE, PLATE[2], 15, edge, beside)
    axes = TABLE._replace(r=as_guide(EYE))
    turned = tuple(Rotation.from_rotvec([twist, 0.0, 0.0]).as_matrix().ravel().tolist())
    return stands(Frame(place, turned, ZERO, ZERO), Box(HALF, exposed), axes, plate)


def before_the_end(h, edge):
    """What is remembered of a leading side whose lower corner is h below the face, 0.01 mm before the end."""
    return remembered((-HALF[0] - 0.01, 0.0, HALF[2] - h), edge)
