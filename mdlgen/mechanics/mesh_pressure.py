"""Pressure of the triangles of a mesh on one face of a box: each is cut to the face, and what is left of it
pressed by its depth (see mechanics.mesh for the laws)."""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import Vector
from mdlgen.mechanics.mesh_side import ramp
from mdlgen.mechanics.mesh_tables import BEYOND
from mdlgen.mechanics.tree import AFTER, AREA, COUNT, FIRST, LEAST, MOST, NORMAL, THICK, span
from mdlgen.mechanics.vector import dot, scale
from mdlgen.program.kernel import njit

STEEP, GENTLE = 0.4, 0.6  # cosines of the angles between which the law of broad faces ends
# Columns of what presses on a face: its force along the file's axes (3) and in all; moments of that in the
# face, of first and of second order; energy; greatest depth; what would be the force of what is too deep.
FORCE, IN_ALL, FIRST_U, FIRST_V, SECOND_U, SECOND_V = 0, 3, 4, 5, 6, 7
ENERGY, DEEPEST, TOO_DEEP, SUMS = 8, 9, 10, 11


class Face(NamedTuple):
    """A face of a box as the mesh's file sees it: its normal and the directions of both sides; the box's
    middle along these three, along the normal less its half length; half lengths of both sides; stiffness per
    area, whether the pressure is linear in depth, and whether depth is looked at in the middles of triangles.
    """

    way: Vector
    along: Vector
    across: Vector
    where: Vector
    half_along: float
    half_across: float
    stiffness: float
    linear: bool
    middles: bool


@njit(cache=True, error_model="numpy", forceinline=True)
def _part(cosine):
    """How much of the broad faces' law acts on a triangle at an angle to them."""
    return ramp(cosine, STEEP, GENTLE)


@njit(cache=True, error_model="numpy")
def _cut(points, kept, count, axis, sign, limit):
    """Cuts a polygon by sign times a coordinate <= limit into `kept`; returns its number of points."""
    found = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        d1, d2 = limit - sign * points[i, axis], limit - sign * points[j, axis]
        if d1 >= 0.0:
            for k in range(3):
                kept[found, k] = points[i, k]
            found += 1
        if (d1 > 0.0 and d2 < 0.0) or (d1 < 0.0 and d2 > 0.0):
            part = d1 / (d1 - d2)
            for k in range(3):
                kept[found, k] = points[i, k] + part * (points[j, k] - points[i, k])
            found += 1
    return found


@njit(cache=True, error_model="numpy")
def _over(room, u, v, z, hp, hr):
    """What of a triangle with corners at u, v (depths z) lies over a face of half lengths hp, hr and below
    it: its points in room[which]. Returns (which, how many)."""
    for k in range(3):
        room[0, k, 0], room[0, k, 1], room[0, k, 2] = u[k], v[k], z[k]
    which, count = 0, 3
    for plane in range(5):
        axis, side = plane // 2, 1.0 if plane % 2 == 1 else -1.0
        limit = hp if axis == 0 else hr if axis == 1 else 0.0
        beyond = False
        for k in range(count):
            beyond = beyond or side * room[which, k, axis] > limit
        if beyond:
            count = _cut(room[which], room[1 - which], count, axis, side, limit)
            which = 1 - which
        if count < 3:
            return which, 0
    return which, count


@njit(cache=True, error_model="numpy", forceinline=True)
def _press(sums, area, u, v, depth, thick, stiff, linear):
    """Adds what an area does at a depth; returns its force."""
    if depth <= 0.0 or depth > BEYOND * thick:
        return 0.0
    force = area * stiff * depth * (1.0 if linear else math.sqrt(depth))
    if depth > thick:
        sums[TOO_DEEP] += force
        return 0.0
    sums[FIRST_U] += force * u
    sums[FIRST_V] += force * v
    sums[SECOND_U] += force * u * u
    sums[SECOND_V] += force * v * v
    sums[ENERGY] += force * depth * (0.5 if linear else 0.4)
    sums[DEEPEST] = max(sums[DEEPEST], depth)
    return force


