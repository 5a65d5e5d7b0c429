"""The pressure of a round on a face of a box: of a roller, a part of one, or the edge of a plate.

The force of one box under a roller is k z^1.5 (Eq. 10), z the depth of the point of its face nearest to the
roller's axis, times the part of the roller's width that the box covers. Where boxes lie side by side under
one roller (`share: width`), they also share k across it: each takes its part of the elastic foundation that
has the same law. A pressure K zeta per area, zeta the depth of each point, under a roller of radius R and
width w pressed z deep into a flat face, gives F = K w 4/3 sqrt(2R) z^1.5; with K = 3 k/(4 w sqrt(2 R)) that
is k z^1.5 again. So a roller that passes from box to box acts as on one sheet. Beyond a free edge no
neighbour takes over. There the box keeps the whole pressure, about the contact line as if the sheet
continued. As an edge comes to that line the pressure is drawn in to it, since force, moment and damping on
both sides of that place must be equal. `share: pair` gives every box the full k, as MotionSolve does.

Two rollers that face each other across a sheet must press equally on each of two boxes as a joint passes
between them. Otherwise the excess of one roller would turn the boxes out of the sheet, by a kink at every
joint that passes, and fling a light sheet. With the pressure k z^1.5 of a round of radius R each reaches
sqrt(2 R z), and in balance z is proportional to k^(-2/3). So the pressure of rollers that face each other is
that of rounds whose radii are proportional to k^(2/3) (`spread`, see mdlgen.model.nips); the force and its
line are those of the roller. Where the radius is not the roller's, the moment on a box that ends in the nip
does not follow from the stored energy: it differs by (spread - R) times the energy per length at that end.
Its work, where a sheet leaves a nip with another curvature than it had before, counts as dissipated.

A roller that is inclined to the face presses perpendicular to its own axis, so that the forces have a
resultant along the sheet. Where the roller ends on the sheet, its rim pushes back with the energy per length
there (`_rim`): both together are the gradient of the stored energy for a motion along the axis. So a sheet
that is wider than the roller is not pushed at all, and one that is narrower is squeezed out as by a wedge.

On a line of the face perpendicular to the axis, two points represent the pressure of the round (`_line`).
Along the axis such lines are summed by Gauss' rule. At a joint oblique to the roller the pressure begins and
ends. So the sum is over pieces, from the place where an edge of the face enters the nip to where it leaves
it. Then boxes on both sides of that joint add up to the force on one sheet.
"""

from __future__ import annotations

import math

from mdlgen.mechanics.contact_patch import (
    GAUSS,
    NONE,
    Seen,
    at_ends,
    cuts_of,
    energy_of,
    foundation,
    free_at,
    lie_of,
    next_of,
    scale_of_energy,
    straight_edges,
)
from mdlgen.mechanics.laws import damped
from mdlgen.mechanics.point import (
    DISSIPATED,
    STORED,
    Load,
    Nip,
    closing,
    passing,
    push,
    push_in_nip,
    push_without_friction,
)
from mdlgen.mechanics.vector import add, cross, dot, local, rotate, scale, sub
from mdlgen.program.kernel import BORROWS, FUSED, njit

WHOLE = 4.0  # the whole round instead of a sector: more than half a turn
_THIRD = math.sqrt(0.6)
# An end of a roller stands on all boxes that are nearer to it along the axis than this part of its width.
EASE = 0.003
# Places and weights of Gauss' rule of four points.
_INNER, _OUTER = (
    math.sqrt(3.0 / 7.0 - 2.0 / 7.0 * math.sqrt(1.2)),
    math.sqrt(3.0 / 7.0 + 2.0 / 7.0 * math.sqrt(1.2)),
)
_WIDE, _NARROW = 0.5 + math.sqrt(30.0) / 36.0, 0.5 - math.sqrt(30.0) / 36.0


@njit(cache=True, error_model="numpy", forceinline=True)
def _at_two(middle, apart, of, off):
    """Pressure across and along a face at two places of a round, at equal distances from their middle."""
    across = along = 0.0
    for side in (-1.0, 1.0):
        t = middle + side * apart
        distance = math.sqrt(t * t + off * off)
        across += (of / distance - 1.0) * off
        along += (of / distance - 1.0) * t
    return across, along


@njit(cache=True, error_model="numpy", forceinline=True)
def _over(left, right, of, off):
    """Integral from left to right of the pressure of a round across a face."""
    middle, half = 0.5 * (left + right), 0.5 * (right - left)
    inner, _ = _at_two(middle, _INNER * half, of, off)
    outer, _ = _at_two(middle, _OUTER * half, of, off)
    return half * (_WIDE * inner + _NARROW * outer)


