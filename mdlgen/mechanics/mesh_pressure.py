"""Pressure of the triangles of a mesh on one face of a box: each is cut to the region of the face, and the
remaining polygon has a pressure by its depth (see mechanics.mesh for the laws).

Force and torque of a triangle are integrals of the pressure along its normal, at the triangle itself. They
are sums over Dunavant's 7 points in each of the triangles that a polygon forms with its centroid.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import Vector
from mdlgen.mechanics.mesh_face import STEEP, beyond, part_of, turning
from mdlgen.mechanics.mesh_tables import BEYOND
from mdlgen.mechanics.tree import AFTER, AREA, COUNT, FIRST, LEAST, MOST, NORMAL, THICK, behind, span
from mdlgen.mechanics.vector import add, cross, dot, scale, three, vec
from mdlgen.program.kernel import njit

EVER = 1e300
# Columns of the sums of a face: force along the file's axes (3); its torque about the box's middle (3); the
# sum of the magnitudes; their moments in the face, of first and of second order, and with the depth; energy;
# greatest depth; the force that parts which are too deep would have.
FORCE, TORQUE, IN_ALL, FIRST_U, FIRST_V, SECOND_U, SECOND_V, FIRST_Z = 0, 3, 6, 7, 8, 9, 10, 11
ENERGY, DEEPEST, TOO_DEEP, SUMS = 12, 13, 14, 15
# Dunavant's rule of degree 5 on a triangle: two groups of three points, each near a corner or the middle of a
# side, and the centroid; barycentric coordinate of the one and of the two others, and the weight of a point.
_NEAR = (0.797426985353087, 0.101286507323456, 0.125939180544827)
_SIDE = (0.059715871789770, 0.470142064105115, 0.132394152788506)
_CENTROID = 0.225


class Side(NamedTuple):
    """A face of a box: its axis q and its side. For a block, the region in which the face is the one that
    presses: its narrowing with depth, along p and along r, and its depth. These are 0, 0 and EVER for a face
    that extends over its sides. `through` and `taken` are for such a face, see `_by_the_other`."""

    q: int
    sign: float
    narrows_p: float
    narrows_r: float
    most: float
    through: float
    taken: bool


class Face(NamedTuple):
    """A face of a box in the axes of the mesh's file: its normal and the directions of both sides; the box's
    middle along these three, along the normal with its half length; half lengths of both sides and along the
    normal; stiffness per area; whether the pressure is linear in depth; whether the depth is evaluated in the
    middles of triangles only; the rest as of a Side.
    """

    way: Vector
    along: Vector
    across: Vector
    where: Vector
    half_along: float
    half_across: float
    half: float
    stiffness: float
    linear: bool
    middles: bool
    narrows_along: float
    narrows_across: float
    most: float
    through: float
    taken: bool


class Element(NamedTuple):
    """A triangle relative to a face: the stiffness of its pressure per true area; true if that is linear in
    depth; the depth from which on it is too deep; the component of its normal into the face, and those along
    and across it, times the narrowing of the region there."""

    stiffness: float
    linear: bool
    deepest: float
    cosine: float
    leans_along: float
    leans_across: float


@njit(cache=True, error_model="numpy")
def _cut(points, kept, count, axis, sign, narrows, limit):
    """Cuts a polygon by sign times a coordinate + narrows times the depth <= limit into `kept`; returns its
    number of points."""
    found = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        d1 = limit - sign * points[i, axis] - narrows * points[i, 2]
        d2 = limit - sign * points[j, axis] - narrows * points[j, 2]
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
def _over(room, u, v, z, face):
    """Cuts a triangle with corners at u, v (depths z) to the region over a Face and below it. Returns (which,
    number of points); the points are in row `which` of the scratch array."""
    for k in range(3):
        room[0, k, 0], room[0, k, 1], room[0, k, 2] = u[k], v[k], z[k]
    which, count = 0, 3
    for plane in range(6):
        axis, side, narrows = plane // 2, 1.0 if plane % 2 == 1 else -1.0, 0.0
        limit = 0.0 if plane == 4 else face.most
        if axis == 0:
            limit, narrows = face.half_along, face.narrows_along
        elif axis == 1:
            limit, narrows = face.half_across, face.narrows_across
        beyond = False
        for k in range(count):
            beyond = beyond or side * room[which, k, axis] + narrows * room[which, k, 2] > limit
        if beyond:
            count = _cut(room[which], room[1 - which], count, axis, side, narrows, limit)
            which = 1 - which
        if count < 3:
            return which, 0
    return which, count


@njit(cache=True, error_model="numpy", forceinline=True)
def _stored(element, u, v):
    """Energy of a place over its force and depth, relative to that of a pressure of the same power. It
    differs since the region of a block has a part along its sides (see mechanics.mesh)."""
    along = element.leans_along if u > 0.0 else -element.leans_along
    return element.cosine - along - (element.leans_across if v > 0.0 else -element.leans_across)


@njit(cache=True, error_model="numpy", forceinline=True)
def _press(sums, area, u, v, depth, element):
    """Adds the pressure of an area of an Element at a depth."""
    if depth <= 0.0 or depth > BEYOND * element.deepest:
        return
    force = area * element.stiffness * depth * (1.0 if element.linear else math.sqrt(depth))
    if depth > element.deepest:
        sums[TOO_DEEP] += force
        return
    sums[IN_ALL] += force
    sums[FIRST_U] += force * u
    sums[FIRST_V] += force * v
    sums[FIRST_Z] += force * depth
    sums[SECOND_U] += force * u * u
    sums[SECOND_V] += force * v * v
    sums[ENERGY] += force * depth * (0.5 if element.linear else 0.4) * _stored(element, u, v)


@njit(cache=True, error_model="numpy")
def _press_all(sums, area, one, two, three, element):
    """Adds the pressure of a triangle (its corners), by a rule that is exact up to the fifth power of
    places."""
    u = (one[0] + two[0] + three[0]) / 3.0
    v = (one[1] + two[1] + three[1]) / 3.0
    z = (one[2] + two[2] + three[2]) / 3.0
    _press(sums, _CENTROID * area, u, v, z, element)
    for rule in (_NEAR, _SIDE):
        own, other, weight = rule
        more = own - other
        _press(
            sums,
            weight * area,
            3.0 * other * u + more * one[0],
            3.0 * other * v + more * one[1],
            3.0 * other * z + more * one[2],
            element,
        )
        _press(
            sums,
            weight * area,
            3.0 * other * u + more * two[0],
            3.0 * other * v + more * two[1],
            3.0 * other * z + more * two[2],
            element,
        )
        _press(
            sums,
            weight * area,
            3.0 * other * u + more * three[0],
            3.0 * other * v + more * three[1],
            3.0 * other * z + more * three[2],
            element,
        )
    sums[DEEPEST] = max(sums[DEEPEST], min(max(one[2], two[2], three[2]), element.deepest))


@njit(cache=True, error_model="numpy", forceinline=True)
def _size(one, two, three):
    """Area of a triangle by its corners."""
    a0, a1, a2 = two[0] - one[0], two[1] - one[1], two[2] - one[2]
    b0, b1, b2 = three[0] - one[0], three[1] - one[1], three[2] - one[2]
    x, y, z = a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0
    return 0.5 * math.sqrt(x * x + y * y + z * z)


@njit(cache=True, error_model="numpy")
def _piece(sums, points, count, element, middles):
    """Adds the pressure of a polygon: of the triangles that its sides form with its centroid, or of the
    centroid alone. So an additional corner near another one changes the result in proportion to their
    distance."""
    first, whole, center = vec(points, 0), 0.0, (0.0, 0.0, 0.0)
    for i in range(1, count - 1):
        one, two = vec(points, i), vec(points, i + 1)
        area = _size(first, one, two)
        whole += area
        center = add(center, scale(area / 3.0, add(first, add(one, two))))
    if whole <= 0.0:
        return
    center = scale(1.0 / whole, center)
    if middles:
        _press(sums, whole, center[0], center[1], center[2], element)
        sums[DEEPEST] = max(sums[DEEPEST], min(center[2], element.deepest))
        return
    for i in range(count):
        one, two = vec(points, i), vec(points, i + 1 if i + 1 < count else 0)
        _press_all(sums, _size(center, one, two), center, one, two, element)


@njit(cache=True, error_model="numpy")
def _middle(points, count):
    """The mean of a polygon's points, and their greatest depth."""
    u = v = z = deepest = 0.0
    for i in range(count):
        u, v, z, deepest = u + points[i, 0], v + points[i, 1], z + points[i, 2], max(deepest, points[i, 2])
    return (u / count, v / count, z / count), deepest


