"""Air in the gap between two faces: Reynolds' equation for a squeeze film, on the grid of one sheet.

With the gap h [mm] between the faces, the pressure p [N/mm^2] over that of the ambient air obeys

    div(h^3/(12 mu) grad p) = -q,    p = 0 at free edges    (Reynolds 1886; Hamrock, Fluid Film Lubrication)

where q [mm/ms] is the closing rate of the faces, along the normal halfway between both: so it includes the
effect of sliding in a wedge. The air is incompressible, has no inertia, and shears the faces by no more than
its pressure does; mu is its viscosity [N ms/mm^2]. So an infinite strip of width L has the force mu L^3 V/h^3
for each mm of it, a square 0.4217 mu L^4 V/h^3.

Pressures are defined in the middles of cells, and are linear between two of them: linear finite elements,
lumped. An edge of the air may lie between two middles, so nothing jumps as sheets slide over each other. The
area of a cell at an edge is corrected for the error of linear pressures in a whole strip. Then the force of a
strip is exact for any number of cells, and that of a square within 0.6 %. The matrix A of the equation is
symmetric and positive: cells that close with a_i q_i, a_i the area of a cell, are pushed back by a_i p_i,
A p = a q, which always dissipates power.

Faces have a roughness e: air flows as through h = e + gap, and where they press into each other as through e.
There they do not close, and have no pressure from it.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.program.kernel import BORROWS, njit

FILM = np.dtype(
    [
        ("row", "i8"),  # of the contacts
        ("body", "i8"),  # first box of the sheet whose grid carries the air,
        ("n_x", "i8"),  # and how many boxes it has
        ("n_y", "i8"),
        ("parts_x", "i8"),  # cells that each box has
        ("parts_y", "i8"),
        ("carrier", "i8"),  # 0: it is the first of a pair's bodies, 1: the second
        ("cell", "i8"),  # first cell; those of a row stand together, the shorter way of the sheet
        ("cells", "i8"),
        ("width", "i8"),  # cells of a row
        ("across", "i8"),  # 1 where rows go along y
        ("acts", "i8"),  # 1 where any of its cells can close
        ("viscosity", "f8"),  # [N ms/mm^2]
        ("roughness", "f8"),  # [mm]
        ("wide", "f8"),  # gaps that are wider count as open: the air there is not lubrication any more [mm]
    ]
)
CELL = np.dtype(
    [
        ("pair", "i8"),  # pair of the cell, -1: no face is near.
        ("following", "i8"),  # next cell of that pair, -1: none.
        ("inside", "i8"),  # 1 where the other face is over its middle.
        ("point", "i8"),  # its number among the points of an iteration, -1: none.
        ("gap", "f8"),  # [mm], negative where the faces press into each other.
        ("beyond", "f8"),  # distance of its middle outside the other box [mm].
        ("size", "f8", 2),  # [mm].
        ("edge", "f8", 4),  # distance from its middle to the free edge of the other sheet, see SIDES [mm].
        ("at", "f8", 3),  # place halfway between both faces.
        ("normal", "f8", 3),  # direction in which pressure pushes the first body.
        ("reach", "f8", 2),  # effective width [mm].
        ("area", "f8"),  # [mm^2], 0: the gap does not close here.
        ("pressure", "f8"),  # [N/mm^2].
        ("rate", "f8"),  # closing rate of the faces [mm/ms].
    ]
)
# Columns of CELL.edge: directions along x and y of the sheet, up and down.
SIDES = 4
X_UP, X_DOWN, Y_UP, Y_DOWN = 0, 1, 2, 3
NEVER = 1e9  # mm: no edge in this direction
# An edge is at least this part of a cell away from its middle.
NEAREST = 1e-3


@njit(cache=True, error_model="numpy", **BORROWS)
def neighbour(film, cell, side):
    """Number of the neighbour of a cell, both counted from the first one of the film; -1: there is none."""
    along = (side in (X_UP, X_DOWN)) == (film.across == 0)
    step = 1 if along else film.width
    place, many = (cell % film.width, film.width) if along else (cell // film.width, film.cells // film.width)
    if side in (X_UP, Y_UP):
        return cell + step if place + 1 < many else -1
    return cell - step if place > 0 else -1


@njit(cache=True, error_model="numpy", **BORROWS)
def _span(film, cells, cell, side):
    """(neighbour of a cell, if it has air, or -1; distance of it, or of the edge where air ends [mm])."""
    own, axis = cells[film.cell + cell], side // 2
    other = neighbour(film, cell, side)
    if other < 0:
        way = 0.5 * own.size[axis]
        return -1, max(min(own.edge[side], way), NEAREST * way)
    far = cells[film.cell + other]
    way = 0.5 * (own.size[axis] + far.size[axis])
    if far.inside != 0:
        return other, way
    to = own.edge[side]
    if to > way and far.pair >= 0:
        to = way - far.edge[side ^ 1]  # the other way: from outside to the edge
    return -1, max(to, NEAREST * way) if to <= way else way


@njit(cache=True, error_model="numpy", **BORROWS)
def assemble(film, cells, band):
    """Computes the matrix of a film, (cells, width + 1) from its diagonal on [mm^5/(N ms)], and the areas of
    its cells; sets film.acts to 1 if any of its cells can close."""
    film.acts = 0
    for i in range(film.cells):
        own = cells[film.cell + i]
        own.area = own.pressure = own.rate = 0.0
        own.reach[0] = own.reach[1] = 0.0
        for k in range(band.shape[1]):
            band[film.cell + i, k] = 0.0
        if own.inside == 0:
            continue
        for side in range(SIDES):
            other, way = _span(film, cells, i, side)
            # less than a whole cell, corrected for the error of linear pressures in a whole strip
            part = 0.0 if other >= 0 else way / own.size[side // 2]
            own.reach[side // 2] += 0.5 * way + part * max(1.0 - part, 0.0) / 3.0 * own.size[side // 2]
        if own.gap > 0.0:
            own.area = own.reach[0] * own.reach[1]
            film.acts = 1
    if film.acts == 0:
        return
    for i in range(film.cells):
        own, row = cells[film.cell + i], film.cell + i
        if own.inside == 0:
            band[row, 0] = 1.0
            continue
        for side in range(SIDES):
            other, way = _span(film, cells, i, side)
            gap, wide = film.roughness + max(own.gap, 0.0), own.reach[1 - side // 2]
            if other >= 0:
                far = cells[film.cell + other]
                gap = 0.5 * (gap + film.roughness + max(far.gap, 0.0))
                wide = 0.5 * (wide + far.reach[1 - side // 2])
            flow = gap * gap * gap / (12.0 * film.viscosity) * wide / way
            band[row, 0] += flow
            if other > i:
                band[row, other - i] = -flow


@njit(cache=True, error_model="numpy", **BORROWS)
def factor(band, first, many, width):
    """Cholesky factor of rows of a band, in place."""
    for j in range(many):
        col = band[first + j]
        pivot = 1.0 / math.sqrt(col[0])
        most = min(width, many - 1 - j)
        for k in range(most + 1):
            col[k] *= pivot
        for k in range(1, most + 1):
            f, target = col[k], band[first + j + k]
            if f != 0.0:
                for i in range(most - k + 1):
                    target[i] -= f * col[k + i]


@njit(cache=True, error_model="numpy", **BORROWS)
def times(film, band, x, y):
    """y = A x of a film, of a band that is not factored."""
    many, width, first = film.cells, film.width, film.cell
    for j in range(many):
        y[first + j] = 0.0
    for j in range(many):
        col, v, far = band[first + j], x[first + j], 0.0
        for k in range(1, min(width, many - 1 - j) + 1):
            y[first + j + k] += col[k] * v
            far += col[k] * x[first + j + k]
        y[first + j] += col[0] * v + far


@njit(cache=True, error_model="numpy", **BORROWS)
def solve(film, band, x):
    """Solves A x = x of a film in place; the band is factored."""
    many, width, first = film.cells, film.width, film.cell
    for j in range(many):
        col, v = band[first + j], x[first + j] / band[first + j, 0]
        x[first + j] = v
        if v != 0.0:
            for k in range(1, min(width, many - 1 - j) + 1):
                x[first + j + k] -= v * col[k]
    for back in range(many):
        j = many - 1 - back
        col, v = band[first + j], x[first + j]
        for k in range(1, min(width, many - 1 - j) + 1):
            v -= col[k] * x[first + j + k]
        x[first + j] = v / col[0]
