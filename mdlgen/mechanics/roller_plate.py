"""Contact of a roller with a plate: a plane or a straight guide; with an arc; which of both a guide is.

The force is k z^1.5 (Eq. 10) where the whole width of the roller stands z deep in a flat face; a part of the
width that is over the plate has that part of k. Each part of the width acts at two points, with the depth
that the roller's lowest line has there: exact for a roller that is parallel to the face. One that leans by an
angle touches with the end of its width that is deeper, by the same k per width:
F = k/w times the integral of z^1.5 along it.

Where the roller's lowest line is beyond an edge of the plate the edge is touched, a sharp line: z is the
radius less the distance of the axis from it, and the force points from it to the axis. So a roller that rolls
off a plate turns round its edge. Friction acts at the roller's own round, at its radius: a roller that rolls
at omega moves at omega R. The depth of a point changes with the velocity of the axis alone, so that rolling
is free of damping.

A plane is a solid plate for a roller: either face and all edges are touched, by which side of it the axis is
on; of a guide the sides that its `side` names. A roller whose axis is inside the plate stands in a hole of
it, and does not touch. In an arc the depth is that of two cylinders in line contact: distance + r - R in the
hollow, R + r - distance on the round.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import ARC_RADIUS, RADIUS, WIDTH, Vector, scaled
from mdlgen.mechanics.guide import BOTH, INSIDE, OUTSIDE, inward
from mdlgen.mechanics.point import FORCE_A, FORCE_B, TORQUE_A, Load, push
from mdlgen.mechanics.rim import profile
from mdlgen.mechanics.vector import add, back, cross, dot, rotate, scale, sub, three
from mdlgen.program.kernel import BORROWS, CALLED, OWNS, njit

# Cosine of the angle between a roller's axis and a face's normal, above which the roller stands on its end.
STEEPEST = 0.5
# Greatest depth of a roller in a plate, relative to its radius: beyond it its axis is soon behind the face.
DEEP_ROLLER = 0.5
_GAUSS = 1.0 / math.sqrt(3.0)


class Spot(NamedTuple):
    """Place at which a roller is touched.

    at: a point of its axis; way: unit vector from there, perpendicular to the axis, to the touched place;
    gap: distance of that place from the axis along `normal`, which points to the roller, so that the depth is
    the radius minus the gap; turns: angle by which `way` turns as the axis moves by a unit along axis x way.
    """

    at: Vector
    way: Vector
    gap: float
    normal: Vector
    turns: float


class Face(NamedTuple):
    """A flat face: its middle, two unit vectors in it and the outward normal, its half lengths, the thickness
    of the plate, and whether the face on the other side is touched, too."""

    middle: Vector
    ways: tuple[Vector, Vector, Vector]
    half: tuple[float, float]
    thick: float
    both: bool


@njit(cache=True, error_model="numpy")
def touch(out, body, rims, a, spot, weight, b, law):
    """Adds one point of a roller a (a record with its axis, size and RIM) on b, which does not turn.

    rims: the table of mechanics.rim; weight: the point's part of k.
    """
    at, way, gap, normal, turns = spot
    upright = -dot(way, normal)  # 1 but for a roller that leans
    axis = three(body.axis)
    radius, lever, stiff, rough, growth, damping = body.size[RADIUS], 0.0, 1.0, 1.0, 0.0, law.beta
    if body.rims > 0:
        own = back(a.r, way)
        angle = math.atan2(own[1], own[0])
        radius, lever, stiff, rough, growth, damping = profile(body, rims, angle, law.beta)
    depth = radius * upright - gap
    if depth <= 0.0:
        return
    spring = weight * law.k * stiff * depth * math.sqrt(depth)
    energy = 0.4 * spring * depth
    aside = cross(axis, way)
    point = add(at, add(scale(radius, way), scale(lever, aside)))
    push(out, point, normal, Load(spring, depth, energy), a, b, scaled(law, stiff, rough, damping))
    if body.rims > 0:
        # the energy changes with the angle of the rim: a stiffness that grows with it turns the roller on
        torque = energy * growth / stiff
        swing = -turns * (torque + spring * lever)
        for i in range(3):
            out[FORCE_A + i] += swing * aside[i]
            out[FORCE_B + i] -= swing * aside[i]
            out[TORQUE_A + i] += torque * axis[i]


@njit(cache=True, error_model="numpy", forceinline=True)
def _inside(at, step, half, low, high):
    """Cuts an interval of s to where |at + s step| <= half."""
    if abs(step) < 1e-12:
        return (low, high) if abs(at) <= half else (1.0, 0.0)
    one, two = (-half - at) / step, (half - at) / step
    return max(low, min(one, two)), min(high, max(one, two))


@njit(cache=True, error_model="numpy", **OWNS)
def roller_plate(out, body, rims, a, b, face, law):
    """Roller a against a Face of a flat plate b."""
    axis = three(body.axis)
    radius, width = body.size[RADIUS], body.size[WIDTH]
    middle, ways, half, thick, both = face
    gap = sub(a.x, middle)
    p, r, n = ways
    height, lean, normal, other = dot(gap, n), dot(axis, n), n, False
    if both and height < -0.5 * thick:  # on the other side: the plate as seen from there
        height, lean, normal, other = -thick - height, -lean, scale(-1.0, n), True
    cosine = math.sqrt(max(0.0, 1.0 - lean * lean))
    if height - 0.5 * width * abs(lean) > radius or abs(lean) > STEEPEST:
        return
    # places in the face: s along the axis, t across; the lowest line of the roller is at t = across
    up, ur = dot(axis, p) / cosine, dot(axis, r) / cosine
    cp, cr = dot(gap, p), dot(gap, r)
    along, across = cp * up + cr * ur, cr * up - cp * ur
    if abs(across) > math.sqrt(half[0] * half[0] + half[1] * half[1]) + radius:
        return
    shift = radius * lean  # how far along s the lowest line is from below the axis
    reach = abs(up) * half[0] + abs(ur) * half[1]
    begin = max(along + shift - 0.5 * width * cosine, -reach)
    end = min(along + shift + 0.5 * width * cosine, reach)
    low, high = _inside(-across * ur, up, half[0], begin, end)
    low, high = _inside(across * up, ur, half[1], low, high)
    whole = high > low  # some of the lowest line is over the plate
    down = scale(1.0 / cosine, sub(scale(lean, axis), normal))
    if whole:
        # where the line is below the face
        first, last = low, high
        if abs(lean) > 1e-12:
            level = along + shift + (radius * cosine - height) / lean * cosine
            first, last = (first, min(last, level)) if lean > 0.0 else (max(first, level), last)
        if body.rims > 0:  # the round is not as wide everywhere
            first, last = low, high
        for station in range(2):
            if last - first <= 1e-12 * width:
                break
            s = 0.5 * (first + last) + (station - 0.5) * _GAUSS * (last - first)
            u = (s - along - shift) / cosine
            over = height + u * lean
            if over > 0.0:
                weight = 0.5 * (last - first) / (cosine * width)
                at = add(a.x, scale(u, axis))
                touch(out, body, rims, a, Spot(at, down, over, normal, 0.0), weight, b, law)
    # part of the width that is not over the plate, and may touch an edge
    for part in range(2):
        first = begin if part == 0 else high
        last = low if part == 0 else end
        if not whole:
            first, last = (begin, 0.5 * (begin + end)) if part == 0 else (0.5 * (begin + end), end)
        if last - first <= 1e-9 * width:
            continue
        for station in range(2):
            s = 0.5 * (first + last) + (station - 0.5) * _GAUSS * (last - first)
            near, far = _inside(s * up, -ur, half[0], -1e30, 1e30)
            near, far = _inside(s * ur, up, half[1], near, far)
            if far <= near or near < across < far:
                continue
            t = near if across <= near else far
            deep = min(0.0, max(-thick, height + (s - along) / cosine * lean))
            # from the middle of the face, as it is seen
            place = add(middle, add(scale(s * up - t * ur, p), scale(s * ur + t * up, r)))
            place = add(place, scale(deep, normal))
            if other:
                place = sub(place, scale(thick, n))
            to = sub(place, a.x)
            u = dot(to, axis)
            if abs(u) > 0.5 * width:
                continue
            to = sub(to, scale(u, axis))
            away = math.sqrt(dot(to, to))
            if away <= 0.0 or away >= radius:
                continue
            weight = 0.5 * (last - first) / (cosine * width)
            way = scale(1.0 / away, to)
            at, turned = add(a.x, scale(u, axis)), -1.0 / away
            touch(out, body, rims, a, Spot(at, way, away, scale(-1.0, way), turned), weight, b, law)


@njit(cache=True, error_model="numpy")
def _end(out, body, rims, a, width, b, own, line, law):
    """A roller against an end of an arc: a line at an angle, from one radius to another; own: the axis of the
    roller as the guide has it, width: the middle of the width that meets it, and its part of the whole."""
    at, share = width
    angle, near, far = line
    ray = (math.cos(angle), math.sin(angle))
    along = min(max(own[0] * ray[0] + own[1] * ray[1], near), far)
    x, y = along * ray[0] - own[0], along * ray[1] - own[1]
    away = math.sqrt(x * x + y * y)
    if away <= 0.0 or away >= body.size[RADIUS]:
        return
    way = rotate(b.r, (x / away, y / away, 0.0))
    touch(out, body, rims, a, Spot(at, way, away, scale(-1.0, way), -1.0 / away), share, b, law)


@njit(cache=True, error_model="numpy")
def roller_arc(out, body, rims, a, b, shape, half, side, law):
    """Roller a against a guide b that is an arc, of a parallel axis; the rest as in mechanics.guide."""
    radius, middle, angle = shape
    rb = b.r
    own, width, thick = back(rb, sub(a.x, b.x)), body.size[WIDTH], 2.0 * half[2]
    low, high = max(own[2] - 0.5 * width, -half[1]), min(own[2] + 0.5 * width, half[1])
    if high <= low:
        return
    share = (high - low) / width
    axis = three(body.axis)
    sense = 1.0 if axis[0] * rb[2] + axis[1] * rb[5] + axis[2] * rb[8] > 0.0 else -1.0
    at = add(a.x, scale(sense * (0.5 * (low + high) - own[2]), axis))
    distance = math.sqrt(own[0] * own[0] + own[1] * own[1])
    outer = radius + (thick if side == INSIDE else 0.5 * thick if side == BOTH else 0.0)
    inner = outer - thick
    turn = math.atan2(own[1], own[0]) - middle
    turn -= 2.0 * math.pi * math.floor(turn / (2.0 * math.pi) + 0.5)
    if abs(turn) > angle:
        for end in (-1.0, 1.0):
            _end(out, body, rims, a, (at, share), b, own, (middle + end * angle, inner, outer), law)
        return
    if distance == 0.0:
        return
    hollow = side == INSIDE or (side == BOTH and inward(own, radius) >= 0.0)
    if (hollow and distance > inner) or (not hollow and distance < outer):
        return  # behind the face, or in the plate
    away = rotate(rb, (own[0] / distance, own[1] / distance, 0.0))
    gap = inner - distance if hollow else distance - outer
    way = away if hollow else scale(-1.0, away)
    turned = 1.0 / distance if hollow else -1.0 / distance
    touch(out, body, rims, a, Spot(at, way, gap, scale(-1.0, way), turned), share, b, law)


@njit(cache=True, error_model="numpy", **BORROWS)
def reach_along(body, way):
    """Extent of a roller to both sides of its centre along a direction."""
    lean = dot(three(body.axis), way)
    return 0.5 * body.size[WIDTH] * abs(lean) + body.size[RADIUS] * math.sqrt(max(0.0, 1.0 - lean * lean))


@njit(cache=True, error_model="numpy", **BORROWS, **CALLED)
def plate_near(body, at, rb, other, more):
    """True if a roller whose centre is at a place (axes rb) of a plane may be nearer to it than `more`."""
    for i in range(3):
        way = (rb[i], rb[3 + i], rb[6 + i])
        if abs(at[i]) > other.half[i] + reach_along(body, way) + more:
            return False
    return True


@njit(cache=True, error_model="numpy", **BORROWS, **CALLED)
def guide_near(body, at, rb, other, more):
    """As plate_near for a guide."""
    half, radius = other.half, other.arc[ARC_RADIUS]
    if abs(at[2]) > half[1] + reach_along(body, (rb[2], rb[5], rb[8])) + more:
        return False
    if radius > 0.0:
        return abs(inward(at, radius)) <= body.size[RADIUS] + 2.0 * half[2] + more
    if abs(at[0]) > half[0] + reach_along(body, (rb[0], rb[3], rb[6])) + more:
        return False
    return abs(at[1]) <= 2.0 * half[2] + reach_along(body, (rb[1], rb[4], rb[7])) + more


@njit(cache=True, error_model="numpy", **CALLED)
def roller_plane(out, body, rims, a, b, half, law):
    """Roller a against plane b, of half lengths `half` along its axes, which does not turn."""
    rb = b.r
    n = (rb[2], rb[5], rb[8])
    ways = ((rb[0], rb[3], rb[6]), (rb[1], rb[4], rb[7]), n)
    face = Face(add(b.x, scale(half[2], n)), ways, (half[0], half[1]), 2.0 * half[2], True)
    roller_plate(out, body, rims, a, b, face, law)


@njit(cache=True, error_model="numpy", **CALLED)
def roller_guide(out, body, rims, a, b, shape, half, side, law):
    """Roller a against guide b, which does not move; side: INSIDE, OUTSIDE or BOTH; the rest as in Plate."""
    if shape[ARC_RADIUS] > 0.0:
        roller_arc(out, body, rims, a, b, shape, half, side, law)
        return
    rb = b.r
    sign = 1.0 if side != OUTSIDE else -1.0
    n = scale(sign, (rb[1], rb[4], rb[7]))
    ways = ((rb[0], rb[3], rb[6]), (rb[2], rb[5], rb[8]), n)
    both = side == BOTH
    middle = add(b.x, scale(half[2], n)) if both else b.x
    roller_plate(out, body, rims, a, b, Face(middle, ways, (half[0], half[1]), 2.0 * half[2], both), law)
