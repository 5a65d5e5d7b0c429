"""Contact of a roller with a mesh of triangles: F = k z^1.5, z the depth of the mesh in the roller's round.

The width is evaluated in SLICES planes perpendicular to the axis, each with its part of k. Triangles cut a
slice in straight pieces. Those that reach into the circle, with the axis on their outer side, form patches,
one for each run of connected pieces. Let rho be the distance of a point from the axis, and zeta = (R^2 -
rho^2)/2R. The depth of a patch is

    z = R - sqrt(R^2 - 2 R y),   y = 5/4 I_2/I_1,

with the integrals I_1 of zeta and I_2 of zeta^2 along the patch. The force on the roller is minus the
gradient of 2/5 k z^2.5, so all stored energy is returned. Along a straight piece, and to second order along
any round, zeta is a parabola, of which y is the height. So over a flat mesh z is the depth of the lowest line
to round-off. Over an arc of any number of facets its error is half of the distance between facets and arc. An
edge that comes into the circle from outside counts as 5/6 of its depth or more. The force goes through the
axis.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.frame import RADIUS, WIDTH
from mdlgen.mechanics.point import Load, push
from mdlgen.mechanics.tree import AFTER, COUNT, FIRST, HIGH, LOW, NORMAL, overlaps, span
from mdlgen.mechanics.vector import add, back, cross, dot, matmul, nine, rotate, scale, sub, three
from mdlgen.program.kernel import CALLED, OWNS, njit

SLICES = 8
MOST_PIECES = 512  # most pieces of one slice; further ones belong to the patch of the last
_JOINED = 1e-7  # relative to the radius: distance of ends of pieces that coincide
# Columns of a piece: places where it begins and ends (2 each); the integrals of zeta and of its square; those
# of place (2), and of zeta times place (2); its patch.
_BEGIN, _END, _ZETA, _SQUARE, _PLACE, _MOMENT, _PATCH, _PIECE = 0, 2, 4, 5, 6, 8, 10, 11


@njit(cache=True, error_model="numpy", forceinline=True)
def _frame(axis):
    """Two unit vectors square to one."""
    other = (1.0, 0.0, 0.0) if abs(axis[0]) < 0.6 else (0.0, 1.0, 0.0)
    one = cross(axis, other)
    one = scale(1.0 / math.sqrt(dot(one, one)), one)
    return one, cross(axis, one)


@njit(cache=True, error_model="numpy")
def _piece(piece, x0, y0, x1, y1, radius):
    """Fills a piece from a straight one in the slice, the axis in the origin; False: out of the circle."""
    dx, dy = x1 - x0, y1 - y0
    length = math.sqrt(dx * dx + dy * dy)
    if length < 1e-12 * radius:
        return False
    dx, dy = dx / length, dy / length
    along = -(x0 * dx + y0 * dy)
    square = radius * radius - (x0 + along * dx) ** 2 - (y0 + along * dy) ** 2
    if square <= 0.0:
        return False
    reach = math.sqrt(square)
    first, last = max(0.0, along - reach), min(length, along + reach)
    if last <= first:
        return False
    piece[_BEGIN], piece[_BEGIN + 1] = x0 + first * dx, y0 + first * dy
    piece[_END], piece[_END + 1] = x0 + last * dx, y0 + last * dy
    for i in range(_ZETA, _PIECE):
        piece[i] = 0.0
    for k in range(3):  # Gauss: exact for the products of two parabolas
        s = 0.5 * (first + last) + (k - 1) * 0.5 * math.sqrt(0.6) * (last - first)
        weight = (4.0 if k == 1 else 2.5) / 9.0 * (last - first)
        x, y = x0 + s * dx, y0 + s * dy
        zeta = 0.5 * (radius * radius - x * x - y * y) / radius
        piece[_ZETA] += weight * zeta
        piece[_SQUARE] += weight * zeta * zeta
        piece[_PLACE] += weight * x
        piece[_PLACE + 1] += weight * y
        piece[_MOMENT] += weight * zeta * x
        piece[_MOMENT + 1] += weight * zeta * y
    return True


@njit(cache=True, error_model="numpy")
def _gather(pieces, meshes, head, at, axis, one, two, radius):
    """Lists the pieces of a slice whose axis is at a point (file axes); returns how many."""
    bounds, links, triangles = meshes.bounds, meshes.links, meshes.triangles
    found, n = 0, head.first
    while n < head.end:
        far = 0.0
        for i in range(3):
            gap = max(bounds[n, LOW + i] - at[i], at[i] - bounds[n, HIGH + i], 0.0)
            far += gap * gap
        middle, reach = span(bounds, n, axis)
        if far > radius * radius or abs(middle - dot(at, axis)) > reach:
            n = links[n, AFTER]
            continue
        for t in range(links[n, FIRST], links[n, FIRST] + links[n, COUNT]):
            c = triangles[t]
            p0 = sub((c[0], c[1], c[2]), at)
            if dot(three(c[NORMAL:]), p0) >= 0.0:  # the axis is not on its outer side
                continue
            p1, p2 = sub((c[3], c[4], c[5]), at), sub((c[6], c[7], c[8]), at)
            d0, d1, d2 = dot(p0, axis), dot(p1, axis), dot(p2, axis)
            # the corner that is alone on its side
            if (d0 >= 0.0) == (d1 >= 0.0):
                if (d0 >= 0.0) == (d2 >= 0.0):
                    continue
                p0, p2, d0, d2 = p2, p0, d2, d0
            elif (d0 >= 0.0) == (d2 >= 0.0):
                p0, p1, d0, d1 = p1, p0, d1, d0
            q1 = add(p0, scale(d0 / (d0 - d1), sub(p1, p0)))
            q2 = add(p0, scale(d0 / (d0 - d2), sub(p2, p0)))
            room = pieces[found]
            if not _piece(room, dot(q1, one), dot(q1, two), dot(q2, one), dot(q2, two), radius):
                continue
            if found < MOST_PIECES:
                room[_PATCH] = found
                found += 1
                continue
            for i in range(_ZETA, _PATCH):
                pieces[found - 1, i] += room[i]
        n += 1
    return found


@njit(cache=True, error_model="numpy")
def _join(pieces, found, radius):
    """Gives connected pieces the same number of a patch."""
    near = _JOINED * radius
    for i in range(found):
        for j in range(i):
            if pieces[i, _PATCH] == pieces[j, _PATCH]:
                continue
            meets = False
            for a in (_BEGIN, _END):
                for b in (_BEGIN, _END):
                    gap = abs(pieces[i, a] - pieces[j, b]) + abs(pieces[i, a + 1] - pieces[j, b + 1])
                    meets = meets or gap <= near
            if meets:
                old, new = pieces[i, _PATCH], pieces[j, _PATCH]
                for k in range(i + 1):
                    if pieces[k, _PATCH] == old:
                        pieces[k, _PATCH] = new


@njit(cache=True, error_model="numpy", **OWNS, **CALLED)
def roller_mesh(out, body, a, b, head, meshes, law):
    """Roller a (a record with its axis and size) on a mesh that moves with body b."""
    frame = matmul(b.r, nine(head.axes))
    place = add(b.x, rotate(b.r, three(head.place)))
    axis, center = back(frame, three(body.axis)), back(frame, sub(a.x, place))
    one, two = _frame(axis)
    radius, width = body.size[RADIUS], body.size[WIDTH]
    pieces, sums = np.empty((MOST_PIECES + 1, _PIECE)), np.empty(_PIECE)
    for slice in range(SLICES):
        u = ((slice + 0.5) / SLICES - 0.5) * width
        found = _gather(pieces, meshes, head, add(center, scale(u, axis)), axis, one, two, radius)
        _join(pieces, found, radius)
        for patch in range(found):
            sums[:] = 0.0
            for i in range(found):
                if pieces[i, _PATCH] == patch:
                    for j in range(_ZETA, _PATCH):
                        sums[j] += pieces[i, j]
            zeta, square = sums[_ZETA], sums[_SQUARE]
            if zeta <= 0.0:
                continue
            mean = square / zeta
            y = min(1.25 * mean, 0.499 * radius)
            left = math.sqrt(radius * radius - 2.0 * radius * y)
            depth = radius - left
            # from the axis into the mesh: the growth of the depth with a move of the axis
            grows = 1.25 / (zeta * left)
            gx = grows * (2.0 * sums[_MOMENT] - mean * sums[_PLACE])
            gy = grows * (2.0 * sums[_MOMENT + 1] - mean * sums[_PLACE + 1])
            steep = math.sqrt(gx * gx + gy * gy)
            if steep <= 0.0:
                continue
            way = rotate(frame, add(scale(gx / steep, one), scale(gy / steep, two)))
            stiff = law.k / SLICES
            spring = stiff * depth * math.sqrt(depth) * steep
            point = add(a.x, add(scale(u, three(body.axis)), scale(radius, way)))
            energy = 0.4 * stiff * depth * depth * math.sqrt(depth)
            push(out, point, scale(-1.0, way), Load(spring, depth, energy), a, b, law)


@njit(cache=True, error_model="numpy", **CALLED)
def roller_mesh_near(body, xa, xb, rb, head, meshes, more):
    """True if a roller that is larger by `more` on all sides may meet a leaf of the mesh's tree."""
    radius, half = body.size[RADIUS] + more, 0.5 * body.size[WIDTH] + more
    gap = sub(xa, xb)
    wide = head.reach + math.sqrt(radius * radius + half * half)
    if dot(gap, gap) > wide * wide:
        return False
    frame = matmul(rb, nine(head.axes))
    place = add(xb, rotate(rb, three(head.place)))
    axis, middle = back(frame, three(body.axis)), back(frame, sub(xa, place))
    one, two = _frame(axis)
    axes = (one[0], two[0], axis[0], one[1], two[1], axis[1], one[2], two[2], axis[2])
    return overlaps(meshes.bounds, meshes.links, head.first, head.end, middle, axes, (radius, radius, half))
