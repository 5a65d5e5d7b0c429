"""Air between two faces: the gap over each cell of a sheet's grid, and the edges of what covers it."""

from __future__ import annotations

import math

from mdlgen.mechanics.film import NEVER, X_DOWN, X_UP, Y_DOWN, Y_UP
from mdlgen.mechanics.overlap import STEEP
from mdlgen.mechanics.vector import add, back, cross, dot, rotate, scale, sub
from mdlgen.program.kernel import BORROWS, njit

# Sides of boxes that have a neighbour may be this part of a box away from it, as in a sheet that is bent.
SLIT = 0.1
# A gap is at least this part of that as the step began.
LEAST = 0.5


@njit(cache=True, error_model="numpy", **BORROWS)
def clear(film, cells, head):
    """Removes the air of all cells; `head`: the first cell of each pair."""
    for i in range(film.cells):
        own = cells[film.cell + i]
        if own.pair >= 0:
            head[own.pair] = -1
        own.pair = own.following = own.point = -1
        own.inside, own.beyond = 0, NEVER


@njit(cache=True, error_model="numpy", forceinline=True)
def _outside(place, half, exposed):
    """Distance of a place along a box's face beyond its free sides, and beyond the others; negative
    inside."""
    free = joined = -NEVER
    for q in range(2):
        for up in range(2):
            out = (place[q] if up == 1 else -place[q]) - half[q]
            if exposed & (1 << (2 * q + up)) != 0:
                free = max(free, out)
            else:
                joined = max(joined, out)
    return free, joined


@njit(cache=True, error_model="numpy", forceinline=True)
def _to_edge(place, half, exposed, way, inside):
    """Distance of a place along a box's face from its free sides in one direction: to where it leaves the
    face, if it is inside, else to where it enters."""
    found = NEVER if inside else 0.0
    for q in range(2):
        for up in range(2):
            if exposed & (1 << (2 * q + up)) == 0:
                continue
            sign = 1.0 if up == 1 else -1.0
            left, speed = half[q] - sign * place[q], sign * way[q]
            if inside and speed > 0.0:
                found = min(found, left / speed)
            elif not inside and left < 0.0:
                found = max(found, left / speed if speed < 0.0 else NEVER)
    return found


@njit(cache=True, error_model="numpy", forceinline=True)
def _normals(a, b, plane):
    """Outer normals of the faces of two bodies (Frames) that look at each other; of a plane it is the upper
    one."""
    up, other = (a.r[2], a.r[5], a.r[8]), (b.r[2], b.r[5], b.r[8])
    if plane:
        return scale(-1.0 if dot(up, other) > 0.0 else 1.0, up), other
    own = scale(1.0 if dot(sub(b.x, a.x), up) >= 0.0 else -1.0, up)
    return own, scale(-1.0 if dot(own, other) > 0.0 else 1.0, other)


@njit(cache=True, error_model="numpy", **BORROWS)
def cover(film, cells, pair, box, frames, shapes, h):
    """Sets the gaps of the cells of one box to another body, if it is the nearest so far. pair: its
    number and whether it is a plane; box: number of the box in its sheet; frames: of the box and of the other
    body; shapes: half lengths of both [mm], and the free sides of the second as a bit mask; h: how long ago
    the step began [ms]."""
    number, plane = pair
    a, b = frames
    half, wide, exposed = shapes
    place = back(a.r, sub(b.x, a.x))
    far = math.sqrt(wide[0] * wide[0] + wide[1] * wide[1])
    for q in range(2):
        if abs(place[q]) > 3.0 * half[q] + far:
            return
    face, other = _normals(a, b, plane)
    facing = -dot(face, other)
    if facing < STEEP:
        return
    way = sub(face, other)
    way = scale(1.0 / math.sqrt(dot(way, way)), way)
    level = add(b.x, scale(wide[2], other))
    along, across = back(b.r, (a.r[0], a.r[3], a.r[6])), back(b.r, (a.r[1], a.r[4], a.r[7]))
    top = half[2] if dot(face, (a.r[2], a.r[5], a.r[8])) > 0.0 else -half[2]
    size_x, size_y = 2.0 * half[0] / film.parts_x, 2.0 * half[1] / film.parts_y
    first_x, first_y = box % film.n_x * film.parts_x, box // film.n_x * film.parts_y
    for k in range(film.parts_x * film.parts_y):
        i, j = k % film.parts_x, k // film.parts_x
        at = add(a.x, rotate(a.r, ((i + 0.5) * size_x - half[0], (j + 0.5) * size_y - half[1], top)))
        gap = dot(sub(level, at), other) / dot(way, other)
        if gap > film.wide:
            continue
        x, y = first_x + i, first_y + j
        own = cells[film.cell + (y * film.width + x if film.across == 0 else x * film.width + y)]
        there = back(b.r, sub(add(at, scale(gap, way)), b.x))
        free, joined = _outside(there, wide, exposed)
        beyond = max(free, joined)
        if beyond >= own.beyond:
            continue
        v = sub(add(a.v, cross(a.w, sub(at, a.x))), add(b.v, cross(b.w, sub(at, b.x))))
        # air through which the guess has moved in half a step may stop it
        own.beyond, own.pair, own.gap = beyond, number, max(gap, LEAST * (gap + h * dot(v, way)))
        inside = free <= 0.0 and joined <= SLIT * min(wide[0], wide[1])
        own.inside = 1 if inside else 0
        own.size[0], own.size[1] = size_x, size_y
        own.edge[X_UP] = _to_edge(there, wide, exposed, along, inside)
        own.edge[X_DOWN] = _to_edge(there, wide, exposed, scale(-1.0, along), inside)
        own.edge[Y_UP] = _to_edge(there, wide, exposed, across, inside)
        own.edge[Y_DOWN] = _to_edge(there, wide, exposed, scale(-1.0, across), inside)
        at = add(at, scale(0.5 * gap, way))
        for q in range(3):
            own.at[q] = at[q]
            own.normal[q] = -way[q] if film.carrier == 0 else way[q]


@njit(cache=True, error_model="numpy", **BORROWS)
def link(film, cells, head, listed, count):
    """Lists the pairs with cells that can close behind the first `count` ones, each with these cells; returns
    how many."""
    for i in range(film.cells):
        own = cells[film.cell + i]
        if own.area == 0.0:
            continue
        if head[own.pair] < 0:
            listed[count] = own.pair
            count += 1
        own.following = head[own.pair]
        head[own.pair] = film.cell + i
    return count
