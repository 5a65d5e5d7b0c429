"""The overlap of two boxes' faces, cached while the boxes hardly move along them.

Boxes of two sheets that lie on each other move across their faces as the contact deforms, and along them as
they slide. The corners of the overlap (mechanics.facing), and the area of each, depend on the latter alone,
and cost ten times as much as the force. So they are cached with the pair, in the axes of the face that owns
the contact. The depth of a corner, its place and its normal are those of the present boxes. The overlap is
recomputed after a corner of the other face may have moved along the owner by more than MOVED times the least
half length of both.

Faces whose outlines are apart have no overlap, nor have boxes that are apart when they are checked.
`facing.box_box` evaluates all other cases each time: a side of a box owns the contact, since it overlaps by
less than the faces do, or a box stands on its edge.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.facing import GRAZE, TIE, overlay, shares
from mdlgen.mechanics.frame import Frame
from mdlgen.mechanics.impacts import stored_beyond, turning_back
from mdlgen.mechanics.laws import damped, friction_over_speed
from mdlgen.mechanics.point import (
    DEPTH,
    DISSIPATED,
    FORCE_A,
    FORCE_B,
    GRIP,
    PRESSING,
    RUBBING,
    STORED,
    TORQUE_A,
    TORQUE_B,
)
from mdlgen.mechanics.vector import add, back, cross, dot, rotate, sub, transpose_matmul
from mdlgen.program.kernel import BORROWS, FUSED, OWNS, njit

# States of a pair: not known yet, outlines apart, an overlap, another case.
UNKNOWN, APART, OVERLAPS, OTHER = 0, 1, 2, 3
MOST_CORNERS = 8  # corners of the intersection of two rectangles.
# A compact record, since piles of sheets have very many.
OVERLAP = np.dtype(
    [
        ("place", "f4", 2),  # place of the other box along the owner's face when it was computed [mm].
        ("turn", "f4", 4),  # directions of its faces' edges there.
        ("wide", "f4", 2),  # half lengths of the other box along them [mm].
        ("allowed", "f4"),  # bound on the motion of its corners along the owner's face since then [mm].
        ("most", "f4"),  # depth up to which faces own the contact [mm].
        ("look", "i4"),  # number of the caller's check in which it last held.
        ("state", "i1"),
        ("count", "i1"),  # number of corners.
        ("first", "i1"),  # 1 if the first box owns the contact, or separates outlines that are apart.
        ("side", "i1"),  # side of the owner's face along its normal.
        ("behind", "f8"),  # half the thickness of the other box [mm].
        ("thick", "f8"),  # half the thickness of the box whose face it is [mm].
        ("corners", "f8", (MOST_CORNERS, 3)),  # in the owner's axes [mm], and their stiffness [N/mm^1.5].
    ]
)
STIFF = 2  # column of the corners
# Motion of one face along the other since their overlap was computed, relative to the least half length of
# both. With 1e-2 within a step the error of notes that slide under a pad no longer falls with the step.
MOVED = 1e-5
# Contact of two boxes by their cached overlap: none, pressure, or one of their sides (facing.box_box).
CLEAR, PRESSES, BY_SIDES = 0, 1, 2
EVER = 1e30
STEEP = 0.75  # cosine of the angle between two faces beyond which they do not lie on each other


@njit(cache=True, error_model="numpy", forceinline=True)
def _seen(owner, other):
    """Place of the other box in the owner's axes, and the directions of its axes there."""
    return back(owner.r, sub(other.x, owner.x)), transpose_matmul(owner.r, other.r)


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def holds(kept, a, b, more):
    """True if the cached overlap of two boxes (Frames) still holds, and will hold while they move along each
    other by less than `more` [mm]."""
    if kept.state == UNKNOWN or kept.state == OTHER:
        return False
    place, turn = _seen(a, b) if kept.first != 0 else _seen(b, a)
    wide, allowed = kept.wide, kept.allowed - more
    for q in range(2):
        moved = abs(place[q] - kept.place[q])
        for i in range(2):
            moved += wide[i] * abs(turn[3 * q + i] - kept.turn[2 * q + i])
        if not moved <= allowed:  # also false for nan
            return False
    return True


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def apart(a, half_a, b, half_b, more):
    """True if two boxes (Frames) are apart by more than `more` [mm] along one of their faces' normals."""
    gap = sub(b.x, a.x)
    for k in range(2):
        one, half, other, wide = (a, half_a, b, half_b) if k == 0 else (b, half_b, a, half_a)
        normal = (one.r[2], one.r[5], one.r[8])
        there = back(other.r, normal)
        spread = half[2] + abs(there[0]) * wide[0] + abs(there[1]) * wide[1] + abs(there[2]) * wide[2]
        if abs(dot(gap, normal)) >= spread + more:
            return True
    return False