@njit(cache=True, error_model="numpy", **BORROWS)
def _part_of_nip(left, right, reach, of, off):
    """Factor of the forces, and angle of rotation of the normals, of two points for a part of a nip. With
    these all parts add up to the forces of two points for the whole nip, without a force along a continuous
    face.

    Along a face the pressure zeta of a round adds up to the difference of zeta^2/2 at both ends.
    """
    middle, half = 0.5 * (left + right), 0.5 * (right - left)
    across, along = _at_two(middle, GAUSS * half, of, off)
    whole, _ = _at_two(0.0, GAUSS * reach, of, off)
    share = reach * whole / _over(-reach, reach, of, off)
    factor = share * _over(left, right, of, off) / (half * across)
    low, high = of - math.sqrt(left * left + off * off), of - math.sqrt(right * right + off * off)
    ends = 0.5 * share * (low - high) * (low + high)
    return factor, (ends / (factor * half) - along) / across


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def press(out, face, a, half, b, roller, sector, law):
    """One face of a box against a cylinder, whose centre, axis and sector are given in box axes.

    face: (p, r, q, sign, free), its in-plane axes and its normal axis, on which side it is, and which edges
    p_min, p_max, r_min, r_max have no neighbour, as a bit mask; roller: (centre, axis, radius, width).
    """
    p, r, q, sign, _ = face
    l0, al, radius, width = roller
    to, angle = sector.middle, sector.angle
    na = math.sqrt(al[p] * al[p] + al[r] * al[r])
    if na < 0.2:  # the roller stands on its end
        return
    up, ur = al[p] / na, al[r] / na  # along the axis in the face; across it: (-ur, up)
    lean = sign * al[q]
    height = sign * l0[q] - half[q]
    # corners of the face along the axis
    c1, c2 = abs(up) * half[p], abs(ur) * half[r]
    base = -(l0[p] * up + l0[r] * ur)
    low = max(base - c1 - c2, (-0.5 * width + height * lean) / na)
    high = min(base + c1 + c2, (0.5 * width + height * lean) / na)
    if high <= low - (2.0 * EASE * width / na if law.shared else 0.0):
        return
    steep_low, steep_high, basis = -1e30, 1e30, width
    if angle < WHOLE:
        # directions from the axis to points of the face, against that to the contact line; 1.5 rad is far
        middle = math.atan2(to[r] * up - to[p] * ur, lean * (to[p] * up + to[r] * ur) - na * sign * to[q])
        low_angle, high_angle = max(middle - angle, -1.5), min(middle + angle, 1.5)
        if high_angle <= low_angle:
            return
        steep_low, steep_high = math.tan(low_angle), math.tan(high_angle)
        basis = 2.0 * (c1 + c2) * na
    wide = law.spread if law.spread > 0.0 else radius
    rim_low, rim_high = low > base - c1 - c2, high < base + c1 + c2
    flush = (rim_low if lean > 0.0 else rim_high) or not free_at(face, up, ur, lean < 0.0)
    seen = Seen(
        l0, up, ur, na, lean, height, steep_low, steep_high, radius, wide, sector.aside, sector.turns, flush
    )
    if law.shared:
        # an end is handed on from box to box over a short way, else its force would jump at their joint
        ease = EASE * width / na
        for outward in (-1.0, 1.0):
            at = (outward * 0.5 * width + height * lean) / na
            first, last = max(at - ease, base - c1 - c2), min(at + ease, base + c1 + c2)
            if last > first:
                middle, apart = 0.5 * (first + last), 0.5 * GAUSS * (last - first)
                stiffness = outward * law.k / basis * (last - first) / (4.0 * ease)
                _rim(out, face, a, half, b, seen, law, middle - apart, stiffness)
                _rim(out, face, a, half, b, seen, law, middle + apart, stiffness)
    deep_low, deep_high = radius - height * na - low * lean, radius - height * na - high * lean
    if high <= low or (deep_low <= 0.0 and deep_high <= 0.0):
        return
    straight = not law.shared or (
        deep_low > 0.0 and deep_high > 0.0 and straight_edges(seen, 0.5 * (deep_low + deep_high), high - low)
    )
    inner = abs(c1 - c2)
    for part in range(3 if law.shared else 1):
        # between two corners the face's edges are straight
        begin, end = low, high
        if law.shared:
            begin = max(low, base - inner) if part == 1 else max(low, base + inner) if part == 2 else low
            end = min(high, base - inner) if part == 0 else min(high, base + inner) if part == 1 else high
        if end - begin <= 1e-12 * width:
            continue
        middle, long = 0.5 * (begin + end), 0.5 * (end - begin)
        cuts, oblique = (NONE, NONE, NONE, NONE, NONE, NONE, NONE), False
        if not straight:
            cuts, oblique = cuts_of(seen, face, half, middle, long)
        v = -1.0
        while v < 1.0:
            to_v = next_of(v, cuts)
            center, half_piece = middle + 0.5 * (v + to_v) * long, 0.5 * (to_v - v) * long
            # the piece's part of k
            weight = law.k * (2.0 * half_piece * na / basis if law.shared else 1.0)
            apart = half_piece * (_THIRD if oblique else GAUSS)
            for side in range(3 if oblique else 2):
                part_of = 0.5 if not oblique else 4.0 / 9.0 if side == 2 else 5.0 / 18.0
                u = center + (apart if side == 1 else -apart if side == 0 else 0.0)
                _line(out, face, a, half, b, seen, law, u, part_of * weight)
            v = to_v


