"""Contact of a box with a mesh: a closed surface of triangles, fixed or on a roller.

The two broad faces of a box meet what of the triangles lies over them. A triangle is cut to the box, and the
depth of what is left is looked at in its corners (`at: nodes`) or in its middle (`at: centres`), as the paper
has it for contact between meshes (section 3.1): with the area that this stands for it gives a force along the
triangle's normal (with corners, the middle counts, too; a pressure that is linear in depth is integrated
exactly),

    fixed:      dF = (k/A) z^1.5 dA, A the area of the box's face: a box flat on a plate has k z^1.5, and one
                that a plate covers in part has that part of it, as with a guide;
    on a roller: dF = K z dA, K = 3 k/(4 w sqrt(2 R)), R and w of the roller: the elastic foundation that
                gives k z^1.5 under a cylinder (mechanics.contact).

Both are pressures, so neither the number of triangles nor that of boxes changes what a sheet feels. A
pressure over many triangles acts as four equal forces with its sum, its middle and its spread. Where a sheet
ends, nothing takes over from the box at its edge: it has what is over it. On a roller these forces are one
nip (mechanics.point). Its contact line lies along the axis through the middle of what presses on the box
and, where that comes near another box, on the face as if the sheet went on flat.

The outer sides of a sheet meet what leans against them (mechanics.mesh_side). A block of one box has
six broad faces.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.contact import local
from mdlgen.mechanics.frame import Vector
from mdlgen.mechanics.mesh_side import Placed, meet_sides, ramp
from mdlgen.mechanics.point import PRESSING, Load, Nip, passing, push, push_in_nip
from mdlgen.mechanics.tree import (
    AFTER,
    AREA,
    COUNT,
    FIRST,
    LEAST,
    MOST,
    THICK,
    WIDTH,
    build_tree,
    overlaps,
    span,
)
from mdlgen.mechanics.vector import (
    add,
    back,
    cross,
    dot,
    matmul,
    nine,
    rotate,
    scale,
    sub,
    three,
    transpose_matmul,
)
from mdlgen.model.meshes import origin
from mdlgen.model.tables import Floats, Ints, Model
from mdlgen.program.kernel import OWNS, njit

DEEPEST = 1.0  # mm: what is deeper in a part is about to come out at its other side, or is lost
BEYOND = 1.5  # how far beyond that depth a contact is still seen, so that a run can end
STEEP, GENTLE = 0.4, 0.6  # cosines of the angles between which the law of broad faces ends
_SPAN = 2.5  # what presses under a round reaches no further than sqrt(5) times its spread
LOST = 1e30  # what a depth that ends a run is above
BLOCK = 15  # all four sides of a box are outer ones
HEAD = np.dtype(
    [
        ("first", "i8"),  # node of the tree
        ("end", "i8"),
        ("place", "f8", 3),  # of the file's axes, in those of the body that the mesh moves with
        ("axes", "f8", 9),
        ("basis", "f8"),  # 4/3 w sqrt(2 R) of the roller that it is on, 0: fixed
        ("middles", "i8"),  # depth is looked at in the middles of elements
        ("most", "f8"),  # DEEPEST
        ("edge", "f8"),  # radius of its edges, 0: sharp
        ("reach", "f8"),  # greatest distance from the body's centre
        ("unseen", "f8"),  # how far a box may move from one state that is looked at to the next
    ]
)


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


class Meshes(NamedTuple):
    """All meshes of a Model: one HEAD each, and the trees behind each other."""

    heads: np.ndarray
    bounds: Floats  # as in mechanics.tree
    links: Ints
    triangles: Floats


def mesh_tables(model: Model, mm: float = 1.0) -> Meshes:
    """The meshes of a Model for compiled code; `mm` is a millimetre in the solver's unit."""
    heads = np.zeros(len(model.meshes), HEAD)
    bounds, links, triangles = [np.zeros((0, 12))], [np.zeros((0, 3), np.int64)], [np.zeros((0, WIDTH))]
    built: dict[tuple[str, float], tuple[int, int, float]] = {}
    for head, mesh in zip(heads, model.meshes, strict=True):
        if (mesh.file, mesh.scale) not in built:
            box, link, table = build_tree(mesh.corners * mm, mesh.triangles, DEEPEST * mm)
            before, shift = sum(map(len, links)), sum(map(len, triangles))
            link[:, FIRST] += shift
            link[:, AFTER] += before
            built[mesh.file, mesh.scale] = before, before + len(link), _unseen(table)
            bounds.append(box)
            links.append(link)
            triangles.append(table)
        head["first"], head["end"], head["unseen"] = built[mesh.file, mesh.scale]
        body = mesh.body
        if mesh.on >= 0:
            roller = model.rollers[mesh.on]
            body = roller.body
            head["basis"] = 4 / 3 * roller.width * math.sqrt(2.0 * roller.radius) * mm**1.5
        turn = model.bodies.rotation[body]
        place = turn.T @ (origin(mesh, model.rollers) - model.bodies.position[body])
        head["place"], head["axes"] = place * mm, (turn.T @ mesh.axes).ravel()
        head["middles"], head["most"] = mesh.at == "centres", DEEPEST * mm
        head["edge"] = mesh.edge_radius * mm
        head["reach"] = (
            float(np.linalg.norm(place + mesh.corners @ (turn.T @ mesh.axes).T, axis=1).max()) * mm
        )
    return Meshes(heads, np.concatenate(bounds), np.concatenate(links), np.concatenate(triangles))


