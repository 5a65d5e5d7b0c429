"""Torques of a contact pair about the axes of its rollers, and its friction along their surfaces.

The friction of a pair is that of all its points; the couple of rolling resistance is a torque, not friction.
"""

from __future__ import annotations

import math

from mdlgen.mechanics.frame import law_of
from mdlgen.mechanics.laws import friction_over_speed, held_over_speed
from mdlgen.mechanics.measured import along_slip, is_stretched
from mdlgen.mechanics.point import (
    COUPLE,
    FORCE,
    HOLD,
    KIND,
    MU_DYNAMIC,
    MU_STATIC,
    NORMAL,
    OF_NIP,
    OUT,
    POINT,
    POINTS,
    SLIP,
    TORQUE_A,
    TORQUE_B,
    WAY,
)
from mdlgen.mechanics.vector import cross, dot, three, three_from
from mdlgen.program.kernel import BORROWS, njit

# Columns: torque of a pair on the first body about the axis of that, and on the second about its own;
# friction along the surface of a roller, positive in the sense of its axis; the limit of that friction.
ABOUT_A, ABOUT_B, ALONG, LIMIT, TURNING = 0, 1, 2, 3, 4


@njit(cache=True, error_model="numpy", **BORROWS)
def turning(bodies, pair, out, rows, row, first):
    """Adds the torques and the friction of a pair to the TURNING columns of a row of `rows`, from `first` on;
    `out` is the result of pair_force, with its contact points.

    A body that is no roller has no axis, and no torque about it. For two rollers the surface is that of the
    second; without any, the magnitude of friction is added.
    """
    one, two = three(bodies[pair.a].axis), three(bodies[pair.b].axis)
    rows[row, first + ABOUT_A] += dot(three_from(out, TORQUE_A), one)
    rows[row, first + ABOUT_B] += dot(three_from(out, TORQUE_B), two)
    axis, law = two if dot(two, two) > 0.0 else one, law_of(pair)
    rolls, stretch = dot(axis, axis) > 0.0, is_stretched(out)
    for k in range(int(out[POINTS])):
        at = OUT + 1 + POINT * k
        if out[at + KIND] == COUPLE:
            continue
        slip, normal = three_from(out, at + SLIP), three_from(out, at + NORMAL)
        speed, static = math.sqrt(dot(slip, slip)), out[at + MU_STATIC]
        if out[at + HOLD] > 0.0:
            grip = held_over_speed(speed, out[at + HOLD], static)
        else:
            grip = friction_over_speed(speed, static, out[at + MU_DYNAMIC], law.stiction, law.sliding)
        if stretch:
            square = three_from(out, at + WAY) if out[at + KIND] == OF_NIP else normal
            slip, more = along_slip(out, slip, square)
            speed, static = more * speed, more * static
        along = dot(slip, cross(axis, normal)) if rolls else speed
        rows[row, first + ALONG] += out[at + FORCE] * grip * along
        rows[row, first + LIMIT] += out[at + FORCE] * static
