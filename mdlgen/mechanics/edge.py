"""Ends of plates: the edge of a plate is a line with a radius, its end a face between two such lines.

A plate is a slab of a thickness between its two faces. Each of its free ends is an End between two such
lines. A point of a sheet is u inside of the end and h below the face.

Two contacts belong to an end. In the one the edge presses into the broad face of a box, which slides over it
(`line`): its normal is that of the box's face, as over a small roller, and its depth that of a cylinder of
the edge's radius r about an axis r inside of both faces; where the free side behind comes to the round, its
depth is that of the cylinder in the corner there (`into_corner`), which rolls off it. In the other an outer
side of a sheet stands against the end (`stub`): of the rounded section, with the angle a of the round's
normal to that of the face at the depth h, cos a = 1 - h/r,

    w = u - r (1 - sin a)        how far the side is in, along the plate; r is 0 between the rounds
    E = 2/5 k w^2.5              so the force has the direction of the round's normal at that height,

at any penetration. So a corner that is pushed along the plate climbs where tan a < 1/mu, which is a depth of
r (1 - cos(90 deg - atan mu)), and is stopped below it. Where w is more than h/(1 - h/r), a corner on the
round is over its top and is pushed up. A side has two corners at one place along it; the deeper one counts
(Holder's mean of power NORM).

A corner 0.05 mm in and 0.05 mm below a face may have come from above or from the end; that depends on its
path. So a pair stores the ends before which outer sides of its box stand, since they were last clear of the
plate: three bits of its field for each side, 0 or 1 + the number of the end.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import Vector
from mdlgen.mechanics.point import Load, push, turn
from mdlgen.mechanics.vector import add, back, cross, dot, local, rotate, scale, sub
from mdlgen.program.kernel import BORROWS, njit

NORM = 12.0
# Sine of the slope of a box to the face between which the face's law passes into that of the edge: the
# former spreads k over what of the box is over the plate, the latter has all of it on a line.
LEVEL, LEANING = 0.03, 0.1
# Where a box of a sheet passes the edge on to the next, in parts of a box, either way of their joint.
SHARED = 0.02
# So what a box of a sheet may touch: this times what it is long.
TAKES = 1.0 + 2.0 * SHARED
# Fields of a body record: its free ends as a bit mask; the radii of the edges of its upper and its lower
# face, and 1 where friction holds what is on them (a static analysis).
UPPER, LOWER, HOLDS = 0, 1, 2
ENDS = [("ends", "i8"), ("edge", "f8", 3)]
EVER = 1e300
_GAUSS = 1.0 / math.sqrt(3.0)


class End(NamedTuple):
    """A free end of a plate, global: the middle of its edge on a face, the way out of the plate, the normal
    of the face, the direction of the edge and half of its length."""

    point: Vector
    out: Vector
    up: Vector
    along: Vector
    length: float


@njit(cache=True, error_model="numpy", forceinline=True)
def leaning(sine):
    """Part of the law of the edge that acts at a slope of the box, 0 to 1."""
    s = min(max((sine - LEVEL) / (LEANING - LEVEL), 0.0), 1.0)
    return s * s * (3.0 - 2.0 * s)


@njit(cache=True, error_model="numpy", forceinline=True)
def leaning_growth(sine):
    """Growth of `leaning` with the sine."""
    s = min(max((sine - LEVEL) / (LEANING - LEVEL), 0.0), 1.0)
    return 6.0 * s * (1.0 - s) / (LEANING - LEVEL)


@njit(cache=True, error_model="numpy", forceinline=True)
def hands_over(a, exposed, inside, way):
    """Distance from the end of a plate, in radii, at which the law begins to pass from the corners of a face
    to its edge. `inside`: distance of the middle of box a inside of the end; `way` points out of it. An outer
    side ahead has 1: its edge law grows with its place on the round (`_passes`). Other sides have 2.
    """
    if inside <= 0.0:
        return 2.0
    one = a.r[0] * way[0] + a.r[3] * way[1] + a.r[6] * way[2]
    two = a.r[1] * way[0] + a.r[4] * way[1] + a.r[7] * way[2]
    p, along = (0, one) if abs(one) > abs(two) else (1, two)
    return 1.0 if exposed & (1 << (2 * p + (1 if along > 0.0 else 0))) != 0 else 2.0


@njit(cache=True, error_model="numpy", forceinline=True)
def held(normal, up, grip):
    """A normal turned to that of the plate by atan(grip) at most: what friction holds in a static analysis,
    where nothing slides."""
    cosine = dot(normal, up)
    if grip <= 0.0 or cosine >= 1.0 - 1e-12:
        return normal
    angle = math.acos(max(cosine, -1.0))
    turn = min(angle, math.atan(grip))
    sine = math.sin(angle)
    if sine < 1e-9:
        return normal
    return add(scale(math.sin(turn) / sine, up), scale(math.sin(angle - turn) / sine, normal))


@njit(cache=True, error_model="numpy")
def end_of(i, b, plate):
    """The End i of a plate on its upper face.

    Ends of a straight plate: 0 and 1 along x, 2 and 3 along z, its width; of an arc 0 where it ends and 1
    where it begins. See mechanics.guide for the axes.
    """
    radius, middle, angle = plate.shape
    half, top = plate.half, plate.top
    sign = 1.0 if i % 2 == 0 else -1.0
    if radius > 0.0:
        at = middle + sign * angle
        c, s = math.cos(at), math.sin(at)
        point, out, up = (
            ((radius - top) * c, (radius - top) * s, 0.0),
            (-sign * s, sign * c, 0.0),
            (-c, -s, 0.0),
        )
        along, length = (0.0, 0.0, 1.0), half[1]
    elif i < 2:
        point, out, up = (sign * half[0], top, 0.0), (sign, 0.0, 0.0), (0.0, 1.0, 0.0)
        along, length = (0.0, 0.0, 1.0), half[1]
    else:
        point, out, up = (0.0, top, sign * half[1]), (0.0, 0.0, sign), (0.0, 1.0, 0.0)
        along, length = (1.0, 0.0, 0.0), half[0]
    return End(add(b.x, rotate(b.r, point)), rotate(b.r, out), rotate(b.r, up), rotate(b.r, along), length)


@njit(cache=True, error_model="numpy", forceinline=True)
def rounded(u, h, thick, edge):
    """Depth of a point in an end of a plate, and its growth with u and h; 0 where it does not touch."""
    if u <= 0.0 or h <= 0.0 or h >= thick:
        return 0.0, 0.0, 0.0
    low, sign, radius = (h, 1.0, edge[UPPER]) if h <= 0.5 * thick else (thick - h, -1.0, edge[LOWER])
    if low >= radius:
        return u, 1.0, 0.0
    c = 1.0 - low / radius
    s = math.sqrt(1.0 - c * c)
    w = u - radius * (1.0 - s)
    if w <= 0.0:
        return 0.0, 0.0, 0.0
    if w * c <= low:
        return w, 1.0, sign * c / s
    return low / c, 0.0, sign / (c * c)


@njit(cache=True, error_model="numpy", forceinline=True)
def station(a, half, p, sign, end):
    """The side `sign` of axis p of a box before an end: from where to where along it (-1 to 1) it is within
    the end's length."""
    r = 1 - p
    middle = add(a.x, rotate(a.r, local(p, r, 2, sign * half[p], 0.0, 0.0)))
    way = (a.r[r], a.r[3 + r], a.r[6 + r])
    v, step = dot(sub(middle, end.point), end.along), half[r] * dot(way, end.along)
    if abs(step) < 1e-9 * half[r]:
        return (-1.0, 1.0) if abs(v) <= end.length else (0.0, 0.0)
    one, two = (-end.length - v) / step, (end.length - v) / step
    return max(-1.0, min(one, two)), min(1.0, max(one, two))