@njit(cache=True, error_model="numpy", forceinline=True)
def _seen_from(kept, place, turn, wide):
    """Stores the place of a box with these half lengths in the axes of the other one."""
    for q in range(2):
        kept.place[q], kept.wide[q] = place[q], wide[q]
        for i in range(2):
            kept.turn[2 * q + i] = turn[3 * q + i]


@njit(cache=True, error_model="numpy", **OWNS)
def find(kept, a, one_box, b, two_box, law):
    """Computes the overlap of two boxes of two sheets into a record OVERLAP."""
    half_a, half_b = one_box.half, two_box.half
    place, turn = _seen(a, b)
    far, turned = _seen(b, a)
    above, below = abs(place[2]) - half_a[2], abs(far[2]) - half_b[2]
    for i in range(3):
        above -= abs(turn[6 + i]) * half_b[i]
        below -= abs(turned[6 + i]) * half_a[i]
    reach = math.sqrt(dot(half_a, half_a)) + math.sqrt(dot(half_b, half_b))
    owner, half, other, wide, kept.first = a, half_a, b, half_b, 1
    if below > above + TIE * reach:
        owner, half, other, wide, kept.first = b, half_b, a, half_a, 0
        place, turn = far, turned
    side = 1.0 if place[2] >= 0.0 else -1.0
    kept.side = int(side)
    kept.behind, kept.thick, kept.most = wide[2], half[2], EVER
    _seen_from(kept, place, turn, wide)
    allowed = MOVED * min(half[0], half[1], wide[0], wide[1])
    kept.count, kept.state, kept.allowed = 0, APART, allowed
    if abs(turn[8]) < STEEP:
        kept.state = OTHER
        return
    # a side may own the contact where it overlaps by less than the faces do
    apart = False
    thin, narrow, gap, beside = min(half_a[2], half_b[2]), 1e300, 0.0, 0.0
    for q in range(2):
        spread, across = half[q] - abs(place[q]), wide[q] - abs(back(other.r, sub(owner.x, other.x))[q])
        for i in range(3):
            spread += abs(turn[3 * q + i]) * wide[i]
            across += abs(turn[3 * i + q]) * half[i]
        if spread <= GRAZE * half[q] or across <= GRAZE * wide[q]:
            gap, beside = max(gap, -spread), max(beside, -across)
            apart = True
        narrow = min(narrow, spread, across)
    if apart:
        thick = wide[2]
        if beside > gap:  # the larger gap is in the axes of the other box
            kept.first = 1 - kept.first
            place, turn = _seen(other, owner)
            _seen_from(kept, place, turn, half)
            gap, thick = beside, half[2]
        # an inclined face may extend beyond its outline by its thickness
        kept.allowed = max(allowed, 0.999 * gap - thick)
        return
    sides = one_box.exposed + two_box.exposed > 0 and narrow < 2.0 * thin
    if sides:
        kept.most = max(0.999 * narrow - allowed, 0.0)
    points = np.empty((12, 3))
    count, smaller, _ = overlay(points, owner, half, 2, side, other, wide)
    weights = np.empty(12)
    area = shares(points, count, 0, 1, weights) if 3 <= count <= MOST_CORNERS else 0.0
    if area <= 1e-12 * smaller:
        kept.state = OTHER if sides else APART
        return
    foundation = law.k / smaller if law.shared else law.k / area
    kept.count, kept.state = count, OVERLAPS
    for corner in range(count):
        kept.corners[corner, 0], kept.corners[corner, 1] = points[corner, 0], points[corner, 1]
        kept.corners[corner, STIFF] = foundation * weights[corner]


@njit(cache=True, error_model="numpy", forceinline=True)
def plane_of(kept, owner, other):
    """The other box's face that looks at the owner's, in the owner's axes: place of its box, depth at the
    middle of the owner's face, growth of depth along both of its edges."""
    normal = back(owner.r, (other.r[2], other.r[5], other.r[8]))
    place = back(owner.r, sub(other.x, owner.x))
    to = -kept.behind if kept.side * normal[2] > 0.0 else kept.behind
    p, r, up = place[0] + to * normal[0], place[1] + to * normal[1], place[2] + to * normal[2]
    lean_p, lean_r = normal[0] / normal[2], normal[1] / normal[2]
    level = kept.thick - kept.side * (up + lean_p * p + lean_r * r)
    return place, level, kept.side * lean_p, kept.side * lean_r


