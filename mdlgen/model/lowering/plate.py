"""`layout: plate`: one bushing in the middle of each shared side, its stiffness that of an orthotropic plate.

A joint of length l and width w (the side that its two boxes share) gets

    along l     E s w / l             membrane
    along w     2 G s w / l           shear: the joints along x and those along y share it in series
    about l     2 D_twist w / l       twist: both ways add up to M_xy = 2 D_twist w_xy
    about w     D w / l               bending
    about z     E s w^3 / (12 l)      bending in the plane: that of the strip of width w itself

so bending, in the plane or out of it, membrane, shear and twist are those of the plate on any grid. Across z
a joint is stiff, as in Eq. 4. Poisson's effect is in lowering.poisson.

Half of the twist's energy is in the joints along x, half in those along y. Over the outer half of the boxes
at a free edge only the joints along that edge are left: there they have the whole of it. So in twist a joint
in the row or column at a free edge stands for half a box more, 3/2 of its width; one of a strip of one box
for both halves, twice its width. At a clamped edge half-cell hinges are over the first half of the boxes.
The remaining error is of second order: a plate with loads at its true corners is too stiff by 1/(n_x n_y),
since the boxes there do not twist themselves.

In the plane nothing is added: shear falls to zero at a free edge. Where a load puts shear on the edges, the
part (1/n_x + 1/n_y)/2 of the compliance is missing.

Rigid boxes that twist by an angle from one to the next leave each other at the corners, by that angle times
w/2 across the sheet. No bushing can have it otherwise: what stays closed there does not twist.
"""

from __future__ import annotations

import math

from mdlgen.model.tables import Floats, Ints
from mdlgen.spec.material import Material
from mdlgen.spec.sheet import Sheet

# Shear modulus in the plane of machine-made paper over sqrt(E_md E_cd), where none is given: Baum, Brennan
# and Habeger, Orthotropic elastic constants of paper, Tappi 64(8), 1981. Twist has the same ratio to bending.
SHEAR_RATIO = 0.387


def shear_modulus(material: Material) -> float:
    """G in the plane of the sheet [MPa]."""
    return material.G if material.G is not None else SHEAR_RATIO * math.sqrt(math.prod(material.moduli))


def twisting(sheet: Sheet, material: Material) -> float | None:
    """Twisting stiffness per width D66 [N mm]; None where none is given and the layout has no need of it."""
    if material.D_twist is not None or sheet.layout != "plate":
        return material.D_twist
    shape = sheet.pitch[0] / sheet.pitch[1]
    return SHEAR_RATIO * math.sqrt(math.prod(material.strips(sheet.thickness, shape)))


def tributary(strip: Ints, cells: int, held_min: bool, held_max: bool) -> Floats:
    """Width that joints stand for in twist over the width of their boxes, (n,).

    `strip` is the row of each joint along x among `cells` rows, or the column of each along y; held are the
    edges along the first and the last of these that a clamp holds.
    """
    first, last = (strip == 0) & (not held_min), (strip == cells - 1) & (not held_max)
    return 1.0 + 0.5 * first + 0.5 * last


def in_plane(
    material: Material, membrane: tuple[Floats, Floats], box: tuple[Floats, Floats], s: Floats, along_x: bool
) -> tuple[Floats, Floats, Floats]:
    """k_x, k_y [N/mm] and k_tz [N mm/rad] of joints along x, or along y, (n,) each.

    `membrane` is Eqs. 5 and 6 [N/mm], `box` has the lengths (d_x, d_y) [mm], `s` the thickness [mm].
    """
    (k_x, k_y), (d_x, d_y) = membrane, box
    shear = 2.0 * shear_modulus(material) * s
    if along_x:
        return k_x, shear * d_y / d_x, k_x * d_y**2 / 12
    return shear * d_x / d_y, k_y, k_y * d_x**2 / 12
