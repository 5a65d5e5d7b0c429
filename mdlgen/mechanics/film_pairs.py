"""The air of all pairs of a solver: gaps at the places of its bodies, and closing rates of the faces of
cells.

`film` has the records of film_grid (films, cells), the matrices `flow` (cells, band), and `head`, `listed`
and `many`: the first cell of each pair, the pairs that have any, and their number.
"""

from __future__ import annotations

from mdlgen.mechanics.film import assemble
from mdlgen.mechanics.film_faces import clear, cover, link
from mdlgen.mechanics.frame import frame_of
from mdlgen.mechanics.vector import add, cross, dot, sub, three
from mdlgen.model.tables.contacts import BOX_BOX, BOX_PLANE
from mdlgen.program.kernel import BORROWS, njit

BLOCK = 15  # all four sides of a plane are free


@njit(cache=True, error_model="numpy", **BORROWS)
def may_have_air(pair):
    """True if a pair is of a kind that can have air between its bodies."""
    return pair.kind == BOX_BOX or pair.kind == BOX_PLANE


@njit(cache=True, error_model="numpy", **BORROWS)
def clear_films(film):
    """Removes the air of all cells, and the cells of all pairs."""
    film.many[0] = 0
    for k in range(film.films.size):
        clear(film.films[k], film.cells, film.head)


@njit(cache=True, error_model="numpy", **BORROWS)
def cover_pair(film, k, bodies, pair, number, motion, h):
    """Sets the gaps of cells of the k-th film to the bodies of a pair, where that is the nearest so far;
    number: that of the pair, h: time since the step began [ms]."""
    own, other = (pair.a, pair.b) if film.films[k].carrier == 0 else (pair.b, pair.a)
    plane = pair.kind == BOX_PLANE
    exposed = BLOCK if plane else bodies[other].exposed
    frames = frame_of(motion, own), frame_of(motion, other)
    shapes = three(bodies[own].half), three(bodies[other].half), exposed
    cover(film.films[k], film.cells, (number, plane), own - film.films[k].body, frames, shapes, h)


@njit(cache=True, error_model="numpy", **BORROWS)
def link_films(film):
    """Computes the matrices and areas of all films, and lists the cells of each pair."""
    for k in range(film.films.size):
        one = film.films[k]
        assemble(one, film.cells, film.flow)
        if one.acts != 0:
            film.many[0] = link(one, film.cells, film.head, film.listed, film.many[0])


@njit(cache=True, error_model="numpy", **BORROWS)
def close_rates(film, pairs, motion):
    """Sets the closing rates of the faces of all cells."""
    cells = film.cells
    for k in range(film.many[0]):
        pair, i = pairs[film.listed[k]], film.head[film.listed[k]]
        a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
        while i >= 0:
            at, n = three(cells[i].at), three(cells[i].normal)
            v = sub(add(a.v, cross(a.w, sub(at, a.x))), add(b.v, cross(b.w, sub(at, b.x))))
            cells[i].rate = -dot(v, n)
            i = cells[i].following