@njit(cache=True, error_model="numpy", **BORROWS)
def _rim(out, face, a, half, b, seen, law, u, stiffness):
    """Force of an end of the roller, at u along its axis, on the face: the energy per length there, along the
    axis, outward. It is damped like the nip, so that a sheet that meets it is not thrown aside. `stiffness`
    is that per length, below zero at the low end."""
    lie = lie_of(seen, face, half, True, u)
    if lie.depth <= 0.0:
        return
    p, r, q, sign, _ = face
    under = local(p, r, q, seen.center[p] + u * seen.up, seen.center[r] + u * seen.ur, sign * half[q])
    at = add(add(a.x, rotate(a.r, under)), seen.aside)
    axis = local(p, r, q, seen.flat * seen.up, seen.flat * seen.ur, sign * seen.lean)
    square = rotate(a.r, local(p, r, q, 0.0, 0.0, -sign))
    over = law.smoothing
    if seen.turns:
        across = rotate(a.r, local(p, r, q, -seen.ur, seen.up, 0.0))
        pressed = passing(at, across, lie.reach / lie.of, a, b)
        over = math.sqrt(over * over + pressed * pressed)
    spring = stiffness * energy_of(seen, lie)
    force = damped(spring, closing(at, square, a, b), law.beta, over)
    push_without_friction(out, at, rotate(a.r, axis), spring, force, a, b)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS, **FUSED)
def _line(out, face, a, half, b, seen, law, u, weight):
    """Adds the force of a round on the line of a face at u along its axis, with `weight` of the stiffness."""
    lie = lie_of(seen, face, half, law.shared, u)
    if lie.depth <= 0.0:
        return
    p, r, q, sign, _ = face
    l0, up, ur, na, lean, radius = seen.center, seen.up, seen.ur, seen.flat, seen.lean, seen.radius
    e, nearest, spread, of, off, reach, left, right, depth, draw = lie
    # from the axis to the contact line: back along the face's normal, turned with the lean
    square = rotate(a.r, local(p, r, q, 0.0, 0.0, -sign))
    way = square
    if law.shared or not seen.flush:
        way = rotate(a.r, local(p, r, q, lean * up, lean * ur, -na * sign))
    under = local(p, r, q, l0[p] + u * up, l0[r] + u * ur, sign * half[q])
    line = add(add(a.x, rotate(a.r, under)), seen.aside)
    across = rotate(a.r, local(p, r, q, -ur, up, 0.0))
    # the 2-point rule costs 5/12 z/R of the force, the lean of the pressure 1/3 z/R
    lost = 5.0 / 12.0 + draw * draw / 3.0
    if spread:
        # energies of two points add up to it where they have all of the nip, and else do not
        out[STORED] += weight * energy_of(seen, lie)
        if of != radius:
            ends = weight * scale_of_energy(seen, lie) * at_ends(left, right, reach)
            out[DISSIPATED] += (of - radius) * ends * dot(sub(a.w, b.w), cross(across, way))
    pressed = draw * passing(line, across, reach / of, a, b) if spread and seen.turns else 0.0
    middle_t, apart = 0.5 * (left + right), 0.5 * GAUSS * (right - left)
    low_zeta = of - math.sqrt((middle_t - apart) ** 2 + off * off)
    high_zeta = of - math.sqrt((middle_t + apart) ** 2 + off * off)
    further = 1.0 + law.lever + law.bend * (radius - e)
    factor, turned = 1.0, 0.0
    if spread and (left > -reach or right < reach):
        factor, turned = _part_of_nip(left, right, reach, of, off)
        turned *= draw
    # middle of the pressure on this box
    center = draw * (middle_t + apart * (high_zeta - low_zeta) / (high_zeta + low_zeta))
    for point in range(2 if spread else 1):
        t = nearest
        if spread:
            t = middle_t + (2.0 * point - 1.0) * apart
        zeta = of - math.sqrt(t * t + off * off)
        if spread:
            length = 0.5 * (right - left) * (1.0 + lost * (radius - e) / of) * factor
            spring = weight * foundation(seen) * length * zeta
            energy = 0.6 * spring * zeta  # 2/5 F z: both points are 2/3 z deep
            out[STORED] -= energy
            t *= draw
        else:
            spring = weight * zeta * math.sqrt(zeta)
            energy = 0.4 * spring * zeta
        distance = math.sqrt(t * t + off * off)
        slant = distance * math.sqrt(1.0 + turned * turned)
        normal = add(scale((t + turned * off) / slant, across), scale((off - turned * t) / slant, way))
        # on the normal's line, as far from the axis as the roller's own surface: it rolls at omega R, on a
        # cover at omega (R + lever z + bend z^2)
        beyond = further * (radius - e) * distance / off if spread else further * (radius - distance)
        at = add(add(line, scale(t, across)), scale(beyond, normal))
        if spread:
            nip = Nip(line, add(line, scale(center, across)), square if seen.flush else way, pressed)
            push_in_nip(out, at, normal, nip, Load(spring, depth, energy), a, b, law)
        else:
            push(out, at, normal, Load(spring, depth, energy), a, b, law)
