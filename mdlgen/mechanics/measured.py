"""Friction as it is measured: by the direction of the sheet, its face, the speed and the pressure.

By direction friction has a potential of dissipation, for 1 of the normal force. With v the slip velocity
along the faces and A = diag(m_MD, m_CD) in the axes of the sheet,

    Phi(v) = integral of mu(s) from 0 to |A v|,    f = -dPhi/dv = -mu(|w|)/|w| A w,    w = A v.

mu is the law over the speed that all friction has (Eq. 12, mechanics.laws). The limit of f is the ellipse
with the half axes mu m_MD and mu m_CD, the slip is along its normal, and f takes mu |w| of power, which is
never below 0. The lesser of m_MD and m_CD is 1: mu is that of the direction with less friction, and friction
in no direction rises over more than the stiction velocity. So A = P + g g^T: P projects onto the faces, and
g, the `stretch`, is the direction with more friction, along the faces, times sqrt(m - 1).

All other effects are factors to mu: that of the face which touches; mu(v)/mu(v_s) of a table; (p/p_0)^n,
where p is the normal force of the pair over the area of the box's face (mechanics.pair).
"""

from __future__ import annotations

import math

from mdlgen.mechanics.laws import of_table
from mdlgen.mechanics.vector import add, dot, scale, sub, three_from
from mdlgen.model.tables.frictions import MOST_SPEEDS
from mdlgen.program.kernel import BORROWS, njit

# Columns of the sums of a pair (mechanics.point) that are input of a law, the first one always: 1 where
# friction is measured, 2 where mu depends on a pressure that is not known yet; the stretch; the factors of
# the sheet's front and back; number of rows of the table of speeds, 0: none, and the table.
FIRST = 26
MEASURED, STRETCH, FRONT, BACK, MANY, TABLE = FIRST, FIRST + 1, FIRST + 4, FIRST + 5, FIRST + 6, FIRST + 7
END = TABLE + 3 * MOST_SPEEDS

# Columns of a row of mechanics.shapes.Shapes.frictions, of a contact: sqrt(m - 1) along MD and along CD; as
# above, from FRONT to the end of TABLE; p_0 and n.
MORE_MD, MORE_CD, FACES, REFERENCE, POWER = 0, 1, 2, 5 + 3 * MOST_SPEEDS, 6 + 3 * MOST_SPEEDS
FRICTION = 7 + 3 * MOST_SPEEDS

# Bound on p/p_0 and its inverse: beyond it the power law would have mu grow without a limit as p goes to 0,
# and no measurement covers more than three decades.
DECADES = 1e3


@njit(cache=True, error_model="numpy", **BORROWS)
def lay_measured(out, row, r, box):
    """Writes the friction `row` of a pair into the input of its law; its first body is `box`, with the
    rotation in r (n, 9)."""
    out[MEASURED] = 2.0 if row[POWER] != 0.0 else 1.0
    for i in range(3):
        out[STRETCH + i] = row[MORE_MD] * r[box, 3 * i] + row[MORE_CD] * r[box, 3 * i + 1]
    for i in range(END - FRONT):
        out[FRONT + i] = row[FACES + i]


@njit(cache=True, error_model="numpy", **BORROWS)
def by_pressure(out, row, pressure):
    """Multiplies the friction in the input of a law by the factor of the pressure, once."""
    share = min(max(pressure / row[REFERENCE], 1.0 / DECADES), DECADES)
    factor = share ** row[POWER]
    out[MEASURED], out[FRONT], out[BACK] = 1.0, factor * out[FRONT], factor * out[BACK]


@njit(cache=True, error_model="numpy", **BORROWS)
def stretched(out, v, square):
    """A v of a velocity that is perpendicular to the direction `square`."""
    g = three_from(out, STRETCH)
    g = sub(g, scale(dot(g, square), square))
    return add(v, scale(dot(g, v), g))


@njit(cache=True, error_model="numpy", **BORROWS)
def factor_of(out, speed, normal, upright):
    """Factor of mu at a speed |w|. normal: to the sheet; upright: the normal of its front."""
    factor = out[BACK] if dot(normal, upright) > 0.0 else out[FRONT]
    if out[MANY] > 0.0:
        factor *= of_table(speed, out, TABLE, int(out[MANY]))
    return factor


@njit(cache=True, error_model="numpy", **BORROWS)
def is_stretched(out):
    """True if friction depends on the direction."""
    g = three_from(out, STRETCH)
    return out[MEASURED] > 0.0 and dot(g, g) > 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def along_slip(out, w, square):
    """(A w, |A w|/|w|): the direction of friction, and its magnitude relative to mu."""
    pull = stretched(out, w, square)
    squares = dot(w, w)
    return pull, math.sqrt(dot(pull, pull) / squares) if squares > 0.0 else 1.0