def _unseen(table: Floats) -> float:
    """A little less than the band in which a box that is too deep is seen, where the part is thinnest, but
    for the 2 % of its surface at its sharpest edges."""
    order = np.argsort(table[:, THICK])
    area = np.cumsum(table[order, AREA])
    thin = table[order[np.searchsorted(area, 0.02 * area[-1])], THICK]
    return 0.8 * (BEYOND - 1.0) * float(thin)


def mesh_numbers(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Of each kept pair: the number of its mesh (0 where it has none), and the body that this moves with."""
    number = {mesh.body: k for k, mesh in enumerate(model.meshes)}
    moved = {m.body: model.rollers[m.on].body for m in model.meshes if m.on >= 0}
    bodies = model.pairs.b.tolist()
    return (
        np.array([number.get(b, 0) for b in bodies], dtype=np.int64),
        np.array([moved.get(b, b) for b in bodies], dtype=np.int64),
    )


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
        sums[10] += force
        return 0.0
    sums[4] += force * u
    sums[5] += force * v
    sums[6] += force * u * u
    sums[7] += force * v * v
    sums[8] += force * depth * (0.5 if linear else 0.4)
    sums[9] = max(sums[9], depth)
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
    sums[4] += part / 12.0 * (z * u + zu)
    sums[5] += part / 12.0 * (z * v + zv)
    sums[6] += part / 60.0 * (z * (u * u + uu) + 2.0 * (u * zu + zuu))
    sums[7] += part / 60.0 * (z * (v * v + vv) + 2.0 * (v * zv + zvv))
    sums[8] += part / 24.0 * (z * z + z0 * z0 + z1 * z1 + z2 * z2)
    sums[9] = max(sums[9], deepest)
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
    cosine = -(way[0] * triangles[t, 9] + way[1] * triangles[t, 10] + way[2] * triangles[t, 11])
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
    sums[0] += force * triangles[t, 9]
    sums[1] += force * triangles[t, 10]
    sums[2] += force * triangles[t, 11]
    sums[3] += force


@njit(cache=True, error_model="numpy")
def _gather(sums, room, head, meshes, placed, half, q, sign, stiff):
    """Adds up what presses on the face q (on the side `sign`) of a box: force along the file's axes (0-2) and
    in all (3), moments in the face of first (4-5) and second order (6-7), energy (8), greatest depth (9), and
    what would be the force of what is too deep (10)."""
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


@njit(cache=True, error_model="numpy")
def _nip(sums, room, head, meshes, placed, half, sign, exposed, stiff):
    """What presses on a broad face that goes on over the sides that are not exposed: its force along the
    file's axes and its middle in the face (fx, fy, fz, u, v). `sums` has what presses on the box itself."""
    u, v = sums[0, 4] / sums[0, 3], sums[0, 5] / sums[0, 3]
    du = math.sqrt(max(sums[0, 6] / sums[0, 3] - u * u, 0.0))
    dv = math.sqrt(max(sums[0, 7] / sums[0, 3] - v * v, 0.0))
    more = math.sqrt(2.0 * head.reach * head.most)  # half of what the deepest contact with a round one spans
    grown = (
        more if exposed & 1 == 0 and -u + _SPAN * du > half[0] else 0.0,
        more if exposed & 2 == 0 and u + _SPAN * du > half[0] else 0.0,
        more if exposed & 4 == 0 and -v + _SPAN * dv > half[1] else 0.0,
        more if exposed & 8 == 0 and v + _SPAN * dv > half[1] else 0.0,
    )
    if grown[0] + grown[1] + grown[2] + grown[3] == 0.0:
        return sums[0, 0], sums[0, 1], sums[0, 2], u, v
    aside = (0.5 * (grown[1] - grown[0]), 0.5 * (grown[3] - grown[2]), 0.0)
    wide = (half[0] + 0.5 * (grown[0] + grown[1]), half[1] + 0.5 * (grown[2] + grown[3]), half[2])
    sums[1] = 0.0
    moved = Placed(add(placed.middle, rotate(placed.axes, aside)), placed.axes, placed.frame)
    _gather(sums[1], room, head, meshes, moved, wide, 2, sign, stiff)
    u, v = sums[1, 4] / sums[1, 3] + aside[0], sums[1, 5] / sums[1, 3] + aside[1]
    return sums[1, 0], sums[1, 1], sums[1, 2], u, v


@njit(cache=True, error_model="numpy", **OWNS)
def box_mesh(out, a, box, b, axis, head, meshes, law):
    """Box a on a mesh that moves with body b; axis: of the roller, where b is one."""
    half, exposed = box
    ra = a.r
    frame = matmul(b.r, nine(head.axes))
    place = add(b.x, rotate(b.r, three(head.place)))
    middle, axes = back(frame, sub(a.x, place)), transpose_matmul(frame, ra)
    if not overlaps(meshes.bounds, meshes.links, head.first, head.end, middle, axes, half):
        return
    placed, over = Placed(middle, axes, frame), 1.0
    if exposed != 0 and exposed != BLOCK:
        over = meet_sides(out, a, box, placed, head, meshes, b, law)
    both, room = np.zeros((2, 11)), np.empty((2, 12, 3))
    sums = both[0]
    lost, spot, out_of = 0.0, a.x, (0.0, 0.0, 0.0)
    for face in range(6 if exposed == BLOCK else 2):
        q, sign = (2 + face // 2) % 3, 1.0 if face % 2 == 0 else -1.0
        p, r = (q + 1) % 3, (q + 2) % 3
        stiff = law.k / head.basis if head.basis > 0.0 else law.k / (4.0 * half[p] * half[r])
        sums[:] = 0.0
        _gather(sums, room, head, meshes, placed, half, q, sign, stiff)
        force = math.sqrt(sums[0] * sums[0] + sums[1] * sums[1] + sums[2] * sums[2])
        if sums[10] > 0.0 and (lost == 0.0 or sums[10] < lost):
            lost, spot = sums[10], add(a.x, rotate(ra, local(p, r, q, 0.0, 0.0, sign * half[q])))
            out_of = rotate(ra, local(p, r, q, 0.0, 0.0, -sign))
        if force <= 0.0 or over <= 0.0:
            continue
        normal = rotate(frame, (sums[0] / force, sums[1] / force, sums[2] / force))
        u, v = sums[4] / sums[3], sums[5] / sums[3]
        du = math.sqrt(max(sums[6] / sums[3] - u * u, 0.0))
        dv = math.sqrt(max(sums[7] / sums[3] - v * v, 0.0))
        line, way, pressed = a.x, normal, 0.0
        if head.basis > 0.0:
            sides = exposed if q == 2 else BLOCK
            fx, fy, fz, line_u, line_v = _nip(both, room, head, meshes, placed, half, sign, sides, stiff)
            line = add(a.x, rotate(ra, local(p, r, q, line_u, line_v, sign * half[q])))
            way = rotate(frame, scale(1.0 / math.sqrt(fx * fx + fy * fy + fz * fz), (fx, fy, fz)))
            across = cross(axis, way)
            seen = back(ra, across)
            # a parabola of pressure with the deviation s along the way is 2 sqrt(5) s long
            wide = math.sqrt(5.0 * ((du * seen[p]) ** 2 + (dv * seen[r]) ** 2))
            if wide > 0.0:
                pressed = passing(line, across, 2.0 * sums[9] / wide, a, b)
        for corner in range(4):
            at_u = u + (du if corner % 2 == 0 else -du)
            at_v = v + (dv if corner < 2 else -dv)
            point = add(a.x, rotate(ra, local(p, r, q, at_u, at_v, sign * half[q])))
            spring, energy = 0.25 * over * force, 0.25 * over * sums[8]
            if head.basis > 0.0:
                under = add(line, scale(dot(sub(point, line), axis), axis))
                # on the mesh's own surface, where that is deepest: see mechanics.point
                point = add(point, scale(sums[9] / dot(normal, way), normal))
                nip = Nip(under, way, pressed)
                push_in_nip(out, point, normal, nip, Load(spring, sums[9], energy), a, b, law)
            else:
                push(out, point, normal, Load(spring, sums[9], energy), a, b, law)
    if lost > 0.0 and out[PRESSING] == 0.0:  # what is as near to the other side is in contact there
        push(out, spot, out_of, Load(lost, math.inf, 0.0), a, b, law)


@njit(cache=True, error_model="numpy")
def mesh_near(head, meshes, xa, ra, half, xb, rb, more):
    """Whether a box that is larger by `more` on all sides may meet a leaf of the mesh's tree."""
    frame = matmul(rb, nine(head.axes))
    middle = back(frame, sub(xa, add(xb, rotate(rb, three(head.place)))))
    wide = (half[0] + more, half[1] + more, half[2] + more)
    axes = transpose_matmul(frame, ra)
    return overlaps(meshes.bounds, meshes.links, head.first, head.end, middle, axes, wide)
