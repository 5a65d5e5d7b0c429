"""Air between sheets: each cell of a film has its own coordinate, whose rate is the pressure there.

The mass of the coordinate is very small (films.LAG), so that Reynolds' equation of mechanics.film holds at
the end of each step:

    F_i = s/A_ii (a_i q_i - sum_j A_ij p_j) = 0

with s the area of a whole cell, which converts it to a force like those of all other coordinates. So the
matrix of the solver is sparse: a cell is coupled to its neighbours and to the two boxes around it. Pressures
that were solved for beforehand would couple all boxes of two sheets.

Gaps are those at the end of a step, predicted by its first velocities, but at least half of those at its
beginning (mechanics.film_faces). They are frozen in its iterations: so F is linear, and does not jump where
faces come to touch.
"""

from __future__ import annotations

import numpy as np

from mdlgen.backends.exudyn_local.place import place_all, spread
from mdlgen.mechanics.film import factor, solve
from mdlgen.mechanics.film_pairs import clear_films, close_rates, cover_pair, link_films, may_have_air
from mdlgen.mechanics.vector import cross, scale, sub, three, vec
from mdlgen.program.kernel import njit

BOX = 7  # generalised coordinates of one


@njit(cache=True, error_model="numpy")
def lay_air(tables, at, h, motion):
    """Sets the gaps and matrices of all films to those at Coordinates at their velocities, h after the
    beginning of a step."""
    film, pairs = tables.film, tables.pairs
    place_all(tables.bodies, at, motion)
    clear_films(film)
    for p in range(film.film_of.size):
        if film.film_of[p] >= 0 and may_have_air(pairs[p]):
            cover_pair(film, film.film_of[p], tables.bodies, pairs[p], p, motion, h)
    link_films(film)
    for k in range(film.films.size):
        one = film.films[k]
        if one.acts == 0:  # its pressures are zero
            for i in range(one.cell, one.cell + one.cells):
                film.flow[i, 0] = 1.0


@njit(cache=True, error_model="numpy")
def begin_air(tables, at, motion):
    """Sets the pressures in the rates of the coordinates `at` to those of a state."""
    film = tables.film
    lay_air(tables, at, 0.0, motion)
    close_rates(film, tables.pairs, motion)
    p = np.zeros(film.cells.size)
    for i in range(p.size):
        p[i] = film.cells[i].area * film.cells[i].rate
        for k in range(film.flow.shape[1]):
            film.factor[i, k] = film.flow[i, k]
    for k in range(film.films.size):
        one = film.films[k]
        if one.acts != 0:
            factor(film.factor, one.cell, one.cells, one.width)
            solve(one, film.factor, p)
    for i in range(p.size):
        at.v[film.first[0] + i] = p[i]


@njit(cache=True, error_model="numpy")
def air_forces(tables, at, motion, f):
    """Adds the forces of the air, and the residuals of its own equations, to the generalised forces. Returns
    the power that it dissipates."""
    film, power = tables.film, 0.0
    q, v, _ = at
    cells, first, flow = film.cells, film.first[0], film.flow
    close_rates(film, tables.pairs, motion)
    for k in range(film.many[0]):
        pair, i = tables.pairs[film.listed[k]], film.head[film.listed[k]]
        while i >= 0:
            p, place = v[first + i], three(cells[i].at)
            push = scale(cells[i].area * p, three(cells[i].normal))
            spread(tables.bodies, pair.a, q, push, cross(sub(place, vec(motion.x, pair.a)), push), f)
            back = scale(-1.0, push)
            spread(tables.bodies, pair.b, q, back, cross(sub(place, vec(motion.x, pair.b)), back), f)
            f[first + i] += film.areas[i] / flow[i, 0] * cells[i].area * cells[i].rate
            power += cells[i].area * p * cells[i].rate
            i = cells[i].following
    for k in range(film.films.size):
        one = film.films[k]
        for j in range(one.cells):
            i = one.cell + j
            f[first + i] -= film.areas[i] * v[first + i]
            for side in range(1, min(one.width, one.cells - 1 - j) + 1 if one.acts != 0 else 1):
                if flow[i, side] == 0.0:
                    continue
                for row, other in ((i, i + side), (i + side, i)):
                    f[first + row] -= film.areas[row] / flow[row, 0] * flow[i, side] * v[first + other]
    return power


@njit(cache=True, error_model="numpy")
def air_slopes(tables, at, by_v, motion, entries, values):
    """Writes the part of the air in the jacobian, -by_v dF/dv: rows and columns into `entries`, (2, n), and
    `values`. Returns the number of entries; those of the same place add up."""
    film = tables.film
    cells, first, flow, many = film.cells, film.first[0], film.flow, 0
    place_all(tables.bodies, at, motion)
    way = np.zeros(at.v.size)
    for k in range(film.many[0]):
        pair, i = tables.pairs[film.listed[k]], film.head[film.listed[k]]
        while i >= 0:
            n, place = three(cells[i].normal), three(cells[i].at)
            for side in range(2):
                body, push = (pair.a, n) if side == 0 else (pair.b, scale(-1.0, n))
                start = tables.bodies[body].first
                if start < 0:
                    continue
                for m in range(BOX):
                    way[start + m] = 0.0
                spread(tables.bodies, body, at.q, push, cross(sub(place, vec(motion.x, body)), push), way)
                for m in range(BOX):
                    value = by_v * cells[i].area * way[start + m]
                    entries[0, many], entries[1, many], values[many] = start + m, first + i, -value
                    many += 1
                    # the gap opens in the direction in which the pressure pushes
                    value *= film.areas[i] / flow[i, 0]
                    entries[0, many], entries[1, many], values[many] = first + i, start + m, value
                    many += 1
            i = cells[i].following
    for k in range(film.films.size):
        one = film.films[k]
        for j in range(one.cells):
            i = one.cell + j
            entries[0, many], entries[1, many], values[many] = first + i, first + i, by_v * film.areas[i]
            many += 1
            for side in range(1, min(one.width, one.cells - 1 - j) + 1 if one.acts != 0 else 1):
                if flow[i, side] == 0.0:
                    continue
                for row, column in ((i, i + side), (i + side, i)):
                    entries[0, many], entries[1, many] = first + row, first + column
                    values[many] = by_v * film.areas[row] / flow[row, 0] * flow[i, side]
                    many += 1
    return many