@njit(cache=True, error_model="numpy", forceinline=True)
def corner_of(a, half, p, sign, t, up, end):
    """A point of an outer side: the place t along it, on the upper or lower face; (point, u, h)."""
    r = 1 - p
    at = add(a.x, rotate(a.r, local(p, r, 2, sign * half[p], t * half[r], up * half[2])))
    gap = sub(at, end.point)
    return at, -dot(gap, end.out), -dot(gap, end.up)


@njit(cache=True, error_model="numpy", **BORROWS)
def stub(out, a, half, p, sign, end, plate, b, law):
    """The outer side `sign` of axis p of box a against an end of plate b, which does not turn."""
    thick, edge = 2.0 * plate.half[2], plate.edge
    first, last = station(a, half, p, sign, end)
    if last - first <= 1e-9:
        return
    share = 0.5 * law.k * (0.5 * (last - first) if law.shared else 1.0)
    for place in range(2):
        t = first if place == 0 else last
        one, u1, h1 = corner_of(a, half, p, sign, t, 1.0, end)
        two, u2, h2 = corner_of(a, half, p, sign, t, -1.0, end)
        if (h1 <= 0.0 and h2 >= thick) or (h2 <= 0.0 and h1 >= thick):
            # the side is taller than the end: it meets it in the middle of the plate
            part = (0.5 * thick - h1) / (h2 - h1)
            one = add(one, scale(part, sub(two, one)))
            u1, h1 = u1 + part * (u2 - u1), 0.5 * thick
        d1, along1, down1 = rounded(u1, h1, thick, edge)
        d2, along2, down2 = rounded(u2, h2, thick, edge)
        most = max(d1, d2)
        if most <= 0.0:
            continue
        whole = most * ((d1 / most) ** NORM + (d2 / most) ** NORM) ** (1.0 / NORM)
        for corner in range(2):
            depth, u, h, at = (d1, along1, down1, one) if corner == 0 else (d2, along2, down2, two)
            if depth <= 1e-3 * most:
                continue
            part = depth / whole
            steep = math.sqrt(u * u + h * h)
            normal = scale(1.0 / steep, add(scale(u, end.out), scale(h, end.up)))
            spring = share * whole * math.sqrt(whole) * part ** (NORM - 1.0) * steep
            energy = 0.4 * share * whole * whole * math.sqrt(whole) * part**NORM
            push(out, at, normal, Load(spring, depth, energy), a, b, law)