@njit(cache=True, error_model="numpy", forceinline=True)
def moves(owner, other, place):
    """Velocity and angular velocity of the owner relative to the other box, in the owner's axes and for its
    centre: a place p moves by the first + the second x p; `place`: that of the other box."""
    w, far = back(owner.r, owner.w), back(owner.r, other.w)
    # the relative velocity at p is v + w x p - far x (p - place), of which the first result is the constant
    # part
    return add(back(owner.r, sub(owner.v, other.v)), cross(far, place)), sub(w, far)


@njit(cache=True, error_model="numpy", forceinline=True)
def _closing(kept, rate, spin):
    """Closing rate of two faces, from the results of `moves`: at the middle of the owner's face, and its
    growth along both of its edges."""
    return kept.side * rate[2], -kept.side * spin[1], kept.side * spin[0]


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def impact(kept, a, b, faster, law, dt):
    """Energy that the cached overlap of two boxes (Frames) stores in a step of dt beyond the work done on it,
    and energy that its damping missed [N mm]; see mechanics.impacts.

    faster: changes of the velocity and the angular velocity of both boxes in half of the step.
    """
    first = kept.first != 0
    owner, other = (a, b) if first else (b, a)
    one, two = faster if first else (faster[1], faster[0])
    place, level, lean_p, lean_r = plane_of(kept, owner, other)
    rate, spin = moves(owner, other, place)
    closes, closes_p, closes_r = _closing(kept, rate, spin)
    rate, spin = moves(
        Frame(owner.x, owner.r, one[0], one[1]), Frame(other.x, other.r, two[0], two[1]), place
    )
    more, more_p, more_r = _closing(kept, rate, spin)
    made = missed = 0.0
    for corner in range(kept.count):
        p, r = kept.corners[corner, 0], kept.corners[corner, 1]
        depth = level + lean_p * p + lean_r * r
        if depth <= 0.0:
            continue
        spring = kept.corners[corner, STIFF] * depth * math.sqrt(depth)
        closing = closes + closes_p * p + closes_r * r
        moved = 0.5 * dt * closing
        made += stored_beyond(spring, depth, 0.4 * spring * depth, moved)
        back_on = turning_back(closing, more + more_p * p + more_r * r, law.beta, law.smoothing)
        missed += spring * dt * back_on
    return made, missed


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def press(out, kept, a, b, law):
    """Writes the contact of two boxes (Frames) by their cached overlap into `out` (see mechanics.point),
    evaluated in the owner's axes and without its points. Returns CLEAR, PRESSES or BY_SIDES; `out` is set
    where they press."""
    first = kept.first != 0
    owner, other = (a, b) if first else (b, a)
    place, level, lean_p, lean_r = plane_of(kept, owner, other)
    deepest = 0.0
    for corner in range(kept.count):
        deepest = max(deepest, level + lean_p * kept.corners[corner, 0] + lean_r * kept.corners[corner, 1])
    if deepest <= 0.0:
        return CLEAR
    if deepest > kept.most:
        return BY_SIDES
    way = -kept.side  # sign of the owner's normal, from the other box to it
    rate, spin = moves(owner, other, place)
    force, torque = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    pressing = stored = lost = rubbing = 0.0
    for corner in range(kept.count):
        p, r = kept.corners[corner, 0], kept.corners[corner, 1]
        depth = level + lean_p * p + lean_r * r
        if depth <= 0.0:
            continue
        at = (p, r, kept.side * (kept.thick - 0.5 * depth))
        spring = kept.corners[corner, STIFF] * depth * math.sqrt(depth)
        v = add(rate, cross(spin, at))
        closes = -way * v[2]
        speed = math.sqrt(v[0] * v[0] + v[1] * v[1])
        normal = damped(spring, closes, law.beta, law.smoothing)
        drag = normal * friction_over_speed(speed, law.mu_static, law.mu_dynamic, law.stiction, law.sliding)
        f = (-drag * v[0], -drag * v[1], way * normal)
        force, torque = add(force, f), add(torque, cross(at, f))
        pressing += normal
        stored += 0.4 * spring * depth
        lost += (normal - spring) * closes + drag * speed * speed
        rubbing += drag * speed
    back_on = sub(cross(place, force), torque)  # on the other box, about its own centre
    force, torque, back_on = rotate(owner.r, force), rotate(owner.r, torque), rotate(owner.r, back_on)
    sign = 1.0 if first else -1.0
    on_a, on_b = (torque, back_on) if first else (back_on, torque)
    for i in range(3):
        out[FORCE_A + i], out[FORCE_B + i] = sign * force[i], -sign * force[i]
        out[TORQUE_A + i], out[TORQUE_B + i] = on_a[i], on_b[i]
    out[PRESSING], out[STORED], out[DISSIPATED], out[DEPTH] = pressing, stored, lost, deepest
    out[RUBBING], out[GRIP] = rubbing, law.mu_static * pressing
    return PRESSES if pressing != 0.0 else CLEAR
