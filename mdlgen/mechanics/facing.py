"""Contact between two boxes: the face of one on the face of the other.

The face with the least overlap along its own normal owns the contact; a side only where it overlaps less
than the sheets' faces do over the area that they share, since tilted faces seem deep beyond their outlines.
The face of the other box that looks at it is cut to the owner's outline. Each corner of the resulting polygon
has a depth along the owner's normal, and represents a part of the area: half of the two triangles that its
edges form with the centroid. k is the stiffness of one pair whose smaller face lies wholly on the other, so a
corner with the area A_i pushes with

    F_i = k A_i / A z^1.5    (Eq. 10), A the area of the smaller face.

So two flat sheets that lie on each other push with the same force at any offset of their grids: the parts of
one box that lie on several boxes add up to the box. `share: pair` gives every pair the full k on any part
that it covers, as MotionSolve does. Both bodies get the force at one point, so linear and angular momentum
are conserved exactly. Sides of a box that a neighbour in its sheet covers own no contact.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.contact import clip, face_corners
from mdlgen.mechanics.point import Load, push
from mdlgen.mechanics.vector import add, back, dot, local, rotate, scale, sub, transpose_matmul
from mdlgen.program.kernel import CALLED, OWNS, njit

# Parts of the boxes' size by which another face must overlap less to own the contact: round-off does not
# make two parallel faces take turns.
TIE = 1e-9
# Nor do faces whose outlines only meet, as those of boxes in equal grids on each other do, have an area.
GRAZE = 1e-9


@njit(cache=True, error_model="numpy")
def _parting(ra, half_a, exposed, rb, half_b, gap):
    """Distance of two boxes along the normals of the first: (true if one of them separates them, distance
    along its faces' normal, its sign, greatest distance along a free side, its axis, its sign); overlap is
    negative, and a box without a free side has -1e300."""
    place, turn = back(ra, gap), transpose_matmul(ra, rb)
    best, at, side = -1e300, 0, 1.0
    face, face_sign = 0.0, 1.0
    for q in range(3):
        spread = half_a[q]
        for i in range(3):
            spread += abs(turn[3 * q + i]) * half_b[i]
        distance = abs(place[q]) - spread
        sign = 1.0 if place[q] >= 0.0 else -1.0
        if distance >= (-GRAZE * half_a[q] if q < 2 else 0.0):
            return True, face, face_sign, best, at, side
        if q == 2:
            face, face_sign = distance, sign
        elif distance > best and exposed & (1 << (2 * q + (1 if sign > 0.0 else 0))) != 0:
            best, at, side = distance, q, sign
    return False, face, face_sign, best, at, side


@njit(cache=True, error_model="numpy")
def overlay(points, owner, half, q, sign, other, wide):
    """The part of the face of box `other` (half lengths `wide`) that looks at face q of box `owner`, over
    that face's outline: its corners into `points`, in the axes of the owner; (number of corners, area of the
    smaller face, global normal)."""
    p, r = (q + 1) % 3, (q + 2) % 3
    normal = rotate(owner.r, local(p, r, q, 0.0, 0.0, sign))
    area = face_corners(points, other, wide, back(other.r, normal), owner)
    smaller = min(4.0 * half[p] * half[r], area)
    count = 4
    for side in (1.0, -1.0):
        count = clip(points, count, local(p, r, q, side, 0.0, 0.0), half[p])
        count = clip(points, count, local(p, r, q, 0.0, side, 0.0), half[r])
    return count, smaller, normal


@njit(cache=True, error_model="numpy")
def shares(points, count, p, r, weights):
    """Writes the area that each corner of a polygon represents into `weights`; returns the sum. p, r: its
    axes."""
    area = cp = cr = 0.0
    for i in range(1, count - 1):
        ap, ar = points[i, p] - points[0, p], points[i, r] - points[0, r]
        bp, br = points[i + 1, p] - points[0, p], points[i + 1, r] - points[0, r]
        part = 0.5 * (ap * br - ar * bp)
        area += part
        cp += part * (ap + bp) / 3.0
        cr += part * (ar + br) / 3.0
    if area == 0.0:
        return 0.0
    cp, cr = points[0, p] + cp / area, points[0, r] + cr / area
    for i in range(count):
        weights[i] = 0.0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        ap, ar = points[i, p] - cp, points[i, r] - cr
        bp, br = points[j, p] - cp, points[j, r] - cr
        part = 0.25 * abs(ap * br - ar * bp)
        weights[i] += part
        weights[j] += part
    return abs(area)


@njit(cache=True, error_model="numpy", **OWNS, **CALLED)
def box_box(out, a, one_box, b, two_box, law):
    """Box a against box b of another sheet."""
    half_a, half_b = one_box.half, two_box.half
    gap = sub(b.x, a.x)
    reach = math.sqrt(dot(half_a, half_a)) + math.sqrt(dot(half_b, half_b))
    if dot(gap, gap) > reach * reach:
        return
    apart, one, sign, side_a, q_a, sign_a = _parting(a.r, half_a, one_box.exposed, b.r, half_b, gap)
    if apart:
        return
    apart, two, sign_two, side_b, q_b, sign_b = _parting(
        b.r, half_b, two_box.exposed, a.r, half_a, scale(-1.0, gap)
    )
    if apart:
        return
    points = np.empty((12, 3))
    owner, half, other, wide, to_a, q = a, half_a, b, half_b, -1.0, 2
    if two > one + TIE * reach:
        owner, half, other, wide, to_a, sign = b, half_b, a, half_a, 1.0, sign_two
    count, smaller, normal = overlay(points, owner, half, q, sign, other, wide)
    side = max(side_a, side_b)
    if side > max(one, two) + TIE * reach:
        deepest = -1.0
        for corner in range(count):
            deepest = max(deepest, half[q] - sign * points[corner, q])
        if count < 3 or deepest > -side:
            owner, half, other, wide, to_a, q, sign = a, half_a, b, half_b, -1.0, q_a, sign_a
            if side_b > side_a + TIE * reach:
                owner, half, other, wide, to_a, q, sign = b, half_b, a, half_a, 1.0, q_b, sign_b
            count, smaller, normal = overlay(points, owner, half, q, sign, other, wide)
    if count < 3:
        return
    p, r = (q + 1) % 3, (q + 2) % 3
    weights = np.empty(12)
    area = shares(points, count, p, r, weights)
    if area <= 1e-12 * smaller:
        return
    foundation = law.k / smaller if law.shared else law.k / area
    for corner in range(count):
        depth = half[q] - sign * points[corner, q]
        if depth <= 0.0:
            continue
        # halfway between both faces
        at = local(p, r, q, points[corner, p], points[corner, r], points[corner, q] + 0.5 * sign * depth)
        spring = foundation * weights[corner] * depth * math.sqrt(depth)
        push(
            out,
            add(owner.x, rotate(owner.r, at)),
            scale(to_a, normal),
            Load(spring, depth, 0.4 * spring * depth),
            a,
            b,
            law,
        )