@njit(cache=True, error_model="numpy", forceinline=True)
def _passes(left, inner, half, radius):
    """Part of the edge's law that acts on a box whose side is at the distance `left` from it: 1 except near
    that side, where the next box takes over (`inner`), or where a free side ahead comes to the round."""
    if inner:
        return min(max(0.5 + left / (4.0 * SHARED * half), 0.0), 1.0)
    return min(max(left / max(radius, 1e-3 * half), 0.0), 1.0)


@njit(cache=True, error_model="numpy", forceinline=True)
def into_corner(face, side, thick):
    """Depth of a point in the end of a layer of thickness `thick`, and its growth with both arguments. `face`
    and `side`: distances inside of one of its faces, and inside of its end. Outside of both the depth is
    minus the distance from the corner. Inside it is the lesser of both, with a smooth transition (Holder's
    mean of power -NORM)."""
    if side <= 0.0 and (face <= 0.0 or face > thick):
        beyond = face if face <= 0.0 else face - thick
        far = math.sqrt(beyond * beyond + side * side)
        return (-far, -beyond / far, -side / far) if far > 0.0 else (0.0, 1.0, 0.0)
    if face <= 0.0 or side >= 1e3 * face:
        return face, 1.0, 0.0
    if side <= 0.0 or face >= 1e3 * side:
        return side, 0.0, 1.0
    least, most = min(face, side), max(face, side)
    part = (least / most) ** NORM
    depth = least * (1.0 + part) ** (-1.0 / NORM)
    return depth, (depth / face) ** (NORM + 1.0), (depth / side) ** (NORM + 1.0)


