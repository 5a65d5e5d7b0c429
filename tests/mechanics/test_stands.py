"""Which sides stand before an end of a plate: what slides down past it is not taken for a side above it."""

from __future__ import annotations

import numpy as np
import pytest

from mdlgen.mechanics.beside import stands
from mdlgen.mechanics.frame import Box, Frame, Plate

# A slab of 1 mm with round edges of 0.1 mm, its upper face at a height of 0; straight, or the hollow arc that
# begins at the same place.
THICK, ROUND = 1.0, 0.1
STRAIGHT = Plate((0.0, 0.0, 0.0), (20.0, 10.0, THICK / 2), 0.0, 15, (ROUND, ROUND, 0.0), 0)
HOLLOW = Plate((50.0, -1.0, 0.5), (0.0, 10.0, THICK / 2), 0.0, 3, (ROUND, ROUND, 0.0), 0)
STILL = (0.0, 0.0, 0.0)
EYE = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
HALF = (4.0, 3.0, 0.07)
AHEAD = 1  # the side x_max of a box


STANDS = 2 << 3 * AHEAD  # before the end 1, where a plate begins


def beside(plate: Plate, known: int, inside: float, height: float, steep: float = 0.5 * np.pi) -> int:
    """Of a box that slopes down into a plate where that begins. inside: how far the middle of its side ahead
    is in, height: above the plate's face [mm]; steep: its slope [rad]."""
    radius, middle, angle = plate.shape
    if radius > 0.0:
        at = middle - angle
        normal, into = np.array([-np.cos(at), -np.sin(at), 0.0]), np.array([-np.sin(at), np.cos(at), 0.0])
        end = -radius * normal
    else:
        normal, into, end = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]), np.array([-20.0, 0.0, 0.0])
    ahead = np.cos(steep) * into - np.sin(steep) * normal
    upright = np.sin(steep) * into + np.cos(steep) * normal
    turned = np.stack([ahead, np.cross(upright, ahead), upright], axis=1)
    place = end + inside * into + height * normal - HALF[0] * ahead
    box = Frame(tuple(place), tuple(turned.ravel()), STILL, STILL)
    own = plate._replace(beside=known)
    return int(stands(box, Box(HALF, 1 << AHEAD), Frame(STILL, EYE, STILL, STILL), own))


@pytest.mark.usefixtures("as_python")
@pytest.mark.parametrize("plate", [STRAIGHT, HOLLOW], ids=["straight", "arc"])
def test_a_side_that_slides_down_past_an_end_stands_there_until_it_is_clear(plate: Plate) -> None:
    """On the round of the lower face it was let go, and the upper face found it 0.98 mm deep."""
    known = beside(plate, 0, -0.2, -0.5, 1.0)  # clear of the end, and abreast of it
    assert known == STANDS
    for height in np.linspace(-0.5, -0.999, 40):
        known = beside(plate, known, 0.03, float(height))
        assert known == STANDS
    assert beside(plate, known, 0.03, -1.01) == 0


@pytest.mark.usefixtures("as_python")
@pytest.mark.parametrize("plate", [STRAIGHT, HOLLOW], ids=["straight", "arc"])
def test_a_side_over_the_top_of_the_round_is_let_go_as_before(plate: Plate) -> None:
    assert beside(plate, STANDS, 2.0, -0.02, 0.3) == 0
    assert beside(plate, 0, 2.0, -0.02, 0.3) == 0