@njit(cache=True, error_model="numpy")
def _by_the_other(meshes, head, t, face, u, v, z, deepest):
    """True if triangle t, which looks at a broad face of a box, came in through the other face. Then it does
    not press here. u, v, z: its middle; deepest: the greatest depth of its points.

    A sheet lies on a sharp edge. The lower side of the edge looks at the upper face of the sheet and is deep
    below it. From there the part is followed upwards to where it ends. The other face has let that end in by
    the thickness of the box, less the depth of the triangle, plus the length of the way. The triangle came in
    there if that is less than `through`: half of the thickness of the box if no face has met the part before,
    else the depth at the face that has (`taken`). A face that has not also needs the near half of the part.
    """
    thick = 2.0 * face.half
    if head.thin == 0 or deepest <= thick - face.through:
        return False
    at = add(scale(face.where[0] - z, face.way), scale(u + face.where[1], face.along))
    at = add(at, scale(v + face.where[2], face.across))
    bounds, links, triangles = meshes.bounds, meshes.links, meshes.triangles
    far = max(2.0 * z, z + face.through)
    wall, by = behind(bounds, links, triangles, head.first, head.end, at, face.way, far)
    if by < 0 or dot(face.way, three(triangles[by, NORMAL:])) <= STEEP:
        return False  # the other face has nothing of that triangle
    # 1e-6: at the limit a triangle counts as one of the other face, in spite of round-off
    return z - wall > (1.0 - 1e-6) * thick - face.through or (face.taken and 2.0 * z > wall)