@njit(cache=True, error_model="numpy", **BORROWS)
def _pressed(out, a, box, face, edge, end, b, law, grip):
    """An edge of an end on a face of box a.

    face: (q, sign), its normal into the box is `sign` times the box's axis q; edge: (a point of the axis of
    its round, its radius); grip: what friction holds, as in `held`.
    """
    (half, exposed), (q, sign), (axis, radius) = box, face, edge
    sheet = exposed != 15
    p, r = (q + 1) % 3, (q + 2) % 3
    normal = scale(sign, (a.r[q], a.r[3 + q], a.r[6 + q]))
    lean = dot(normal, end.out)
    part = leaning(lean)
    if part <= 0.0:
        return
    place, way = back(a.r, sub(axis, a.x)), back(a.r, end.along)
    if abs(way[p]) < abs(way[r]):  # p is the axis that goes with the edge, r the one across it
        p, r = r, p
    if abs(way[p]) < 0.1:
        return
    # of a sheet that leaves the end: whether its low or high side across the edge is a free one behind
    behind = dot((a.r[r], a.r[3 + r], a.r[6 + r]), end.out)
    low_behind = sheet and exposed & (1 << (2 * r)) != 0 and behind > 0.0
    high_behind = sheet and exposed & (2 << (2 * r)) != 0 and behind < 0.0
    first, last = -end.length, end.length
    for side in range(2):
        i = p if side == 0 else r
        # of a block all sides are free, of a box of a sheet those that have no neighbour
        low = i == 2 or exposed & (1 << (2 * i)) != 0
        high = i == 2 or exposed & (2 << (2 * i)) != 0
        more = 0.0 if side == 0 else 2.0 * SHARED * half[i]
        least, most = -half[i] - (0.0 if low else more), half[i] + (0.0 if high else more)
        if side == 1:  # the part behind is on the round up to its end
            least -= radius if low_behind else 0.0
            most += radius if high_behind else 0.0
        if abs(way[i]) < 1e-12:
            if place[i] < least or place[i] > most:
                return
            continue
        one, two = (least - place[i]) / way[i], (most - place[i]) / way[i]
        first, last = max(first, min(one, two)), min(last, max(one, two))
    if last <= first:
        return
    whole = 2.0 * half[p] / abs(way[p])
    share = 0.5 * part * law.k * (min(1.0, (last - first) / whole) if law.shared else 1.0)
    inner_low = r != 2 and exposed & (1 << (2 * r)) == 0
    inner_high = r != 2 and exposed & (2 << (2 * r)) == 0
    for station in range(2):
        s = 0.5 * (first + last) + (station - 0.5) * _GAUSS * (last - first)
        at = add(place, scale(s, way))
        inside, low, high = sign * at[q] + half[q], half[r] + at[r], half[r] - at[r]
        free = min(EVER if inner_low else low, EVER if inner_high else high)
        if inside - 2.0 * half[q] > max(free, 0.0):
            # the edge is beyond the box, and nearer to its free side: that side came in over the plate's face
            continue
        left = low if low_behind else high if high_behind else EVER
        depth, through, beside = into_corner(inside, left, 2.0 * half[q])
        depth += radius
        if depth <= 0.0:
            continue
        weight = 1.0 if low_behind else _passes(low, inner_low, half[r], radius)
        weight *= 1.0 if high_behind else _passes(high, inner_high, half[r], radius)
        spring = share * weight * depth * math.sqrt(depth)
        if spring <= 0.0:
            continue
        steep = math.sqrt(through * through + beside * beside)
        across = scale(1.0 if low_behind else -1.0, (a.r[r], a.r[3 + r], a.r[6 + r]))
        onto = scale(1.0 / steep, add(scale(through, normal), scale(beside, across)))
        # where the round would touch
        point = add(a.x, add(rotate(a.r, at), scale(-radius, onto)))
        load = Load(spring * steep, depth, 0.4 * spring * depth)
        push(out, point, held(onto, end.up, grip), load, a, b, law)
        # the part that the edge has of k grows as the box turns
        turn(out, scale(-load.energy * leaning_growth(lean) / part, cross(normal, end.out)))


@njit(cache=True, error_model="numpy", **BORROWS)
def line(out, a, box, end, plate, b, law):
    """Both edges of an end in the broad faces of box a, or in any face of a block."""
    point, away, up, along, length = end
    half, edge, thick = box.half, plate.edge, 2.0 * plate.half[2]
    gap = sub(a.x, point)
    reach = math.sqrt(dot(half, half)) + max(edge[UPPER], edge[LOWER])
    if abs(dot(gap, away)) > reach or abs(dot(gap, along)) > length + reach:
        return
    height = dot(gap, up)
    if height > reach or height < -thick - reach:
        return
    # inside of the end, abreast of the box: a sheet that leans along the end lies otherwise farther along it
    abreast = scale(min(max(dot(gap, along), -length), length), along)
    inner = add(add(point, abreast), scale(-0.5 * thick, add(up, away)))
    for lower in range(2):
        normal, radius = (up, edge[UPPER]) if lower == 0 else (scale(-1.0, up), edge[LOWER])
        corner = point if lower == 0 else sub(point, scale(thick, up))
        axis = sub(corner, scale(radius, add(normal, away)))
        seen = End(point, away, normal, along, length)
        # the plate lies on one side of the sheet's middle
        q, sign = 2, 1.0 if back(a.r, sub(inner, a.x))[2] < 0.0 else -1.0
        if box.exposed == 15:
            # a block: the face through which the edge is the shortest way in, of those that look at it
            place, best = back(a.r, sub(axis, a.x)), 1e300
            n, e = back(a.r, normal), back(a.r, away)
            q = -1
            for i in range(3):
                way = 1.0 if n[i] + e[i] > 0.0 else -1.0
                if way * n[i] < -1e-9 or way * e[i] < -1e-9:
                    continue
                depth = way * place[i] + half[i]
                if depth < best:
                    best, q, sign = depth, i, way
            if q < 0:
                continue
        _pressed(out, a, box, (q, sign), (axis, radius), seen, b, law, edge[HOLDS] * law.mu_static)


@njit(cache=True, error_model="numpy", forceinline=True)
def deepest_at(thick, half, beside):
    """Greatest depth of a box (half lengths) in a plate of this half thickness, which it equals. A side that
    stands before an end may be further in, by half of the box, since the next box follows behind it."""
    return thick if beside == 0 else max(thick, min(half[0], half[1]))