@njit(cache=True, error_model="numpy")
def _press_linear(sums, area, us, vs, zs, thick, stiff):
    """Adds what a triangle does whose pressure is linear in depth: integrals of products of linear functions
    are exact, so a face that is cut in another way has the same. us, vs, zs: places and depths of its
    corners. Returns its force."""
    u0, u1, u2 = us
    v0, v1, v2 = vs
    z0, z1, z2 = zs
    deepest = max(z0, z1, z2)
    if deepest > thick:
        third, force = area / 3.0, 0.0
        for u, v, z in ((u0, v0, z0), (u1, v1, z1), (u2, v2, z2)):
            force += _press(sums, third, u, v, z, thick, stiff, True)
        return force
    z, u, v = z0 + z1 + z2, u0 + u1 + u2, v0 + v1 + v2
    zu, zv = z0 * u0 + z1 * u1 + z2 * u2, z0 * v0 + z1 * v1 + z2 * v2
    uu, vv = u0 * u0 + u1 * u1 + u2 * u2, v0 * v0 + v1 * v1 + v2 * v2
    zuu, zvv = z0 * u0 * u0 + z1 * u1 * u1 + z2 * u2 * u2, z0 * v0 * v0 + z1 * v1 * v1 + z2 * v2 * v2
    part = area * stiff
    sums[FIRST_U] += part / 12.0 * (z * u + zu)
    sums[FIRST_V] += part / 12.0 * (z * v + zv)
    sums[SECOND_U] += part / 60.0 * (z * (u * u + uu) + 2.0 * (u * zu + zuu))
    sums[SECOND_V] += part / 60.0 * (z * (v * v + vv) + 2.0 * (v * zv + zvv))
    sums[ENERGY] += part / 24.0 * (z * z + z0 * z0 + z1 * z1 + z2 * z2)
    sums[DEEPEST] = max(sums[DEEPEST], deepest)
    return part / 3.0 * z


@njit(cache=True, error_model="numpy")
def _piece(sums, points, count, scale, thick, stiff, linear, middles):
    """Adds what a polygon does; depths and areas are true after `scale`, the cosine of its angle to the face.
    Returns its force.

    Where depth is looked at in points these are its centroid, alone or with its corners: what a corner more
    that is hardly apart from the next one changes is as small as their distance.
    """
    force, whole, cu, cv, cz = 0.0, 0.0, 0.0, 0.0, 0.0
    part = _part(scale) / scale
    for i in range(1, count - 1):
        a0, a1 = points[i, 0] - points[0, 0], points[i, 1] - points[0, 1]
        b0, b1 = points[i + 1, 0] - points[0, 0], points[i + 1, 1] - points[0, 1]
        area = 0.5 * part * abs(a0 * b1 - a1 * b0)
        if linear and not middles:
            us = (points[0, 0], points[i, 0], points[i + 1, 0])
            vs = (points[0, 1], points[i, 1], points[i + 1, 1])
            zs = (points[0, 2] * scale, points[i, 2] * scale, points[i + 1, 2] * scale)
            force += _press_linear(sums, area, us, vs, zs, thick, stiff)
        else:
            whole += area
            cu += area / 3.0 * (points[0, 0] + points[i, 0] + points[i + 1, 0])
            cv += area / 3.0 * (points[0, 1] + points[i, 1] + points[i + 1, 1])
            cz += area / 3.0 * (points[0, 2] + points[i, 2] + points[i + 1, 2])
    if whole <= 0.0:
        return force
    cu, cv, cz = cu / whole, cv / whole, cz / whole
    if middles:
        return _press(sums, whole, cu, cv, cz * scale, thick, stiff, linear)
    force = _press(sums, whole / 3.0, cu, cv, cz * scale, thick, stiff, linear)
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        a0, a1 = points[i, 0] - cu, points[i, 1] - cv
        b0, b1 = points[j, 0] - cu, points[j, 1] - cv
        third = 0.5 / 3.0 * part * abs(a0 * b1 - a1 * b0)
        force += _press(sums, third, points[i, 0], points[i, 1], points[i, 2] * scale, thick, stiff, linear)
        force += _press(sums, third, points[j, 0], points[j, 1], points[j, 2] * scale, thick, stiff, linear)
    return force