@njit(cache=True, error_model="numpy", forceinline=True)
def _element(sums, room, head, meshes, t, face):
    """Adds the pressure of one triangle on a Face."""
    triangles = meshes.triangles
    way, along, across, where = face.way, face.along, face.across, face.where
    hp, hr, block = face.half_along, face.half_across, face.most < EVER
    normal = (triangles[t, NORMAL], triangles[t, NORMAL + 1], triangles[t, NORMAL + 2])
    cosine = -dot(way, normal)
    if cosine <= STEEP and not block:
        return
    z0 = where[0] - (way[0] * triangles[t, 0] + way[1] * triangles[t, 1] + way[2] * triangles[t, 2])
    z1 = where[0] - (way[0] * triangles[t, 3] + way[1] * triangles[t, 4] + way[2] * triangles[t, 5])
    z2 = where[0] - (way[0] * triangles[t, 6] + way[1] * triangles[t, 7] + way[2] * triangles[t, 8])
    if (z0 <= 0.0 and z1 <= 0.0 and z2 <= 0.0) or min(z0, z1, z2) >= face.most:
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
    part = 1.0 if block else part_of(cosine)
    element = Element(
        part * face.stiffness,
        face.linear,
        triangles[t, THICK] / cosine if cosine > STEEP else EVER,
        cosine,
        face.narrows_along * dot(along, normal),
        face.narrows_across * dot(across, normal),
    )
    before = (sums[IN_ALL], sums[FIRST_U], sums[FIRST_V], sums[FIRST_Z], sums[ENERGY])
    by_u, by_v = face.narrows_along, face.narrows_across
    inside = (
        max(abs(u0) + by_u * z0, abs(u1) + by_u * z1, abs(u2) + by_u * z2) <= hp
        and max(abs(v0) + by_v * z0, abs(v1) + by_v * z1, abs(v2) + by_v * z2) <= hr
        and max(z0, z1, z2) <= face.most
    )
    if inside and min(z0, z1, z2) >= 0.0:
        u, v, z = (u0 + u1 + u2) / 3.0, (v0 + v1 + v2) / 3.0, (z0 + z1 + z2) / 3.0
        if not block and _by_the_other(meshes, head, t, face, u, v, z, max(z0, z1, z2)):
            return
        if face.middles:
            _press(sums, triangles[t, AREA], u, v, z, element)
            sums[DEEPEST] = max(sums[DEEPEST], min(z, element.deepest))
        else:
            _press_all(sums, triangles[t, AREA], (u0, v0, z0), (u1, v1, z1), (u2, v2, z2), element)
    else:
        which, count = _over(room, (u0, u1, u2), (v0, v1, v2), (z0, z1, z2), face)
        if count < 3:
            return
        (u, v, z), deepest = _middle(room[which], count)
        if not block and _by_the_other(meshes, head, t, face, u, v, z, deepest):
            return
        _piece(sums, room[which], count, element, face.middles)
    force, at_u, at_v = sums[IN_ALL] - before[0], sums[FIRST_U] - before[1], sums[FIRST_V] - before[2]
    # the pressure acts on the triangle itself, which is that deep below the face
    at = add(
        scale(force * face.half - (sums[FIRST_Z] - before[3]), way),
        add(scale(at_u, along), scale(at_v, across)),
    )
    torque = cross(at, normal)
    if not block:
        # the part of the law that acts changes as the box turns
        torque = add(torque, scale((sums[ENERGY] - before[4]) * turning(cosine), cross(way, normal)))
    push = scale(force, normal)
    if force > 0.0 and not (block or face.middles or face.linear):
        along_sides, turned = beyond(meshes, t, face, element, part, (u0, u1, u2), (v0, v1, v2), (z0, z1, z2))
        push, torque = add(push, along_sides), add(torque, turned)
    for i in range(3):
        sums[FORCE + i] += push[i]
        sums[TORQUE + i] += torque[i]


@njit(cache=True, error_model="numpy")
def gather(sums, room, head, meshes, placed, half, side, stiff):
    """Adds the pressure of all triangles on a Side of a box to its sums."""
    bounds, links = meshes.bounds, meshes.links
    middle, axes = placed.middle, placed.axes
    q, sign, narrows_p, narrows_r, most, through, taken = side
    p, r = (q + 1) % 3, (q + 2) % 3
    way = scale(sign, (axes[q], axes[3 + q], axes[6 + q]))
    along, across = (axes[p], axes[3 + p], axes[6 + p]), (axes[r], axes[3 + r], axes[6 + r])
    where = (half[q] + dot(way, middle), dot(along, middle), dot(across, middle))
    block = most < EVER
    far = min(BEYOND * head.most / STEEP, most)
    linear, middles = head.basis > 0.0, head.middles != 0
    face = Face(
        way,
        along,
        across,
        where,
        half[p],
        half[r],
        half[q],
        stiff,
        linear,
        middles,
        narrows_p,
        narrows_r,
        most,
        through,
        taken,
    )
    n = head.first
    while n < head.end:
        facing = -1.0  # the least that a normal has along the face's
        if not block:
            facing = 0.0
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
            _element(sums, room, head, meshes, t, face)
        n += 1