@njit(cache=True, error_model="numpy", forceinline=True)
def _element(sums, room, triangles, t, face):
    """Adds what one triangle does to a Face."""
    way, along, across, where, hp, hr, stiff, linear, middles = face
    cosine = -(
        way[0] * triangles[t, NORMAL] + way[1] * triangles[t, NORMAL + 1] + way[2] * triangles[t, NORMAL + 2]
    )
    if cosine <= STEEP:
        return
    z0 = where[0] - (way[0] * triangles[t, 0] + way[1] * triangles[t, 1] + way[2] * triangles[t, 2])
    z1 = where[0] - (way[0] * triangles[t, 3] + way[1] * triangles[t, 4] + way[2] * triangles[t, 5])
    z2 = where[0] - (way[0] * triangles[t, 6] + way[1] * triangles[t, 7] + way[2] * triangles[t, 8])
    if z0 <= 0.0 and z1 <= 0.0 and z2 <= 0.0:
        return
    u0 = along[0] * triangles[t, 0] + along[1] * triangles[t, 1] + along[2] * triangles[t, 2] - where[1]
    u1 = along[0] * triangles[t, 3] + along[1] * triangles[t, 4] + along[2] * triangles[t, 5] - where[1]
    u2 = along[0] * triangles[t, 6] + along[1] * triangles[t, 7] + along[2] * triangles[t, 8] - where[1]
    if min(u0, u1, u2) > hp or max(u0, u1, u2) < -hp:
        return
    v0 = across[0] * triangles[t, 0] + across[1] * triangles[t, 1] + across[2] * triangles[t, 2] - where[2]
    v1 = across[0] * triangles[t, 3] + across[1] * triangles[t, 4] + across[2] * triangles[t, 5] - where[2]
    v2 = across[0] * triangles[t, 6] + across[1] * triangles[t, 7] + across[2] * triangles[t, 8] - where[2]
    if min(v0, v1, v2) > hr or max(v0, v1, v2) < -hr:
        return
    thick, force = triangles[t, THICK], 0.0
    inside = max(abs(u0), abs(u1), abs(u2)) <= hp and max(abs(v0), abs(v1), abs(v2)) <= hr
    if inside and min(z0, z1, z2) >= 0.0:
        area = _part(cosine) * triangles[t, AREA]
        u, v, z = (u0 + u1 + u2) / 3.0, (v0 + v1 + v2) / 3.0, (z0 + z1 + z2) / 3.0
        if middles:
            force = _press(sums, area, u, v, z * cosine, thick, stiff, linear)
        elif linear:
            z0, z1, z2 = z0 * cosine, z1 * cosine, z2 * cosine
            force = _press_linear(sums, area, (u0, u1, u2), (v0, v1, v2), (z0, z1, z2), thick, stiff)
        else:
            force = _press(sums, area / 3.0, u, v, z * cosine, thick, stiff, linear)
            corner = 2.0 / 9.0 * area
            force += _press(sums, corner, u0, v0, z0 * cosine, thick, stiff, linear)
            force += _press(sums, corner, u1, v1, z1 * cosine, thick, stiff, linear)
            force += _press(sums, corner, u2, v2, z2 * cosine, thick, stiff, linear)
    else:
        which, count = _over(room, (u0, u1, u2), (v0, v1, v2), (z0, z1, z2), hp, hr)
        force = _piece(sums, room[which], count, cosine, thick, stiff, linear, middles)
    sums[FORCE] += force * triangles[t, NORMAL]
    sums[FORCE + 1] += force * triangles[t, NORMAL + 1]
    sums[FORCE + 2] += force * triangles[t, NORMAL + 2]
    sums[IN_ALL] += force


@njit(cache=True, error_model="numpy")
def gather(sums, room, head, meshes, placed, half, q, sign, stiff):
    """Adds up what presses on the face q (on the side `sign`) of a box, into its sums."""
    bounds, links, triangles = meshes.bounds, meshes.links, meshes.triangles
    middle, axes = placed.middle, placed.axes
    p, r = (q + 1) % 3, (q + 2) % 3
    way = scale(sign, (axes[q], axes[3 + q], axes[6 + q]))
    along, across = (axes[p], axes[3 + p], axes[6 + p]), (axes[r], axes[3 + r], axes[6 + r])
    where = (half[q] + dot(way, middle), dot(along, middle), dot(across, middle))
    far = BEYOND * head.most / STEEP
    linear, middles = head.basis > 0.0, head.middles != 0
    face = Face(way, along, across, where, half[p], half[r], stiff, linear, middles)
    n = head.first
    while n < head.end:
        facing = 0.0  # the least that a normal has along the face's
        for i in range(3):
            facing += min(way[i] * bounds[n, LEAST + i], way[i] * bounds[n, MOST + i])
        away, reach = span(bounds, n, way)
        apart = facing > -STEEP or away - reach > where[0] or away + reach < where[0] - far
        if not apart:
            away, reach = span(bounds, n, along)
            apart = abs(away - where[1]) > half[p] + reach
        if not apart:
            away, reach = span(bounds, n, across)
            apart = abs(away - where[2]) > half[r] + reach
        if apart:
            n = links[n, AFTER]
            continue
        for t in range(links[n, FIRST], links[n, FIRST] + links[n, COUNT]):
            _element(sums, room, triangles, t, face)
        n += 1
